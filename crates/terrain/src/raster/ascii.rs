//! ESRI ASCII grids.

use super::{MapBox, Raster, Survey, check_not_empty, check_size, outside};
use crate::{Georeference, TerrainError};
use std::io::Read;
use std::iter::Peekable;
use std::path::Path;

/// What marks cells without data where the header does not say it (ESRI).
const DEFAULT_NO_DATA: f64 = -9999.0;

/// What the header says; keys are case-insensitive.
#[derive(Debug, Default)]
struct Header {
    columns: Option<usize>,
    rows: Option<usize>,
    /// West side and south side, or the centre of the south-west cell.
    corner: [Option<f64>; 2],
    centre: [Option<f64>; 2],
    cell: [Option<f64>; 2],
    no_data: Option<f64>,
}

/// True for the beginning of an ESRI ASCII grid.
pub(super) fn looks_like(start: &[u8]) -> bool {
    let start = start.trim_ascii_start();
    [&b"ncols"[..], b"nrows"].iter().any(|key| start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(key)))
}

/// Reads the text of an ESRI ASCII grid: all of it, or the cells in `part`.
pub(super) fn read(path: &Path, text: &[u8], part: Option<&MapBox>) -> Result<Raster, TerrainError> {
    let raster = read_whole(path, text)?;
    let Some(part) = part else { return Ok(raster) };
    let cut = raster.cropped(part).ok_or_else(|| outside(path, part, &raster.outline()))?;
    check_size(path, [cut.columns, cut.rows])?;
    Ok(cut)
}

/// The most text that a header takes.
pub(super) const LONGEST_HEADER: u64 = 4096;

/// The most text for a value with what parts it from the next, on average over the grid: numbers in full have 24 characters.
const LONGEST_VALUE: u64 = 64;

/// The most text that a grid with this beginning can have; only its beginning where that has no header.
pub(super) fn longest(path: &Path, start: &[u8]) -> u64 {
    let cells = survey(path, start).map_or(0, |survey| (survey.columns as u64).saturating_mul(survey.rows as u64));
    cells.saturating_mul(LONGEST_VALUE).saturating_add(LONGEST_HEADER)
}

/// What the header says.
pub(super) fn survey(path: &Path, source: impl Read) -> Result<Survey, TerrainError> {
    let mut start = Vec::new();
    source.take(LONGEST_HEADER).read_to_end(&mut start).map_err(|error| TerrainError::read(path, error))?;
    // The last word may be cut through.
    let whole_words = start.iter().rposition(u8::is_ascii_whitespace).unwrap_or(start.len());
    let mut words = words(path, &start[..whole_words])?;
    let header = header(path, &mut words)?;
    let (columns, rows, georeference) = header.grid().map_err(|what| TerrainError::damaged(path, what))?;
    check_not_empty(path, [columns, rows])?;
    let (format, samples) = ("ESRI ASCII grid", "text".to_owned());
    Ok(Survey { columns, rows, georeference, format, samples, height_unit_m: 1.0 })
}

/// The words of a text, with their lines.
fn words<'a>(path: &Path, text: &'a [u8]) -> Result<Peekable<impl Iterator<Item = (usize, &'a str)>>, TerrainError> {
    if !looks_like(text) {
        return Err(TerrainError::wrong_type(path, "unpacked, it is a text that does not begin with `ncols`"));
    }
    let text = std::str::from_utf8(text)
        .map_err(|error| TerrainError::damaged(path, format!("byte {} is not text", error.valid_up_to())))?;
    let lines = text.lines().enumerate();
    Ok(lines.flat_map(|(line, words)| words.split_ascii_whitespace().map(move |word| (line + 1, word))).peekable())
}

/// Reads the header.
fn header<'a>(
    path: &Path,
    words: &mut Peekable<impl Iterator<Item = (usize, &'a str)>>,
) -> Result<Header, TerrainError> {
    let mut header = Header::default();
    while let Some((line, key)) = words.next_if(|(_, word)| is_key(word)) {
        let (_, value) = words.next().ok_or_else(|| damaged(path, line, &format!("`{key}` has no value")))?;
        header.set(key, value).map_err(|what| damaged(path, line, &what))?;
    }
    Ok(header)
}

fn read_whole(path: &Path, text: &[u8]) -> Result<Raster, TerrainError> {
    let mut words = words(path, text)?;
    let header = header(path, &mut words)?;
    let (columns, rows, georeference) = header.grid().map_err(|what| TerrainError::damaged(path, what))?;
    check_size(path, [columns, rows])?;
    let cells = columns * rows;
    // A value and its separator take two bytes at least.
    if cells > text.len() / 2 + 1 {
        let what = format!("its header says {columns} x {rows} cells, which its {} bytes cannot hold", text.len());
        return Err(TerrainError::damaged(path, what));
    }
    let mut values = Vec::with_capacity(cells);
    for (line, word) in words {
        let value: f64 = word.parse().map_err(|_| damaged(path, line, &format!("`{word}` is not a number")))?;
        values.push(if header.no_data.unwrap_or(DEFAULT_NO_DATA) == value { f64::NAN } else { value });
    }
    if values.len() != cells {
        let what = format!("its header says {columns} x {rows} = {cells} values, but there are {}", values.len());
        return Err(TerrainError::damaged(path, what));
    }
    let warnings = projection_file(path).into_iter().collect();
    Ok(Raster { columns, rows, values, georeference, warnings })
}

fn damaged(path: &Path, line: usize, what: &str) -> TerrainError {
    TerrainError::damaged(path, format!("line {line}: {what}"))
}

/// True for a word that is no value; `nan` and `inf` are values.
fn is_key(word: &str) -> bool {
    word.starts_with(|first: char| first.is_alphabetic()) && word.parse::<f64>().is_err()
}

/// A word about a projection file beside the grid, which is not read.
fn projection_file(path: &Path) -> Option<String> {
    let beside = path.with_extension("prj");
    beside.is_file().then(|| {
        format!(
            "The reference system in {} is not read; name it with `crs` in [terrain.file], e.g. crs = \"EPSG:27700\".",
            beside.display()
        )
    })
}

impl Header {
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let number = || value.parse::<f64>().map_err(|_| format!("`{key}` is `{value}`, not a number"));
        let count = || value.parse::<usize>().map_err(|_| format!("`{key}` is `{value}`, not a whole number"));
        match key.to_ascii_lowercase().as_str() {
            "ncols" => self.columns = Some(count()?),
            "nrows" => self.rows = Some(count()?),
            "xllcorner" => self.corner[0] = Some(number()?),
            "yllcorner" => self.corner[1] = Some(number()?),
            "xllcenter" => self.centre[0] = Some(number()?),
            "yllcenter" => self.centre[1] = Some(number()?),
            "cellsize" => self.cell = [Some(number()?); 2],
            "dx" => self.cell[0] = Some(number()?),
            "dy" => self.cell[1] = Some(number()?),
            "nodata_value" => self.no_data = Some(number()?),
            _ => return Err(format!("`{key}` is no key of an ESRI ASCII grid")),
        }
        Ok(())
    }

    /// Columns, rows and position.
    fn grid(&self) -> Result<(usize, usize, Georeference), String> {
        let missing = |key: &str| format!("its header has no `{key}`");
        let columns = self.columns.ok_or_else(|| missing("ncols"))?;
        let rows = self.rows.ok_or_else(|| missing("nrows"))?;
        let [dx, dy] = self.cell;
        let cell = [dx.ok_or_else(|| missing("cellsize"))?, dy.ok_or_else(|| missing("cellsize"))?];
        let side = |axis: usize, key: &str| match (self.corner[axis], self.centre[axis]) {
            (Some(side), _) => Ok(side),
            (None, Some(centre)) => Ok(centre - 0.5 * cell[axis]),
            (None, None) => Err(missing(key)),
        };
        let [west, south] = [side(0, "xllcorner")?, side(1, "yllcorner")?];
        Ok((columns, rows, Georeference::plain([west, south + rows as f64 * cell[1]], cell)))
    }
}
