//! Uploads of the data of a run.

use super::MAX_SPAWN_REQUESTS;
use super::shared::{
    Column, Drop, MapCell, Memory, OPEN, PERIODIC, Packed, Parameters, Partial, Shown, SpawnRequest, Status, WALL,
};
use crate::friction::Roughness;
use crate::sph_swe::boundaries::EdgeRule;
use crate::sph_swe::falling::Falling;
use crate::sph_swe::friction::upload::roughness;
use crate::sph_swe::gauges::on_gpu::MOST_ROWS;
use crate::sph_swe::ground::upload::nodes;
use crate::sph_swe::inflow::upload::zones;
use crate::sph_swe::maps::on_gpu::MAX_MAP_TIMES;
use crate::sph_swe::obstacles::upload::GpuObstacles;
use crate::sph_swe::particle::Particle;
use crate::sph_swe::surroundings::Surroundings;
use crate::zone::Source;
use corpuscle_gpu::{CellSort, Gpu, GpuError, THREADS, filled, storage, uniform};
use corpuscle_scene::SphSwe;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Slots of three numbers of groups: see `sph_finish.wgsl`.
const SLOTS: usize = 9;

/// Inputs of the GPU solver: what the water moves in, and how.
#[derive(Clone, Copy)]
pub(crate) struct GpuInputs<'a> {
    pub surroundings: &'a Surroundings,
    pub scheme: &'a SphSwe,
    /// Particles in the air.
    pub falling: usize,
    /// The longest step while any are, s.
    pub fall_step: f64,
    pub gravity: f64,
    pub roughness: &'a Roughness,
    pub sources: &'a [Source],
    pub seed: u64,
    /// Volume, m3, smoothing length, m, and distance, m, of new particles.
    pub volume: f64,
    pub h: f64,
    pub spacing: f64,
}

/// What lies on the device at the start.
pub(super) struct Uploaded {
    pub memory: Memory,
    pub sort: CellSort,
    pub parameters: Parameters,
    pub origin: Origin,
    pub obstacles: GpuObstacles,
    /// The zone of each source.
    pub zones: Vec<u32>,
}

impl GpuInputs<'_> {
    /// Parameters of the run: all but the cells of the particles, which change, and those of ground and obstacles.
    fn parameters(&self, origin: Origin) -> Parameters {
        let &GpuInputs { surroundings, scheme, .. } = self;
        let bounds = surroundings.edges.bounds;
        let [west, south] = origin.relative([bounds.x_min, bounds.y_min]);
        let [east, north] = origin.relative([bounds.x_max, bounds.y_max]);
        Parameters {
            bounds: [west, east, south, north],
            rules: surroundings.edges.rules.map(|rule| match rule {
                EdgeRule::Open => OPEN,
                EdgeRule::Wall => WALL,
                EdgeRule::Periodic => PERIODIC,
            }),
            key: bytemuck::cast(ChaCha8Rng::seed_from_u64(self.seed).get_seed()),
            gravity: self.gravity as f32,
            time_step: scheme.time_step_s as f32,
            fall_step: self.fall_step as f32,
            new_volume: self.volume as f32,
            new_h: self.h as f32,
            spacing: self.spacing as f32,
            obstacles: surroundings.obstacles.names.len() as u32,
            in_air: self.falling as u32,
            rest_density: scheme.density_kg_per_m3 as f32,
            gas_constant: scheme.gas_constant as f32,
            viscosity: scheme.viscosity as f32,
            clips_pressure: u32::from(scheme.clip_negative_pressure),
            control: u32::from(scheme.control_force),
            control_strength: scheme.control_strength as f32,
            control_square: scheme.control_square as f32,
            first_h: self.h as f32,
            widest_h: (scheme.largest_smoothing * self.h) as f32,
            ..Parameters::default()
        }
    }

    /// Makes room for `count` particles in `cells` cells, and uploads what does not change.
    pub(super) fn upload(&self, gpu: &Gpu, count: usize, cells: usize) -> Result<Uploaded, GpuError> {
        let Surroundings { terrain, edges, obstacles } = self.surroundings;
        let bounds = edges.bounds;
        let level = terrain.height(bounds.centre()[0], bounds.centre()[1]);
        let origin = Origin { centre: bounds.centre(), level };
        let mut parameters = self.parameters(origin);
        let nodes = nodes(terrain, origin, &mut parameters);
        let rough = roughness(self.roughness, bounds, origin, &mut parameters);
        let farthest = self.scheme.largest_smoothing * self.h;
        let obstacles = GpuObstacles::new(obstacles, origin, farthest);
        (parameters.walls, parameters.outlines) = (obstacles.grid, obstacles.outlines_grid);
        let (words, zones) = zones(self.sources, origin);
        let status = storage::<Status>(gpu, "status", 1)?;
        let keys = storage::<u32>(gpu, "numbers of particles", count)?;
        let sort = CellSort::new(gpu, count, cells, &status, &keys)?;
        let pushed = if obstacles.count > 0 { count } else { 0 };
        let groups = count.max(self.falling).div_ceil(THREADS as usize);
        let memory = Memory {
            parameters: uniform(gpu, "parameters of the flood", &parameters),
            status,
            particles: storage::<Packed>(gpu, "particles", count)?,
            sorted: storage::<Packed>(gpu, "particles in order", count)?,
            spots: storage::<[f32; 4]>(gpu, "positions of particles", count)?,
            columns: storage::<Column>(gpu, "columns of water", count)?,
            pushes: storage::<[f32; 4]>(gpu, "pushes of obstacles", pushed)?,
            partials: storage::<Partial>(gpu, "sums of groups", groups)?,
            counts: sort.counts.clone(),
            slots: sort.cell_slots.clone(),
            keys,
            start: sort.start.clone(),
            order: sort.order.clone(),
            own_reaches: storage::<f32>(gpu, "reaches in cells", cells)?,
            reaches_along_rows: storage::<f32>(gpu, "reaches along rows", cells)?,
            reaches: storage::<f32>(gpu, "reaches", cells)?,
            groups: storage::<[u32; 3]>(gpu, "groups", SLOTS)?,
            nodes: filled(gpu, "ground", &nodes)?,
            rough: filled(gpu, "roughness", &rough)?,
            site_start: filled(gpu, "starts of boundary particles", &obstacles.start)?,
            sites: filled(gpu, "boundary particles", &obstacles.sites)?,
            outlines: filled(gpu, "outlines of obstacles", &obstacles.outlines)?,
            knocks: storage::<i32>(gpu, "knocks", 2 * obstacles.count + 1)?,
            obstacles: filled(gpu, "forces on obstacles", &obstacles.rectangles)?,
            zones: filled(gpu, "zones of sources", &words)?,
            spawn_requests: storage::<SpawnRequest>(gpu, "spawn requests", MAX_SPAWN_REQUESTS)?,
            drops: storage::<Drop>(gpu, "water in the air", self.falling)?,
            due: storage::<[f32; 2]>(gpu, "times of gauges", MOST_ROWS)?,
            map_times: storage::<[f32; 2]>(gpu, "sample times of maps", MAX_MAP_TIMES)?,
            volumes: storage::<f32>(gpu, "sums of water", groups)?,
            rows: storage::<u32>(gpu, "rows of gauges", 0)?,
            map_cells: storage::<MapCell>(gpu, "cells of maps", 0)?,
            shown: uniform(gpu, "time shown", &Shown::default()),
            drawn: storage::<[u32; 16]>(gpu, "nothing drawn", 1)?,
        };
        Ok(Uploaded { memory, sort, parameters, origin, obstacles, zones })
    }
}

/// Where the shaders count from, in model coordinates: single precision has some 7 digits, which are not to be spent on the position of the whole.
#[derive(Debug, Clone, Copy)]
pub(in crate::sph_swe) struct Origin {
    pub centre: [f64; 2],
    pub level: f64,
}

impl Origin {
    /// A position from the centre.
    pub fn relative(self, position: [f64; 2]) -> [f32; 2] {
        [0, 1].map(|axis| (position[axis] - self.centre[axis]) as f32)
    }

    fn position(self, x: f32, y: f32) -> [f64; 2] {
        [f64::from(x) + self.centre[0], f64::from(y) + self.centre[1]]
    }

    pub fn packed(self, particle: &Particle) -> Packed {
        let Particle { u, v, ax, ay, volume, depth, h, next_h, ground, .. } = *particle;
        let [x, y] = self.relative([particle.x, particle.y]);
        Packed {
            position_and_velocity: [x, y, u as f32, v as f32],
            acceleration_volume_depth: [ax, ay, volume, depth].map(|value| value as f32),
            lengths_and_ground: [h as f32, next_h as f32, (ground - self.level) as f32, 0.0],
            identity: [particle.id as u32, particle.outside.map_or(0, |side| u32::from(side) + 1), 0, 0],
        }
    }

    /// But for the slope of the ground, which is the terrain's.
    pub fn unpacked(self, packed: &Packed) -> Particle {
        let [x, y, u, v] = packed.position_and_velocity;
        let [ax, ay, volume, depth] = packed.acceleration_volume_depth.map(f64::from);
        let [h, next_h, ground, _] = packed.lengths_and_ground.map(f64::from);
        let [id, outside, ..] = packed.identity;
        let [x, y] = self.position(x, y);
        Particle {
            x,
            y,
            u: f64::from(u),
            v: f64::from(v),
            ax,
            ay,
            volume,
            h,
            next_h,
            depth,
            ground: ground + self.level,
            ground_slope: [0.0; 2],
            outside: outside.checked_sub(1).map(|side| side as u8),
            id: u64::from(id),
        }
    }

    pub fn drop(self, falling: &Falling) -> Drop {
        let Particle { x, y, u, v, volume, h, id, .. } = falling.particle;
        Drop {
            position: self.relative([x, y]),
            velocity: [u as f32, v as f32],
            z: (falling.z - self.level) as f32,
            w: falling.w as f32,
            volume: volume as f32,
            h: h as f32,
            id: id as u32,
            state: super::shared::FALLS,
        }
    }

    pub fn falling(self, drop: &Drop) -> Falling {
        let [x, y] = self.position(drop.position[0], drop.position[1]);
        let mut particle = Particle::new(u64::from(drop.id), x, y, f64::from(drop.volume), f64::from(drop.h));
        [particle.u, particle.v] = drop.velocity.map(f64::from);
        Falling { particle, z: f64::from(drop.z) + self.level, w: f64::from(drop.w) }
    }
}
