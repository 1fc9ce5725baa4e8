//! The device of pictures that take long.

use corpuscle::gpu::{Gpu, GpuError, GpuKind};
use std::sync::{Arc, Mutex, PoisonError};

/// The device of pictures that take long: a card draws them between two pictures of the window; software that stands in for one has a
/// single queue, in which the window would wait for them, so that there is a second device then. It is opened when it is first needed.
#[derive(Clone)]
pub struct SlowDevice {
    window: Gpu,
    second: Arc<Mutex<Option<Gpu>>>,
}

impl SlowDevice {
    /// The one beside a window's device.
    pub fn beside(window: &Gpu) -> Self {
        Self { window: window.clone(), second: Arc::default() }
    }

    /// The device; waits until it is open.
    ///
    /// # Errors
    /// Those of [`Gpu::open`].
    pub fn gpu(&self) -> Result<Gpu, GpuError> {
        if self.window.kind == GpuKind::Card {
            return Ok(self.window.clone());
        }
        let mut second = self.second.lock().unwrap_or_else(PoisonError::into_inner);
        if second.is_none() {
            *second = Some(Gpu::open()?);
        }
        Ok(second.clone().expect("it was opened above"))
    }
}
