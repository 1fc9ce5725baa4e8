//! The water as particles on the device, for drawing.

use super::shared::{CellPosition, Memory, Shown};
use super::{GpuSolver, LIBRARY};
use crate::voronoi::mesh::Mesh;
use corpuscle_gpu::{DeviceParticles, GpuError, Kernel, Seen, filled, uniform};

/// Name and text.
pub(super) const SHADER: (&str, &str) = ("voronoi_seen", include_str!("voronoi_seen.wgsl"));

impl GpuSolver {
    /// The water at a time, s, as particles on the device: those deeper than `least_depth`, m.
    ///
    /// # Errors
    /// [`GpuError::Memory`].
    pub fn seen(&self, mesh: &Mesh, time: f64, least_depth: f64) -> Result<DeviceParticles, GpuError> {
        let totals = self.totals();
        let share = (time - (totals.time - totals.last_step)) / totals.last_step;
        let share = if totals.last_step > 0.0 { share.clamp(0.0, 1.0) } else { 1.0 };
        let shown = Shown { share: share as f32, least_depth: least_depth as f32, ..Shown::default() };
        self.seen.write(self.batches.gpu(), &shown, || self.make_seen(mesh))
    }

    fn make_seen(&self, mesh: &Mesh) -> Result<Seen, GpuError> {
        let gpu = self.batches.gpu();
        let [x, y] = mesh.layout.bounds.centre();
        let level = mesh.bed.first().copied().unwrap_or(0.0);
        let particles = DeviceParticles::new(gpu, mesh.len(), [x, y, level], mesh.layout.spacing())?;
        let position = |cell: usize| {
            let [east, north] = mesh.centroid[cell];
            CellPosition {
                at: [(east - x) as f32, (north - y) as f32],
                bed: (mesh.bed[cell] - level) as f32,
                id: mesh.point[cell] as u32,
            }
        };
        let memory = Memory {
            positions: filled(gpu, "positions of cells", &(0..mesh.len()).map(position).collect::<Vec<_>>())?,
            shown: uniform(gpu, "time shown", &Shown::default()),
            drawn: particles.buffer.clone(),
            ..self.memory.clone()
        };
        let kernel = Kernel::<Memory>::new(gpu, SHADER.0, SHADER.1, LIBRARY);
        Ok(Seen { task: kernel.on(gpu, &memory), shown: memory.shown, particles })
    }
}
