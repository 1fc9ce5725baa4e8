//! Scheme `sph-swe` on a GPU, in single precision: the water stays there while it takes steps.
//!
//! The host says until when to go on and reads a few numbers after some steps. The state is downloaded on demand. Each pass is a WGSL file beside its
//! CPU code.

mod advance;
mod batch;
mod frame_request;
mod model;
mod observers;
mod seen;
pub(super) mod shared;
mod state;
pub(super) mod tasks;
#[cfg(test)]
mod tests;
pub(super) mod upload;

pub(super) use model::failed;
pub(super) use observers::Observers;

use crate::sph_swe::obstacles::upload::GpuObstacles;
use corpuscle_gpu::{Batches, Buffers, Gpu, GpuError, MOST_GROUPS, SeenParticles, THREADS, wgpu};
use corpuscle_terrain::Bounds;
use shared::{Parameters, Status};
use state::ObstacleTotals;
use tasks::Tasks;
use upload::{GpuInputs, Origin};

/// Cells for each particle, and least number of cells: the sort processes them beside the particles.
const CELLS_A_PARTICLE: usize = 4;
const FEWEST_CELLS: usize = 65_536;

/// More cells are no work for one thread each.
pub(super) const MOST_CELLS: usize = (MOST_GROUPS * THREADS) as usize;

/// Spawn requests that are uploaded to the GPU at once, at most.
const MAX_SPAWN_REQUESTS: usize = 16_384;

/// Water on a GPU.
#[derive(Debug)]
pub(super) struct OnGpu {
    batches: Batches,
    pub(super) tasks: Tasks,
    pub(super) obstacles: GpuObstacles,
    /// The zone of each source.
    zones: Vec<u32>,
    /// The particles for drawing, once they are drawn.
    seen: SeenParticles,
    parameters: Parameters,
    pub(super) origin: Origin,
    bounds: Bounds,
    pub(super) status: Status,
    /// Particles, drops and cells that there is room for.
    room: usize,
    room_in_air: usize,
    most_cells: usize,
    /// Steps in all: the cells are laid out at the same steps however often the host reads the state.
    steps: u64,
    /// What the device's times count from, s.
    pub(super) clock_began: f64,
    /// Whether the GPU's state is ahead of the host's.
    ahead: bool,
    /// Totals of the obstacles when the water was uploaded.
    totals_before: ObstacleTotals,
}

impl OnGpu {
    /// Room for `count` particles.
    ///
    /// # Errors
    /// [`GpuError::Memory`], [`GpuError::TooMany`].
    pub fn new(gpu: Gpu, count: usize, inputs: &GpuInputs<'_>) -> Result<Self, GpuError> {
        let most_cells = (CELLS_A_PARTICLE * count).clamp(FEWEST_CELLS, MOST_CELLS);
        let uploaded = inputs.upload(&gpu, count, most_cells)?;
        let (tasks, parameters) = (Tasks::new(&gpu, uploaded.memory, uploaded.sort, inputs), uploaded.parameters);
        Ok(Self {
            batches: Batches::new(gpu, "sph-swe"),
            tasks,
            obstacles: uploaded.obstacles,
            zones: uploaded.zones,
            seen: SeenParticles::default(),
            parameters,
            origin: uploaded.origin,
            bounds: inputs.surroundings.edges.bounds,
            status: Status::default(),
            room: count,
            room_in_air: inputs.falling,
            most_cells,
            steps: 0,
            clock_began: 0.0,
            ahead: false,
            totals_before: ObstacleTotals::default(),
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        self.batches.gpu()
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tasks.memory.in_order().into_iter().map(wgpu::Buffer::size).sum()
    }

    /// Particles that there are, those in the air among them.
    pub fn particles(&self) -> usize {
        (self.status.particles + self.status.falling) as usize
    }

    /// Particles that there is room for.
    pub fn room(&self) -> usize {
        self.room
    }

    /// Drops that there is room for.
    pub fn room_in_air(&self) -> usize {
        self.room_in_air
    }

    /// Leaves the maps to the host.
    #[cfg(test)]
    pub fn forget_maps(&mut self) {
        self.tasks.maps = None;
    }
}
