//! Aerial photos: kinds of colours, and where their pixels lie.

use corpuscle_scene::NoData;
use corpuscle_terrain::{Photo, Raster, Terrain, Window};
use geotiff_writer::{Compression, ExtraSample, GeoTiffBuilder, JpegOptions, NumericSample, PhotometricInterpretation};
use ndarray::Array3;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const COLUMNS: usize = 30;
const ROWS: usize = 20;

/// Channels of a pixel: red counts columns, green rows.
fn channel(column: usize, row: usize, channel: usize) -> u8 {
    [8 * column as u8, 12 * row as u8, 200, if column < 3 { 0 } else { 255 }][channel]
}

fn builder(bands: u32) -> GeoTiffBuilder {
    GeoTiffBuilder::new(COLUMNS as u32, ROWS as u32)
        .bands(bands)
        .photometric(PhotometricInterpretation::Rgb)
        .pixel_scale(10.0, 10.0)
        .origin(400_000.0, 300_000.0)
        .projected_epsg(27700)
}

fn write<T: NumericSample>(builder: &GeoTiffBuilder, bands: usize, convert: impl Fn(u8) -> T) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("photo.tif");
    let samples =
        Array3::from_shape_fn((ROWS, COLUMNS, bands), |(row, column, band)| convert(channel(column, row, band)));
    builder.write_3d(&path, samples.view()).unwrap();
    (folder, path)
}

/// Differences from what was written, at most, in a window.
fn worst(path: &Path, window: Window) -> u8 {
    let rgba = Photo::open(path).unwrap().read(window).unwrap();
    let [columns, rows] = window.size;
    assert_eq!(rgba.len(), 4 * columns * rows);
    let at = |k: usize| (window.first[0] + k % columns, window.first[1] + k / columns);
    let differences = rgba.chunks_exact(4).enumerate().map(|(k, pixel)| {
        let (column, row) = at(k);
        (0..3).map(|c| pixel[c].abs_diff(channel(column, row, c))).max().unwrap()
    });
    differences.max().unwrap()
}

const WHOLE: Window = Window { first: [0, 0], size: [COLUMNS, ROWS] };
const PART: Window = Window { first: [5, 3], size: [11, 7] };

#[test]
fn colours_of_every_kind_are_read() {
    let (_folder, path) = write(&builder(3), 3, |v| v);
    assert_eq!((worst(&path, WHOLE), worst(&path, PART)), (0, 0));
    let (_folder, path) = write(&builder(3).compression(Compression::Deflate), 3, |v| u16::from(v) * 257);
    assert_eq!((worst(&path, WHOLE), worst(&path, PART)), (0, 0));
    let jpeg = builder(3).compression(Compression::Jpeg).jpeg_options(JpegOptions { quality: 95 });
    let (_folder, path) = write(&jpeg.photometric(PhotometricInterpretation::YCbCr), 3, |v| v);
    assert!(worst(&path, WHOLE) < 40, "{}", worst(&path, WHOLE));
}

#[test]
fn opacity_and_no_data_are_holes_and_infrared_is_not() {
    let opacity = |path: &Path, k: usize| Photo::open(path).unwrap().read(WHOLE).unwrap()[4 * k + 3];
    let with = |extra| builder(4).extra_samples(vec![extra]);
    let (_folder, path) = write(&with(ExtraSample::UnassociatedAlpha), 4, |v| v);
    assert_eq!((opacity(&path, 0), opacity(&path, 3)), (0, 255));
    let (_folder, path) = write(&with(ExtraSample::Unspecified), 4, |v| v);
    assert_eq!((opacity(&path, 0), opacity(&path, 3)), (255, 255));
    let (_folder, path) = write(&builder(3).nodata("200"), 3, |_| 200_u8);
    assert_eq!(opacity(&path, 7), 0);
}

#[test]
fn other_files_are_refused_in_words() {
    let (_folder, path) = write(&builder(3), 3, f32::from);
    let error = Photo::open(&path).unwrap().read(WHOLE).unwrap_err().to_string();
    assert!(error.contains("8 or 16 bits") && error.contains("gdal_translate"), "{error}");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..200]).unwrap();
    assert!(Photo::open(&path).and_then(|photo| photo.read(WHOLE)).is_err());
    assert!(Photo::open(Path::new("none.tif")).is_err());
}

/// A flat terrain of 300 m x 200 m in a reference system, from a corner on.
fn terrain(corner: [f64; 2], cell: [f64; 2], crs: Option<&str>) -> Terrain {
    let raster = Raster::of_values([30, 20], vec![1.0; 600], corner, cell, crs).unwrap();
    Terrain::from_raster(raster, Path::new("dem.tif"), NoData::default()).unwrap()
}

#[test]
fn pixels_lie_where_the_reference_systems_say() {
    let (_folder, path) = write(&builder(3), 3, |v| v);
    let photo = Photo::open(&path).unwrap();
    let near = |found: Option<[f64; 2]>, expected: [f64; 2]| {
        let found = found.unwrap();
        assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-3, "{found:?} for {expected:?}");
    };
    // The same system, and none.
    for crs in [Some("EPSG:27700"), None] {
        let same = terrain([400_000.0, 300_000.0], [10.0, 10.0], crs);
        near(photo.pixel(&same, [400_055.0, 299_935.0]), [5.0, 6.0]);
    }
    // Degrees on WGS 84: the terrain's corners are found in the photo's grid by the library that converts terrain too.
    let home = terrain([400_000.0, 300_000.0], [10.0, 10.0], Some("EPSG:27700"));
    let corner = home.to_lon_lat([400_000.0, 300_000.0]).unwrap();
    let degrees = terrain(corner, [1e-4, 1e-4], Some("EPSG:4326"));
    for position in [[400_055.0, 299_935.0], [400_200.0, 299_900.0]] {
        let lon_lat = home.to_lon_lat(position).unwrap();
        let here = degrees.from_lon_lat(lon_lat).unwrap();
        near(photo.pixel(&degrees, here), photo.pixel(&home, position).unwrap());
    }
}
