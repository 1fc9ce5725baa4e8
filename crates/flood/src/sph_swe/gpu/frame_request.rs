//! Frames whose particles stay in buffers of the GPU that takes the steps.

use super::observers::Observers;
use crate::sph_swe::SphSweFlood;
use corpuscle_gpu::GpuError;
use corpuscle_model::{Frame, Glance};

/// A request for frames of the particles on the GPU.
pub(crate) struct FrameRequest<'a> {
    /// Time of the next frame, s: the end of the next step if that is past.
    pub wanted: f64,
    /// Called with the time, s, and the particles; returns the time of the next frame, s.
    pub show: &'a mut dyn FnMut(Glance) -> f64,
}

impl SphSweFlood {
    /// Shows the particles on the GPU after a step that ended at `now`, where a frame is due before `before`, s.
    pub(super) fn show_to(&self, observers: &mut Observers<'_>, now: f64, before: f64) -> Result<(), GpuError> {
        let (Some(on_gpu), Some(frame_request)) = (&self.on_gpu, &mut observers.frame_request) else { return Ok(()) };
        let mut is_first = true;
        while frame_request.wanted < before && (frame_request.wanted > now || is_first) {
            let at = frame_request.wanted.max(now);
            let particles = on_gpu.seen(at - now, self.spacing_shown(), self.spacing)?;
            let next = (frame_request.show)(Glance {
                frame: Frame { time: at, sets: Vec::new() },
                on_device: Some(particles),
            });
            frame_request.wanted = if next > at { next } else { f64::NEG_INFINITY };
            is_first = false;
        }
        Ok(())
    }
}
