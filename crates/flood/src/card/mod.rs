//! The flood on the graphics card: twins of scheme balanced's passes, in single precision, that leave the water where it is.
//!
//! The host says until when to go on and reads a few numbers after some steps. The state comes back when something looks at it.

mod advance;
mod air;
mod gauges;
mod ground;
mod layout;
mod maps;
mod rates;
mod resource;
mod seen;
mod setting;
mod span;
mod state;
mod steps;
mod tasks;
mod walls;
mod weather;
mod works;

pub(crate) use gauges::MOST_ROWS;
pub(crate) use maps::MOST_LOOKS;
pub(crate) use seen::Shown;
pub(crate) use setting::Setting;
pub(crate) use span::{Birth, Progress, Span};
pub(crate) use state::Water;

use crate::rain::Intensity;
use air::Air;
use corpuscle_gpu::{Gpu, GpuError, MOST_GROUPS, Stopwatch, THREADS, wgpu};
use corpuscle_terrain::Bounds;
use layout::{Origin, Parameters, Status};
use seen::Seen;
use state::DoneToObstacles;
use std::sync::OnceLock;
use tasks::Tasks;
use walls::Walls;
use weather::Weather;
use works::Works;

/// Cells a particle, and at least: what the sort goes through beside the particles.
const CELLS_A_PARTICLE: usize = 4;
const FEWEST_CELLS: usize = 65_536;

/// More cells are no work for one thread each.
const MOST_CELLS: usize = (MOST_GROUPS * THREADS) as usize;

/// Neighbours that a particle keeps a list of, at most: few have more.
const MOST_NEAR: usize = 35;

/// Births that the card can be told of at once.
pub(crate) const MOST_BIRTHS: usize = 16_384;

/// Neighbours for whose lists there is room; scheme sph-swe has none.
fn most_near(gpu: &Gpu, count: usize, cells: usize, setting: &Setting<'_>) -> usize {
    if setting.sph_swe.is_some() {
        return 0;
    }
    let fours = (gpu.most_bytes() / 16) as usize;
    (4 * (fours.saturating_sub(cells.div_ceil(4)) / count.max(1))).saturating_sub(1).min(MOST_NEAR)
}

/// Water on a card.
#[derive(Debug)]
pub(crate) struct Card {
    gpu: Gpu,
    tasks: Tasks,
    walls: Walls,
    works: Works,
    weather: Option<Weather>,
    air: Option<Air>,
    /// The nodes of the ground.
    nodes: wgpu::TextureView,
    /// What others draw, where they do.
    seen: OnceLock<Seen>,
    parameters: Parameters,
    origin: Origin,
    bounds: Bounds,
    status: Status,
    /// Particles and cells that there is room for.
    room: usize,
    most_cells: usize,
    /// Steps in all, to lay the cells out at the same ones however often the host looks.
    steps: u64,
    /// The time that the clock of the device counts from, s, and how long before that it last rained, s.
    clock_began: f64,
    dry_before: f64,
    /// Steps in a batch.
    batch: u32,
    /// Whether the host has not the state that is here.
    ahead: bool,
    /// Time spent on steps, s.
    busy: f64,
    /// Where passes are timed.
    pub stopwatch: Option<Stopwatch>,
    /// As it was when the water was handed over.
    done_before: DoneToObstacles,
}

impl Card {
    /// Room for `count` particles.
    pub fn new(gpu: Gpu, count: usize, setting: &Setting<'_>) -> Result<Self, GpuError> {
        let &Setting { surroundings, scheme, roughness, sources, structures, ground, .. } = setting;
        let bounds = surroundings.edges.bounds;
        let origin = Origin {
            centre: bounds.centre(),
            level: surroundings.terrain.height(bounds.centre()[0], bounds.centre()[1]),
        };
        let (nodes, patches) = ground::texture(&gpu, &surroundings.terrain, origin.level)?;
        let farthest = setting.sph_swe.map_or(2.0 * scheme.largest_h, |sph_swe| sph_swe.largest_smoothing * setting.h);
        let walls = Walls::new(&gpu, &surroundings.obstacles, origin, farthest)?;
        let rain = ground.and_then(|ground| match &ground.intensity {
            Intensity::Table(table) => Some(table),
            Intensity::None | Intensity::Function(_) => None,
        });
        let works = Works::new(&gpu, surroundings, sources, structures, rain, origin, setting.h)?;
        let mut parameters = setting.parameters(origin, &patches, &walls, &works);
        let rough = ground::roughness(&gpu, roughness, bounds, origin, &mut parameters)?;
        let mut weather = None;
        if let Some(ground) = ground {
            weather = Some(Weather::new(&gpu, ground, count, scheme.eta, &mut parameters)?);
        }
        if setting.sph_swe.is_some() {
            parameters.drop_h = setting.h as f32;
        }
        let air = (setting.falling > 0).then(|| Air::new(&gpu, setting.falling)).transpose()?;
        let most_cells = (CELLS_A_PARTICLE * count).clamp(FEWEST_CELLS, MOST_CELLS);
        let most_near = most_near(&gpu, count, most_cells, setting);
        parameters.near_first = most_cells.div_ceil(4) as u32;
        parameters.near_stride = count as u32;
        parameters.most_near = most_near as u32;
        let tasks = Tasks::new(
            &gpu,
            count,
            most_cells,
            MOST_BIRTHS,
            [&nodes, &rough],
            &walls,
            &works,
            weather.as_ref(),
            air.as_ref(),
            setting.sph_swe.is_some(),
            setting.refinement.is_some(),
            most_near,
        )?;
        let status = Status::default();
        Ok(Self {
            gpu,
            room: count,
            tasks,
            walls,
            works,
            weather,
            air,
            nodes,
            seen: OnceLock::new(),
            parameters,
            origin,
            bounds,
            status,
            most_cells,
            steps: 0,
            clock_began: 0.0,
            dry_before: 0.0,
            batch: 4,
            ahead: false,
            busy: 0.0,
            stopwatch: None,
            done_before: DoneToObstacles::default(),
        })
    }

    /// The device.
    pub fn gpu(&self) -> Gpu {
        self.gpu.clone()
    }

    /// Wall-clock time spent on steps, s.
    pub fn busy(&self) -> f64 {
        self.busy
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tasks.bytes
    }

    /// Particles that there are, those in the air among them.
    pub fn particles(&self) -> usize {
        (self.status.particles + self.status.falling) as usize
    }

    /// Particles that there is room for.
    pub fn room(&self) -> usize {
        self.room
    }

    /// Particles in the air that there is room for.
    pub fn room_in_air(&self) -> usize {
        self.air.as_ref().map_or(0, |air| air.room)
    }

    /// Leaves the maps to the host.
    #[cfg(test)]
    pub fn forget_maps(&mut self) {
        self.tasks.maps = None;
    }

    /// Takes lists of neighbours of another length, as far as there is room.
    #[cfg(test)]
    pub fn list(&mut self, most_near: u32) {
        self.parameters.most_near = most_near.min(self.parameters.most_near);
    }
}
