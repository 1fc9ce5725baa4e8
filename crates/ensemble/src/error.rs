//! Errors of an ensemble.

use std::io;
use std::path::{Path, PathBuf};

/// An error of an ensemble: of its plan, its folder or its results. An error of a member is part of its record instead.
#[derive(Debug, thiserror::Error)]
pub enum EnsembleError {
    /// The plan cannot be used.
    #[error("{}: {what}", location(path, *line))]
    Plan {
        /// The file.
        path: PathBuf,
        /// Its line, counted from 1, where it is known.
        line: Option<usize>,
        /// What is wrong, and what to do.
        what: String,
    },
    /// The folder holds something else, or is damaged.
    #[error("{0}")]
    Folder(String),
    /// A file cannot be read or written.
    #[error("cannot access {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The scene cannot be opened, or results cannot be written.
    #[error(transparent)]
    Scene(#[from] corpuscle::Error),
}

impl EnsembleError {
    /// True for an error of the input; false where the system failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Plan { .. } | Self::Folder(_) => true,
            Self::File { .. } => false,
            Self::Scene(error) => error.is_refusal(),
        }
    }

    pub(crate) fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::File { path: path.to_owned(), source }
    }

    pub(crate) fn plan(path: &Path, what: impl Into<String>) -> Self {
        Self::Plan { path: path.to_owned(), line: None, what: what.into() }
    }

    /// A member's file that cannot be used.
    pub(crate) fn damaged(path: &Path, what: impl std::fmt::Display) -> Self {
        let folder = path.parent().unwrap_or(path).display();
        Self::Folder(format!(
            "{} cannot be used: {what}; remove {folder} and run the plan again, which computes this member anew",
            path.display()
        ))
    }
}

impl From<corpuscle::output::OutputError> for EnsembleError {
    fn from(error: corpuscle::output::OutputError) -> Self {
        Self::Scene(error.into())
    }
}

fn location(path: &Path, line: Option<usize>) -> String {
    let path = path.display();
    line.map_or_else(|| path.to_string(), |line| format!("{path}:{line}"))
}
