//! ESRI ASCII grids.

use super::{Raster, check_size};
use crate::{Georeference, TerrainError};
use std::path::Path;

/// What the header says; keys are case-insensitive.
#[derive(Debug, Default)]
struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
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

/// Reads the text of an ESRI ASCII grid.
pub(super) fn read(path: &Path, text: &[u8]) -> Result<Raster, TerrainError> {
    if !looks_like(text) {
        return Err(TerrainError::wrong_type(path, "unpacked, it is a text that does not begin with `ncols`"));
    }
    let text = std::str::from_utf8(text)
        .map_err(|error| TerrainError::damaged(path, format!("byte {} is not text", error.valid_up_to())))?;
    let mut words = text
        .lines()
        .enumerate()
        .flat_map(|(line, words)| words.split_ascii_whitespace().map(move |word| (line + 1, word)))
        .peekable();
    let mut header = Header::default();
    while let Some((line, key)) = words.next_if(|(_, word)| is_key(word)) {
        let (_, value) = words.next().ok_or_else(|| damaged(path, line, &format!("`{key}` has no value")))?;
        header.set(key, value).map_err(|what| damaged(path, line, &what))?;
    }
    let (columns, rows, georeference) = header.grid().map_err(|what| TerrainError::damaged(path, what))?;
    check_size(path, columns, rows)?;
    let cells = (columns * rows) as usize;
    // A value and its separator take two bytes at least.
    if cells > text.len() / 2 + 1 {
        let what = format!("its header says {columns} x {rows} cells, which its {} bytes cannot hold", text.len());
        return Err(TerrainError::damaged(path, what));
    }
    let mut values = Vec::with_capacity(cells);
    for (line, word) in words {
        let value: f64 = word.parse().map_err(|_| damaged(path, line, &format!("`{word}` is not a number")))?;
        values.push(if header.no_data == Some(value) { f64::NAN } else { value });
    }
    if values.len() != cells {
        let what = format!("its header says {columns} x {rows} = {cells} values, but there are {}", values.len());
        return Err(TerrainError::damaged(path, what));
    }
    let warnings = projection_file(path).into_iter().collect();
    Ok(Raster { columns: columns as usize, rows: rows as usize, values, georeference, warnings })
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
        let count = || value.parse::<u64>().map_err(|_| format!("`{key}` is `{value}`, not a whole number"));
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

    /// Columns, rows and place.
    fn grid(&self) -> Result<(u64, u64, Georeference), String> {
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
