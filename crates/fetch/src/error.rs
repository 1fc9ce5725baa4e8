//! What can go wrong while terrain is fetched.

use crate::source::{BASE_VARIABLE, CACHE_VARIABLE};
use corpuscle_terrain::TerrainError;
use std::path::{Path, PathBuf};

/// Why terrain cannot be had. The text says what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FetchError {
    /// The box is none, or too large.
    #[error("the box cannot be fetched: {0}")]
    Box(String),
    /// The server was not reached, or broke off, every time.
    #[error(
        "{url} was not to be had in {attempts} attempts: {what}; check the network and try again: what has come is kept \
         in the cache, and fetching goes on from there"
    )]
    Network {
        /// What was asked for.
        url: String,
        /// How often.
        attempts: u32,
        /// What happened the last time.
        what: String,
    },
    /// The server refuses.
    #[error(
        "{url} was refused: the server answers with HTTP status {status}; check the base address ({BASE_VARIABLE})"
    )]
    Refused {
        /// What was asked for.
        url: String,
        /// HTTP status.
        status: u16,
    },
    /// Nothing there looks like the bucket.
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
    /// The list names a file that is not there.
    #[error(
        "{base} lists the tile {tile} but does not have it; the copy is not complete, use another ({BASE_VARIABLE})"
    )]
    Incomplete {
        /// Base address.
        base: String,
        /// Name of the tile.
        tile: String,
    },
    /// What came is no such file.
    #[error("{url} is not a tile of Copernicus GLO-30: {what}; check the base address ({BASE_VARIABLE})")]
    NoTile {
        /// What was asked for.
        url: String,
        /// What it is instead.
        what: String,
    },
    /// The file on the server became another while it was read.
    #[error("{url} changed on the server while it was read; try again")]
    Changed {
        /// What was asked for.
        url: String,
    },
    /// There is nothing but sea.
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
    /// It was stopped.
    #[error("fetching was interrupted; what has come is kept in the cache, and fetching goes on from there")]
    Stopped,
    /// The tiles do not go together.
    #[error("the tiles cannot be joined: {0}")]
    Join(String),
}

impl FetchError {
    /// True where what was asked for cannot be had as it is; false where it came to grief on the way.
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
