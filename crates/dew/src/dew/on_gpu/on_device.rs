//! Frames of humid air whose particles stay in buffers of the GPU that takes the steps.

use super::Dew;
use crate::wetting::Wetting;
use corpuscle_gpu::GpuError;
use corpuscle_model::{Frame, Glance};

/// A request for frames: of the drops, and of the air on the GPU.
pub(crate) struct FrameRequest<'a> {
    /// Time of the next frame, s.
    pub wanted: f64,
    /// Whether the air is drawn, or only what the host has.
    pub sees_air: bool,
    /// Called with the drops and, where it is drawn, the air on the GPU; returns the time of the next frame, s.
    pub show: &'a mut dyn FnMut(Glance) -> f64,
}

impl Dew {
    /// Shows the state now, where a frame is due.
    pub(super) fn show_to(&self, frame_request: &mut Option<FrameRequest<'_>>) -> Result<(), GpuError> {
        let Some(frame_request) = frame_request.as_mut().filter(|frame_request| frame_request.wanted <= self.shown)
        else {
            return Ok(());
        };
        let drops = self.wetting.iter().flat_map(Wetting::sets);
        let solver = self.gpu_solver.as_ref().filter(|_| frame_request.sees_air);
        let air = solver.map(|solver| solver.seen(self.scale().spacing, self.since())).transpose()?;
        let frame = Frame { time: self.shown, sets: drops.collect() };
        let next = (frame_request.show)(Glance { frame, on_device: air });
        frame_request.wanted = next.max(self.shown + self.state.time_step);
        Ok(())
    }
}
