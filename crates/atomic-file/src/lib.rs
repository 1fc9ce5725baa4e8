//! Files that appear whole or not at all.
//!
//! What is written goes to a temporary file in the same folder, which takes the place of the old one only when all of
//! it is on the disk: a reader gets the old content or the new, never a part.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file in the making. Dropped before [`WholeFile::finish`], it leaves nothing behind.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    buffer: BufWriter<NamedTempFile>,
}

impl WholeFile {
    /// Begins the file that shall stand at `path`, in a folder that exists.
    ///
    /// # Errors
    /// What the system says where no file can be made in the folder.
    pub fn create(path: &Path) -> io::Result<Self> {
        Ok(Self { path: path.into(), buffer: BufWriter::with_capacity(1 << 16, temporary_beside(path)?) })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// What the system says, as when the disk is full; what stood at the path before is untouched then.
    pub fn finish(self) -> io::Result<()> {
        let file = self.buffer.into_inner().map_err(io::IntoInnerError::into_error)?;
        put_in_place(file, &self.path)
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.buffer.flush()
    }
}

impl Seek for WholeFile {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.buffer.seek(place)
    }
}

/// Writes a file in one go.
///
/// # Errors
/// What `write` or the system says; what stood at `path` before is untouched then.
pub fn write_whole(path: &Path, write: impl FnOnce(&mut WholeFile) -> io::Result<()>) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    write(&mut file)?;
    file.finish()
}

/// Writes a file by code that opens it itself: `write` is given the path of the temporary file, which is there and empty.
///
/// # Errors
/// What `write` or the system says; what stood at `path` before is untouched then.
pub fn write_whole_by_path<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let file = temporary_beside(path)?;
    write(file.path())?;
    Ok(put_in_place(file, path)?)
}

/// Puts a temporary file in its place once its content is on the disk, and then the new name.
fn put_in_place(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.as_file().sync_data()?;
    file.persist(path).map_err(|error| error.error)?;
    sync_folder(folder_of(path))
}

/// Puts the names in a folder on the disk. Some file systems have no way to; elsewhere than on Unix a folder cannot be opened.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported | io::ErrorKind::PermissionDenied
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// How the names of temporary files begin.
const IN_THE_MAKING: &str = ".writing-";

/// Removes temporary files that a killed program left in a folder, to which no other process writes. A missing folder is clean.
///
/// # Errors
/// What the system says where something cannot be removed.
pub fn clear_unfinished(folder: &Path) -> io::Result<()> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let unfinished = |entry: &std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with(IN_THE_MAKING);
    entries.flatten().filter(unfinished).try_for_each(|entry| std::fs::remove_file(entry.path()))
}

/// A temporary file in the folder of `path`, with the permissions that a plain new file would get.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(IN_THE_MAKING);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_failed_write_leaves_the_old_content_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_whole(&path, |file| file.write_all(b"old")).unwrap();
        let error = write_whole(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(error.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_opened_by_its_path_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_whole_by_path(&path, |temporary| fs::write(temporary, b"old")).unwrap();
        let error = write_whole_by_path(&path, |temporary| {
            fs::write(temporary, b"half of the new")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        assert_eq!(error.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = WholeFile::create(&folder.path().join("a.txt")).unwrap();
        file.write_all(b"half").unwrap();
        drop(file);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_a_killed_program_left_is_cleared() {
        let folder = tempfile::tempdir().unwrap();
        write_whole(&folder.path().join("a.txt"), |file| file.write_all(b"whole")).unwrap();
        let mut file = WholeFile::create(&folder.path().join("b.txt")).unwrap();
        file.write_all(b"half").unwrap();
        // As a kill leaves it: never dropped.
        std::mem::forget(file);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        clear_unfinished(folder.path()).unwrap();
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["a.txt"]);
        clear_unfinished(&folder.path().join("none")).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn files_are_readable_by_whom_the_umask_allows() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [plain, whole] = ["plain", "whole"].map(|name| folder.path().join(name));
        fs::write(&plain, b"x").unwrap();
        write_whole(&whole, |file| file.write_all(b"x")).unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&plain), mode(&whole));
    }
}
