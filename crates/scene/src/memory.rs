//! Files in memory, for programs without a disk, as in a browser.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

type Files = BTreeMap<PathBuf, Arc<[u8]>>;

static FILES: Mutex<Files> = Mutex::new(BTreeMap::new());

fn files() -> MutexGuard<'static, Files> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Holds a file in memory: from now on it is read from there, whatever the disk has under its path.
pub fn hold_in_memory(path: PathBuf, bytes: &[u8]) {
    files().insert(path, bytes.into());
}

/// The file in memory under a path, if there is one.
pub fn in_memory(path: &Path) -> Option<Arc<[u8]>> {
    files().get(path).cloned()
}

/// Frees all files in memory but those in a folder.
pub fn keep_in_memory(folder: &Path) {
    files().retain(|path, _| path.starts_with(folder));
}

/// The error of reading a file: where there is no disk, that it is not in memory.
pub fn without_disk(error: io::Error) -> io::Error {
    match error.kind() {
        ErrorKind::Unsupported => io::Error::new(
            ErrorKind::NotFound,
            "a page has only the files that are dropped together with the scene; drop this one with it, under the name that the \
             scene gives without any folder",
        ),
        _ => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read_bytes, read_text};

    #[test]
    fn files_of_other_folders_are_freed() {
        hold_in_memory("/freed/1/a.csv".into(), b"0, 1");
        hold_in_memory("/freed/2/b.csv".into(), b"0, 2");
        assert_eq!(read_text(Path::new("/freed/1/a.csv")).unwrap(), "0, 1");
        keep_in_memory(Path::new("/freed/2"));
        assert!(in_memory(Path::new("/freed/1/a.csv")).is_none());
        assert_eq!(read_bytes(Path::new("/freed/2/b.csv")).unwrap(), b"0, 2");
    }

    #[test]
    fn a_file_is_missing_where_there_is_no_disk() {
        let error = without_disk(ErrorKind::Unsupported.into());
        assert!(error.to_string().contains("dropped together"), "{error}");
        assert_eq!(read_text(Path::new("/freed/none.csv")).unwrap_err().kind(), ErrorKind::NotFound);
    }
}
