//! Raster files in memory or on the disk.

use corpuscle_scene::{in_memory, without_disk};
use std::fs::File;
use std::io::{self, Cursor, Read, Seek};
use std::path::Path;

/// Bytes of a file in memory or on the disk.
pub(super) fn length(path: &Path) -> io::Result<u64> {
    let of_disk = || Ok(std::fs::metadata(path).map_err(without_disk)?.len());
    in_memory(path).map_or_else(of_disk, |bytes| Ok(bytes.len() as u64))
}

/// What a file is read from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Opens a file in memory or on the disk.
pub(super) fn open(path: &Path) -> io::Result<Box<dyn Source>> {
    Ok(match in_memory(path) {
        Some(bytes) => Box::new(Cursor::new(bytes)),
        None => Box::new(File::open(path).map_err(without_disk)?),
    })
}
