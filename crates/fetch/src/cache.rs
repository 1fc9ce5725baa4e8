//! The cache of downloaded pieces, in files with checksums.

use crate::FetchError;
use crate::checksum::{self, StoredFile};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Description of a remote file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum About {
    /// It exists.
    File {
        /// Bytes.
        length: u64,
        /// The server's entity tag of this version.
        etag: Option<String>,
    },
    /// It does not exist: sea.
    Sea,
}

/// The cache of one remote file, or of files beside each other.
#[derive(Debug)]
pub(crate) struct Cache {
    folder: PathBuf,
    /// Files that were found damaged.
    damaged: AtomicUsize,
}

impl Cache {
    /// The cache of the file `tile` below a base address.
    pub fn of(cache: &Path, base: &str, tile: &str) -> Self {
        Self { folder: cache.join("glo-30").join(checksum::short_name(base)).join(tile), damaged: AtomicUsize::new(0) }
    }

    pub fn about(&self) -> Option<About> {
        serde_json::from_slice(&self.read("about")?).ok()
    }

    pub fn set_about(&self, about: &About) -> Result<(), FetchError> {
        let path = self.folder.join("about");
        let text = serde_json::to_vec(about).map_err(|error| FetchError::cache(&path, error))?;
        checksum::write(&path, &text)
    }

    /// A piece, if it is stored undamaged with the expected length.
    pub fn piece(&self, number: u64, length: u64) -> Option<Vec<u8>> {
        self.read(&piece_name(number)).filter(|piece| piece.len() as u64 == length)
    }

    pub fn set_piece(&self, number: u64, bytes: &[u8]) -> Result<(), FetchError> {
        checksum::write(&self.folder.join(piece_name(number)), bytes)
    }

    /// Empties the cache of this file.
    pub fn clear(&self) -> Result<(), FetchError> {
        match fs::remove_dir_all(&self.folder) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(FetchError::cache(&self.folder, error)),
            _ => Ok(()),
        }
    }

    /// Files that were found damaged.
    pub fn damaged(&self) -> usize {
        self.damaged.load(Ordering::Relaxed)
    }

    fn read(&self, name: &str) -> Option<Vec<u8>> {
        match checksum::read(&self.folder.join(name)) {
            StoredFile::Intact(content) => Some(content),
            StoredFile::Damaged => {
                self.damaged.fetch_add(1, Ordering::Relaxed);
                None
            }
            StoredFile::Absent => None,
        }
    }
}

fn piece_name(number: u64) -> String {
    format!("{number:06}")
}
