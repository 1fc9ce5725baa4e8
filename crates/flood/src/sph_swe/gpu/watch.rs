//! A flood drawn where it lies: its particles as buffers of the GPU that takes the steps.

use super::measured::Onlookers;
use crate::sph_swe::SphSweFlood;
use corpuscle_gpu::GpuError;
use corpuscle_model::{Frame, Glance};

/// Who looks at the particles on the GPU.
pub(crate) struct Watch<'a> {
    /// When it wants to see them, s: at the end of the next step if that has passed.
    pub wanted: f64,
    /// Is called with the time, s, and the particles; returns when it wants to see them next, s.
    pub show: &'a mut dyn FnMut(Glance) -> f64,
}

impl SphSweFlood {
    /// Shows the particles, as the GPU has them after a step that ended at `now`, to who wants to see them before `before`, s.
    pub(super) fn show_to(&self, onlookers: &mut Onlookers<'_>, now: f64, before: f64) -> Result<(), GpuError> {
        let (Some(on_gpu), Some(watch)) = (&self.on_gpu, &mut onlookers.watch) else { return Ok(()) };
        let mut is_first = true;
        while watch.wanted < before && (watch.wanted > now || is_first) {
            let at = watch.wanted.max(now);
            let particles = on_gpu.seen(at - now, self.spacing_shown(), self.spacing)?;
            let next = (watch.show)(Glance { frame: Frame { time: at, sets: Vec::new() }, on_device: Some(particles) });
            watch.wanted = if next > at { next } else { f64::NEG_INFINITY };
            is_first = false;
        }
        Ok(())
    }
}
