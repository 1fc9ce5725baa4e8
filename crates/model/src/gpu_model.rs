//! Models that take their steps on a GPU.

use crate::{AdvanceObserver, Frame, ModelError};
use corpuscle_gpu::{DeviceParticles, Gpu, PassTiming};
use std::pin::Pin;
use std::sync::atomic::AtomicBool;

/// What is shown of a model that steps on the device that draws, while it advances.
#[derive(Debug, Clone)]
pub struct Glance {
    /// The time, s, and what of it the host has without asking the device: drops of dew.
    pub frame: Frame,
    /// The particles that pictures show, in buffers of the device; they change with the next step. None where pictures show but drops.
    pub on_device: Option<DeviceParticles>,
}

/// An advance that awaits what it reads back from the GPU.
pub type Advance<'a> = Pin<Box<dyn Future<Output = Result<(), ModelError>> + 'a>>;

/// A model that can take its steps on a GPU, in single precision.
pub trait GpuModel {
    /// Lets a GPU take the steps from here on.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where the GPU has too little memory, or the scene has what only the CPU computes: nothing has changed then.
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError>;

    /// The GPU that takes the steps, where one does.
    fn gpu(&self) -> Option<Gpu>;

    /// The particles that [`Model::frame`](crate::Model::frame) gives (a flood's water, at the height of its surface; dew's air), as buffers of
    /// the GPU that takes the steps, without a copy to the host. They hold until the model advances. None where no GPU takes the steps.
    ///
    /// # Errors
    /// [`ModelError::Device`] where the GPU has too little memory for them.
    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError>;

    /// Advances to `time`, s, as [`Model::advance_with`](crate::Model::advance_with) does, and calls `show` from the first of the times `shown`,
    /// s, on; `show` returns the time of its next call, s (a past time stands for the end of the next step). Where the second of
    /// `shown` is true, the particles that the host does not have are shown too. Nothing of them comes back to the host before the end. On the CPU `show` is never
    /// called.
    ///
    /// # Errors
    /// Those of [`Model::advance_to`](crate::Model::advance_to), and [`ModelError::Device`] where the GPU has too little memory.
    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        shown: (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError>;

    /// Advances as [`Model::advance_to`](crate::Model::advance_to) does, for a browser, where no thread may wait for the GPU: what is read back is
    /// awaited. To be awaited to its end.
    ///
    /// # Errors
    /// Those of [`Model::advance_to`](crate::Model::advance_to).
    fn advance_later<'a>(&'a mut self, time: f64, stop: &'a AtomicBool) -> Advance<'a>;

    /// Wall-clock time that the GPU has spent on steps, s; none where no GPU takes them.
    fn gpu_seconds(&self) -> Option<f64>;

    /// Memory held on the GPU, bytes; none where no GPU takes the steps.
    fn gpu_bytes(&self) -> Option<u64>;

    /// Times each pass on the GPU from now on, which makes passes wait for one another. Nothing changes where the GPU has no clock.
    fn time_passes(&mut self);

    /// What each pass has taken since [`GpuModel::time_passes`].
    fn pass_times(&self) -> Vec<(&'static str, PassTiming)>;
}
