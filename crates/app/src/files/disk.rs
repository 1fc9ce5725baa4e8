//! Files on the disk.

use std::io::{self, Write};
use std::path::Path;

/// Writes a whole file.
pub(super) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    corpuscle_atomic_file::write_whole(path, |file| file.write_all(bytes))
}
