//! Water drawn from GPU memory: discs made on the GPU from particles there. Twin of [`Water`](super::Water), in single
//! precision.
//!
//! ```text
//! begin    how many particles there are                             water_begin.wgsl
//! count    into cells, by the device's sort                         water_count.wgsl
//! draw     arguments of indirect draws and dispatches               water_draw_arguments.wgsl
//! columns  in the order of the cells, with the ground's slope       water_columns.wgsl
//! settle   slopes are limited, until none is too steep              water_settle.wgsl, water_settled.wgsl
//! calm     heights and velocities of planes through neighbours      water_calm.wgsl
//! discs    in the surface, with the foam that comes now             water_discs.wgsl
//! foam     spread, and remembered by ids                            water_foam.wgsl
//! levels   of the water at the borders of the ground                water_levels.wgsl
//! faces    of the water there                                       water_faces.wgsl
//! ```

mod ground;
mod kernels;
mod shared;
mod tasks;
#[cfg(test)]
mod twin;

use super::droplet::Batch;
use super::water::{LIFE, REACH};
use crate::{HeightField, RenderError, Stage};
use corpuscle_gpu::{DeviceParticles, Gpu, MOST_GROUPS, PassTiming, Stopwatch, THREADS, uniform, wait_for, wgpu};
use glam::{DVec2, DVec3};
use ground::Ground;
use kernels::Kernels;
use shared::{DRAW, SPLATS, Settings};
use tasks::{Tasks, entries};

/// Cells a particle at most, where they are more than so many.
const CELLS_A_PARTICLE: usize = 4;
const FEWEST_CELLS: usize = 65_536;

/// Bytes of the arguments of indirect draws and dispatches.
const BYTES: u32 = size_of::<u32>() as u32;

/// Makes discs from the particles of shallow water on the GPU, and balls from those in the air. Stores the foam on them from picture
/// to picture.
#[derive(Debug)]
pub struct DeviceWater {
    kernels: Kernels,
    stage: Stage,
    /// Exaggeration of heights.
    raise: f64,
    ground: Ground,
    /// Numbers of the picture.
    settings: wgpu::Buffer,
    /// For the particles drawn last.
    drawn: Option<(DeviceParticles, Tasks)>,
    /// Of the last picture, s.
    time: Option<f64>,
    /// Where kernels are timed.
    stopwatch: Option<Stopwatch>,
}

impl DeviceWater {
    /// Water on a stage, on ground whose heights are drawn `raise` times higher than they are, as those of the field are already.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] for more nodes than the device can hold.
    pub fn new(gpu: &Gpu, stage: &Stage, field: &HeightField, raise: f64) -> Result<Self, RenderError> {
        let ground = Ground::new(gpu, stage, field)?;
        let settings = uniform(gpu, "water", &Settings::default());
        Ok(Self {
            kernels: Kernels::new(gpu),
            stage: *stage,
            raise,
            ground,
            settings,
            drawn: None,
            time: None,
            stopwatch: None,
        })
    }

    /// Updates the water from these particles at a time, s, not before that of the last call. The discs are made on the GPU.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] for more particles than there is room for.
    pub fn update(&mut self, gpu: &Gpu, time: f64, particles: &DeviceParticles) -> Result<(), RenderError> {
        let settings = self.settings(time, particles);
        if self.drawn.as_ref().is_none_or(|(drawn, _)| drawn.buffer != particles.buffer) {
            let cells = most_cells(particles) + 2;
            let tasks = Tasks::new(gpu, &self.kernels, particles, cells, &self.ground, &self.settings)?;
            if let Some((_, before)) = &self.drawn {
                tasks.remember(gpu, before);
            }
            self.drawn = Some((particles.clone(), tasks));
        }
        self.time = Some(time);
        gpu.queue.write_buffer(&self.settings, 0, bytemuck::bytes_of(&settings));
        if let Some((_, tasks)) = &mut self.drawn {
            tasks.run(gpu, &self.ground, self.stopwatch.as_mut());
        }
        Ok(self.stopwatch.iter_mut().try_for_each(|stopwatch| wait_for(stopwatch.read(gpu)))?)
    }

    /// Times each kernel from the next update on, which then waits for the device.
    pub fn measure(&mut self, gpu: &Gpu) {
        self.stopwatch = Stopwatch::new(gpu);
    }

    /// Time of each kernel since, by its name; empty where the device has no timer queries.
    pub fn taken(&self) -> impl Iterator<Item = (&'static str, PassTiming)> {
        self.stopwatch.iter().flat_map(Stopwatch::taken)
    }

    /// The particles as they are drawn; nothing before the first update.
    pub(super) fn droplets(&self) -> Option<Batch> {
        let (_, tasks) = self.drawn.as_ref()?;
        let shared::Memory { instances, groups, .. } = tasks.memory.clone();
        Some(Batch::Indirect {
            instances,
            draw_args: groups,
            at: (BYTES * DRAW).into(),
            splats: (BYTES * SPLATS).into(),
        })
    }

    /// The faces of water at the borders, corner by corner, and how many corners; nothing before the first update.
    pub(super) fn faces(&self) -> Option<(wgpu::Buffer, u32)> {
        self.drawn.as_ref().map(|_| (self.ground.faces.clone(), 6 * self.ground.border_nodes()))
    }

    fn settings(&self, time: f64, particles: &DeviceParticles) -> Settings {
        let Self { stage, ground, .. } = self;
        let half = 0.5 * (stage.to - stage.from).truncate();
        let [x, y, z] = particles.origin;
        let shift = DVec3::new(x, y, self.raise * z) - stage.centre();
        let [columns, rows, cell] = cells(half, particles);
        Settings {
            shift: shift.as_vec3().into(),
            raise: self.raise as f32,
            corner: (-half).as_vec2().into(),
            per_cell: (1.0 / cell) as f32,
            unit: (1.0 / stage.unit()) as f32,
            ground_corner: ground.corner.as_vec2().into(),
            ground_per_metre: ground.per_metre.as_vec2().into(),
            ground_nodes: ground.nodes,
            columns: columns as u32,
            rows: rows as u32,
            room: particles.room as u32,
            memory: entries(particles.room) as u32 - 1,
            left: self.time.map_or(0.0, |before| (-(time - before).max(0.0) / LIFE).exp()) as f32,
            unused: 0.0,
        }
    }
}

fn most_cells(particles: &DeviceParticles) -> usize {
    // With two more, a thread each.
    let most = MOST_GROUPS as usize * THREADS as usize - 2;
    (CELLS_A_PARTICLE * particles.room).max(FEWEST_CELLS).min(most)
}

/// Columns and rows of cells over twice `half` m, and their size, m: as wide as the radius of the neighbour search, or wider where there would be too many.
fn cells(half: DVec2, particles: &DeviceParticles) -> [f64; 3] {
    let most = most_cells(particles) as f64;
    let mut cell = REACH * particles.spacing;
    loop {
        let [columns, rows] = [half.x, half.y].map(|half| (2.0 * half / cell).floor() + 1.0);
        if columns * rows <= most {
            return [columns, rows, cell];
        }
        cell *= 1.1;
    }
}
