//! Errors of a run's folder.

use corpuscle_terrain::TerrainError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a run's folder cannot be written or read. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A file or folder cannot be written.
    #[error("cannot write {}: {source}; {}; what was written before is whole and stays readable", path.display(), advice(source))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}; check the path and that it may be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The folder holds something already.
    #[error(
        "{} holds files already and a run is never overwritten; name another folder with `-o`, or continue a run that \
         was interrupted with `--resume {}`",
        path.display(), path.display()
    )]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds no checkpoint.
    #[error(
        "{} holds no checkpoint, so there is nothing to continue from; run its scene.toml again into a new folder",
        path.display()
    )]
    NoCheckpoint {
        /// The folder.
        path: PathBuf,
    },
    /// The run wrote no particle files.
    #[error("{} holds no particle files; run its scene.toml again with `--frames vtp`", path.display())]
    NoFrames {
        /// The folder of the run.
        path: PathBuf,
    },
    /// The run wrote no maps.
    #[error("{} holds no maps; floods write them, a depth map at each frame and the others at the end of the run", path.display())]
    NoMaps {
        /// The folder of the run.
        path: PathBuf,
    },
    /// The checkpoint is damaged or belongs to something else.
    #[error("the checkpoint {} cannot be used: {what}; run the folder's scene.toml again into a new folder", path.display())]
    Checkpoint {
        /// The checkpoint file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// A file has wrong content.
    #[error("{} cannot be understood: {what}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, where, and what would be right.
        what: String,
    },
    /// A value that was to be written is not finite.
    #[error(
        "{what}: it is not written, and the run ends; what was written before stays readable. Look in the last frame at what is \
         there; smaller particles or a smaller time step may help"
    )]
    NotFinite {
        /// The quantity, where it is, and its value.
        what: String,
    },
    /// A map cannot be written.
    #[error(transparent)]
    Map(#[from] TerrainError),
    /// A row of gauge values does not fit the header.
    #[error(
        "a gauge row has {found} values where the header of gauges.csv names {expected}; this is a fault of the model"
    )]
    GaugeCount {
        /// Columns in the header, without the time.
        expected: usize,
        /// Values given.
        found: usize,
    },
}

impl OutputError {
    /// Makes an [`io::Error`] met while writing `path` into an error that names it.
    pub(crate) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Write { path: path.to_owned(), source }
    }

    /// Makes an [`io::Error`] met while reading `path` into an error that names it.
    pub(crate) fn read(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Read { path: path.to_owned(), source }
    }

    /// An error for content of `path` that cannot be understood.
    pub(crate) fn content(path: &Path, what: impl ToString) -> Self {
        Self::Content { path: path.to_owned(), what: what.to_string() }
    }
}

/// Advice for a failed write.
fn advice(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space there",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that may be written to with `-o`"
        }
        _ => "check that the folder exists and may be written to",
    }
}
