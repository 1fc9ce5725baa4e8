//! Ctrl-C.

use anyhow::Context;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that becomes true on Ctrl-C, so that the command ends in order. A second Ctrl-C ends it at once.
pub fn stop_on_interrupt() -> anyhow::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let handler_stop = stop.clone();
    ctrlc::set_handler(move || {
        if handler_stop.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    })
    .context("cannot install the handler of Ctrl-C")?;
    Ok(stop)
}
