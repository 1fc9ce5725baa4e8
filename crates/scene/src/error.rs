//! What can be wrong with a scene, said so that the reader can put it right.

use std::fmt;
use std::path::PathBuf;

/// Why a scene cannot be used. Each text names the file, line, key and value at fault, and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read the scene {}: {source}", path.display())]
    Unreadable {
        /// The requested file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Something in the scene is not as it must be.
    #[error("{0}")]
    Invalid(Box<Problem>),
    /// A time series in a CSV file cannot be used.
    #[error("{}{}: {what}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Series {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1, where one is at fault.
        line: Option<usize>,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// A path in the scene is not Unicode and so cannot be written in TOML.
    #[error("the scene cannot be written as TOML: {0}")]
    Unwritable(String),
}

impl SceneError {
    /// The problem in the scene's text, where it is one.
    pub fn problem(&self) -> Option<&Problem> {
        match self {
            Self::Invalid(problem) => Some(problem),
            _ => None,
        }
    }
}

/// What is wrong at one location of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The key at fault as a path, `flood.gauge.0.name`; rows of tables are counted from 0. Empty for the whole scene.
    pub key: String,
    /// What is wrong, and what would be right.
    pub what: String,
    /// Where it is written; none for a scene made in memory.
    pub location: Option<Location>,
}

impl Problem {
    pub(crate) fn new(key: impl Into<String>, what: impl Into<String>) -> Box<Self> {
        Box::new(Self { key: key.into(), what: what.into(), location: None })
    }
}

impl From<Box<Problem>> for SceneError {
    fn from(problem: Box<Problem>) -> Self {
        Self::Invalid(problem)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(location) = &self.location {
            write!(f, "{}: ", location.address())?;
        }
        if !self.key.is_empty() {
            write!(f, "{}", self.key)?;
        }
        write!(f, "{}", self.what)?;
        self.location.as_ref().map_or(Ok(()), |location| location.write_marked_line(f))
    }
}

/// A stretch of one line of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file's name, or the `--set` argument.
    pub source: String,
    /// Line, counted from 1; none for an argument and for a file as a whole.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: usize,
    /// Characters marked.
    pub width: usize,
    /// The line's text.
    pub text: String,
}

/// Longer lines are not shown: they would hide the message.
const LONGEST_SHOWN: usize = 160;

impl Location {
    pub(crate) fn address(&self) -> String {
        match self.line {
            Some(line) => format!("{}:{line}:{}", self.source, self.column),
            None => self.source.clone(),
        }
    }

    fn write_marked_line(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(line) = self.line else { return Ok(()) };
        let text = self.text.replace('\t', " ");
        if text.trim().is_empty() || text.chars().count() > LONGEST_SHOWN {
            return Ok(());
        }
        let number = line.to_string();
        let indent = " ".repeat(number.len());
        let before = " ".repeat(self.column - 1);
        write!(f, "\n  {number} | {text}\n  {indent} | {before}{}", "^".repeat(self.width.max(1)))
    }
}
