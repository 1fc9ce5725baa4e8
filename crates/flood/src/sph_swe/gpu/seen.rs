//! Particles as they are seen, for whoever draws them on the same device.

use super::OnGpu;
use super::shared::{Memory, Shown};
use super::tasks::{Shader, task};
use corpuscle_gpu::{DeviceParticles, GpuError, THREADS, Task, submit};

pub(super) const SHADER: Shader = ("sph_seen", include_str!("../sph_seen.wgsl"));

/// Particles as they are seen, and what writes them.
#[derive(Debug)]
pub(super) struct Seen {
    particles: DeviceParticles,
    task: Task,
}

impl Seen {
    fn new(on_gpu: &OnGpu) -> Result<Self, GpuError> {
        let gpu = on_gpu.gpu();
        let origin = [on_gpu.origin.centre[0], on_gpu.origin.centre[1], on_gpu.origin.level];
        let particles = DeviceParticles::new(gpu, on_gpu.room + on_gpu.room_in_air, origin, 0.0)?;
        let memory = Memory { drawn: particles.buffer.clone(), ..on_gpu.tasks.memory.clone() };
        Ok(Self { task: task(gpu, SHADER, &memory), particles })
    }
}

impl OnGpu {
    /// The particles as they are seen `since` s after the last step, `spacing` m apart, those in the air `drop_spacing` m, on the device.
    pub fn seen(&self, since: f64, spacing: f64, drop_spacing: f64) -> Result<DeviceParticles, GpuError> {
        if self.seen.get().is_none() {
            // Another thread that was faster has set the same value.
            let _ = self.seen.set(Seen::new(self)?);
        }
        let seen = self.seen.get().expect("it was set above");
        let [since, of_particles, of_drops] = [since, spacing, drop_spacing].map(|value| value as f32);
        let shown = Shown { since, spacing: of_particles, drop_spacing: of_drops, unused: 0.0 };
        self.gpu().queue.write_buffer(&self.tasks.memory.shown, 0, bytemuck::bytes_of(&shown));
        let groups = (seen.particles.room as u32).div_ceil(THREADS);
        submit(self.gpu(), "seen", None, |pass| seen.task.run(pass, groups));
        Ok(DeviceParticles { spacing, ..seen.particles.clone() })
    }
}
