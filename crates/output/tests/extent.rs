//! The flooded extent as GeoJSON.

use corpuscle_output::{compare_extent, write_extent, write_run_up};
use corpuscle_scene::{NoData, TerrainFile};
use corpuscle_terrain::Terrain;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A terrain of 40 x 30 cells of 10 m (0.0001 degrees where geographic).
fn terrain(folder: &Path, crs: Option<&str>, corner: [f64; 2], cell: f64) -> Terrain {
    let path = folder.join("dem.asc");
    let rows: String =
        (0..30).map(|row| (0..40).map(|column| format!("{} ", row + column)).collect::<String>() + "\n").collect();
    let header = format!(
        "ncols 40\nnrows 30\nxllcorner {}\nyllcorner {}\ncellsize {cell}\nNODATA_value -9999\n",
        corner[0], corner[1]
    );
    fs::write(&path, header + &rows).unwrap();
    let file = TerrainFile { path, crs: crs.map(str::to_owned), no_data: NoData::Wall };
    Terrain::open(&corpuscle_scene::Terrain::File(file), 1, folder).unwrap()
}

/// A lake with an island, and a pond that touches it at a corner.
fn depths() -> Vec<f32> {
    let wet = |column: usize, row: usize| {
        let lake = (5..25).contains(&column) && (5..20).contains(&row);
        let island = (10..14).contains(&column) && (8..12).contains(&row);
        let pond = (25..30).contains(&column) && (20..24).contains(&row);
        lake && !island || pond
    };
    (0..1200).map(|cell| if wet(cell % 40, cell / 40) { 1.0 } else { f32::NAN }).collect()
}

const CELLS: f64 = (20 * 15 - 16 + 20) as f64;

/// Signed areas of the rings of each polygon.
fn areas(geojson: &Value) -> Vec<Vec<f64>> {
    let ring_area = |ring: &Value| -> f64 {
        let positions: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
        assert_eq!(positions.first(), positions.last());
        positions.windows(2).map(|pair| 0.5 * (pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1])).sum()
    };
    let polygons = geojson["features"][0]["geometry"]["coordinates"].as_array().unwrap();
    polygons.iter().map(|polygon| polygon.as_array().unwrap().iter().map(ring_area).collect()).collect()
}

fn extent(terrain: &Terrain, folder: &Path) -> Value {
    let path = folder.join("extent.geojson");
    write_extent(&path, terrain, &depths()).unwrap();
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn without_reference_system_coordinates_are_the_terrains_own() {
    let folder = tempfile::tempdir().unwrap();
    let terrain = terrain(folder.path(), None, [1000.0, 2000.0], 10.0);
    let geojson = extent(&terrain, folder.path());
    assert_eq!(areas(&geojson), [vec![30_000.0, -1600.0], vec![2000.0]]);
    let properties = &geojson["features"][0]["properties"];
    assert_eq!(properties["area_m2"], CELLS * 100.0);
    assert!(properties["note"].as_str().unwrap().contains("no reference system"));
    // South-west corner of the lake: column 5, row 20 from the north.
    let positions = geojson["features"][0]["geometry"]["coordinates"][0][0].as_array().unwrap();
    assert!(positions.contains(&serde_json::json!([1050.0, 2100.0])));
}

#[test]
fn projected_terrain_gives_longitude_and_latitude() {
    let folder = tempfile::tempdir().unwrap();
    // UTM zone 33 north, on its central meridian.
    let terrain = terrain(folder.path(), Some("EPSG:32633"), [500_000.0, 5_300_000.0], 10.0);
    let geojson = extent(&terrain, folder.path());
    assert_eq!(geojson["features"][0]["properties"].get("note"), None);
    let positions = geojson["features"][0]["geometry"]["coordinates"][0][0].as_array().unwrap();
    for position in positions {
        let [longitude, latitude] = [0, 1].map(|axis| position[axis].as_f64().unwrap());
        assert!((15.0..15.01).contains(&longitude) && (47.8..47.9).contains(&latitude), "{position}");
    }
    // A degree of latitude is 111.2 km here, one of longitude 74.8 km.
    let [lake, island] = [0, 1].map(|ring| areas(&geojson)[0][ring] * 111_190.0 * 74_790.0);
    assert!((lake / 30_000.0 - 1.0).abs() < 5e-3 && (island / -1600.0 - 1.0).abs() < 5e-3, "{lake} {island}");
}

#[test]
fn an_extent_compared_with_itself_scores_full() {
    let folder = tempfile::tempdir().unwrap();
    for (crs, corner, cell) in [
        (None, [1000.0, 2000.0], 10.0),
        (Some("EPSG:32633"), [500_000.0, 5_300_000.0], 10.0),
        (Some("EPSG:4326"), [-84.2, 36.5], 0.0001),
    ] {
        let terrain = terrain(folder.path(), crs, corner, cell);
        extent(&terrain, folder.path());
        let scores = compare_extent(&folder.path().join("extent.geojson"), &terrain, &depths()).unwrap();
        assert_eq!((scores.hit_rate, scores.false_alarm_ratio, scores.critical_success_index), (1.0, 0.0, 1.0));
        assert!((scores.observed_area_m2 / scores.simulated_area_m2 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn where_the_terrain_has_no_data_nothing_is_missed() {
    let folder = tempfile::tempdir().unwrap();
    let whole = terrain(folder.path(), None, [1000.0, 2000.0], 10.0);
    extent(&whole, folder.path());
    // The same terrain, cut out to its western part: half of the lake is not in it.
    let path = folder.path().join("dem.asc");
    let text = fs::read_to_string(&path).unwrap();
    let cut = |line: &str| {
        let cells = line.split_whitespace().enumerate();
        cells
            .map(|(column, height)| if column < 15 { format!("{height} ") } else { "-9999 ".into() })
            .collect::<String>()
            + "\n"
    };
    let is_row = |line: &str| line.split_whitespace().count() == 40;
    let rows: String = text.lines().map(|line| if is_row(line) { cut(line) } else { format!("{line}\n") }).collect();
    fs::write(&path, rows).unwrap();
    let file = TerrainFile { path, crs: None, no_data: NoData::Wall };
    let western = Terrain::open(&corpuscle_scene::Terrain::File(file), 1, folder.path()).unwrap();
    let mut computed = depths();
    computed.iter_mut().enumerate().filter(|(cell, _)| cell % 40 >= 15).for_each(|(_, depth)| *depth = f32::NAN);
    let scores = compare_extent(&folder.path().join("extent.geojson"), &western, &computed).unwrap();
    assert_eq!((scores.hit_rate, scores.critical_success_index), (1.0, 1.0));
}

#[test]
fn nothing_wet_is_an_empty_extent() {
    let folder = tempfile::tempdir().unwrap();
    let terrain = terrain(folder.path(), None, [0.0, 0.0], 10.0);
    let path = folder.path().join("extent.geojson");
    write_extent(&path, &terrain, &[f32::NAN; 1200]).unwrap();
    let geojson: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    assert_eq!(areas(&geojson).len(), 0);
    assert_eq!(geojson["features"][0]["properties"]["area_m2"], 0.0);
}

/// Water over the western half of a slope that rises by 1 m a cell eastwards: the line runs along its eastern border and the border of an island only.
#[test]
fn the_run_up_line_leaves_out_where_the_terrain_ends() {
    let folder = tempfile::tempdir().unwrap();
    let terrain = terrain(folder.path(), None, [1000.0, 2000.0], 10.0);
    let is_wet = |cell: usize| cell % 40 < 20 && cell != 15 * 40 + 4;
    let depths: Vec<f32> = (0..1200).map(|cell| if is_wet(cell) { 1.0 } else { f32::NAN }).collect();
    let path = folder.path().join("run_up.geojson");
    write_run_up(&path, &terrain, &depths).unwrap();
    let geojson: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let feature = &geojson["features"][0];
    assert_eq!(feature["geometry"]["type"], "MultiLineString");
    let lines: Vec<Vec<[f64; 2]>> = serde_json::from_value(feature["geometry"]["coordinates"].clone()).unwrap();
    assert_eq!(lines[0], [[1200.0, 2000.0], [1200.0, 2300.0]]);
    assert!(lines.len() == 2 && lines[1].len() == 5 && lines[1].contains(&[1040.0, 2150.0]), "{lines:?}");
    // The wet cell farthest to the south-east, column 19 of row 29: the ground is column + row.
    let highest = feature["properties"]["highest_m"].as_f64().unwrap();
    assert!((highest - 48.0).abs() < 0.3, "{highest}");
    write_run_up(&path, &terrain, &[f32::NAN; 1200]).unwrap();
    let none: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    assert!(none["features"][0]["properties"]["highest_m"].is_null());
}
