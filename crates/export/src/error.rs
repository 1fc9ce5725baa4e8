//! Errors of an export.

use corpuscle_output::OutputError;
use corpuscle_scene::SceneError;
use std::io;
use std::path::{Path, PathBuf};

/// Why results cannot be exported. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The ending of the file's name says no format.
    #[error(
        "{} has no ending that says a format; end its name with .nc (maps), .parquet (gauges), .vtkhdf or .xyz (particles)",
        path.display()
    )]
    Ending {
        /// The file that was to be written.
        path: PathBuf,
    },
    /// The folder holds no run.
    #[error("{} holds no run: it has no scene.toml; name the folder of a run, such as runs/valley-1", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// The run has no row of gauges.
    #[error("{} holds no gauges: its gauges.csv has no row yet; export it when the run has gone on", path.display())]
    NoGauges {
        /// The folder of the run.
        path: PathBuf,
    },
    /// The scene of the run cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A part of the run cannot be read, or is not there.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The file cannot be written.
    #[error(
        "cannot write {}: {source}; check that its folder exists, may be written to and has space left",
        path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system or the library of the format says.
        source: io::Error,
    },
}

impl ExportError {
    /// True for an error of the input; false where the file could not be written.
    pub fn is_refusal(&self) -> bool {
        !matches!(self, Self::Write { .. })
    }

    /// Makes an error of the system into one that names the file.
    pub(crate) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Write { path: path.to_owned(), source }
    }
}

/// An error while a file is written, before it is known which.
#[derive(Debug)]
pub(crate) enum Failed {
    /// A file of the run.
    Read(OutputError),
    /// The file to write.
    Write(io::Error),
}

impl Failed {
    /// The error with the name of the file to write.
    pub(crate) fn at(path: &Path) -> impl FnOnce(Self) -> ExportError {
        move |failed| match failed {
            Self::Read(error) => error.into(),
            Self::Write(source) => ExportError::write(path)(source),
        }
    }
}

impl From<OutputError> for Failed {
    fn from(error: OutputError) -> Self {
        Self::Read(error)
    }
}

impl From<io::Error> for Failed {
    fn from(error: io::Error) -> Self {
        Self::Write(error)
    }
}

impl From<rust_hdf5::Hdf5Error> for Failed {
    fn from(error: rust_hdf5::Hdf5Error) -> Self {
        Self::Write(match error {
            rust_hdf5::Hdf5Error::Io(error) => error,
            error => io::Error::other(error.to_string()),
        })
    }
}
