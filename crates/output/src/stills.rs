//! Pictures in a run's folder.

use crate::OutputError;
use crate::whole::write_bytes;
use corpuscle_drawing::png::encode_rgba;
use std::fs;
use std::path::Path;

/// Writes a picture of `size` `[width, height]` (red, green, blue and opacity bytes, rows from the top) as PNG. Its folder is
/// made where it is not there.
///
/// # Errors
/// [`OutputError::Write`]; [`OutputError::Content`] where the bytes do not fit the size.
pub fn write_picture(path: &Path, size: [u32; 2], rgba: &[u8]) -> Result<(), OutputError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(OutputError::write(folder))?;
    }
    let png = encode_rgba(size[0], size[1], rgba).map_err(|what| OutputError::content(path, what))?;
    write_bytes(path, &png)
}

/// Writes a drawing, SVG, into a folder that is there.
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_drawing(path: &Path, svg: &str) -> Result<(), OutputError> {
    write_bytes(path, svg.as_bytes())
}
