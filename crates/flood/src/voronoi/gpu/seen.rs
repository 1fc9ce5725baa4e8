//! The water as particles on the device, for drawing.

use super::shared::{Memory, Place, Shown};
use super::{GpuSolver, LIBRARY};
use crate::voronoi::mesh::Mesh;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, Kernel, THREADS, Task, filled, submit, uniform};

/// Buffers of the particles for drawing, and the task that fills them.
pub(super) struct Seen {
    particles: DeviceParticles,
    memory: Memory,
    task: Task,
}

impl Seen {
    fn new(solver: &GpuSolver, mesh: &Mesh) -> Result<Self, GpuError> {
        let gpu = solver.batches.gpu();
        let [x, y] = mesh.layout.bounds.centre();
        let level = mesh.bed.first().copied().unwrap_or(0.0);
        let particles = DeviceParticles::new(gpu, mesh.len(), [x, y, level], mesh.layout.spacing())?;
        let place = |cell: usize| {
            let [east, north] = mesh.centroid[cell];
            Place {
                at: [(east - x) as f32, (north - y) as f32],
                bed: (mesh.bed[cell] - level) as f32,
                id: mesh.point[cell] as u32,
            }
        };
        let memory = Memory {
            places: filled(gpu, "places of cells", &(0..mesh.len()).map(place).collect::<Vec<_>>())?,
            shown: uniform(gpu, "time shown", &Shown::default()),
            drawn: particles.buffer.clone(),
            ..solver.memory.clone()
        };
        let task = kernel(gpu).on(gpu, &memory);
        Ok(Self { particles, memory, task })
    }

    /// Has the device write the particles for drawing.
    fn write(&self, gpu: &Gpu, shown: Shown) {
        gpu.queue.write_buffer(&self.memory.shown, 0, bytemuck::bytes_of(&shown));
        let groups = (self.particles.room as u32).div_ceil(THREADS);
        submit(gpu, "seen", None, |pass| self.task.run(pass, groups));
    }
}

/// Name and text.
pub(super) const SHADER: (&str, &str) = ("voronoi_seen", include_str!("voronoi_seen.wgsl"));

fn kernel(gpu: &Gpu) -> Kernel<Memory> {
    Kernel::new(gpu, SHADER.0, SHADER.1, LIBRARY)
}

impl GpuSolver {
    /// The water at a time, s, as particles on the device: those deeper than `least_depth`, m.
    ///
    /// # Errors
    /// [`GpuError::Memory`].
    pub fn seen(&self, mesh: &Mesh, time: f64, least_depth: f64) -> Result<DeviceParticles, GpuError> {
        if self.seen.get().is_none() {
            // Another thread that was faster has set the same value.
            let _ = self.seen.set(Seen::new(self, mesh)?);
        }
        let seen = self.seen.get().expect("it was set above");
        let totals = self.totals();
        let share = (time - (totals.time - totals.last_step)) / totals.last_step;
        let share = if totals.last_step > 0.0 { share.clamp(0.0, 1.0) } else { 1.0 };
        seen.write(
            self.batches.gpu(),
            Shown { share: share as f32, least_depth: least_depth as f32, ..Shown::default() },
        );
        Ok(seen.particles.clone())
    }
}
