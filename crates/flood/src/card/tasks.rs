//! The passes of a step, each with what it works on.

use super::air::Air;
use super::layout::{CardBirth, CardParticle, Column, Parameters, Partial, Slopes, Status};
use super::walls::Walls;
use super::weather::Weather;
use super::works::Works;
use corpuscle_gpu::{CellSort, Gpu, GpuError, Kernel, SortSlots, THREADS, Task, sort_blocks, storage, uniform, wgpu};

/// Pieces that the shaders import.
const LIBRARY: &[(&str, &str)] = &[
    ("flood_card", include_str!("flood_card.wgsl")),
    ("flood_friction", include_str!("flood_friction.wgsl")),
    ("flood_ground", include_str!("flood_ground.wgsl")),
    ("flood_neighbours", include_str!("flood_neighbours.wgsl")),
    ("flood_columns", include_str!("flood_columns.wgsl")),
    ("flood_walls", include_str!("flood_walls.wgsl")),
    ("flood_outlines", include_str!("flood_outlines.wgsl")),
    ("flood_places", include_str!("flood_places.wgsl")),
    ("flood_water", include_str!("flood_water.wgsl")),
    ("flood_accounts", include_str!("flood_accounts.wgsl")),
    ("flood_laws", include_str!("flood_laws.wgsl")),
    ("flood_wetness", include_str!("flood_wetness.wgsl")),
    ("flood_air", include_str!("flood_air.wgsl")),
    ("flood_sums", include_str!("flood_sums.wgsl")),
    ("flood_paper", include_str!("flood_paper.wgsl")),
];

/// Slots of the numbers of groups: see `flood_finish.wgsl`.
const SLOTS: SortSlots = SortSlots { particles: 0, cells: 1, blocks: 2, once: 3 };

/// Slots beyond those of the sort: particles that it rains on, and cells of the ground.
const WEATHER: [u64; 2] = [4, 5];

/// The slot of particles in the air.
const IN_AIR: u64 = 7;

/// Everything on the device.
#[derive(Debug)]
pub(super) struct Tasks {
    pub parameters: wgpu::Buffer,
    pub status: wgpu::Buffer,
    pub particles: wgpu::Buffer,
    pub births: wgpu::Buffer,
    /// Bytes held.
    pub bytes: u64,
    sorted: wgpu::Buffer,
    groups: wgpu::Buffer,
    sort: CellSort,
    /// Water beyond sides held at levels, and structures, where there are any.
    carry: Option<Task>,
    regulate: Option<Task>,
    drift: Task,
    /// Where water comes in.
    bear: Option<Task>,
    /// Rain and infiltration, where there are any: area covered, cells of the ground, what particles get; and drops.
    weather: Option<[Task; 3]>,
    drops: Option<Task>,
    /// What falls, and what of it has landed.
    land: Option<[Task; 2]>,
    leave: Task,
    reorder: Task,
    reach_own: Task,
    reach_rows: Task,
    reach: Task,
    density: Task,
    /// In scheme balanced.
    gradients: Option<Task>,
    /// What obstacles do, where there are any.
    push: Option<Task>,
    on_obstacles: Option<Task>,
    obstacles: u32,
    forces: Task,
    finish: Task,
}

/// What a shader works on.
enum Resource<'a> {
    Buffer(&'a wgpu::Buffer),
    Texture(&'a wgpu::TextureView),
    /// The shader leaves it alone.
    Unused,
}

impl<'a> Resource<'a> {
    fn binding(&self) -> Option<wgpu::BindingResource<'a>> {
        match *self {
            Self::Buffer(buffer) => Some(buffer.as_entire_binding()),
            Self::Texture(texture) => Some(wgpu::BindingResource::TextureView(texture)),
            Self::Unused => None,
        }
    }
}

impl<'a> From<&'a wgpu::Buffer> for Resource<'a> {
    fn from(buffer: &'a wgpu::Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl From<&()> for Resource<'_> {
    fn from((): &()) -> Self {
        Self::Unused
    }
}

impl<'a> From<&'a wgpu::TextureView> for Resource<'a> {
    fn from(texture: &'a wgpu::TextureView) -> Self {
        Self::Texture(texture)
    }
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
        is_paper: bool,
    ) -> Result<Self, GpuError> {
        let parameters = uniform(gpu, "parameters of the flood", &Parameters::default());
        let status = storage::<Status>(gpu, "status", 1)?;
        let groups = storage::<[u32; 3]>(gpu, "groups", 8)?;
        let particles = storage::<CardParticle>(gpu, "particles", count)?;
        let sorted = storage::<CardParticle>(gpu, "particles in order", count)?;
        let keys = storage::<u32>(gpu, "numbers of particles", count)?;
        let sites = storage::<[f32; 4]>(gpu, "sites", count)?;
        let columns = storage::<Column>(gpu, "columns of water", count)?;
        let slopes = storage::<Slopes>(gpu, "slopes", count)?;
        let births = storage::<CardBirth>(gpu, "particles to come", most_births)?;
        let partials = storage::<Partial>(gpu, "sums of groups", count.div_ceil(THREADS as usize))?;
        let [own, along_rows, reaches] = ["reaches", "reaches of rows", "reaches in cells"];
        let own = storage::<f32>(gpu, own, cells)?;
        let along_rows = storage::<f32>(gpu, along_rows, cells)?;
        let reaches = storage::<f32>(gpu, reaches, cells)?;
        let sort = CellSort::new(gpu, count, cells, &status, &keys)?;
        let pushes = if walls.count > 0 { Walls::pushes(gpu, count)? } else { storage::<[f32; 4]>(gpu, "pushes", 0)? };
        let of_particles = [&pushes, &particles, &sorted, &keys, &sites, &columns, &slopes, &births, &partials];
        let of_cells = [&own, &along_rows, &reaches, &sort.counts, &sort.places, &sort.start, &sort.order];
        let bytes: u64 = of_particles.into_iter().chain(of_cells).map(wgpu::Buffer::size).sum();
        let bytes = bytes + weather.map_or(0, Weather::bytes);
        let task = |name, text, resources: &[Resource<'_>]| {
            Kernel::new(gpu, name, text, LIBRARY).on_those(gpu, resources.iter().map(Resource::binding))
        };
        macro_rules! shader {
            ($name:literal, [$($resource:expr),*]) => {
                task($name, include_str!(concat!($name, ".wgsl")), &[$(Resource::from(&$resource)),*])
            };
        }
        let has_walls = walls.count > 0;
        let comes_in = !works.sources.is_empty() || works.holds_level;
        Ok(Self {
            carry: works.holds_level.then(|| {
                shader!(
                    "flood_carry",
                    [parameters, status, particles, sort.start, (), *nodes, reaches, walls.start, walls.sites]
                )
            }),
            drift: shader!(
                "flood_drift",
                [parameters, status, particles, walls.outlines, walls.knocks, partials, *rough]
            ),
            regulate: works.has_structures.then(|| {
                shader!(
                    "flood_regulate",
                    [
                        parameters,
                        status,
                        particles,
                        sort.start,
                        works.buffer,
                        *nodes,
                        reaches,
                        walls.start,
                        walls.sites
                    ]
                )
            }),
            bear: comes_in.then(|| {
                shader!(
                    "flood_births",
                    [parameters, status, particles, sort.start, works.buffer, *nodes, births, groups]
                )
            }),
            weather: weather.map(|weather| {
                let Weather { ground, tallies, laws, sums, .. } = weather;
                [
                    shader!("flood_cover", [parameters, status, particles, *tallies]),
                    shader!(
                        "flood_wet",
                        [parameters, status, (), (), works.buffer, (), *ground, *tallies, *laws, *sums]
                    ),
                    shader!("flood_share", [parameters, status, particles, *ground, *tallies, *sums]),
                ]
            }),
            drops: weather.map(|Weather { ground, sums, .. }| {
                shader!("flood_drops", [parameters, status, particles, (), (), (), *ground, *sums, groups])
            }),
            land: air.map(|air| {
                [
                    shader!(
                        "flood_land",
                        [
                            parameters,
                            status,
                            particles,
                            sort.start,
                            (),
                            *nodes,
                            reaches,
                            walls.start,
                            walls.sites,
                            air.buffer
                        ]
                    ),
                    shader!("flood_landed", [status, air.buffer, groups]),
                ]
            }),
            leave: shader!("flood_leave", [parameters, status, particles, sort.counts, sort.places, keys, partials]),
            reorder: shader!("flood_reorder", [parameters, status, sort.start, sort.order, particles, sorted, sites]),
            reach_own: shader!("flood_reach_own", [parameters, sort.start, sites, own]),
            reach_rows: shader!("flood_reach_rows", [parameters, own, along_rows]),
            reach: shader!("flood_reach", [parameters, along_rows, reaches]),
            density: if is_paper {
                shader!(
                    "flood_paper_density",
                    [parameters, status, sort.start, sites, sorted, columns, walls.start, walls.sites, *nodes]
                )
            } else {
                shader!(
                    "flood_density",
                    [parameters, status, sort.start, reaches, sites, sorted, columns, walls.start, walls.sites, *nodes]
                )
            },
            gradients: (!is_paper).then(|| {
                shader!(
                    "flood_slopes",
                    [
                        parameters,
                        status,
                        sort.start,
                        reaches,
                        columns,
                        sorted,
                        slopes,
                        walls.start,
                        walls.sites,
                        *nodes
                    ]
                )
            }),
            push: match (has_walls, is_paper) {
                (false, _) => None,
                (true, false) => Some(shader!(
                    "flood_push",
                    [parameters, status, columns, slopes, walls.start, walls.sites, sorted, pushes]
                )),
                (true, true) => Some(shader!(
                    "flood_paper_push",
                    [parameters, status, columns, walls.start, walls.sites, sorted, pushes]
                )),
            },
            on_obstacles: has_walls
                .then(|| shader!("flood_on_obstacles", [parameters, status, sort.start, pushes, walls.on_obstacles])),
            obstacles: walls.count as u32,
            forces: if is_paper {
                shader!(
                    "flood_paper_forces",
                    [parameters, status, sort.start, columns, sorted, particles, partials, *nodes, *rough]
                )
            } else {
                shader!(
                    "flood_forces",
                    [
                        parameters, status, sort.start, reaches, columns, slopes, sorted, particles, partials, *nodes,
                        *rough
                    ]
                )
            },
            finish: shader!("flood_finish", [parameters, status, partials, groups, works.buffer]),
            parameters,
            status,
            particles,
            births,
            bytes,
            sorted,
            groups,
            sort,
        })
    }

    /// Decides whether to go on, and then takes so many steps, or fewer: from where it is to halt they do nothing.
    pub fn steps(&self, pass: &mut wgpu::ComputePass<'_>, count: u32) {
        self.finish.run(pass, 1);
        for _ in 0..count {
            self.step(pass);
        }
    }

    /// Brings the particles into the order of new cells. The status says that the next step is 0 s long, so that nothing moves.
    pub fn arrange(&self, gpu: &Gpu, status: &Status) {
        let threads = |count: u32| [count.div_ceil(THREADS), 1, 1];
        let blocks = [sort_blocks(status.cells as usize) as u32, 1, 1];
        let groups = [threads(status.particles), threads(status.cells), blocks, [1, 1, 1]];
        gpu.queue.write_buffer(&self.status, 0, bytemuck::bytes_of(status));
        gpu.queue.write_buffer(&self.groups, 0, bytemuck::cast_slice(&groups));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("arrange") });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        self.leave.run_as_told(&mut pass, &self.groups, SLOTS.particles);
        self.sort(&mut pass);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.sorted, 0, &self.particles, 0, self.particles.size());
        gpu.queue.submit([encoder.finish()]);
    }

    /// Sorts what has counted itself, and finds how far each cell must look.
    fn sort(&self, pass: &mut wgpu::ComputePass<'_>) {
        let groups = &self.groups;
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.run_as_told(pass, groups, SLOTS.particles);
        self.reach_own.run_as_told(pass, groups, SLOTS.cells);
        self.reach_rows.run_as_told(pass, groups, SLOTS.cells);
        self.reach.run_as_told(pass, groups, SLOTS.cells);
    }

    fn step(&self, pass: &mut wgpu::ComputePass<'_>) {
        let groups = &self.groups;
        if let Some(carry) = &self.carry {
            carry.run_as_told(pass, groups, SLOTS.particles);
        }
        self.drift.run_as_told(pass, groups, SLOTS.particles);
        for task in [&self.regulate, &self.bear].into_iter().flatten() {
            task.run(pass, 1);
        }
        if let Some([land, landed]) = &self.land {
            land.run_as_told(pass, groups, IN_AIR);
            landed.run(pass, 1);
        }
        if let Some(tasks) = &self.weather {
            let [particles, cells] = WEATHER;
            for (task, slot) in tasks.iter().zip([particles, cells, particles]) {
                task.run_as_told(pass, groups, slot);
            }
        }
        if let Some(drops) = &self.drops {
            drops.run(pass, 1);
        }
        self.leave.run_as_told(pass, groups, SLOTS.particles);
        self.sort(pass);
        self.density.run_as_told(pass, groups, SLOTS.particles);
        if let Some(gradients) = &self.gradients {
            gradients.run_as_told(pass, groups, SLOTS.particles);
        }
        if let (Some(push), Some(on_obstacles)) = (&self.push, &self.on_obstacles) {
            push.run_as_told(pass, groups, SLOTS.particles);
            on_obstacles.run(pass, self.obstacles);
        }
        self.forces.run_as_told(pass, groups, SLOTS.particles);
        self.finish.run(pass, 1);
    }
}
