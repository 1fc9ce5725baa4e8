//! Download of a box of terrain from the server or the cache.

use crate::cache::{About, Cache};
use crate::client::{Answer, Client};
use crate::glo30::TileName;
use crate::observer::{FetchObserver, Progress};
use crate::remote::RemoteFile;
use crate::{ATTRIBUTION, FetchError, Source, tile};
use corpuscle_terrain::{MapBox, Raster, merge};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The list of all tiles, beside them.
const LIST: &str = "tileList.txt";

/// A box of terrain.
#[derive(Debug, Clone)]
pub struct Fetched {
    /// Its heights, in longitude and latitude on WGS 84; notes to the user, with the attribution, are in its
    /// warnings.
    pub raster: Raster,
    /// Names of its tiles.
    pub tiles: Vec<String>,
    /// Names of tiles that do not exist: sea, at height 0.
    pub sea: Vec<String>,
    /// Bytes downloaded; the rest was in the cache.
    pub bytes: u64,
    /// Files of the cache that were damaged, and were downloaded again.
    pub renewed: usize,
}

/// Fetches the heights in a box given by longitudes and latitudes, degrees.
///
/// # Errors
/// What could not be downloaded, and what to do. Pieces downloaded until then stay in the cache.
pub fn fetch(source: &Source, part: &MapBox, observer: &FetchObserver) -> Result<Fetched, FetchError> {
    let names = TileName::within(part).map_err(FetchError::Box)?;
    let mut fetching = Fetching::new(source, observer, names.len());
    let mut rasters = Vec::new();
    for name in names {
        rasters.extend(fetching.tile(name, part)?.map(|raster| (PathBuf::from(name.to_string()), raster)));
        fetching.done += 1;
        (fetching.observer.show)(fetching.progress());
    }
    fetching.joined(rasters, part)
}

/// A download in progress.
struct Fetching<'a> {
    source: &'a Source,
    observer: &'a FetchObserver,
    of_tiles: usize,
    done: usize,
    bytes: Arc<AtomicU64>,
    renewed: usize,
    tiles: Vec<String>,
    sea: Vec<String>,
    /// The server's list of tiles, downloaded when first needed.
    list: Option<String>,
}

impl<'a> Fetching<'a> {
    fn new(source: &'a Source, observer: &'a FetchObserver, of_tiles: usize) -> Self {
        Self {
            source,
            observer,
            of_tiles,
            done: 0,
            bytes: Arc::default(),
            renewed: 0,
            tiles: Vec::new(),
            sea: Vec::new(),
            list: None,
        }
    }

    fn progress(&self) -> Progress {
        Progress { tiles: self.done, of_tiles: self.of_tiles, bytes: self.bytes.load(Ordering::Relaxed) }
    }

    /// The heights of a tile in the part. A file that changed on the server is read again, once.
    fn tile(&mut self, name: TileName, part: &MapBox) -> Result<Option<Raster>, FetchError> {
        match self.try_tile(name, part) {
            Err(FetchError::Changed { .. }) => {
                self.cache(name).clear()?;
                self.try_tile(name, part)
            }
            result => result,
        }
    }

    fn try_tile(&mut self, name: TileName, part: &MapBox) -> Result<Option<Raster>, FetchError> {
        if self.observer.is_stopped() {
            return Err(FetchError::Stopped);
        }
        let url = format!("{}/{name}/{name}.tif", self.source.base);
        let (observer, bytes, progress) = (self.observer.clone(), self.bytes.clone(), self.progress());
        let came = move |count| {
            let bytes = bytes.fetch_add(count, Ordering::Relaxed) + count;
            (observer.show)(Progress { bytes, ..progress });
        };
        let client = Client::new(self.source, self.observer);
        let Some(file) = RemoteFile::open(&url, client, self.cache(name), came)? else { return self.sea(name, part) };
        let file = Arc::new(file);
        let raster = tile::read(name, &url, &file, part);
        self.renewed += file.cache().damaged();
        if matches!(&raster, Ok(Some(_))) {
            self.tiles.push(name.to_string());
        }
        raster
    }

    fn cache(&self, name: TileName) -> Cache {
        Cache::of(&self.source.cache, &self.source.base, &name.to_string())
    }

    /// Sea instead of a tile that the server does not have, after a check that the tile does not exist.
    fn sea(&mut self, name: TileName, part: &MapBox) -> Result<Option<Raster>, FetchError> {
        let cache = self.cache(name);
        if cache.about() != Some(About::Sea) {
            self.check_missing(name)?;
            cache.set_about(&About::Sea)?;
        }
        let sea = tile::sea(name, part);
        if sea.is_some() {
            self.sea.push(name.to_string());
        }
        Ok(sea)
    }

    /// Checks that a missing tile is not in the server's own list of tiles; an error where it is.
    fn check_missing(&mut self, name: TileName) -> Result<(), FetchError> {
        let (base, tile) = (self.source.base.clone(), name.to_string());
        if self.list.is_none() {
            let client = Client::new(self.source, self.observer);
            let list = match client.get(&format!("{base}/{LIST}"), None)? {
                Answer::Whole { bytes, .. } => String::from_utf8_lossy(&bytes).into_owned(),
                _ => String::new(),
            };
            self.list = Some(list);
        }
        let list = self.list.as_deref().unwrap_or_default();
        if !list.contains("Copernicus_DSM") {
            return Err(FetchError::WrongBase { base, tile });
        }
        if list.lines().any(|line| line.trim() == tile) {
            return Err(FetchError::Incomplete { base, tile });
        }
        Ok(())
    }

    fn joined(self, rasters: Vec<(PathBuf, Raster)>, part: &MapBox) -> Result<Fetched, FetchError> {
        if self.tiles.is_empty() {
            return Err(FetchError::NoLand { tiles: self.sea.join(", ") });
        }
        let mut raster = merge(rasters)?;
        raster = raster.cropped(part).ok_or_else(|| FetchError::Box("it is smaller than a cell".into()))?;
        if raster.columns < 2 || raster.rows < 2 {
            return Err(FetchError::Box(format!(
                "it has {} x {} cells of about 30 m; at least 2 x 2 are needed",
                raster.columns, raster.rows
            )));
        }
        raster.warnings.extend(self.warnings());
        let bytes = self.bytes.load(Ordering::Relaxed);
        Ok(Fetched { raster, tiles: self.tiles, sea: self.sea, bytes, renewed: self.renewed })
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.sea.is_empty() {
            warnings.push(format!(
                "Copernicus GLO-30 has no tile {}: taken for sea at height 0. (Of a few countries it has no public tiles \
                 either.)",
                self.sea.join(", ")
            ));
        }
        if self.renewed > 0 {
            warnings.push(format!("{} files of the cache were damaged and were downloaded again.", self.renewed));
        }
        warnings.push(ATTRIBUTION.into());
        warnings
    }
}
