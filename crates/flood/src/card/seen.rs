//! Particles as they are seen, for whoever draws them on the same device.

use super::Card;
use super::air::NO_AIR;
use super::tasks::LIBRARY;
use corpuscle_gpu::{
    DEVICE_PARTICLES, DeviceParticles, Gpu, GpuError, Kernel, Pass, THREADS, Task, storage, uniform, wgpu,
};

/// How particles are seen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// Time from the last step to the time shown, s.
    pub since: f64,
    /// Distance of particles where all are seen with the same, m.
    pub spacing: Option<f64>,
    /// Distance of those in the air, m.
    pub drop_spacing: f64,
    /// Distance of all on the whole, m.
    pub mean_spacing: f64,
}

/// Particles as they are seen, and what writes them.
#[derive(Debug)]
pub(super) struct Seen {
    particles: DeviceParticles,
    task: Task,
    shown: wgpu::Buffer,
}

impl Seen {
    fn new(card: &Card) -> Result<Self, GpuError> {
        let gpu = &card.gpu;
        let origin = [card.origin.centre[0], card.origin.centre[1], card.origin.level];
        let particles = DeviceParticles::new(gpu, card.room + card.room_in_air(), origin, 0.0)?;
        let shown = uniform(gpu, "time shown", &[0.0_f32; 4]);
        let no_air = storage::<u8>(gpu, "no water in the air", NO_AIR)?;
        let air = card.air.as_ref().map_or(&no_air, |air| &air.buffer);
        let library: Vec<_> = LIBRARY.iter().copied().chain([DEVICE_PARTICLES]).collect();
        let kernel = Kernel::new(gpu, "flood_seen", include_str!("flood_seen.wgsl"), &library);
        let task = kernel.on(
            gpu,
            &[
                card.tasks.parameters.as_entire_binding(),
                card.tasks.status.as_entire_binding(),
                card.tasks.particles.as_entire_binding(),
                wgpu::BindingResource::TextureView(&card.nodes),
                card.walls.outlines.as_entire_binding(),
                air.as_entire_binding(),
                shown.as_entire_binding(),
                particles.buffer.as_entire_binding(),
            ],
        );
        Ok(Self { particles, task, shown })
    }

    /// Has the device write the particles as they are seen.
    fn write(&self, gpu: &Gpu, shown: Shown) {
        let numbers = [shown.since, shown.spacing.unwrap_or(0.0), shown.drop_spacing, 0.0].map(|value| value as f32);
        gpu.queue.write_buffer(&self.shown, 0, bytemuck::bytes_of(&numbers));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("seen") });
        let mut pass = Pass::begin(&mut encoder, None);
        self.task.run(&mut pass, (self.particles.room as u32).div_ceil(THREADS));
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}

impl Card {
    /// The particles as they are seen, on the device.
    pub fn seen(&self, shown: Shown) -> Result<DeviceParticles, GpuError> {
        if self.seen.get().is_none() {
            // Nobody else can have been faster and done otherwise.
            let _ = self.seen.set(Seen::new(self)?);
        }
        let seen = self.seen.get().expect("it was set above");
        seen.write(&self.gpu, shown);
        Ok(DeviceParticles { spacing: shown.mean_spacing, ..seen.particles.clone() })
    }
}
