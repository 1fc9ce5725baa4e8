//! Files written whole or not at all, with errors that name them.

use crate::OutputError;
use corpuscle_atomic_file::WholeFile;
use std::io::{self, Write};
use std::path::Path;

/// Writes a file atomically: a reader of `path` sees the old content or the new, never a part.
///
/// # Errors
/// [`OutputError::Write`], naming `path`; the old content, if there was any, is untouched.
pub(crate) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> Result<(), OutputError> {
    corpuscle_atomic_file::write_whole(path, write).map_err(OutputError::write(path))
}

/// [`write_whole`] for content that is there already.
pub(crate) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_whole(path, |file| file.write_all(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_file_and_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let text = write_whole(&path, |_| Err(io::ErrorKind::StorageFull.into())).unwrap_err().to_string();
        assert!(text.contains("a.txt") && text.contains("free some space"), "{text}");
        let path = folder.path().join("none").join("a.txt");
        assert!(write_bytes(&path, b"x").unwrap_err().to_string().contains("a.txt"));
    }
}
