//! Long work that Python waits for: the lock of the interpreter is released, Ctrl-C stops it, and progress is reported.

use crate::error::panicked;
use corpuscle::Progress;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Thread};
use std::time::Duration;

/// Longest time between two checks for Ctrl-C.
const CHECKED_EVERY: Duration = Duration::from_millis(50);

/// What the working thread passes to the waiting one.
struct Shared {
    progress: Mutex<Option<Progress>>,
    has_ended: AtomicBool,
    waiting: Thread,
}

impl Shared {
    fn take(&self) -> Option<Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Wakes the waiting thread when the work ends, also by a panic.
struct End<'a>(&'a Shared);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.has_ended.store(true, Ordering::Release);
        self.0.waiting.unpark();
    }
}

/// Does `work` in a thread of its own, without the lock of the interpreter, and waits for it. Meanwhile `on_progress` is called with
/// (time, end, particles, rate, seconds left) of the newest progress; Ctrl-C, or an exception of `on_progress`, sets `stop`.
///
/// # Errors
/// The exception that set `stop`, after the work has ended.
pub fn watched<T: Send>(
    py: Python<'_>,
    stop: &AtomicBool,
    on_progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&mut (dyn FnMut(&Progress) + Send)) -> T + Send,
) -> PyResult<T> {
    let shared = Shared { progress: Mutex::new(None), has_ended: AtomicBool::new(false), waiting: thread::current() };
    thread::scope(|scope| {
        let working = scope.spawn(|| {
            let _end = End(&shared);
            work(&mut |progress| {
                *shared.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(*progress);
            })
        });
        let mut raised = None;
        loop {
            py.detach(|| thread::park_timeout(CHECKED_EVERY));
            // Read before the progress, so that the last one is reported.
            let has_ended = shared.has_ended.load(Ordering::Acquire);
            if let Err(error) = py.check_signals().and_then(|()| report(on_progress, shared.take())) {
                stop.store(true, Ordering::Relaxed);
                raised.get_or_insert(error);
            }
            if has_ended {
                break;
            }
        }
        let done = py.detach(|| working.join()).map_err(|cause| panicked(&*cause))?;
        match raised {
            Some(error) => Err(error),
            None => Ok(done),
        }
    })
}

fn report(on_progress: Option<&Bound<'_, PyAny>>, progress: Option<Progress>) -> PyResult<()> {
    if let (Some(call), Some(progress)) = (on_progress, progress) {
        let Progress { time, until, particles, particle_steps_per_s, left_s, .. } = progress;
        call.call1((time, until, particles, particle_steps_per_s, left_s))?;
    }
    Ok(())
}
