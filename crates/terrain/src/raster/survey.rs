//! What a raster file says of itself, without its values.

use super::{Content, MapBox, ascii, content, geotiff};
use crate::{Georeference, TerrainError};
use std::path::Path;

/// What a raster file says of itself.
#[derive(Debug, Clone)]
pub struct Survey {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Where it lies.
    pub georeference: Georeference,
    /// The format: `GeoTIFF` or `ESRI ASCII grid`.
    pub format: &'static str,
    /// How values are stored: `32-bit floating point`, `text`.
    pub samples: String,
    /// Metres in the unit of its heights.
    pub height_unit_m: f64,
}

impl Survey {
    /// The rectangle round the cells, in the file's own coordinates.
    pub fn outline(&self) -> MapBox {
        self.georeference.outline([self.columns, self.rows])
    }
}

/// Reads what a raster file says of itself, by content, whatever its name and size.
///
/// # Errors
/// As [`crate::read_raster`], without the warnings that depend on its values.
pub fn survey(path: impl AsRef<Path>) -> Result<Survey, TerrainError> {
    let path = path.as_ref();
    match content(path)? {
        Content::GeoTiff { .. } => geotiff::survey(path),
        Content::Text(text) => ascii::survey(path, text),
    }
}
