//! From a terrain's own coordinates to metres, to longitude and latitude, and back. Expected numbers are from PROJ 9
//! (through rasterio).

use corpuscle_scene::{NoData, TerrainFile};
use corpuscle_terrain::{RasterField, Terrain, read_raster, write_geotiff};
use geotiff_writer::GeoTiffBuilder;
use ndarray::Array2;
use std::path::Path;
use tempfile::TempDir;

const COLUMNS: usize = 60;
const ROWS: usize = 50;

/// Writes a raster of the given heights at (x, y) in its own coordinates.
fn write(path: &Path, builder: GeoTiffBuilder, corner: [f64; 2], cell: f64, height: impl Fn(f64, f64) -> f64) {
    let samples = Array2::from_shape_fn((ROWS, COLUMNS), |(row, column)| {
        height(corner[0] + (column as f64 + 0.5) * cell, corner[1] - (row as f64 + 0.5) * cell)
    });
    builder.pixel_scale(cell, cell).origin(corner[0], corner[1]).write_2d(path, samples.view()).unwrap();
}

fn builder() -> GeoTiffBuilder {
    GeoTiffBuilder::new(COLUMNS as u32, ROWS as u32)
}

fn open(folder: &TempDir, crs: Option<&str>) -> Terrain {
    let scene = TerrainFile { path: "dem.tif".into(), crs: crs.map(Into::into), no_data: NoData::Wall };
    Terrain::open(&corpuscle_scene::Terrain::File(scene), 1, folder.path()).unwrap()
}

fn assert_near(a: [f64; 2], b: [f64; 2], tolerance: f64) {
    assert!((a[0] - b[0]).abs() <= tolerance && (a[1] - b[1]).abs() <= tolerance, "{a:?} is not {b:?}");
}

#[test]
fn a_projected_terrain_keeps_its_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let plane = |x: f64, y: f64| 0.1 * (x - 535_000.0) - 0.2 * (y - 5_594_000.0);
    let corner = [535_000.0, 5_595_000.0];
    write(&folder.path().join("dem.tif"), builder().projected_epsg(25832), corner, 20.0, plane);
    let terrain = open(&folder, None);
    assert!(terrain.warnings().is_empty(), "{:?}", terrain.warnings());
    let bounds = terrain.bounds();
    assert_eq!(
        [bounds.x_min, bounds.x_max, bounds.y_min, bounds.y_max],
        [535_000.0, 536_200.0, 5_594_000.0, 5_595_000.0]
    );
    let (height, slope) = terrain.height_and_slope(535_461.0, 5_594_344.0);
    assert!((height - plane(535_461.0, 5_594_344.0)).abs() < 1e-8);
    assert_near(slope, [0.1, -0.2], 1e-10);
    assert_near(terrain.from_lon_lat([9.5, 50.5]).unwrap(), [535_460.445_812_532_4, 5_594_344.786_006_397], 1e-3);
    assert_near(terrain.to_lon_lat([535_460.445_812_532_4, 5_594_344.786_006_397]).unwrap(), [9.5, 50.5], 1e-8);
    assert_eq!(terrain.map_grid().centre(0, 0), [535_010.0, 5_594_990.0]);
    assert_near(terrain.map_grid().position(535_010.0, 5_594_990.0), [0.0, 0.0], 1e-12);
    assert!((terrain.map_grid().cell_area(3, 4) - 400.0).abs() < 1e-6);
}

#[test]
fn a_geographic_terrain_becomes_metres_about_its_middle() {
    let folder = tempfile::tempdir().unwrap();
    let degree = 1.0 / 1200.0;
    let corner = [-84.27, 36.61];
    let ground = |lon: f64, lat: f64| 500.0 + 2000.0 * (lon + 84.25) - 1000.0 * (lat - 36.6);
    write(&folder.path().join("dem.tif"), builder().geographic_epsg(4326), corner, degree, ground);
    let terrain = open(&folder, None);
    let middle = [corner[0] + 0.5 * COLUMNS as f64 * degree, corner[1] - 0.5 * ROWS as f64 * degree];
    assert_near(terrain.to_model(middle), [0.0, 0.0], 1e-6);
    let [width, height] = terrain.map_grid().cell_size();
    // At 36.6 degrees north a degree is 89.5 km of longitude and 111.0 km of latitude.
    assert!((width - 89_500.0 * degree).abs() < 0.2 && (height - 110_970.0 * degree).abs() < 0.2, "{width} {height}");
    for [column, row] in [[3, 2], [30, 20], [55, 47]] {
        let [x, y] = terrain.map_grid().centre(column, row);
        let [lon, lat] = terrain.to_own([x, y]);
        assert_near(terrain.map_grid().position(x, y), [column as f64, row as f64], 1e-6);
        assert!(terrain.bounds().contains(x, y));
        assert!(
            (terrain.height(x, y) - ground(lon, lat)).abs() < 1e-3,
            "{} {}",
            terrain.height(x, y),
            ground(lon, lat)
        );
        assert_near(terrain.to_lon_lat([x, y]).unwrap(), [lon, lat], 1e-9);
        assert_near(terrain.from_lon_lat([lon, lat]).unwrap(), [x, y], 1e-4);
    }
    // Every corner of the bounds lies on the raster.
    let bounds = terrain.bounds();
    for x in [bounds.x_min, bounds.x_max] {
        for y in [bounds.y_min, bounds.y_max] {
            let [column, row] = terrain.map_grid().position(x, y);
            assert!((-0.501..COLUMNS as f64 - 0.499).contains(&column) && (-0.501..ROWS as f64 - 0.499).contains(&row));
        }
    }
}

#[test]
fn the_local_projection_is_that_of_proj() {
    let folder = tempfile::tempdir().unwrap();
    let degree = 0.000_833_333_333_333_333_4;
    let corner = [-84.413_75, 36.732_916_666_666_67];
    let samples = Array2::<i16>::zeros((344, 403));
    let builder = GeoTiffBuilder::new(403, 344).geographic_epsg(4326);
    let builder = builder.pixel_scale(degree, degree).origin(corner[0], corner[1]);
    builder.write_2d(folder.path().join("dem.tif"), samples.view()).unwrap();
    let terrain = open(&folder, None);
    assert_near(terrain.to_model([-84.4, 36.5]), [-13_811.966_251_216, -9_929.931_637_501], 1e-3);
    assert_near(terrain.to_model([-84.1, 36.7]), [13_031.692_251_989, 12_262.959_020_318], 1e-3);
}

#[test]
fn a_terrain_in_feet_becomes_metres() {
    let folder = tempfile::tempdir().unwrap();
    let corner = [6_422_000.0, 2_066_000.0];
    write(&folder.path().join("dem.tif"), builder().projected_epsg(2225), corner, 30.0, |x, _| x - corner[0]);
    let terrain = open(&folder, None);
    let foot = 1200.0 / 3937.0;
    assert!((terrain.bounds().size()[0] - 60.0 * 30.0 * foot).abs() < 1e-6);
    assert_near(terrain.to_model(corner), corner.map(|value| value * foot), 1e-6);
    let position = terrain.from_lon_lat([-122.5, 40.5]).unwrap();
    assert_near(terrain.to_own(position), [6_422_625.255_795_221, 2_065_824.321_027_114_3], 1e-2);
    let (height, [east, _]) = terrain.height_and_slope(position[0], position[1]);
    assert!((height - 625.255).abs() < 1e-2 && (east - 1.0 / foot).abs() < 1e-6);
}

#[test]
fn a_projection_that_is_not_true_to_scale_is_told_of() {
    let folder = tempfile::tempdir().unwrap();
    // Web Mercator at 60 degrees north shows everything twice as large.
    write(&folder.path().join("dem.tif"), builder().projected_epsg(3857), [1_000_000.0, 8_400_500.0], 10.0, |_, _| 1.0);
    let warnings = open(&folder, None).warnings().to_vec();
    assert!(warnings.iter().any(|warning| warning.contains("is 0.50") && warning.contains("UTM")), "{warnings:?}");
}

#[test]
fn a_file_without_a_system_takes_the_scenes_or_none() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("dem.tif"), builder(), [238_000.0, 836_500.0], 10.0, |_, _| 1.0);
    let plain = open(&folder, None);
    assert!(plain.from_lon_lat([0.0, 0.0]).unwrap_err().to_string().contains("no known reference system"));
    assert!(plain.warnings().iter().any(|warning| warning.contains("names no reference system")));
    let named = open(&folder, Some("epsg:27700"));
    // The datum shift of seven parameters is good to a few metres of PROJ's grid.
    assert_near(named.to_lon_lat([238_225.0, 836_005.0]).unwrap(), [-4.692_933_761, 57.385_624_327], 5e-5);
    let out = folder.path().join("map.tif");
    write_geotiff(&out, named.map_grid(), &vec![0.0; COLUMNS * ROWS], -9999.0).unwrap();
    assert_eq!(read_raster(&out).unwrap().georeference.system.unwrap().name, "EPSG:27700");
    let by_string = open(&folder, Some("+proj=utm +zone=30 +datum=WGS84"));
    assert!(by_string.to_lon_lat([238_225.0, 836_005.0]).is_ok());
    assert!(by_string.warnings().iter().any(|warning| warning.contains("PROJ string")));
}

#[test]
fn an_unknown_code_is_carried_to_the_maps() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("dem.tif"), builder().projected_epsg(1234), [0.0, 500.0], 10.0, |x, _| x);
    let terrain = open(&folder, None);
    assert!(terrain.warnings().iter().any(|warning| warning.contains("EPSG:1234")), "{:?}", terrain.warnings());
    assert!(terrain.to_lon_lat([0.0, 0.0]).is_err());
    let out = folder.path().join("map.tif");
    write_geotiff(&out, terrain.map_grid(), &vec![0.0; COLUMNS * ROWS], -9999.0).unwrap();
    assert_eq!(read_raster(&out).unwrap().georeference.system.unwrap().epsg, Some(1234));
}

#[test]
fn another_raster_is_looked_up_wherever_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    let corner = [535_000.0, 5_595_000.0];
    write(&folder.path().join("dem.tif"), builder().projected_epsg(25832), corner, 20.0, |_, _| 0.0);
    let terrain = open(&folder, None);
    let eastings = folder.path().join("same.tif");
    write(&eastings, builder().projected_epsg(25832).nodata("535275"), [535_200.0, 5_594_800.0], 10.0, |x, _| {
        x.round()
    });
    let field = RasterField::open(&eastings, &terrain).unwrap();
    assert_eq!(field.nearest(535_231.0, 5_594_700.0), Some(535_235.0));
    assert_eq!(field.bilinear(535_240.0, 5_594_700.0), Some(535_240.0));
    assert_eq!(field.nearest(535_100.0, 5_594_700.0), None, "outside");
    assert_eq!(field.bilinear(535_272.0, 5_594_700.0), None, "no data");
    assert_eq!(field.bilinear(535_269.0, 5_594_700.0), Some(535_265.0), "beside no data");
    assert_eq!(field.nearest(535_200.0, 5_594_800.0), Some(535_205.0), "on the corner");
    assert_eq!(field.nearest(535_800.0, 5_594_300.0), Some(535_795.0), "on the other corner");
    // The same position in degrees.
    let degrees = folder.path().join("degrees.tif");
    write(&degrees, builder().geographic_epsg(4326), [9.49, 50.51], 0.0005, |lon, _| lon);
    let field = RasterField::open(&degrees, &terrain).unwrap();
    let [x, y] = terrain.from_lon_lat([9.501, 50.5]).unwrap();
    assert!((field.bilinear(x, y).unwrap() - 9.501).abs() < 1e-9);
    // Beside the terrain, in metres and in degrees, and round it: smaller than the distance between positions that are tried, and larger.
    let of = |name: &str, builder: GeoTiffBuilder, corner: [f64; 2], cell: f64| {
        let path = folder.path().join(name);
        write(&path, builder, corner, cell, |_, _| 1.0);
        RasterField::open(&path, &terrain).map(|_| ()).map_err(|error| error.to_string())
    };
    for (name, geographic, corner, cell) in
        [("west.tif", false, [534_000.0, 5_595_000.0], 10.0), ("north.tif", true, [9.49, 51.5], 0.0005)]
    {
        let builder = if geographic { builder().geographic_epsg(4326) } else { builder().projected_epsg(25832) };
        let told = of(name, builder, corner, cell).unwrap_err();
        assert!(told.contains(name) && told.contains("outside the terrain"), "{told}");
    }
    assert_eq!(of("small.tif", builder().projected_epsg(25832), [535_111.0, 5_594_777.0], 0.01), Ok(()));
    assert_eq!(of("large.tif", builder().projected_epsg(25832), [500_000.0, 5_700_000.0], 3000.0), Ok(()));
}
