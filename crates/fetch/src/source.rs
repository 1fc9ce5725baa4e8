//! The source of terrain: server, cache and time limits.

use crate::FetchError;
use etcetera::{BaseStrategy, choose_base_strategy};
use std::path::PathBuf;
use std::time::Duration;

/// The public bucket, as its documentation names it (copernicus-dem-30m.s3.amazonaws.com/readme.html).
pub const BASE: &str = "https://copernicus-dem-30m.s3.amazonaws.com";

/// The environment variable that names another base address.
pub const BASE_VARIABLE: &str = "CORPUSCLE_GLO30";

/// The environment variable that names the folder of the cache.
pub const CACHE_VARIABLE: &str = "CORPUSCLE_CACHE";

/// The source of terrain: server, cache folder and time limits.
#[derive(Debug, Clone)]
pub struct Source {
    /// Address below which `NAME/NAME.tif` and `tileList.txt` lie.
    pub base: String,
    /// Folder of the cache.
    pub cache: PathBuf,
    /// Timeout for connecting, for the response, and between bytes.
    pub timeout: Duration,
    /// Most attempts of a request.
    pub attempts: u32,
    /// Pause before the second attempt; it doubles from one to the next.
    pub pause: Duration,
}

impl Source {
    /// A source with this address and cache folder, and default time limits.
    pub fn new(base: impl Into<String>, cache: impl Into<PathBuf>) -> Self {
        let base = base.into().trim_end_matches('/').to_owned();
        let (timeout, pause) = (Duration::from_secs(30), Duration::from_millis(500));
        Self { base, cache: cache.into(), timeout, attempts: 4, pause }
    }

    /// The public bucket, or the address in [`BASE_VARIABLE`]; the user's cache folder, or the one in
    /// [`CACHE_VARIABLE`].
    ///
    /// # Errors
    /// [`FetchError::NoCacheFolder`] where the user has no home.
    pub fn from_environment() -> Result<Self, FetchError> {
        let set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
        let base = set(BASE_VARIABLE).map_or_else(|| BASE.to_owned(), |base| base.to_string_lossy().into_owned());
        let cache = match set(CACHE_VARIABLE) {
            Some(folder) => PathBuf::from(folder),
            None => choose_base_strategy().map_err(|_| FetchError::NoCacheFolder)?.cache_dir().join("corpuscle"),
        };
        Ok(Self::new(base, cache))
    }
}
