//! Files with a checksum before their content, so that damage is found.

use crate::FetchError;
use sha2::{Digest, Sha256};
use std::fs;
use std::io::Write;
use std::path::Path;

/// Bytes of a SHA-256 checksum.
const CHECKSUM: usize = 32;

/// Writes a file, whole or not at all, with its checksum.
pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), FetchError> {
    try_write(path, content).map_err(|error| FetchError::cache(path, error))
}

fn try_write(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    corpuscle_atomic_file::write_whole(path, |file| {
        file.write_all(&Sha256::digest(content))?;
        file.write_all(content)
    })
}

/// The result of reading a file with a checksum.
#[derive(Debug, PartialEq)]
pub(crate) enum StoredFile {
    Intact(Vec<u8>),
    /// The checksum does not fit.
    Damaged,
    Absent,
}

/// Reads a file and compares its checksum.
pub(crate) fn read(path: &Path) -> StoredFile {
    let Ok(mut bytes) = fs::read(path) else { return StoredFile::Absent };
    if bytes.len() < CHECKSUM {
        return StoredFile::Damaged;
    }
    let content = bytes.split_off(CHECKSUM);
    if bytes == *Sha256::digest(&content) { StoredFile::Intact(content) } else { StoredFile::Damaged }
}

/// The beginning of a checksum, as a name.
pub(crate) fn short_name(text: &str) -> String {
    Sha256::digest(text.as_bytes())[..8].iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_is_found_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sub/a");
        assert_eq!(read(&path), StoredFile::Absent);
        write(&path, b"content").unwrap();
        assert_eq!(read(&path), StoredFile::Intact(b"content".to_vec()));
        let whole = fs::read(&path).unwrap();
        for broken in [&whole[..whole.len() - 1], &whole[..10], b"", &[&whole[..], b"x"].concat()] {
            fs::write(&path, broken).unwrap();
            assert_eq!(read(&path), StoredFile::Damaged);
        }
        let mut flipped = whole.clone();
        flipped[CHECKSUM + 2] ^= 1;
        fs::write(&path, flipped).unwrap();
        assert_eq!(read(&path), StoredFile::Damaged);
    }
}
