//! Ctrl-C.

use anyhow::Context;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Becomes true on Ctrl-C, and what is going on ends in order. A second one ends it at once.
pub fn stop_on_interrupt() -> anyhow::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let handler_stop = stop.clone();
    ctrlc::set_handler(move || {
        if handler_stop.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    })
    .context("cannot watch for Ctrl-C")?;
    Ok(stop)
}
