//! Raster files in memory, for programs without a disk, as in a browser.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Cursor, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

static FILES: Mutex<BTreeMap<PathBuf, Arc<[u8]>>> = Mutex::new(BTreeMap::new());

/// Holds a raster file in memory: from now on it is read from there, whatever the disk has under its path.
pub fn hold_in_memory(path: PathBuf, bytes: &[u8]) {
    FILES.lock().unwrap_or_else(PoisonError::into_inner).insert(path, bytes.into());
}

/// The file in memory under a path, if there is one.
pub fn in_memory(path: &Path) -> Option<Arc<[u8]>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner).get(path).cloned()
}

/// Bytes of a file in memory or on the disk.
pub(super) fn length(path: &Path) -> io::Result<u64> {
    in_memory(path).map_or_else(|| Ok(std::fs::metadata(path)?.len()), |bytes| Ok(bytes.len() as u64))
}

/// What a file is read from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Opens a file in memory or on the disk.
pub(super) fn open(path: &Path) -> io::Result<Box<dyn Source>> {
    Ok(match in_memory(path) {
        Some(bytes) => Box::new(Cursor::new(bytes)),
        None => Box::new(File::open(path)?),
    })
}
