//! A folder of numbered PNG files.

use crate::{FilmError, Writer, check_size};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Longest side that is accepted, pixels.
const LONGEST: u32 = 1 << 16;

/// The writer of PNG files: into a temporary folder, which is renamed at the end.
pub(crate) struct Sequence {
    path: PathBuf,
    size: [u32; 2],
    folder: TempDir,
    pictures: usize,
}

impl Sequence {
    pub(crate) fn create(path: &Path, size: [u32; 2]) -> Result<Self, FilmError> {
        check_size(size, 1, [LONGEST; 2])?;
        if holds_something(path) {
            return Err(FilmError::Exists { path: path.into() });
        }
        let folder = temporary_beside(path).map_err(FilmError::write(path))?;
        Ok(Self { path: path.into(), size, folder, pictures: 0 })
    }

    fn write(&self, rgba: &[u8]) -> io::Result<()> {
        let [width, height] = self.size;
        let mut file = BufWriter::new(File::create(self.folder.path().join(format!("{:06}.png", self.pictures)))?);
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(rgba)?;
        writer.finish()?;
        file.flush()
    }
}

impl Writer for Sequence {
    fn add(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        self.write(rgba).map_err(FilmError::write(&self.path))?;
        self.pictures += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), FilmError> {
        // An empty folder in the way is no loss, and not every system renames onto one.
        let made_way = if self.path.is_dir() { fs::remove_dir(&self.path) } else { Ok(()) };
        made_way.and_then(|()| fs::rename(self.folder.path(), &self.path)).map_err(FilmError::write(&self.path))
    }
}

fn holds_something(path: &Path) -> bool {
    path.exists() && fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some())
}

/// A temporary folder beside `path`, as readable as a plain new one.
fn temporary_beside(path: &Path) -> io::Result<TempDir> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".writing-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    builder.tempdir_in(parent)
}
