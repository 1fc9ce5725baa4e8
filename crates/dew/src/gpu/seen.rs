//! The air as particles for drawing on the same device.

use super::GpuSolver;
use super::shared::{Memory, Shown};
use super::tasks::PIECES;
use corpuscle_gpu::{DeviceParticles, GpuError, Kernel, THREADS, Task, submit};

/// Buffer of the air's particles for drawing, and the task that fills it.
#[derive(Debug)]
pub(super) struct Seen {
    air: DeviceParticles,
    task: Task,
}

impl Seen {
    fn new(solver: &GpuSolver, spacing: f64) -> Result<Self, GpuError> {
        let gpu = solver.batches.gpu();
        let air = DeviceParticles::new(gpu, solver.room, solver.origin.middle(), spacing)?;
        let memory = Memory { drawn: air.buffer.clone(), ..solver.tasks.memory.clone() };
        let kernel = Kernel::new(gpu, "dew_seen", include_str!("dew_seen.wgsl"), PIECES);
        Ok(Self { task: kernel.on(gpu, &memory), air })
    }
}

impl GpuSolver {
    /// The air's particles on the device, for drawing at a time, s, after the last step.
    pub fn seen(&self, spacing: f64, since: f64) -> Result<DeviceParticles, GpuError> {
        if self.seen.get().is_none() {
            // Another thread that was faster has set the same value.
            let _ = self.seen.set(Seen::new(self, spacing)?);
        }
        let gpu = self.batches.gpu();
        let Seen { air, task } = self.seen.get().expect("it was set above");
        let shown = Shown { since: since as f32, ..Shown::default() };
        gpu.queue.write_buffer(&self.tasks.memory.seen_at, 0, bytemuck::bytes_of(&shown));
        let groups = (air.room as u32).div_ceil(THREADS);
        submit(gpu, "seen", None, |pass| task.run(pass, groups));
        Ok(air.clone())
    }
}
