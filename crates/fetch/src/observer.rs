//! Progress and cancellation of a download of terrain.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Progress of a download.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Files of one degree by one degree that are done.
    pub tiles: usize,
    /// All of them.
    pub of_tiles: usize,
    /// Bytes downloaded.
    pub bytes: u64,
}

/// The observer of a download: receives the progress, and may stop it.
#[derive(Clone)]
pub struct FetchObserver {
    /// The download ends soon after this has become true.
    pub stop: Arc<AtomicBool>,
    /// Receives the progress.
    pub show: Arc<dyn Fn(Progress) + Send + Sync>,
}

impl FetchObserver {
    /// An observer that does nothing.
    pub fn none() -> Self {
        Self { stop: Arc::new(AtomicBool::new(false)), show: Arc::new(|_| {}) }
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl fmt::Debug for FetchObserver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FetchObserver").field("stop", &self.stop).finish_non_exhaustive()
    }
}
