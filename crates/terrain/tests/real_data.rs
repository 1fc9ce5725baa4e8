//! Real rasters, where the environment variable `CORPUSCLE_DATA` names the folder of reference data. Expected numbers
//! are from GDAL (through rasterio).

use corpuscle_scene::{NoData, TerrainFile};
use corpuscle_terrain::{Raster, RasterField, Terrain, read_raster};
use std::path::PathBuf;

/// The folder of reference data; `None` where a test is to be skipped.
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("CORPUSCLE_DATA").map(PathBuf::from);
    if folder.is_none() {
        assert!(
            std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_none_or(|value| value != "1"),
            "CORPUSCLE_DATA is not set"
        );
        eprintln!("skipped: CORPUSCLE_DATA does not name the folder of reference data");
    }
    folder
}

fn open(folder: PathBuf, name: &str) -> Terrain {
    let scene = TerrainFile { path: name.into(), crs: None, no_data: NoData::Wall };
    Terrain::open(&corpuscle_scene::Terrain::File(scene), 1, &folder).unwrap()
}

/// Number of cells with data and sum of their values.
fn totals(raster: &Raster) -> (usize, f64) {
    let valid = raster.values.iter().filter(|value| !value.is_nan());
    valid.fold((0, 0.0), |(count, sum), value| (count + 1, sum + value))
}

#[test]
fn malpasset() {
    let Some(folder) = data() else { return };
    let bed = read_raster(folder.join("malpasset/bed-20m.tif")).unwrap();
    assert_eq!((bed.columns, bed.rows), (862, 459));
    assert_eq!((bed.georeference.corner, bed.georeference.cell), ([530.0, 6830.0], [20.0, 20.0]));
    let (count, sum) = totals(&bed);
    assert!(count == 129_616 && (sum - 1_823_124.106_444_1).abs() < 1e-3, "{count} {sum}");
    let depth = read_raster(folder.join("malpasset/initial-depth-20m.tif")).unwrap();
    let (count, sum) = totals(&depth);
    assert!(count == 129_616 && (sum - 239_737.119_238_4).abs() < 1e-3, "{count} {sum}");

    let terrain = open(folder.clone(), "malpasset/bed-20m.tif");
    assert!((terrain.height(9160.0, 2240.0) - 29.623_867).abs() < 1e-5);
    assert!(terrain.is_valid_cell(431, 229) && !terrain.is_valid_cell(0, 0) && !terrain.is_valid_cell(862, 0));
    assert!(terrain.height(540.0, 6820.0) > 149.0, "outside the valley stands a wall");
    assert_eq!(terrain.warnings().len(), 1, "{:?}", terrain.warnings());
    let water = RasterField::open(folder.join("malpasset/initial-depth-20m.tif"), &terrain).unwrap();
    assert_eq!(water.bilinear(9160.0, 2240.0), Some(0.0));
    assert_eq!(water.nearest(540.0, 6820.0), None);
    // The reservoir behind the dam stands at 100 m.
    let [x, y] = [4620.0, 4380.0];
    let level = terrain.height(x, y) + water.nearest(x, y).unwrap();
    assert!((level - 100.0).abs() < 1e-4, "{level}");
}

#[test]
fn jacksboro() {
    let Some(folder) = data() else { return };
    let dem = read_raster(folder.join("jacksboro/dem.tif")).unwrap();
    assert_eq!((dem.columns, dem.rows), (403, 344));
    assert_eq!(totals(&dem), (138_632, 73_617_913.0));
    assert_eq!((dem.values[200 * 403 + 100], dem.values[230 * 403 + 300]), (616.0, 335.0));
    let system = dem.georeference.system.as_ref().unwrap();
    assert_eq!((system.name.as_str(), system.geographic), ("EPSG:4326", true));

    let terrain = open(folder, "jacksboro/dem.tif");
    assert!(terrain.warnings().is_empty(), "{:?}", terrain.warnings());
    // 0.3358 degrees at 36.6 north by 0.2867 degrees.
    let [width, height] = terrain.bounds().size();
    assert!((29_900.0..30_060.0).contains(&width) && (31_700.0..31_820.0).contains(&height), "{width} {height}");
    // Resampling to metres keeps the ground: within a metre on average, relief being 840 m.
    let grid = terrain.map_grid();
    let (mut count, mut sum) = (0.0, 0.0);
    for row in 5..339 {
        for column in 5..398 {
            let [x, y] = grid.centre(column, row);
            sum += (terrain.height(x, y) - dem.values[row * 403 + column]).abs();
            count += 1.0;
        }
    }
    assert!(sum / count < 0.5, "{}", sum / count);
    let [x, y] = terrain.from_lon_lat([-84.33, 36.565_833_333]).unwrap();
    assert!((terrain.height(x, y) - 616.0).abs() < 3.0);
}

#[test]
fn valley_of_the_environment_agency() {
    let Some(folder) = data() else { return };
    let dem = read_raster(folder.join("ea_test5/dem-10m.tif")).unwrap();
    let (count, sum) = totals(&dem);
    assert!(count == 306_757 && (sum - 77_509_224.695_678_7).abs() < 1e-2, "{count} {sum}");
    let terrain = open(folder, "ea_test5/dem-10m.tif");
    assert!((terrain.height(238_230.0, 836_000.0) - 151.577).abs() < 1e-4);
    // The datum shift of seven parameters is good to a few metres of GDAL's grid.
    let [lon, lat] = terrain.to_lon_lat([238_225.0, 836_005.0]).unwrap();
    assert!((lon + 4.692_933_76).abs() < 5e-5 && (lat - 57.385_624_33).abs() < 5e-5, "{lon} {lat}");
}
