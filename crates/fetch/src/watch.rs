//! Looking on while terrain is fetched, and stopping it.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How far fetching has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Files of one degree by one degree that are done.
    pub tiles: usize,
    /// All of them.
    pub of_tiles: usize,
    /// Bytes that came over the network.
    pub bytes: u64,
}

/// Who looks on, and may stop it.
#[derive(Clone)]
pub struct Watch {
    /// Fetching ends soon after this has become true.
    pub stop: Arc<AtomicBool>,
    /// Is told how far it has come.
    pub show: Arc<dyn Fn(Progress) + Send + Sync>,
}

impl Watch {
    /// Nobody looks on.
    pub fn none() -> Self {
        Self { stop: Arc::new(AtomicBool::new(false)), show: Arc::new(|_| {}) }
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch").field("stop", &self.stop).finish_non_exhaustive()
    }
}
