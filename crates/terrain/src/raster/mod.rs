//! Rasters: files of values on a grid.

mod ascii;
mod field;
mod geotiff;
mod write;

pub use field::RasterField;
pub use write::write_geotiff;

use crate::{Georeference, TerrainError};
use flate2::read::GzDecoder;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// A raster may have this many cells: 10,000 x 10,000. Beyond, the smooth surface alone takes more than 3 GB.
pub(crate) const MOST_CELLS: u64 = 100_000_000;

/// The most text that is unpacked from a compressed grid: 20 characters for each of the cells a raster may have.
const MOST_TEXT: u64 = 20 * MOST_CELLS;

/// A raster as read.
#[derive(Debug, Clone)]
pub struct Raster {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// `rows * columns` values, row by row from the north-west; not-a-number where the file has no data.
    pub values: Vec<f64>,
    /// Where it lies.
    pub georeference: Georeference,
    /// What a user should know about it, in sentences.
    pub warnings: Vec<String>,
}

/// Reads a raster: GeoTIFF, or ESRI ASCII grid, also compressed with gzip; by content, whatever the file's name.
/// Values that are not a number count as no data.
///
/// # Errors
/// A text that names the file, for one that is no such raster, damaged, too large (more than 100 million cells, or
/// more than its bytes can hold), less than 2 cells wide or high, or without any data.
pub fn read_raster(path: impl AsRef<Path>) -> Result<Raster, TerrainError> {
    let path = path.as_ref();
    let mut file = File::open(path).map_err(|error| TerrainError::read(path, error))?;
    let mut start = Vec::new();
    (&mut file).take(64).read_to_end(&mut start).map_err(|error| TerrainError::read(path, error))?;
    file.rewind().map_err(|error| TerrainError::read(path, error))?;
    let raster = match start.as_slice() {
        [] => return Err(TerrainError::wrong_type(path, "the file is empty")),
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => geotiff::read(path, start[0] == b'M')?,
        [0x1f, 0x8b, ..] => ascii::read(path, &text(path, GzDecoder::new(BufReader::new(file)))?)?,
        _ if ascii::looks_like(&start) => ascii::read(path, &text(path, file)?)?,
        _ => return Err(TerrainError::wrong_type(path, kind(&start))),
    };
    checked(path, raster)
}

/// What a file that is no raster seems to be.
fn kind(start: &[u8]) -> &'static str {
    match start {
        [0x89, b'P', b'N', b'G', ..] => "it is a PNG picture, whose colours are not heights",
        [0xff, 0xd8, 0xff, ..] => "it is a JPEG picture, whose colours are not heights",
        [b'P', b'K', 3, 4, ..] => "it is a ZIP archive; unpack it",
        _ if start.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace()) => {
            "it is a text that does not begin with `ncols`"
        }
        _ => "its first bytes are those of neither",
    }
}

/// The whole text of a file.
fn text(path: &Path, source: impl Read) -> Result<Vec<u8>, TerrainError> {
    let mut text = Vec::new();
    source.take(MOST_TEXT + 1).read_to_end(&mut text).map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof | std::io::ErrorKind::InvalidInput | std::io::ErrorKind::InvalidData => {
            TerrainError::damaged(path, error.to_string())
        }
        _ => TerrainError::read(path, error),
    })?;
    if text.len() as u64 > MOST_TEXT {
        return Err(TerrainError::unusable(
            path,
            "its text is longer than 2 GB; convert it to a GeoTIFF and cut it out",
        ));
    }
    Ok(text)
}

/// Refuses a size that cannot be meant, before anything is reserved for it.
fn check_size(path: &Path, columns: u64, rows: u64) -> Result<(), TerrainError> {
    if columns < 2 || rows < 2 {
        let what = format!("it has {columns} x {rows} cells; at least 2 x 2 are needed");
        return Err(TerrainError::unusable(path, what));
    }
    if columns.checked_mul(rows).is_none_or(|cells| cells > MOST_CELLS) {
        let what = format!(
            "it says that it has {columns} x {rows} cells, more than the {} million that can be used; cut out the part \
             that matters (`gdal_translate -projwin`) or make it coarser (`gdalwarp -tr`)",
            MOST_CELLS / 1_000_000
        );
        return Err(TerrainError::unusable(path, what));
    }
    Ok(())
}

/// Refuses values and places that no model can use.
fn checked(path: &Path, raster: Raster) -> Result<Raster, TerrainError> {
    let Georeference { corner, cell, .. } = &raster.georeference;
    if !corner.iter().chain(cell).all(|value| value.is_finite()) || cell.iter().any(|size| *size <= 0.0) {
        let what = format!("its corner {corner:?} or its cell size {cell:?} makes no sense");
        return Err(TerrainError::damaged(path, what));
    }
    if let Some(index) = raster.values.iter().position(|value| value.is_infinite()) {
        let (column, row) = (index % raster.columns, index / raster.columns);
        let what = format!(
            "its value in column {column}, row {row} (counted from 0 at the north-west) is infinite; mark such cells as \
             no data"
        );
        return Err(TerrainError::unusable(path, what));
    }
    if raster.values.iter().all(|value| value.is_nan()) {
        return Err(TerrainError::unusable(path, "none of its cells has data; check its no-data value"));
    }
    Ok(raster)
}
