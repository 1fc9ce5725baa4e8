//! The air as particles for drawing on the same device.

use super::GpuSolver;
use super::tasks::PIECES;
use crate::shared::{Memory, Shown};
use corpuscle_gpu::{DeviceParticles, GpuError, Kernel, Seen};

impl GpuSolver {
    /// The air's particles on the device, for drawing at a time, s, after the last step.
    pub fn seen(&self, spacing: f64, since: f64) -> Result<DeviceParticles, GpuError> {
        let gpu = self.batches.gpu();
        let make = || {
            let particles = DeviceParticles::new(gpu, self.room, self.origin.middle(), spacing)?;
            let memory = Memory { drawn: particles.buffer.clone(), ..self.tasks.memory.clone() };
            let kernel = Kernel::new(gpu, "dew_seen", include_str!("dew_seen.wgsl"), PIECES);
            Ok(Seen { task: kernel.on(gpu, &memory), shown: memory.seen_at, particles })
        };
        self.seen.write(gpu, &Shown { since: since as f32, ..Shown::default() }, make)
    }
}
