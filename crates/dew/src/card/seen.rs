//! Air as it is seen, for whoever draws it on the same device.

use super::Card;
use super::shared::Memory;
use super::tasks::with_types;
use corpuscle_gpu::{Buffers, DeviceParticles, GpuError, Kernel, THREADS, Task, submit, uniform, wgpu};

/// Air as it is seen, and what writes it.
#[derive(Debug)]
pub(super) struct Seen {
    air: DeviceParticles,
    task: Task,
    shown: wgpu::Buffer,
}

impl Seen {
    fn new(card: &Card, spacing: f64) -> Result<Self, GpuError> {
        let gpu = card.batches.gpu();
        let air = DeviceParticles::new(gpu, card.room, card.origin.middle(), spacing)?;
        let shown = uniform(gpu, "time shown", &[0.0_f32; 4]);
        let types = Memory::declaration().types();
        let library = with_types(&types);
        let kernel = Kernel::new(gpu, "dew_seen", include_str!("dew_seen.wgsl"), &library);
        let Memory { parameters, status, particles, .. } = &card.tasks.memory;
        let buffers = [parameters, status, particles, &shown, &air.buffer];
        let task = kernel.on(gpu, &buffers.map(wgpu::Buffer::as_entire_binding));
        Ok(Self { air, task, shown })
    }
}

impl Card {
    /// The air as it is seen so long after the last step, s, on the device.
    pub fn seen(&self, spacing: f64, since: f64) -> Result<DeviceParticles, GpuError> {
        if self.seen.get().is_none() {
            // Nobody else can have been faster and done otherwise.
            let _ = self.seen.set(Seen::new(self, spacing)?);
        }
        let gpu = self.batches.gpu();
        let Seen { air, task, shown } = self.seen.get().expect("it was set above");
        gpu.queue.write_buffer(shown, 0, bytemuck::bytes_of(&(since as f32)));
        let groups = (air.room as u32).div_ceil(THREADS);
        submit(gpu, "seen", None, |pass| task.run(pass, groups));
        Ok(air.clone())
    }
}
