//! Version of an ensemble's folder, and how its text files are written.

use crate::EnsembleError;
use corpuscle_atomic_file::write_whole;
use std::io::Write;
use std::path::Path;

/// Version of the layout, which the Python package writes too.
pub(crate) const FORMAT: u32 = 1;

/// Writes a text file whole or not at all.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), EnsembleError> {
    write_whole(path, |file| file.write_all(text.as_bytes())).map_err(EnsembleError::file(path))
}
