//! Writing of films (video files) from pictures.
//!
//! ```
//! use corpuscle_video::{Film, Format};
//! # let folder = tempfile::tempdir().unwrap();
//! # let path = folder.path().join("film.gif");
//! let mut film = Film::create(&path, Format::of(&path), [32, 16], 25.0)?;
//! for shade in 0..50 {
//!     film.add(&[shade, 0, 0, 255].repeat(32 * 16))?;
//! }
//! film.finish()?; // two seconds
//! # Ok::<(), corpuscle_video::FilmError>(())
//! ```

mod error;
mod gif;
#[cfg(feature = "h264")]
mod mp4;
mod sequence;

pub use error::FilmError;

use std::path::{Path, PathBuf};

/// Format of a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// One file, H.264 in MP4: up to 3840 x 2160. A side of odd length gets its last row or column twice, since the
    /// codec's colours come in squares of two.
    Mp4,
    /// One file, an endless loop of 256 colours a picture, in whole hundredths of a second.
    Gif,
    /// A folder of files `000000.png`, `000001.png`, ..., lossless; the rate is not stored.
    Png,
}

impl Format {
    /// The format that a path's ending asks for: `.mp4`, `.gif`, else a folder of PNG files.
    pub fn of(path: &Path) -> Self {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("mp4") => Self::Mp4,
            Some("gif") => Self::Gif,
            _ => Self::Png,
        }
    }
}

/// A film being written. It appears at its path when it is finished; dropped before, it leaves nothing behind.
pub struct Film {
    path: PathBuf,
    size: [u32; 2],
    pictures: usize,
    writer: Box<dyn Writer>,
}

/// The writer of a format; the size of pictures has been checked.
trait Writer: Send {
    fn add(&mut self, rgba: &[u8]) -> Result<(), FilmError>;
    fn finish(self: Box<Self>) -> Result<(), FilmError>;
}

impl Film {
    /// Begins a film of pictures of `size` (width, height) in pixels, `rate` pictures a second.
    ///
    /// # Errors
    /// [`FilmError::Size`] and [`FilmError::Rate`] where the format cannot hold them, [`FilmError::Exists`] where a
    /// folder for PNG files holds something, [`FilmError::Write`] where nothing can be written, and
    /// [`FilmError::NoH264`] for an MP4 without the feature `h264`.
    pub fn create(path: &Path, format: Format, size: [u32; 2], rate: f64) -> Result<Self, FilmError> {
        let writer: Box<dyn Writer> = match format {
            #[cfg(feature = "h264")]
            Format::Mp4 => Box::new(mp4::Mp4::create(path, size, rate)?),
            #[cfg(not(feature = "h264"))]
            Format::Mp4 => return Err(FilmError::NoH264),
            Format::Gif => Box::new(gif::Gif::create(path, size, rate)?),
            Format::Png => Box::new(sequence::Sequence::create(path, size)?),
        };
        Ok(Self { path: path.into(), size, pictures: 0, writer })
    }

    /// Adds the next picture: four bytes a pixel (red, green, blue, alpha), row by row from the top. Only PNG files
    /// keep the alpha; elsewhere every pixel is opaque.
    ///
    /// # Errors
    /// [`FilmError::Picture`] where the number of bytes is not that of the film's size; else what the codec or the disk
    /// says.
    pub fn add(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let [width, height] = self.size;
        let expected = width as usize * height as usize * 4;
        if rgba.len() != expected {
            return Err(FilmError::Picture { number: self.pictures, width, height, expected, found: rgba.len() });
        }
        self.writer.add(rgba)?;
        self.pictures += 1;
        Ok(())
    }

    /// Pictures so far.
    pub fn pictures(&self) -> usize {
        self.pictures
    }

    /// Moves the finished film to its path. An existing file there is replaced.
    ///
    /// # Errors
    /// [`FilmError::Empty`] without a picture; [`FilmError::Write`] where it cannot be written. Nothing changes at
    /// the path then.
    pub fn finish(self) -> Result<(), FilmError> {
        if self.pictures == 0 {
            return Err(FilmError::Empty { path: self.path });
        }
        self.writer.finish()
    }
}

/// Refuses a rate that is not positive or above `most` pictures per second.
fn check_rate(rate: f64, most: f64) -> Result<(), FilmError> {
    let sound = rate >= 0.1 && rate <= most;
    if sound { Ok(()) } else { Err(FilmError::Rate { rate, most }) }
}

/// Refuses a picture without pixels and sides longer than `longest`, the longer side first.
fn check_size([width, height]: [u32; 2], shortest: u32, longest: [u32; 2]) -> Result<(), FilmError> {
    let sound = width.min(height) >= shortest && width.max(height) <= longest[0] && width.min(height) <= longest[1];
    if sound { Ok(()) } else { Err(FilmError::Size { width, height, shortest, longest }) }
}
