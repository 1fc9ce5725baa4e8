//! The passes of a step, each with what it works on.

use super::air::Air;
use super::gauges::{Gauges, MOST_ROWS};
use super::layout::{CardBirth, CardParticle, Column, Parameters, Partial, Plan, Slopes, Status};
use super::maps::{CardMaps, MOST_LOOKS};
use super::resource::shader;
use super::walls::Walls;
use super::weather::Weather;
use super::works::Works;
use corpuscle_gpu::{CellSort, Gpu, GpuError, SUMS_BEFORE, THREADS, Task, storage, uniform, wgpu};

/// Pieces that the shaders import.
pub(super) const LIBRARY: &[(&str, &str)] = &[
    ("flood_card", include_str!("flood_card.wgsl")),
    ("infiltration_laws", include_str!("../infiltration_laws.wgsl")),
    ("flood_friction", include_str!("flood_friction.wgsl")),
    ("flood_ground", include_str!("flood_ground.wgsl")),
    ("flood_neighbours", include_str!("flood_neighbours.wgsl")),
    ("flood_columns", include_str!("flood_columns.wgsl")),
    ("flood_near", include_str!("flood_near.wgsl")),
    ("flood_walls", include_str!("flood_walls.wgsl")),
    ("flood_outlines", include_str!("flood_outlines.wgsl")),
    ("flood_places", include_str!("flood_places.wgsl")),
    ("flood_water", include_str!("flood_water.wgsl")),
    ("flood_accounts", include_str!("flood_accounts.wgsl")),
    ("hydraulics", include_str!("../hydraulics.wgsl")),
    ("flood_laws", include_str!("flood_laws.wgsl")),
    ("flood_wetness", include_str!("flood_wetness.wgsl")),
    ("flood_air", include_str!("flood_air.wgsl")),
    ("flood_sums", include_str!("flood_sums.wgsl")),
    ("flood_sph_swe", include_str!("flood_sph_swe.wgsl")),
    ("flood_moves", include_str!("flood_moves.wgsl")),
    ("flood_drifting", include_str!("flood_drifting.wgsl")),
    ("flood_leaving", include_str!("flood_leaving.wgsl")),
    SUMS_BEFORE,
    ("flood_refinement", include_str!("flood_refinement.wgsl")),
    ("flood_done", include_str!("flood_done.wgsl")),
    ("flood_rows", include_str!("flood_rows.wgsl")),
];

/// Everything on the device.
#[derive(Debug)]
pub(super) struct Tasks {
    pub parameters: wgpu::Buffer,
    pub status: wgpu::Buffer,
    pub particles: wgpu::Buffer,
    pub births: wgpu::Buffer,
    /// Bytes held.
    pub bytes: u64,
    pub sorted: wgpu::Buffer,
    pub groups: wgpu::Buffer,
    pub sort: CellSort,
    /// Times at which rows of gauges are due, and those to look at the maps; and reaches with lists of neighbours.
    pub due: wgpu::Buffer,
    pub looks: wgpu::Buffer,
    pub near: wgpu::Buffer,
    /// Water beyond sides held at levels, and structures, where there are any.
    pub carry: Option<Task>,
    pub regulate: Option<Task>,
    pub drift: Task,
    /// Splitting and merging, where they are asked for: what is to become of each particle, room for halves, and what becomes of it.
    pub refine: Option<[Task; 3]>,
    /// Where water comes in.
    pub bear: Option<Task>,
    /// Rain and infiltration, where there are any: area covered, cells of the ground, what particles get; and drops.
    pub weather: Option<[Task; 3]>,
    pub drops: Option<Task>,
    /// What falls, and what of it has landed.
    pub land: Option<[Task; 2]>,
    pub leave: Task,
    /// Drift and leave at once, where nothing comes between them.
    pub moves: Option<Task>,
    pub reorder: Task,
    pub reach_own: Task,
    pub reach_rows: Task,
    pub reach: Task,
    pub density: Task,
    /// In scheme balanced.
    pub gradients: Option<Task>,
    /// What obstacles do, where there are any.
    pub push: Option<Task>,
    pub on_obstacles: Option<Task>,
    pub obstacles: u32,
    pub forces: Task,
    pub finish: Task,
    /// Where gauges are asked for.
    pub gauges: Option<Gauges>,
    /// Where it keeps the maps.
    pub maps: Option<CardMaps>,
}

impl Tasks {
    /// For so many particles, cells, and births between two words of the host, at most.
    pub fn new(
        gpu: &Gpu,
        count: usize,
        cells: usize,
        most_births: usize,
        [nodes, rough]: [&wgpu::TextureView; 2],
        walls: &Walls,
        works: &Works,
        weather: Option<&Weather>,
        air: Option<&Air>,
        is_sph_swe: bool,
        refines: bool,
        most_near: usize,
    ) -> Result<Self, GpuError> {
        let parameters = uniform(gpu, "parameters of the flood", &Parameters::default());
        let status = storage::<Status>(gpu, "status", 1)?;
        let groups = storage::<[u32; 3]>(gpu, "groups", 13)?;
        let looks = storage::<f32>(gpu, "times of looks", MOST_LOOKS)?;
        let due = storage::<f32>(gpu, "times of gauges", MOST_ROWS)?;
        let particles = storage::<CardParticle>(gpu, "particles", count)?;
        let sorted = storage::<CardParticle>(gpu, "particles in order", count)?;
        let keys = storage::<u32>(gpu, "numbers of particles", count)?;
        let sites = storage::<[f32; 4]>(gpu, "sites", count)?;
        let columns = storage::<Column>(gpu, "columns of water", count)?;
        let slopes = storage::<Slopes>(gpu, "slopes", count)?;
        let births = storage::<CardBirth>(gpu, "particles to come", most_births)?;
        let partials = storage::<Partial>(gpu, "sums of groups", count.div_ceil(THREADS as usize))?;
        let own = storage::<f32>(gpu, "reaches", cells)?;
        let along_rows = storage::<f32>(gpu, "reaches of rows", cells)?;
        // Reaches in cells come first, and each list begins with its length.
        let near = storage::<[u32; 4]>(gpu, "neighbours", cells.div_ceil(4) + count * (1 + most_near).div_ceil(4))?;
        let sort = CellSort::new(gpu, count, cells, &status, &keys)?;
        let pushes = if walls.count > 0 { Walls::pushes(gpu, count)? } else { storage::<[f32; 4]>(gpu, "pushes", 0)? };
        let of_particles = [&pushes, &particles, &sorted, &keys, &sites, &columns, &slopes, &births, &partials];
        let of_cells = [&own, &along_rows, &near, &sort.counts, &sort.places, &sort.start, &sort.order];
        let planned = if refines { count } else { 0 };
        let plans = storage::<Plan>(gpu, "plans", planned)?;
        let tallies = storage::<u32>(gpu, "tallies of plans", 3 + planned.div_ceil(THREADS as usize))?;
        let of_particles = of_particles.into_iter().chain([&plans, &tallies]);
        let bytes: u64 = of_particles.chain(of_cells).map(wgpu::Buffer::size).sum();
        let bytes = bytes + weather.map_or(0, Weather::bytes);
        let has_walls = walls.count > 0;
        let comes_in = !works.sources.is_empty() || works.holds_level;
        let comes_between = comes_in || refines || works.has_structures || air.is_some() || weather.is_some();
        Ok(Self {
            carry: works.holds_level.then(|| {
                shader!(
                    gpu,
                    "flood_carry",
                    [parameters, status, particles, sort.start, (), *nodes, near, walls.start, walls.sites]
                )
            }),
            drift: shader!(
                gpu,
                "flood_drift",
                [parameters, status, particles, walls.outlines, walls.knocks, partials, *rough]
            ),
            refine: refines.then(|| {
                [
                    shader!(
                        gpu,
                        "flood_plans",
                        [parameters, walls.outlines, status, particles, sort.start, sites, plans, tallies]
                    ),
                    shader!(gpu, "flood_halves", [(), (), status, tallies, groups, plans]),
                    shader!(gpu, "flood_refine", [parameters, walls.outlines, particles, plans, tallies]),
                ]
            }),
            regulate: works.has_structures.then(|| {
                shader!(
                    gpu,
                    "flood_regulate",
                    [parameters, status, particles, sort.start, works.buffer, *nodes, near, walls.start, walls.sites]
                )
            }),
            bear: comes_in.then(|| {
                shader!(
                    gpu,
                    "flood_births",
                    [parameters, status, particles, sort.start, works.buffer, *nodes, births, groups]
                )
            }),
            weather: weather.map(|weather| {
                let Weather { ground, tallies, laws, sums, rates, .. } = weather;
                [
                    shader!(gpu, "flood_cover", [parameters, status, particles, *tallies]),
                    shader!(
                        gpu,
                        "flood_wet",
                        [parameters, status, works.buffer, *ground, *tallies, *laws, *sums, rates.buffer]
                    ),
                    shader!(gpu, "flood_share", [parameters, status, particles, *ground, *tallies, *sums]),
                ]
            }),
            drops: weather.map(|Weather { ground, sums, .. }| {
                shader!(gpu, "flood_drops", [parameters, status, particles, (), (), (), *ground, *sums, groups])
            }),
            land: air.map(|air| {
                [
                    shader!(
                        gpu,
                        "flood_land",
                        [
                            parameters,
                            status,
                            particles,
                            sort.start,
                            (),
                            *nodes,
                            near,
                            walls.start,
                            walls.sites,
                            air.buffer
                        ]
                    ),
                    shader!(gpu, "flood_landed", [status, air.buffer, groups]),
                ]
            }),
            leave: shader!(
                gpu,
                "flood_leave",
                [parameters, status, particles, (), (), partials, (), sort.counts, sort.places, keys]
            ),
            moves: (!comes_between).then(|| {
                shader!(
                    gpu,
                    "flood_move",
                    [
                        parameters,
                        status,
                        particles,
                        walls.outlines,
                        walls.knocks,
                        partials,
                        *rough,
                        sort.counts,
                        sort.places,
                        keys
                    ]
                )
            }),
            reorder: shader!(
                gpu,
                "flood_reorder",
                [parameters, status, sort.start, sort.order, particles, sorted, sites]
            ),
            reach_own: shader!(gpu, "flood_reach_own", [parameters, sort.start, sites, own]),
            reach_rows: shader!(gpu, "flood_reach_rows", [parameters, own, along_rows]),
            reach: shader!(gpu, "flood_reach", [parameters, along_rows, near]),
            density: if is_sph_swe {
                shader!(
                    gpu,
                    "flood_sph_swe_density",
                    [parameters, status, sort.start, sites, sorted, columns, walls.start, walls.sites, *nodes]
                )
            } else {
                shader!(
                    gpu,
                    "flood_density",
                    [parameters, status, sort.start, near, sites, sorted, columns, walls.start, walls.sites, *nodes]
                )
            },
            gradients: (!is_sph_swe).then(|| {
                shader!(
                    gpu,
                    "flood_slopes",
                    [parameters, status, sort.start, near, columns, sorted, slopes, walls.start, walls.sites, *nodes]
                )
            }),
            push: match (has_walls, is_sph_swe) {
                (false, _) => None,
                (true, false) => Some(shader!(
                    gpu,
                    "flood_push",
                    [parameters, status, columns, slopes, walls.start, walls.sites, sorted, pushes]
                )),
                (true, true) => Some(shader!(
                    gpu,
                    "flood_sph_swe_push",
                    [parameters, status, columns, walls.start, walls.sites, sorted, pushes]
                )),
            },
            on_obstacles: has_walls.then(|| {
                shader!(gpu, "flood_on_obstacles", [parameters, status, sort.start, pushes, walls.on_obstacles])
            }),
            obstacles: walls.count as u32,
            forces: if is_sph_swe {
                shader!(
                    gpu,
                    "flood_sph_swe_forces",
                    [parameters, status, sort.start, columns, sorted, particles, partials, *nodes, *rough]
                )
            } else {
                shader!(
                    gpu,
                    "flood_forces",
                    [
                        parameters, status, sort.start, near, columns, slopes, sorted, particles, partials, *nodes,
                        *rough
                    ]
                )
            },
            finish: shader!(gpu, "flood_finish", [parameters, status, partials, groups, works.buffer, due, looks]),
            gauges: None,
            maps: None,
            parameters,
            status,
            particles,
            births,
            bytes,
            sorted,
            groups,
            sort,
            due,
            looks,
            near,
        })
    }
}
