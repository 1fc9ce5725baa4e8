//! Files in, files out: formats, sample types, layouts, units, no-data.

use corpuscle_terrain::{Raster, Terrain, hold_in_memory, read_raster, write_geotiff};
use flate2::write::GzEncoder;
use geotiff_reader::GeoTiffFile;
use geotiff_reader::transform::GeoTransform;
use geotiff_writer::{Compression, GeoTiffBuilder, NumericSample, RasterType};
use ndarray::Array2;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const COLUMNS: usize = 37;
const ROWS: usize = 21;

/// The value that the test rasters have in a cell, small enough for every sample type.
fn value(column: usize, row: usize) -> f64 {
    (column + 2 * row) as f64
}

fn builder() -> GeoTiffBuilder {
    GeoTiffBuilder::new(COLUMNS as u32, ROWS as u32)
        .pixel_scale(10.0, 20.0)
        .origin(1000.0, 5000.0)
        .projected_epsg(27700)
}

fn write<T: NumericSample>(path: &Path, builder: &GeoTiffBuilder, convert: impl Fn(f64) -> T) {
    let samples = Array2::from_shape_fn((ROWS, COLUMNS), |(row, column)| convert(value(column, row)));
    builder.write_2d(path, samples.view()).unwrap();
}

fn assert_values(raster: &Raster) {
    assert_eq!((raster.columns, raster.rows), (COLUMNS, ROWS));
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            assert_eq!(raster.values[row * COLUMNS + column], value(column, row), "column {column}, row {row}");
        }
    }
}

fn temporary(name: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

#[test]
fn a_file_in_memory_is_read_as_from_the_disk() {
    let (folder, path) = temporary("dem.tif");
    write(&path, &builder(), |v| v);
    let grid = folder.path().join("dem.asc");
    let row = |row| (0..COLUMNS).map(|column| format!("{} ", value(column, row))).collect::<String>();
    let rows: Vec<_> = (0..ROWS).map(row).collect();
    let head = format!("ncols {COLUMNS}\nnrows {ROWS}\nxllcorner 0\nyllcorner 0\ncellsize 10\n");
    std::fs::write(&grid, head + &rows.join("\n")).unwrap();
    for path in [path, grid] {
        let held = Path::new("/nowhere").join(path.file_name().unwrap());
        assert!(read_raster(&held).is_err());
        hold_in_memory(held.clone(), &std::fs::read(&path).unwrap());
        let (of_memory, of_disk) = (read_raster(&held).unwrap(), read_raster(&path).unwrap());
        assert_values(&of_memory);
        assert_eq!(of_memory.values, of_disk.values);
        assert_eq!(format!("{:?}", of_memory.georeference), format!("{:?}", of_disk.georeference));
    }
    hold_in_memory("/nowhere/broken.tif".into(), b"II*\0broken");
    assert!(read_raster(Path::new("/nowhere/broken.tif")).is_err());
}

#[test]
fn every_sample_type_is_read() {
    let (_folder, path) = temporary("dem.tif");
    let check = || assert_values(&read_raster(&path).unwrap());
    write(&path, &builder(), |v| v as u8);
    check();
    write(&path, &builder(), |v| v as i8);
    check();
    write(&path, &builder(), |v| v as u16);
    check();
    write(&path, &builder(), |v| v as i16);
    check();
    write(&path, &builder(), |v| v as u32);
    check();
    write(&path, &builder(), |v| v as i32);
    check();
    write(&path, &builder(), |v| v as u64);
    check();
    write(&path, &builder(), |v| v as i64);
    check();
    write(&path, &builder(), |v| v as f32);
    check();
    write(&path, &builder(), |v| v);
    check();
}

#[test]
fn every_compression_and_layout_is_read() {
    let (_folder, path) = temporary("dem.tif");
    for compression in [Compression::None, Compression::Deflate, Compression::Lzw, Compression::Zstd] {
        for tiled in [false, true] {
            let builder = builder().compression(compression);
            let builder = if tiled { builder.tile_size(16, 16) } else { builder };
            write(&path, &builder, |v| v as f32);
            let raster = read_raster(&path).unwrap_or_else(|error| panic!("{compression:?}, tiled {tiled}: {error}"));
            assert_values(&raster);
        }
    }
}

const PACK_BITS: u32 = 32773;

/// A big-endian TIFF of 16-bit samples in one strip, packed by PackBits as runs of literal bytes; with its position, the
/// same as that of `builder`, or without. Another code of compression makes it a lie.
fn packed_bits(with_position: bool, compression: u32) -> Vec<u8> {
    let samples: Vec<u8> =
        (0..ROWS * COLUMNS).flat_map(|i| (value(i % COLUMNS, i / COLUMNS) as u16).to_be_bytes()).collect();
    // Each row is packed on its own: a count of bytes less one, then the bytes.
    let strip: Vec<u8> = samples
        .chunks(2 * COLUMNS)
        .flat_map(|row| std::iter::once((row.len() - 1) as u8).chain(row.iter().copied()))
        .collect();
    // Pixel scale and tie point.
    let position: [f64; 9] = [10.0, 20.0, 0.0, 0.0, 0.0, 0.0, 1000.0, 5000.0, 0.0];
    let position_at = 8 + strip.len() as u32;
    let directory_at = position_at + 72;
    let (short, long, double) = (3_u16, 4_u16, 12_u16);
    let mut entries = vec![
        (256, short, 1, COLUMNS as u32),
        (257, short, 1, ROWS as u32),
        (258, short, 1, 16),
        (259, long, 1, compression),
        (262, short, 1, 1),
        (273, long, 1, 8),
        (277, short, 1, 1),
        (278, short, 1, ROWS as u32),
        (279, long, 1, strip.len() as u32),
    ];
    if with_position {
        entries.extend([(33550, double, 3, position_at), (33922, double, 6, position_at + 24)]);
    }
    let mut bytes = b"MM\0*".to_vec();
    bytes.extend(directory_at.to_be_bytes());
    bytes.extend(&strip);
    bytes.extend(position.iter().flat_map(|value| value.to_be_bytes()));
    bytes.extend((entries.len() as u16).to_be_bytes());
    for (tag, kind, count, number) in entries {
        bytes.extend([tag, kind].iter().flat_map(|value: &u16| value.to_be_bytes()));
        bytes.extend(u32::to_be_bytes(count));
        // A short number stands at the left of its four bytes.
        bytes.extend((if kind == short { number << 16 } else { number }).to_be_bytes());
    }
    bytes.extend([0; 4]);
    bytes
}

#[test]
fn packed_bits_in_big_endian_order_are_read() {
    let (_folder, path) = temporary("dem.tif");
    std::fs::write(&path, packed_bits(true, PACK_BITS)).unwrap();
    let raster = read_raster(&path).unwrap();
    assert_values(&raster);
    assert_eq!((raster.georeference.corner, raster.georeference.cell), ([1000.0, 5000.0], [10.0, 20.0]));
    assert!(raster.georeference.system.is_none());
}

#[test]
fn compressions_that_are_not_read_are_refused_by_name() {
    let (_folder, path) = temporary("dem.tif");
    // LERC in a big-endian file, and LZMA.
    for (compression, hint) in [(34887, "LERC"), (34925, "34925")] {
        std::fs::write(&path, packed_bits(true, compression)).unwrap();
        let error = read_raster(&path).unwrap_err().to_string();
        assert!(error.contains(hint) && error.contains("COMPRESS=DEFLATE"), "{error}");
    }
}

#[test]
fn a_picture_without_a_position_is_refused() {
    let (_folder, path) = temporary("dem.tif");
    std::fs::write(&path, packed_bits(false, PACK_BITS)).unwrap();
    assert!(read_raster(&path).unwrap_err().to_string().contains("says nowhere where it lies"));
}

#[test]
fn position_and_system_are_read_for_areas_and_points() {
    let (_folder, path) = temporary("dem.tif");
    for raster_type in [RasterType::PixelIsArea, RasterType::PixelIsPoint] {
        write(&path, &builder().raster_type(raster_type), |v| v as f32);
        let georeference = read_raster(&path).unwrap().georeference;
        assert_eq!((georeference.corner, georeference.cell), ([1000.0, 5000.0], [10.0, 20.0]), "{raster_type:?}");
        assert_eq!(georeference.centre(0, 0), [1005.0, 4990.0]);
        let system = georeference.system.unwrap();
        assert_eq!((system.name.as_str(), system.geographic, system.metres_per_unit), ("EPSG:27700", false, 1.0));
    }
}

#[test]
fn a_raster_from_south_to_north_is_turned_over() {
    let (_folder, path) = temporary("dem.tif");
    let upwards = GeoTransform::from_origin_and_pixel_size(1000.0, 4580.0, 10.0, 20.0);
    write(&path, &builder().transform(upwards), |v| v as f32);
    let raster = read_raster(&path).unwrap();
    assert_eq!(raster.georeference.corner, [1000.0, 5000.0]);
    assert_eq!(raster.values[0], value(0, ROWS - 1));
    assert_eq!(raster.values[(ROWS - 1) * COLUMNS + 3], value(3, 0));
}

#[test]
fn a_turned_raster_is_refused() {
    let (_folder, path) = temporary("dem.tif");
    let turned = GeoTransform { skew_x: 1.0, ..GeoTransform::from_origin_and_pixel_size(0.0, 0.0, 10.0, -10.0) };
    write(&path, &builder().transform(turned), |v| v as f32);
    assert!(read_raster(&path).unwrap_err().to_string().contains("turned"));
}

#[test]
fn no_data_is_told_by_the_mark_whatever_its_type() {
    let (_folder, path) = temporary("dem.tif");
    let holes = |raster: Raster| raster.values.iter().filter(|value| value.is_nan()).count();
    let expected = (0..ROWS * COLUMNS).filter(|i| value(i % COLUMNS, i / COLUMNS) == 30.0).count();
    write(&path, &builder().nodata("30"), |v| v as i16);
    assert_eq!(holes(read_raster(&path).unwrap()), expected);
    // A mark in single precision, written with fewer digits than double precision has.
    let lowest = |v: f64| if v == 30.0 { f32::MIN } else { v as f32 };
    write(&path, &builder().nodata("-3.40282347e+38"), lowest);
    assert_eq!(holes(read_raster(&path).unwrap()), expected);
    write(&path, &builder().nodata("nan"), |v| if v == 30.0 { f64::NAN } else { v });
    assert_eq!(holes(read_raster(&path).unwrap()), expected);
}

#[test]
fn heights_in_feet_become_metres() {
    let (_folder, path) = temporary("dem.tif");
    write(&path, &builder().vertical_units(9002), |v| v as f32);
    let raster = read_raster(&path).unwrap();
    assert!((raster.values[5] - 5.0 * 0.3048).abs() < 1e-12);
    assert!(raster.warnings.iter().any(|warning| warning.contains("0.3048")));
}

const GRID: &str = "NCOLS 3\nnrows 2\nXLLCORNER 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n\
                    1 2 3\n4 -9999 6\n";

#[test]
fn ascii_grids_are_read_plain_and_compressed() {
    let (folder, path) = temporary("dem.asc");
    std::fs::write(&path, GRID).unwrap();
    let compressed = folder.path().join("dem.asc.gz");
    let mut encoder = GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(GRID.as_bytes()).unwrap();
    std::fs::write(&compressed, encoder.finish().unwrap()).unwrap();
    // The content decides, not the name.
    let misnamed = folder.path().join("dem.tif");
    std::fs::write(&misnamed, GRID).unwrap();
    for path in [path, compressed, misnamed] {
        let raster = read_raster(&path).unwrap();
        assert_eq!((raster.columns, raster.rows), (3, 2));
        assert_eq!(raster.georeference.corner, [100.0, 220.0]);
        assert_eq!((raster.values[2], raster.values[3]), (3.0, 4.0));
        assert!(raster.values[4].is_nan());
    }
}

#[test]
fn ascii_variants_are_read() {
    let (_folder, path) = temporary("dem.asc");
    let text = "ncols 2\r\nnrows 2\r\nxllcenter 105\r\nyllcenter 202\r\ndx 10\r\ndy 4\r\n1 2 3\r\n4\r\n";
    std::fs::write(&path, text).unwrap();
    let raster = read_raster(&path).unwrap();
    assert_eq!((raster.georeference.corner, raster.georeference.cell), ([100.0, 208.0], [10.0, 4.0]));
    assert_eq!(raster.values, [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn a_map_comes_back_with_the_position_and_the_system_of_the_terrain() {
    let (folder, path) = temporary("dem.tif");
    let out = folder.path().join("depth.tif");
    write(&path, &builder().vertical_citation("some datum").nodata("30"), |v| v as i16);
    let terrain = open(&path);
    let mut values: Vec<f32> = (0..ROWS * COLUMNS).map(|index| 0.1 * index as f32).collect();
    values[7] = f32::NAN;
    write_geotiff(&out, terrain.map_grid(), &values, -9999.0).unwrap();
    let (before, after) = (GeoTiffFile::open(&path).unwrap(), GeoTiffFile::open(&out).unwrap());
    assert_eq!(after.metadata().tiepoints, before.metadata().tiepoints);
    assert_eq!(after.metadata().pixel_scale, before.metadata().pixel_scale);
    assert_eq!((after.epsg(), after.crs().vertical_citation()), (Some(27700), Some("some datum")));
    assert_eq!(after.nodata(), Some("-9999"));
    let raster = read_raster(&out).unwrap();
    for (index, (read, written)) in raster.values.iter().zip(&values).enumerate() {
        assert!(*read == f64::from(*written) || (read.is_nan() && index == 7), "{index}");
    }
    let written: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(written.len(), 2, "a temporary file was left behind: {written:?}");
}

#[test]
fn heights_in_feet_are_written_in_metres_and_other_values_have_no_unit_of_heights() {
    let (folder, path) = temporary("dem.tif");
    let in_feet = builder()
        .geokey(4099, geotiff_writer::GeoKeyValue::Short(9002))
        .geokey(4096, geotiff_writer::GeoKeyValue::Short(8228));
    write(&path, &in_feet, |v| v);
    let terrain = open(&path);
    let [x, y] = terrain.map_grid().centre(3, 4);
    assert!((terrain.height(x, y) - 0.3048 * value(3, 4)).abs() < 1e-9);
    let out = folder.path().join("metres.tif");
    let values: Vec<f32> = (0..ROWS * COLUMNS).map(|index| index as f32).collect();
    write_geotiff(&out, terrain.map_grid(), &values, -9999.0).unwrap();
    let raster = read_raster(&out).unwrap();
    assert!(raster.warnings.is_empty() && raster.values[7] == 7.0, "{:?}", raster.warnings);
    assert_eq!(corpuscle_terrain::RasterField::open(&path, &terrain).unwrap().nearest(x, y), Some(value(3, 4)));
}

#[test]
fn the_usual_mark_counts_where_no_other_is_named() {
    let (folder, path) = temporary("dem.tif");
    write(&path, &builder(), |v| if v == 10.0 { -9999.0 } else { v });
    let terrain = open(&path);
    assert!(terrain.has_holes() && terrain.warnings().iter().any(|warning| warning.contains("-9999")));
    let ascii = folder.path().join("dem.asc");
    std::fs::write(&ascii, "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 -9999\n3 4\n").unwrap();
    assert!(read_raster(&ascii).unwrap().values[1].is_nan());
}

#[test]
fn a_large_map_has_overviews_of_its_own_cells_before_its_data() {
    let (folder, path) = temporary("dem.tif");
    let [columns, rows] = [700, 300];
    let samples = Array2::from_elem((rows, columns), 1.0_f32);
    let large = GeoTiffBuilder::new(columns as u32, rows as u32).pixel_scale(10.0, 20.0).origin(1000.0, 5000.0);
    large.projected_epsg(27700).write_2d(&path, samples.view()).unwrap();
    let values: Vec<f32> = (0..rows * columns).map(|cell| if cell % 5 == 2 { f32::NAN } else { cell as f32 }).collect();
    let out = folder.path().join("depth.tif");
    write_geotiff(&out, open(&path).map_grid(), &values, -9999.0).unwrap();

    let bytes = std::fs::read(&out).unwrap();
    let layout = "LAYOUT=IFDS_BEFORE_DATA";
    assert!(String::from_utf8_lossy(&bytes[..200]).contains(layout), "it is not cloud-optimised");
    let file = GeoTiffFile::open(&out).unwrap();
    assert_eq!((file.width(), file.height(), file.overview_count()), (700, 300, 2));
    for (index, step) in [2, 4].into_iter().enumerate() {
        let overview = file.read_overview::<f32>(index).unwrap();
        assert_eq!(overview.shape(), [rows.div_ceil(step), columns.div_ceil(step)]);
        for (pixel, value) in overview.iter().enumerate() {
            let [row, column] = [pixel / columns.div_ceil(step), pixel % columns.div_ceil(step)];
            let cell = values[row * step * columns + column * step];
            assert_eq!(*value, if cell.is_nan() { -9999.0 } else { cell }, "step {step}, row {row}, column {column}");
        }
    }
    // One that a tile has all of needs none.
    write(&path, &builder(), |v| v as f32);
    let small = open(&path);
    write_geotiff(&out, small.map_grid(), &[0.5; COLUMNS * ROWS], -9999.0).unwrap();
    assert_eq!(GeoTiffFile::open(&out).unwrap().overview_count(), 0);
}

#[test]
fn a_map_that_cannot_be_written_is_an_error_and_leaves_the_old_file() {
    let (folder, path) = temporary("dem.tif");
    write(&path, &builder(), |v| v as f32);
    let terrain = open(&path);
    let before = std::fs::read(&path).unwrap();
    let error = write_geotiff(&path, terrain.map_grid(), &[1.0, 2.0], -9999.0).unwrap_err();
    assert!(error.to_string().contains("dem.tif"), "{error}");
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let nowhere = folder.path().join("no/such/folder/map.tif");
    let values = vec![0.0; COLUMNS * ROWS];
    assert!(write_geotiff(nowhere, terrain.map_grid(), &values, -9999.0).is_err());
}

fn open(path: &Path) -> Terrain {
    let scene = corpuscle_scene::TerrainFile { path: path.into(), crs: None, no_data: Default::default() };
    Terrain::open(&corpuscle_scene::Terrain::File(scene), 1, Path::new(".")).unwrap()
}
