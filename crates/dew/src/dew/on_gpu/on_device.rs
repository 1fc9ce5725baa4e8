//! Humid air drawn where it lies: the air as buffers of the GPU that takes the steps.

use super::Dew;
use crate::wetting::Wetting;
use corpuscle_gpu::GpuError;
use corpuscle_model::{Frame, Glance};

/// Who looks at the drops, and at the air on the GPU.
pub(crate) struct Watch<'a> {
    /// When it wants to see them, s.
    pub wanted: f64,
    /// Whether the air is seen, or only what the host has.
    pub sees_air: bool,
    /// Is called with the drops and, where it is seen, the air on the GPU; returns when it wants to see them next, s.
    pub show: &'a mut dyn FnMut(Glance) -> f64,
}

impl Dew {
    /// Shows how it stands now to who wants to see it by now.
    pub(super) fn show_to(&self, watch: &mut Option<Watch<'_>>) -> Result<(), GpuError> {
        let Some(watch) = watch.as_mut().filter(|watch| watch.wanted <= self.shown) else { return Ok(()) };
        let drops = self.wetting.as_ref().map(Wetting::set);
        let solver = self.gpu_solver.as_ref().filter(|_| watch.sees_air);
        let air = solver.map(|solver| solver.seen(self.scale().spacing, self.since())).transpose()?;
        let frame = Frame { time: self.shown, sets: drops.into_iter().collect() };
        let next = (watch.show)(Glance { frame, on_device: air });
        watch.wanted = next.max(self.shown + self.state.time_step);
        Ok(())
    }
}
