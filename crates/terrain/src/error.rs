//! What can go wrong with terrain.

use std::path::{Path, PathBuf};

/// Why ground cannot be had, or a raster not be read or written. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum TerrainError {
    /// The file cannot be opened or read.
    #[error("the raster {path} cannot be read: {source}; check the path and that you may read it")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is no GeoTIFF and no ESRI ASCII grid.
    #[error(
        "{path} is not a raster that can be read: {what}; give a GeoTIFF (.tif) or an ESRI ASCII grid (.asc, also \
         .asc.gz), or convert it with `gdal_translate`"
    )]
    WrongType {
        /// The file.
        path: PathBuf,
        /// What it is instead.
        what: String,
    },
    /// The file is a raster, but broken.
    #[error("the raster {path} is damaged or cut off: {what}; copy or download it again")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        what: String,
    },
    /// The file is a sound raster that cannot serve.
    #[error("the raster {path} cannot be used: {what}")]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Why, and what to do.
        what: String,
    },
    /// A reference system that is not understood.
    #[error(
        "crs = \"{crs}\" in [terrain.file] is not a reference system: {what}; write an EPSG code as \"EPSG:27700\" or \
         a PROJ string as \"+proj=utm +zone=32 +datum=WGS84\""
    )]
    ReferenceSystem {
        /// What the scene says.
        crs: String,
        /// What is wrong with it.
        what: String,
    },
    /// A position on Earth is required, and the terrain has none.
    #[error(
        "the terrain has no known reference system, so longitude and latitude mean nothing on it; give places in the \
         terrain's own coordinates, or name the reference system of a terrain file with `crs` in [terrain.file]"
    )]
    NoReferenceSystem,
    /// A position that the reference system cannot express.
    #[error("the position {position:?} cannot be converted to or from longitude and latitude: {what}")]
    Position {
        /// The coordinates given.
        position: [f64; 2],
        /// Why.
        what: String,
    },
    /// A generated terrain's numbers make no ground.
    #[error("the terrain cannot be made: {0}")]
    Shape(String),
    /// The scene has terrain from a server, which must be fetched first.
    #[error(
        "the terrain of [terrain.fetch] comes over a network, which neither a page of a browser nor a program built \
         without feature `fetch` reads; fetch it with the program (`corpuscle terrain fetch`), and name the file in [terrain.file]"
    )]
    NotFetched,
    /// A raster cannot be written.
    #[error(
        "the raster {path} cannot be written: {what}; check the folder, its permissions and the space left on the disk"
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        what: String,
    },
}

impl TerrainError {
    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.into(), source }
    }

    pub(crate) fn wrong_type(path: &Path, what: impl Into<String>) -> Self {
        Self::WrongType { path: path.into(), what: what.into() }
    }

    pub(crate) fn damaged(path: &Path, what: impl Into<String>) -> Self {
        Self::Damaged { path: path.into(), what: what.into() }
    }

    pub(crate) fn unusable(path: &Path, what: impl Into<String>) -> Self {
        Self::Unusable { path: path.into(), what: what.into() }
    }

    pub(crate) fn write(path: &Path, source: impl std::fmt::Display) -> Self {
        Self::Write { path: path.into(), what: source.to_string() }
    }
}
