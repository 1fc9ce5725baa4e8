//! The GPU device for pictures that take long.

use corpuscle::gpu::{Gpu, GpuError, GpuKind};
use std::sync::{Arc, Mutex, PoisonError};

/// Niceness added to its threads, of 19 steps.
#[cfg(target_os = "linux")]
const ADDED_NICENESS: i32 = 10;

/// The GPU device for pictures that take long: a GPU draws them between two pictures of the window; software in place of one has a
/// single queue, in which the window would wait for them, so that there is a second device then. It is opened when it is first needed.
#[derive(Clone)]
pub struct BackgroundDevice {
    /// The window's; none where there is none that draws.
    window: Option<Gpu>,
    second: Arc<Mutex<Option<Gpu>>>,
}

impl BackgroundDevice {
    /// The background device that goes with a window's device.
    pub fn beside(window: Option<&Gpu>) -> Self {
        Self { window: window.cloned(), second: Arc::default() }
    }

    /// The device; waits until it is open.
    ///
    /// # Errors
    /// [`GpuError::NoDevice`] where the window has none; those of [`Gpu::open`].
    pub fn gpu(&self) -> Result<Gpu, GpuError> {
        let window = self.window.as_ref().ok_or(GpuError::NoDevice)?;
        // A browser opens none while a program runs.
        if window.kind == GpuKind::Hardware || cfg!(target_arch = "wasm32") {
            return Ok(window.clone());
        }
        let mut second = self.second.lock().unwrap_or_else(PoisonError::into_inner);
        if second.is_none() {
            *second = Some(open()?);
        }
        Ok(second.clone().expect("it was opened above"))
    }
}

/// Opens a second device whose threads have a lower priority than the window's.
fn open() -> Result<Gpu, GpuError> {
    // A device's threads inherit the priority of the thread that opens it: one that does nothing else.
    let opened = std::thread::spawn(|| {
        lower_priority();
        Gpu::open()
    });
    opened.join().unwrap_or(Err(GpuError::NoDevice))
}

/// Lowers the priority of this thread and of those that it starts. Other systems than Linux have no such call for a single thread, or none that
/// is safe.
fn lower_priority() {
    // Where the system refuses, pictures of the window come a little later.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::nice(ADDED_NICENESS);
}
