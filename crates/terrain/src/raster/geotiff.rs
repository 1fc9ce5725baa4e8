//! GeoTIFF, read with the `geotiff-reader` library.

use super::{Raster, check_size};
use crate::system::{ReferenceSystem, height_unit};
use crate::{Georeference, TerrainError};
use geotiff_reader::transform::GeoTransform;
use geotiff_reader::{Error as ReaderError, GeoTiffFile, Result as ReaderResult};
use ndarray::ArrayD;
use std::path::Path;

/// No compression in use makes terrain this many times smaller (Deflate reaches 1032 and LZW 2700 on a constant; a
/// block left out of a sparse file takes 16 bytes): a header that claims more is broken.
const LARGEST_COMPRESSION: u64 = 20_000;

/// Reads the first band of a GeoTIFF, whose first bytes say whether it is big-endian.
pub(super) fn read(path: &Path, big_endian: bool) -> Result<Raster, TerrainError> {
    let bytes = std::fs::metadata(path).map_err(|error| TerrainError::read(path, error))?.len();
    let nowhere =
        || TerrainError::unusable(path, "it says nowhere where it lies; add its corners with `gdal_edit.py -a_ullr`");
    let damaged = |error| match error {
        ReaderError::NotGeoTiff => nowhere(),
        error => refused(path, &error),
    };
    let file = GeoTiffFile::open(path).map_err(damaged)?;
    let (columns, rows) = (u64::from(file.width()), u64::from(file.height()));
    check_size(path, columns, rows)?;
    check_compression(path, &file, big_endian)?;
    let format = SampleFormat::of(&file).map_err(damaged)?;
    if columns * rows * u64::from(format.bits) / 8 > bytes.saturating_mul(LARGEST_COMPRESSION) {
        let what = format!("its header says {columns} x {rows} cells, which its {bytes} bytes cannot hold");
        return Err(TerrainError::damaged(path, what));
    }
    let mut warnings = Vec::new();
    if file.band_count() > 1 {
        warnings.push(format!("{} has {} bands; the first is used.", path.display(), file.band_count()));
    }
    let mut values = values(path, &file, &format)?;
    let unit = height_unit(file.geokeys());
    if unit != 1.0 {
        values.iter_mut().for_each(|value| *value *= unit);
        warnings.push(format!("{} gives its values in units of {unit} m; they were converted.", path.display()));
    }
    let transform = *file.transform().ok_or_else(nowhere)?;
    let corner = north_up(path, &transform, [file.width() as usize, file.height() as usize], &mut values)?;
    let georeference = Georeference {
        corner,
        cell: [transform.pixel_width, transform.pixel_height.abs()],
        system: ReferenceSystem::from_keys(file.geokeys()).map_err(|what| TerrainError::unusable(path, what))?,
        keys: file.geokeys().clone(),
    };
    Ok(Raster { columns: columns as usize, rows: rows as usize, values, georeference, warnings })
}

/// What is wrong with a file that the library does not read.
fn refused(path: &Path, error: &ReaderError) -> TerrainError {
    let what = error.to_string();
    // The library's own error type, which would tell, is not part of its interface.
    if what.contains("unsupported") {
        return TerrainError::unusable(path, format!("{what}; convert it with `gdal_translate -co COMPRESS=DEFLATE`"));
    }
    TerrainError::damaged(path, what)
}

/// Refuses LERC in big-endian files, whose bytes the library (0.10) turns round although LERC's own order is fixed.
fn check_compression(path: &Path, file: &GeoTiffFile, big_endian: bool) -> Result<(), TerrainError> {
    const LERC: u16 = 34887;
    let image = file.tiff().ifd(file.base_ifd_index()).map_err(|error| refused(path, &error.into()))?;
    if image.compression() == LERC && big_endian {
        let what = "LERC in a big-endian file is not read; convert it with `gdal_translate -co COMPRESS=DEFLATE`";
        return Err(TerrainError::unusable(path, what));
    }
    Ok(())
}

/// How a file stores its samples.
struct SampleFormat {
    /// TIFF code: 1 unsigned, 2 signed, 3 floating point.
    code: u16,
    bits: u16,
}

impl SampleFormat {
    fn of(file: &GeoTiffFile) -> ReaderResult<Self> {
        let image = file.tiff().ifd(file.base_ifd_index())?;
        let first = |values: Vec<u16>| values.first().copied().unwrap_or(1);
        Ok(Self { code: first(image.sample_format()?), bits: first(image.bits_per_sample()?) })
    }
}

/// All values of the first band, not-a-number where there are none.
fn values(path: &Path, file: &GeoTiffFile, format: &SampleFormat) -> Result<Vec<f64>, TerrainError> {
    let no_data: Option<f64> = file.nodata().and_then(|text| text.trim().parse().ok());
    // A mark that the sample type cannot hold marks no cell; one in single precision is compared as such.
    let exact = |value: f64| Some(value) == no_data;
    match (format.code, format.bits) {
        (1, 1..=8) => band(path, file.read_band(0), |v: u8| f64::from(v), exact),
        (1, 9..=16) => band(path, file.read_band(0), |v: u16| f64::from(v), exact),
        (1, 32) => band(path, file.read_band(0), |v: u32| f64::from(v), exact),
        (1, 64) => band(path, file.read_band(0), |v: u64| v as f64, exact),
        (2, 8) => band(path, file.read_band(0), |v: i8| f64::from(v), exact),
        (2, 16) => band(path, file.read_band(0), |v: i16| f64::from(v), exact),
        (2, 32) => band(path, file.read_band(0), |v: i32| f64::from(v), exact),
        (2, 64) => band(path, file.read_band(0), |v: i64| v as f64, exact),
        (3, 32) => band(
            path,
            file.read_band(0),
            |v: f32| f64::from(v),
            |value| Some(value as f32) == no_data.map(|v| v as f32),
        ),
        (3, 64) => band(path, file.read_band(0), |v: f64| v, exact),
        (code, bits) => Err(TerrainError::unusable(
            path,
            format!(
                "its samples (TIFF sample format {code}, {bits} bits) are of a kind that cannot be read; convert it with \
                 `gdal_translate -ot Float32`"
            ),
        )),
    }
}

/// The values of the first band, converted by `number`, without those that `is_no_data` tells.
fn band<T: Copy>(
    path: &Path,
    samples: ReaderResult<ArrayD<T>>,
    number: impl Fn(T) -> f64,
    is_no_data: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, TerrainError> {
    let samples = samples.map_err(|error| refused(path, &error))?;
    let with_holes = |value: f64| if is_no_data(value) { f64::NAN } else { value };
    Ok(samples.iter().map(|sample| with_holes(number(*sample))).collect())
}

/// Puts the north row first and gives the north-west corner; refuses turned and mirrored rasters.
fn north_up(
    path: &Path,
    transform: &GeoTransform,
    [columns, rows]: [usize; 2],
    values: &mut [f64],
) -> Result<[f64; 2], TerrainError> {
    if transform.skew_x != 0.0 || transform.skew_y != 0.0 || transform.pixel_width < 0.0 {
        let what = "it is turned or mirrored against north; straighten it with `gdalwarp`";
        return Err(TerrainError::unusable(path, what));
    }
    if transform.pixel_height <= 0.0 {
        return Ok([transform.origin_x, transform.origin_y]);
    }
    for row in 0..rows / 2 {
        let (above, below) = values.split_at_mut((rows - 1 - row) * columns);
        above[row * columns..][..columns].swap_with_slice(&mut below[..columns]);
    }
    Ok([transform.origin_x, transform.origin_y + rows as f64 * transform.pixel_height])
}
