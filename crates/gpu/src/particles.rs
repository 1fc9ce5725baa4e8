//! Particles of a model that are drawn where they lie: whoever moves them writes them, whoever draws them reads them, and
//! nothing is downloaded to the host.

use crate::{Gpu, GpuError, Shared, SharedPiece, THREADS, Task, read, storage, submit, wait_for};
use bytemuck::NoUninit;
use std::sync::OnceLock;

crate::declare! {
    constants {}
    structs {
        /// A particle as the device has it.
        pub struct DeviceParticle {
            /// Position from [`DeviceParticles::origin`], m.
            pub position: [f32; 3],
            /// Distance to its neighbours, m.
            pub spacing: f32,
            /// Velocity, m/s.
            pub velocity: [f32; 3],
            /// Depth of the water under it, m; 0 for one in the air.
            pub depth: f32,
            /// Its volume, m3; 0 where there is no particle.
            pub volume: f32,
            /// Lasting identity: its lowest 32 bits.
            pub id: u32,
            /// Of air, degrees Celsius; of water 0.
            pub temperature: f32,
            /// Fills up.
            pub unused: u32,
        }
    }

    /// What particles on a device consist of.
    pub piece Particle;
}

/// A binding to [`DeviceParticles::buffer`].
impl Shared for DeviceParticles {
    fn wgsl() -> String {
        "DeviceParticles".into()
    }

    fn piece() -> Option<(&'static str, String)> {
        Some(("device_particles", format!("{}{ALL}", Particle::wgsl())))
    }
}

/// The buffer as shaders have it.
const ALL: &str = "struct DeviceParticles {
    count: u32,
    all: array<DeviceParticle>,
}
";

/// Bytes before the first particle: the number of particles, and what aligns the first.
const HEADER: usize = 16;

/// Particles on a device.
#[derive(Debug, Clone)]
pub struct DeviceParticles {
    /// Their number as `u32`, 12 bytes of nothing, and the particles: `DeviceParticles` of the piece. In any order; some may be
    /// no particles.
    pub buffer: wgpu::Buffer,
    /// Particles that there is room for.
    pub room: usize,
    /// The point that positions are counted from, m.
    pub origin: [f64; 3],
    /// How far apart they are on the whole, m: what is made for them is made for this.
    pub spacing: f64,
}

impl DeviceParticles {
    /// Room for so many; still none.
    ///
    /// # Errors
    /// [`GpuError::Memory`].
    pub fn new(gpu: &Gpu, room: usize, origin: [f64; 3], spacing: f64) -> Result<Self, GpuError> {
        let bytes = HEADER + room.max(1) * size_of::<DeviceParticle>();
        Ok(Self { buffer: storage::<u8>(gpu, "particles as seen", bytes)?, room, origin, spacing })
    }

    /// Takes these instead of those before, as many as there is room for.
    pub fn write(&self, gpu: &Gpu, particles: &[DeviceParticle]) {
        let count = particles.len().min(self.room);
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(&[count as u32, 0, 0, 0]));
        gpu.queue.write_buffer(&self.buffer, HEADER as u64, bytemuck::cast_slice(&particles[..count]));
    }

    /// Brings them to the host. Waits for the device.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<DeviceParticle>, GpuError> {
        let count = wait_for(read::<u32>(gpu, &self.buffer, 1))?[0] as usize;
        let bytes =
            wait_for(read::<u8>(gpu, &self.buffer, HEADER + count.min(self.room) * size_of::<DeviceParticle>()))?;
        let particles: Vec<DeviceParticle> = bytemuck::pod_collect_to_vec(&bytes[HEADER..]);
        Ok(particles.into_iter().filter(|particle| particle.volume > 0.0).collect())
    }
}

/// Particles that a model on a device writes for drawing; made when they are first drawn.
#[derive(Debug, Default)]
pub struct SeenParticles(OnceLock<Seen>);

/// What a model on a device writes for drawing, and how.
#[derive(Debug)]
pub struct Seen {
    /// The particles.
    pub particles: DeviceParticles,
    /// Uniform that says which state is shown, as its time.
    pub shown: wgpu::Buffer,
    /// Writes the particles, a thread for each that there is room for.
    pub task: Task,
}

impl SeenParticles {
    /// Has the device write the particles as `shown` says; `make` makes what is needed at the first call.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn write(
        &self,
        gpu: &Gpu,
        shown: &impl NoUninit,
        make: impl FnOnce() -> Result<Seen, GpuError>,
    ) -> Result<DeviceParticles, GpuError> {
        let seen = match self.0.get() {
            Some(seen) => seen,
            None => {
                let made = make()?;
                // Another thread that was faster has set the same value.
                self.0.get_or_init(|| made)
            }
        };
        gpu.queue.write_buffer(&seen.shown, 0, bytemuck::bytes_of(shown));
        let groups = (seen.particles.room as u32).div_ceil(THREADS);
        submit(gpu, "seen", None, |pass| seen.task.run(pass, groups));
        Ok(seen.particles.clone())
    }
}
