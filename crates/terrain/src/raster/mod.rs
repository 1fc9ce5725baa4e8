//! Rasters: files of values on a grid.

mod ascii;
mod field;
mod geotiff;
mod memory;
mod photo;
mod survey;
mod window;
mod write;

pub use corpuscle_scene::{hold_in_memory, in_memory, keep_in_memory};
pub use field::RasterField;
pub use photo::Photo;
pub use survey::{Survey, survey};
pub use window::{MapBox, Window};
pub use write::{write_geotiff, write_raster, write_raster_exactly};

use crate::system::ReferenceSystem;
use crate::{Georeference, TerrainError};
use flate2::read::GzDecoder;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// A raster may have this many cells: 10,000 x 10,000, beyond which the smooth surface alone takes more than 3 GB where all of it is
/// looked at; 5,000 x 5,000 where addresses have 32 bits, as in a page of a browser.
pub(crate) const MOST_CELLS: u64 = if usize::BITS > 32 { 100_000_000 } else { 25_000_000 };

/// What more can be done about a raster with too many cells.
const OR_ELSE: &str = if usize::BITS > 32 { "" } else { ", or open it with the program, which takes 100 million" };

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
    /// Warnings about it, in sentences.
    pub warnings: Vec<String>,
}

impl Raster {
    /// A raster from values in memory: `rows * columns`, row by row from the north-west, not-a-number where there is no data. `corner` is its
    /// outer corner at the north-west and `cell` the size of a cell `[eastwards, southwards]`, in units of the reference system, which is named
    /// by its EPSG code as in `EPSG:27700`.
    ///
    /// # Errors
    /// [`TerrainError::ReferenceSystem`] for a name without an EPSG code.
    pub fn of_values(
        [columns, rows]: [usize; 2],
        values: Vec<f64>,
        corner: [f64; 2],
        cell: [f64; 2],
        crs: Option<&str>,
    ) -> Result<Self, TerrainError> {
        let plain = Georeference::plain(corner, cell);
        let georeference = match crs.map(|crs| ReferenceSystem::parse(crs).map(|system| (crs, system))).transpose()? {
            None => plain,
            Some((_, system)) if system.epsg.is_some() => plain.with_system(system),
            Some((crs, _)) => {
                let what = "a raster in memory needs an EPSG code".into();
                return Err(TerrainError::ReferenceSystem { crs: crs.into(), what });
            }
        };
        Ok(Self { columns, rows, values, georeference, warnings: Vec::new() })
    }
}

/// Reads a raster: GeoTIFF, or ESRI ASCII grid, also compressed with gzip; by content, whatever the file's name.
/// Values that are not a number count as no data.
///
/// # Errors
/// A text that names the file, for one that is no such raster, damaged, too large (more than 100 million cells, or
/// more than its bytes can hold), less than 2 cells wide or high, or without any data.
pub fn read_raster(path: impl AsRef<Path>) -> Result<Raster, TerrainError> {
    read(path.as_ref(), None, Values::Heights)
}

/// Reads a raster whose values are no heights, as [`read_raster`] does: a unit of heights that the file names does not count.
pub(crate) fn read_values(path: &Path) -> Result<Raster, TerrainError> {
    read(path, None, Values::Others)
}

/// What the values of a raster are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Values {
    /// Heights, in the unit that the file names.
    Heights,
    /// Something else, in its own unit.
    Others,
}

/// Reads the cells of a raster that share area with `part`, as [`read_raster`] does; of a GeoTIFF in blocks only those
/// blocks, so that it may be of any size.
///
/// # Errors
/// As [`read_raster`], and where no cell lies in `part`; a part without any data is no error.
pub fn read_raster_part(path: impl AsRef<Path>, part: &MapBox) -> Result<Raster, TerrainError> {
    read(path.as_ref(), Some(part), Values::Heights)
}

fn read(path: &Path, part: Option<&MapBox>, values: Values) -> Result<Raster, TerrainError> {
    let raster = match content(path)? {
        Content::GeoTiff { big_endian } => geotiff::read(path, big_endian, part, values)?,
        Content::Text(source) => ascii::read(path, &text(path, source)?, part)?,
    };
    let raster = checked(path, raster)?;
    if part.is_none() {
        refuse_empty(path, &raster)?;
    }
    Ok(raster)
}

/// What a file holds.
enum Content {
    GeoTiff {
        big_endian: bool,
    },
    /// The text of an ESRI ASCII grid, unpacked.
    Text(Box<dyn Read>),
}

/// What a file holds, by its first bytes.
fn content(path: &Path) -> Result<Content, TerrainError> {
    let mut file = memory::open(path).map_err(|error| TerrainError::read(path, error))?;
    let mut start = Vec::new();
    (&mut file).take(64).read_to_end(&mut start).map_err(|error| TerrainError::read(path, error))?;
    file.rewind().map_err(|error| TerrainError::read(path, error))?;
    match start.as_slice() {
        [] => Err(TerrainError::wrong_type(path, "the file is empty")),
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => {
            Ok(Content::GeoTiff { big_endian: start[0] == b'M' })
        }
        [0x1f, 0x8b, ..] => Ok(Content::Text(Box::new(GzDecoder::new(BufReader::new(file))))),
        _ if ascii::looks_like(&start) => Ok(Content::Text(Box::new(file))),
        _ => Err(TerrainError::wrong_type(path, kind(&start))),
    }
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

/// The whole text of a file: no more than the cells that its header tells can need, so that a small file cannot unpack to a huge text.
fn text(path: &Path, mut source: impl Read) -> Result<Vec<u8>, TerrainError> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof | std::io::ErrorKind::InvalidInput | std::io::ErrorKind::InvalidData => {
            TerrainError::damaged(path, error.to_string())
        }
        _ => TerrainError::read(path, error),
    };
    let mut text = Vec::new();
    (&mut source).take(ascii::LONGEST_HEADER).read_to_end(&mut text).map_err(failed)?;
    let longest = ascii::longest(path, &text);
    let most = longest.min(MOST_TEXT);
    source.take((most + 1).saturating_sub(text.len() as u64)).read_to_end(&mut text).map_err(failed)?;
    if text.len() as u64 > most && longest > MOST_TEXT {
        return Err(TerrainError::unusable(
            path,
            "its text is longer than 2 GB; convert it to a GeoTIFF and cut it out",
        ));
    }
    if text.len() as u64 > most && most > ascii::LONGEST_HEADER {
        let what =
            format!("its text goes on beyond {most} characters, far more than the cells that its header tells need");
        return Err(TerrainError::damaged(path, what));
    }
    Ok(text)
}

/// Refuses a header without columns or rows, on which nothing can be read or said.
fn check_not_empty(path: &Path, [columns, rows]: [usize; 2]) -> Result<(), TerrainError> {
    if columns == 0 || rows == 0 {
        return Err(TerrainError::damaged(
            path,
            format!("its header says that it has {columns} columns and {rows} rows"),
        ));
    }
    Ok(())
}

/// Refuses a size that cannot be meant, before anything is reserved for it.
pub(crate) fn check_size(path: &Path, size: [usize; 2]) -> Result<(), TerrainError> {
    check_not_empty(path, size)?;
    let [columns, rows] = size.map(|count| count as u64);
    if columns < 2 || rows < 2 {
        let what = format!("it has {columns} x {rows} cells; at least 2 x 2 are needed");
        return Err(TerrainError::unusable(path, what));
    }
    if columns.checked_mul(rows).is_none_or(|cells| cells > MOST_CELLS) {
        let what = format!(
            "it says that it has {columns} x {rows} cells, more than the {} million that can be used; cut out the part \
             that matters (`corpuscle terrain clip`) or make it coarser (`gdalwarp -tr`){OR_ELSE}",
            MOST_CELLS / 1_000_000
        );
        return Err(TerrainError::unusable(path, what));
    }
    Ok(())
}

/// The error for a raster of which nothing lies in a box.
pub(crate) fn outside(path: &Path, part: &MapBox, outline: &MapBox) -> TerrainError {
    let sides = |MapBox { west, south, east, north }: &MapBox| format!("{west},{south},{east},{north}");
    let what = format!(
        "nothing lies in the box {} (west,south,east,north); this file, in whose coordinates the box must be, covers {}",
        sides(part),
        sides(outline)
    );
    TerrainError::unusable(path, what)
}

/// Refuses values and positions that no model can use.
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
    Ok(raster)
}

/// Refuses a raster without any data.
pub(crate) fn refuse_empty(path: &Path, raster: &Raster) -> Result<(), TerrainError> {
    if raster.values.iter().all(|value| value.is_nan()) {
        return Err(TerrainError::unusable(path, "none of its cells has data; check its no-data value"));
    }
    Ok(())
}
