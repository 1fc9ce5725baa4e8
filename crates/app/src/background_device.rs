//! The device of pictures that take long.

use corpuscle::gpu::{Gpu, GpuError, GpuKind};
use std::sync::{Arc, Mutex, PoisonError};

/// How much less urgent its threads are than the window's, of 19 steps.
#[cfg(target_os = "linux")]
const LESS_URGENT: i32 = 10;

/// The device of pictures that take long: a GPU draws them between two pictures of the window; software that stands in for one has a
/// single queue, in which the window would wait for them, so that there is a second device then. It is opened when it is first needed.
#[derive(Clone)]
pub struct BackgroundDevice {
    window: Gpu,
    second: Arc<Mutex<Option<Gpu>>>,
}

impl BackgroundDevice {
    /// The one beside a window's device.
    pub fn beside(window: &Gpu) -> Self {
        Self { window: window.clone(), second: Arc::default() }
    }

    /// The device; waits until it is open.
    ///
    /// # Errors
    /// Those of [`Gpu::open`].
    pub fn gpu(&self) -> Result<Gpu, GpuError> {
        if self.window.kind == GpuKind::Hardware {
            return Ok(self.window.clone());
        }
        let mut second = self.second.lock().unwrap_or_else(PoisonError::into_inner);
        if second.is_none() {
            *second = Some(open()?);
        }
        Ok(second.clone().expect("it was opened above"))
    }
}

/// Opens a second device whose threads give way to the window's.
fn open() -> Result<Gpu, GpuError> {
    // A device's threads are as urgent as the thread that opens it: one that does nothing else.
    let opened = std::thread::spawn(|| {
        give_way();
        Gpu::open()
    });
    opened.join().unwrap_or(Err(GpuError::NoDevice))
}

/// Makes this thread, and those that it starts, less urgent. Other systems than Linux have no such call for a single thread, or none that
/// is safe.
fn give_way() {
    // Where the system refuses, pictures of the window come a little later.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::nice(LESS_URGENT);
}
