//! Errors of downloading terrain.

use crate::source::{BASE_VARIABLE, CACHE_VARIABLE};
use corpuscle_terrain::TerrainError;
use std::path::{Path, PathBuf};

/// An error of downloading terrain. The text says what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FetchError {
    /// The box is invalid or too large.
    #[error("the box cannot be downloaded: {0}")]
    Box(String),
    /// The server was not reached, or the connection failed, at every attempt.
    #[error(
        "{url} could not be downloaded in {attempts} attempts: {what}; check the network and try again: the cache keeps what \
         was downloaded, and the download resumes from there"
    )]
    Network {
        /// The address requested.
        url: String,
        /// Number of attempts.
        attempts: u32,
        /// The error of the last attempt.
        what: String,
    },
    /// The server refused the request.
    #[error("{url} was refused: the server returned HTTP status {status}; check the base address ({BASE_VARIABLE})")]
    Refused {
        /// The address requested.
        url: String,
        /// HTTP status.
        status: u16,
    },
    /// The base address is no copy of the bucket.
    #[error(
        "{base} is not a copy of Copernicus GLO-30: it has neither the file {tile}/{tile}.tif nor a tileList.txt with \
         names of such files; check the base address ({BASE_VARIABLE})"
    )]
    WrongBase {
        /// Base address.
        base: String,
        /// Name of a tile.
        tile: String,
    },
    /// The list names a file that does not exist.
    #[error(
        "{base} lists the tile {tile} but does not have it; the copy is not complete, use another ({BASE_VARIABLE})"
    )]
    Incomplete {
        /// Base address.
        base: String,
        /// Name of the tile.
        tile: String,
    },
    /// The file is no such tile.
    #[error("{url} is not a tile of Copernicus GLO-30: {what}; check the base address ({BASE_VARIABLE})")]
    NoTile {
        /// The address requested.
        url: String,
        /// The reason.
        what: String,
    },
    /// The file changed on the server while it was read.
    #[error("{url} changed on the server while it was read; try again")]
    Changed {
        /// The address requested.
        url: String,
    },
    /// All of the box is sea.
    #[error(
        "there is no land in the box: none of its tiles ({tiles}) exists; check it, the order is west,south,east,north in \
         degrees"
    )]
    NoLand {
        /// Names of tiles.
        tiles: String,
    },
    /// The cache cannot be written.
    #[error(
        "the cache file {path} cannot be written: {what}; name another folder with {CACHE_VARIABLE}, or free some space"
    )]
    Cache {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        what: String,
    },
    /// No folder is known for the cache.
    #[error("there is no home folder for the cache; name a folder with {CACHE_VARIABLE}")]
    NoCacheFolder,
    /// The download was interrupted.
    #[error("the download was interrupted; the cache keeps what was downloaded, and the download resumes from there")]
    Stopped,
    /// The tiles cannot be joined.
    #[error("the tiles cannot be joined: {0}")]
    Join(String),
}

impl FetchError {
    /// True for an error of the input; false where an accepted download failed.
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::Box(_) | Self::WrongBase { .. } | Self::NoTile { .. } | Self::NoLand { .. })
    }

    pub(crate) fn cache(path: &Path, what: impl ToString) -> Self {
        Self::Cache { path: path.into(), what: what.to_string() }
    }

    pub(crate) fn no_tile(url: &str, what: impl ToString) -> Self {
        Self::NoTile { url: url.into(), what: what.to_string() }
    }
}

impl From<TerrainError> for FetchError {
    fn from(error: TerrainError) -> Self {
        Self::Join(error.to_string())
    }
}
