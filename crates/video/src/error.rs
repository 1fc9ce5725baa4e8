//! Errors of writing a film.

use std::io;
use std::path::{Path, PathBuf};

/// An error of writing a film. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The format holds no pictures of this size.
    #[error(
        "a film of {width} x {height} pixels cannot be written in this format, whose sides are {shortest} to {} pixels, the \
         shorter at most {}; choose another size",
        longest[0], longest[1]
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Fewest pixels of a side.
        shortest: u32,
        /// Most pixels of the longer and of the shorter side.
        longest: [u32; 2],
    },
    /// The format holds no film of this rate.
    #[error("{rate} pictures a second cannot be written in this format; choose 0.1 to {most}")]
    Rate {
        /// Pictures per second, as requested.
        rate: f64,
        /// The most that the format holds.
        most: f64,
    },
    /// A picture does not fit the film.
    #[error(
        "picture {number} has {found} bytes where the film's {width} x {height} pixels have {expected}; every picture of a \
         film has its size, at four bytes a pixel"
    )]
    Picture {
        /// The picture, counted from 0.
        number: usize,
        /// Pixels across in the film.
        width: u32,
        /// Pixels down in the film.
        height: u32,
        /// Bytes that it should have.
        expected: usize,
        /// Bytes that it has.
        found: usize,
    },
    /// No picture was added.
    #[error("the film {} has no picture, so it is not written; give it at least one", path.display())]
    Empty {
        /// Where the film should have been.
        path: PathBuf,
    },
    /// The folder for PNG files holds something.
    #[error("{} exists already and holds files; name another folder for the film's pictures, or empty it", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// The file or folder cannot be written.
    #[error("the film {} cannot be written: {source}; check the folder, its permissions and the space on its disk", path.display())]
    Write {
        /// The film.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The encoder failed.
    #[error("the film {} cannot be encoded: {what}; try another format (.gif, or a folder of PNG files)", path.display())]
    Encoder {
        /// The film.
        path: PathBuf,
        /// The error of the encoder.
        what: String,
    },
    /// Built without H.264.
    #[error(
        "this build writes no MP4, since it was made without the feature `h264`; write a .gif or a folder of PNG files, or \
         build with the feature"
    )]
    NoH264,
}

impl FilmError {
    /// An error of the system, about this path.
    pub(crate) fn write(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        move |source| Self::Write { path: path.into(), source }
    }

    /// An error of an encoder, about this path.
    #[cfg(feature = "h264")]
    pub(crate) fn encoder<E: std::fmt::Display>(path: &Path) -> impl Fn(E) -> Self + '_ {
        move |error| Self::Encoder { path: path.into(), what: error.to_string() }
    }
}
