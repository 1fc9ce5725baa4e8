//! Particles as they are seen, for whoever draws them on the same device.

use super::OnGpu;
use super::shared::{Memory, Shown};
use super::tasks::{Shader, task};
use corpuscle_gpu::{DeviceParticles, GpuError, Seen};

pub(super) const SHADER: Shader = ("sph_seen", include_str!("sph_seen.wgsl"));

impl OnGpu {
    /// The particles as they are seen `since` s after the last step, `spacing` m apart, those in the air `drop_spacing` m, on the device.
    pub fn seen(&self, since: f64, spacing: f64, drop_spacing: f64) -> Result<DeviceParticles, GpuError> {
        let gpu = self.gpu();
        let make = || {
            let origin = [self.origin.centre[0], self.origin.centre[1], self.origin.level];
            let particles = DeviceParticles::new(gpu, self.room + self.room_in_air, origin, 0.0)?;
            let memory = Memory { drawn: particles.buffer.clone(), ..self.tasks.memory.clone() };
            Ok(Seen { task: task(gpu, SHADER, &memory), shown: memory.shown, particles })
        };
        let [since, of_particles, of_drops] = [since, spacing, drop_spacing].map(|value| value as f32);
        let shown = Shown { since, spacing: of_particles, drop_spacing: of_drops, unused: 0.0 };
        Ok(DeviceParticles { spacing, ..self.seen.write(gpu, &shown, make)? })
    }
}
