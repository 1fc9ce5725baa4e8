//! Several files as one terrain, and parts of files.

use corpuscle_scene::{NoData, TerrainFile, TerrainTiles};
use corpuscle_terrain::{
    MapBox, Raster, Terrain, TerrainError, read_raster, read_raster_part, read_rasters, survey, write_raster,
    write_raster_exactly,
};
use geotiff_writer::GeoTiffBuilder;
use ndarray::Array2;
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const COLUMNS: usize = 48;
const ROWS: usize = 40;
const CORNER: [f64; 2] = [535_000.0, 5_595_000.0];
const CELL: f64 = 10.0;

/// Rough ground.
fn rough(x: f64, y: f64) -> f64 {
    20.0 * (0.013 * x).sin() + 15.0 * (0.017 * y).cos() + 0.01 * (x - CORNER[0])
}

/// An even slope, which linear interpolation keeps.
fn plane(x: f64, y: f64) -> f64 {
    0.1 * (x - CORNER[0]) - 0.2 * (y - CORNER[1])
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes heights on a grid given by its corner, cell and numbers of columns and rows.
    fn write(
        &self,
        name: &str,
        system: impl Fn(GeoTiffBuilder) -> GeoTiffBuilder,
        corner: [f64; 2],
        cell: f64,
        [columns, rows]: [usize; 2],
        height: impl Fn(f64, f64) -> f64,
    ) {
        let samples = Array2::from_shape_fn((rows, columns), |(row, column)| {
            height(corner[0] + (column as f64 + 0.5) * cell, corner[1] - (row as f64 + 0.5) * cell)
        });
        let builder = GeoTiffBuilder::new(columns as u32, rows as u32).tile_size(16, 16).nodata("-9999");
        let builder = system(builder).pixel_scale(cell, cell).origin(corner[0], corner[1]);
        builder.write_2d(self.path(name), samples.view()).unwrap();
    }

    /// Some cells of the whole ground as a file.
    fn part(&self, name: &str, [column, row]: [usize; 2], size: [usize; 2], height: impl Fn(f64, f64) -> f64) {
        let corner = [CORNER[0] + column as f64 * CELL, CORNER[1] - row as f64 * CELL];
        self.write(name, utm, corner, CELL, size, height);
    }

    fn tiles(&self, names: &[&str], no_data: NoData) -> Result<Terrain, TerrainError> {
        let paths = names.iter().map(PathBuf::from).collect();
        Terrain::open(&corpuscle_scene::Terrain::Tiles(TerrainTiles { paths, crs: None, no_data }), 1, self.0.path())
    }

    fn file(&self, name: &str) -> Terrain {
        let file = TerrainFile { path: name.into(), crs: None, no_data: NoData::Wall };
        Terrain::open(&corpuscle_scene::Terrain::File(file), 1, self.0.path()).unwrap()
    }
}

fn utm(builder: GeoTiffBuilder) -> GeoTiffBuilder {
    builder.projected_epsg(25832)
}

/// The four quarters of the ground, not equal, in an order of their own.
fn quarters(folder: &Folder) -> [&'static str; 4] {
    folder.part("nw.tif", [0, 0], [20, 15], rough);
    folder.part("ne.tif", [20, 0], [COLUMNS - 20, 15], rough);
    folder.part("sw.tif", [0, 15], [20, ROWS - 15], rough);
    folder.part("se.tif", [20, 15], [COLUMNS - 20, ROWS - 15], rough);
    ["se.tif", "nw.tif", "sw.tif", "ne.tif"]
}

#[test]
fn tiles_of_one_grid_are_the_whole_to_the_bit() {
    let folder = Folder::new();
    folder.part("whole.tif", [0, 0], [COLUMNS, ROWS], rough);
    let whole = folder.file("whole.tif");
    let tiles = folder.tiles(&quarters(&folder), NoData::Wall).unwrap();
    assert!(tiles.warnings().is_empty(), "{:?}", tiles.warnings());
    assert_eq!(tiles.bounds(), whole.bounds());
    assert_eq!((tiles.map_grid().columns, tiles.map_grid().rows), (COLUMNS, ROWS));
    for step in 0..500 {
        let (x, y) = (CORNER[0] + 0.963 * step as f64, CORNER[1] - 0.797 * step as f64);
        assert_eq!(tiles.height_and_slope(x, y), whole.height_and_slope(x, y), "{x} {y}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Wherever the ground is cut, and in whatever order its parts are named, they are the whole to the bit.
    #[test]
    fn any_cuts_in_any_order_are_the_whole(
        at in (2..COLUMNS - 2, 2..ROWS - 2), overlap in 0usize..2, order in Just([0, 1, 2, 3]).prop_shuffle()
    ) {
        let folder = Folder::new();
        let (column, row) = at;
        folder.part("whole.tif", [0, 0], [COLUMNS, ROWS], rough);
        folder.part("0.tif", [0, 0], [column + overlap, row], rough);
        folder.part("1.tif", [column, 0], [COLUMNS - column, row + overlap], rough);
        folder.part("2.tif", [0, row], [column, ROWS - row], rough);
        folder.part("3.tif", [column, row], [COLUMNS - column, ROWS - row], rough);
        let paths = order.map(|part| folder.path(&format!("{part}.tif")));
        let merged = read_rasters(&paths, None, None).unwrap();
        let whole = read_raster(folder.path("whole.tif")).unwrap();
        prop_assert!(merged.values == whole.values && merged.warnings.is_empty());
        prop_assert!((merged.georeference.corner[0] - whole.georeference.corner[0]).abs() < 1e-6);
    }
}

#[test]
fn where_files_overlap_the_first_counts_and_differences_are_told() {
    let folder = Folder::new();
    folder.part("west.tif", [0, 0], [30, ROWS], |_, _| 1.0);
    folder.part("east.tif", [20, 0], [COLUMNS - 20, ROWS], |_, _| 3.5);
    let heights = |names: &[&str]| {
        let terrain = folder.tiles(names, NoData::Wall).unwrap();
        let at = |column: usize| {
            let [x, y] = terrain.map_grid().centre(column, 7);
            terrain.height(x, y)
        };
        ([at(5), at(25), at(45)], terrain.warnings().to_vec())
    };
    let (west_first, warnings) = heights(&["west.tif", "east.tif"]);
    assert_eq!(west_first, [1.0, 1.0, 3.5]);
    assert!(warnings.len() == 1 && warnings[0].contains("400 cells, by up to 2.50 m"), "{warnings:?}");
    let (east_first, _) = heights(&["east.tif", "west.tif"]);
    assert_eq!(east_first, [1.0, 3.5, 3.5]);
    // A hole of the first is filled by the second.
    folder.part("holed.tif", [0, 0], [30, ROWS], |x, _| if x > CORNER[0] + 220.0 { -9999.0 } else { 1.0 });
    assert_eq!(heights(&["holed.tif", "east.tif"]).0, [1.0, 3.5, 3.5]);
    // The same heights twice are nothing to be told.
    folder.part("again.tif", [10, 0], [30, ROWS], |_, _| 1.0);
    assert_eq!(heights(&["west.tif", "again.tif"]).1, Vec::<String>::new());
}

#[test]
fn gaps_have_no_data_and_are_told() {
    let folder = Folder::new();
    folder.part("west.tif", [0, 0], [20, ROWS], rough);
    folder.part("east.tif", [24, 0], [COLUMNS - 24, ROWS], rough);
    let terrain = folder.tiles(&["west.tif", "east.tif"], NoData::Wall).unwrap();
    let warnings = terrain.warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("160 cells (8.3 %)"), "{warnings:?}");
    assert!(terrain.is_valid_cell(19, 3) && !terrain.is_valid_cell(20, 3) && !terrain.is_valid_cell(23, 3));
    let [x, y] = terrain.map_grid().centre(22, 3);
    assert!(terrain.height(x, y) > 60.0, "a wall stands in the gap");
    let filled = folder.tiles(&["west.tif", "east.tif"], NoData::Fill).unwrap();
    assert!(filled.height(x, y) < 40.0 && filled.is_valid_cell(22, 3) && filled.has_data_at(x, y));
}

#[test]
fn a_coarser_file_joins_without_a_seam() {
    let folder = Folder::new();
    folder.part("fine.tif", [0, 0], [20, ROWS], plane);
    // Cells of 25 m, off the fine grid, from the border of the fine file on.
    folder.write("coarse.tif", utm, [CORNER[0] + 200.0, CORNER[1]], 25.0, [11, 16], plane);
    let terrain = folder.tiles(&["coarse.tif", "fine.tif"], NoData::Wall).unwrap();
    let warnings = terrain.warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("coarse.tif") && !warnings[0].contains("fine"), "{warnings:?}");
    let grid = terrain.map_grid();
    assert_eq!((grid.georeference.cell, grid.columns, grid.rows), ([CELL; 2], 48, 40));
    // Beyond the outermost centres of the coarse file, but for the side at the fine one, its heights are held.
    for row in 2..38 {
        for column in 0..46 {
            let [x, y] = grid.centre(column, row);
            let error = terrain.height(x, y) - plane(x, y);
            assert!(error.abs() < 1e-9, "{column} {row}: {error}");
        }
    }
}

#[test]
fn a_file_in_another_reference_system_joins() {
    let folder = Folder::new();
    folder.part("utm.tif", [0, 0], [24, ROWS], |_, _| 0.0);
    let terrain = folder.file("utm.tif");
    let degrees = |builder: GeoTiffBuilder| builder.geographic_epsg(4326);
    let [west, north] = terrain.to_lon_lat([CORNER[0] + 200.0, CORNER[1] + 10.0]).unwrap();
    folder.write("degrees.tif", degrees, [west, north], 1.5e-4, [30, 30], |longitude, _| longitude);
    let both = folder.tiles(&["utm.tif", "degrees.tif"], NoData::Wall).unwrap();
    assert_eq!(both.map_grid().georeference.system.as_ref().unwrap().name, "EPSG:25832");
    for [x, y] in [[300.0, 50.0], [370.0, 200.0], [450.0, 330.0]] {
        let (x, y) = (CORNER[0] + x, CORNER[1] - y);
        let [longitude, _] = both.to_lon_lat([x, y]).unwrap();
        assert!((both.height(x, y) - longitude).abs() < 2e-6, "{} {longitude}", both.height(x, y));
    }
    assert_eq!(both.height(CORNER[0] + 50.0, CORNER[1] - 50.0), 0.0);
}

#[test]
fn files_that_cannot_be_joined_are_named() {
    let folder = Folder::new();
    folder.part("utm.tif", [0, 0], [24, ROWS], rough);
    folder.write("nowhere.tif", |builder| builder, CORNER, CELL, [24, ROWS], rough);
    let text = folder.tiles(&["utm.tif", "nowhere.tif"], NoData::Wall).unwrap_err().to_string();
    assert!(text.contains("nowhere.tif") && text.contains("EPSG:25832") && text.contains("`crs`"), "{text}");
    let named = [folder.path("utm.tif"), folder.path("nowhere.tif")];
    assert!(read_rasters(&named, Some("EPSG:25832"), None).is_ok());
    folder.write("far.tif", utm, [9e6, 5e6], CELL, [24, ROWS], rough);
    let text = folder.tiles(&["utm.tif", "far.tif"], NoData::Wall).unwrap_err().to_string();
    assert!(text.contains("utm.tif") && text.contains("together") && text.contains("clip"), "{text}");
    assert!(read_rasters(&[], None, None).unwrap_err().to_string().contains("no file"));
}

#[test]
fn files_without_a_system_are_told_of_once() {
    let folder = Folder::new();
    for (name, column) in [("a.tif", 0), ("b.tif", 10), ("c.tif", 20)] {
        let corner = [CORNER[0] + column as f64 * CELL, CORNER[1]];
        folder.write(name, |builder| builder, corner, CELL, [10, 10], rough);
    }
    let warnings = folder.tiles(&["a.tif", "b.tif", "c.tif"], NoData::Wall).unwrap().warnings().to_vec();
    assert!(warnings.len() == 1 && warnings[0].contains("a.tif names no reference system"), "{warnings:?}");
}

/// Reading a part gives what cutting out the whole gives.
fn assert_part(path: &Path, part: &MapBox) {
    let (part_read, whole) = (read_raster_part(path, part).unwrap(), read_raster(path).unwrap());
    let cut = whole.cropped(part).unwrap();
    assert_eq!((part_read.columns, part_read.rows), (cut.columns, cut.rows));
    assert_eq!(part_read.georeference.corner, cut.georeference.corner);
    assert_eq!(part_read.values, cut.values);
    assert!(part_read.columns < whole.columns && part_read.rows < whole.rows);
}

#[test]
fn a_part_is_what_the_whole_has_there() {
    let folder = Folder::new();
    folder.part("dem.tif", [0, 0], [COLUMNS, ROWS], rough);
    let part = MapBox::new([CORNER[0] + 95.0, CORNER[1] - 333.0, CORNER[0] + 301.0, CORNER[1] - 40.0]).unwrap();
    assert_part(&folder.path("dem.tif"), &part);
    // A file whose first row is the south one.
    let transform = geotiff_reader::transform::GeoTransform {
        origin_x: CORNER[0],
        pixel_width: CELL,
        skew_x: 0.0,
        origin_y: CORNER[1] - ROWS as f64 * CELL,
        skew_y: 0.0,
        pixel_height: CELL,
    };
    let samples = Array2::from_shape_fn((ROWS, COLUMNS), |(row, column)| (100 * row + column) as f32);
    let builder = GeoTiffBuilder::new(COLUMNS as u32, ROWS as u32).projected_epsg(25832).transform(transform);
    builder.write_2d(folder.path("south.tif"), samples.view()).unwrap();
    assert_part(&folder.path("south.tif"), &part);
    let rows: Vec<String> =
        (0..ROWS).map(|row| (0..COLUMNS).map(|column| format!("{} ", row * column)).collect()).collect();
    let south = CORNER[1] - ROWS as f64 * CELL;
    let header =
        format!("ncols {COLUMNS}\nnrows {ROWS}\nxllcorner {}\nyllcorner {south}\ncellsize {CELL}\n", CORNER[0]);
    std::fs::write(folder.path("dem.asc"), header + &rows.join("\n")).unwrap();
    assert_part(&folder.path("dem.asc"), &part);
    let text = read_raster_part(folder.path("dem.tif"), &MapBox::new([0.0, 0.0, 1.0, 1.0]).unwrap());
    assert!(text.unwrap_err().to_string().contains("nothing lies in the box 0,0,1,1"));
}

#[test]
fn a_part_of_several_files_is_cut_across_their_borders() {
    let folder = Folder::new();
    folder.part("whole.tif", [0, 0], [COLUMNS, ROWS], rough);
    let paths = quarters(&folder).map(|name| folder.path(name));
    let part = MapBox::new([CORNER[0] + 150.0, CORNER[1] - 200.0, CORNER[0] + 260.0, CORNER[1] - 100.0]).unwrap();
    let merged = read_rasters(&paths, None, Some(&part)).unwrap();
    let cut = read_raster_part(folder.path("whole.tif"), &part).unwrap();
    assert_eq!((merged.columns, merged.rows, &merged.values), (11, 10, &cut.values));
    write_raster(folder.path("out.tif"), &merged, -9999.0).unwrap();
    let written = read_raster(folder.path("out.tif")).unwrap();
    assert_eq!(written.georeference.corner, [CORNER[0] + 150.0, CORNER[1] - 100.0]);
    assert_eq!(written.georeference.system.as_ref().unwrap().name, "EPSG:25832");
    for (a, b) in written.values.iter().zip(&cut.values) {
        assert_eq!(*a, f64::from(*b as f32));
    }
    let elsewhere = MapBox::new([0.0, 0.0, 1.0, 1.0]).unwrap();
    let text = read_rasters(&paths, None, Some(&elsewhere)).unwrap_err().to_string();
    assert!(text.contains("0,0,1,1") && text.contains("covers 535200,"), "{text}");
}

#[test]
fn a_raster_in_memory_is_written_with_all_bits() {
    let folder = Folder::new();
    let values: Vec<_> = (0..6).map(|count| 1.0 / (1.0 + f64::from(count))).chain([f64::NAN, -9999.0, 0.1]).collect();
    let raster =
        Raster::of_values([3, 3], values.clone(), [512_000.5, 204_000.0], [5.0, 2.5], Some("EPSG:27700")).unwrap();
    write_raster_exactly(folder.path("out.tif"), &raster).unwrap();
    let written = read_raster(folder.path("out.tif")).unwrap();
    assert_eq!((written.columns, written.rows), (3, 3));
    assert_eq!((written.georeference.corner, written.georeference.cell), ([512_000.5, 204_000.0], [5.0, 2.5]));
    assert_eq!(written.georeference.system.as_ref().unwrap().name, "EPSG:27700");
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&written.values), bits(&values));
    let nameless = Raster::of_values([3, 3], values, [0.0; 2], [1.0; 2], Some("+proj=utm +zone=32"));
    assert!(nameless.unwrap_err().to_string().contains("EPSG code"));
}

#[test]
fn a_survey_tells_of_files_of_any_size() {
    let folder = Folder::new();
    folder.part("dem.tif", [0, 0], [COLUMNS, ROWS], rough);
    let found = survey(folder.path("dem.tif")).unwrap();
    assert_eq!((found.columns, found.rows, found.format), (COLUMNS, ROWS, "GeoTIFF"));
    assert_eq!((found.samples.as_str(), found.height_unit_m), ("64-bit floating point", 1.0));
    assert_eq!(found.outline().east, CORNER[0] + COLUMNS as f64 * CELL);
    // More cells than are read at once, in a file that stores none of them.
    let header = "ncols 200000\nnrows 100000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3";
    std::fs::write(folder.path("huge.asc"), header).unwrap();
    let found = survey(folder.path("huge.asc")).unwrap();
    assert_eq!((found.columns, found.rows, found.format), (200_000, 100_000, "ESRI ASCII grid"));
}
