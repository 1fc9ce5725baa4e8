//! The passes of a step, each with what it works on.

use super::layout::{CardBirth, CardParticle, Column, Parameters, Partial, Slopes, Status};
use super::walls::Walls;
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
];

/// Slots of the numbers of groups: see `flood_finish.wgsl`.
const SLOTS: SortSlots = SortSlots { particles: 0, cells: 1, blocks: 2, once: 3 };

/// Everything on the device.
#[derive(Debug)]
pub(super) struct Tasks {
    pub parameters: wgpu::Buffer,
    pub status: wgpu::Buffer,
    pub particles: wgpu::Buffer,
    pub slopes: wgpu::Buffer,
    pub births: wgpu::Buffer,
    /// Bytes held.
    pub bytes: u64,
    sorted: wgpu::Buffer,
    groups: wgpu::Buffer,
    sort: CellSort,
    drift: Task,
    bear: Task,
    reorder: Task,
    reach_own: Task,
    reach_rows: Task,
    reach: Task,
    density: Task,
    gradients: Task,
    /// What obstacles do, where there are any.
    push: Option<Task>,
    on_obstacles: Option<Task>,
    obstacles: u32,
    forces: Task,
    finish: Task,
}

impl Tasks {
    /// For so many particles, cells, and births between two words of the host, at most.
    pub fn new(
        gpu: &Gpu,
        count: usize,
        cells: usize,
        most_births: usize,
        nodes: &wgpu::TextureView,
        walls: &Walls,
    ) -> Result<Self, GpuError> {
        let parameters = uniform(gpu, "parameters of the flood", &Parameters::default());
        let status = storage::<Status>(gpu, "status", 1)?;
        let groups = storage::<[u32; 3]>(gpu, "groups", 4)?;
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
        let bytes = of_particles.into_iter().chain(of_cells).map(wgpu::Buffer::size).sum();
        let task = |name, text, buffers: &[&wgpu::Buffer], nodes: Option<&wgpu::TextureView>| {
            let buffers = buffers.iter().map(|buffer| buffer.as_entire_binding());
            let resources: Vec<_> = buffers.chain(nodes.map(wgpu::BindingResource::TextureView)).collect();
            Kernel::new(gpu, name, text, LIBRARY).on(gpu, &resources)
        };
        macro_rules! shader {
            ($name:literal, [$($buffer:expr),*], $nodes:expr) => {
                task($name, include_str!(concat!($name, ".wgsl")), &[$(&$buffer),*], $nodes)
            };
        }
        let (none, ground) = (None, Some(nodes));
        Ok(Self {
            drift: shader!(
                "flood_drift",
                [parameters, status, particles, sort.counts, sort.places, keys, partials, walls.outlines, walls.knocks],
                none
            ),
            bear: shader!(
                "flood_births",
                [parameters, status, particles, sort.start, sort.counts, sort.places, keys, births, groups],
                ground
            ),
            reorder: shader!("flood_reorder", [status, sort.start, sort.order, particles, sorted, sites], none),
            reach_own: shader!("flood_reach_own", [parameters, sort.start, sites, own], none),
            reach_rows: shader!("flood_reach_rows", [parameters, own, along_rows], none),
            reach: shader!("flood_reach", [parameters, along_rows, reaches], none),
            density: shader!(
                "flood_density",
                [parameters, status, sort.start, reaches, sites, sorted, columns, walls.start, walls.sites],
                ground
            ),
            gradients: shader!(
                "flood_slopes",
                [parameters, status, sort.start, reaches, columns, sorted, slopes, walls.start, walls.sites],
                ground
            ),
            push: (walls.count > 0).then(|| {
                shader!(
                    "flood_push",
                    [parameters, status, columns, slopes, walls.start, walls.sites, sorted, pushes],
                    none
                )
            }),
            on_obstacles: (walls.count > 0).then(|| {
                shader!("flood_on_obstacles", [parameters, status, sort.start, pushes, walls.on_obstacles], none)
            }),
            obstacles: walls.count as u32,
            forces: shader!(
                "flood_forces",
                [parameters, status, sort.start, reaches, columns, slopes, sorted, particles, partials],
                ground
            ),
            finish: shader!("flood_finish", [parameters, status, partials, groups], none),
            parameters,
            status,
            particles,
            slopes,
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
        self.drift.run_as_told(&mut pass, &self.groups, SLOTS.particles);
        self.sort.sort(&mut pass, &self.groups, SLOTS);
        self.reorder.run_as_told(&mut pass, &self.groups, SLOTS.particles);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.sorted, 0, &self.particles, 0, self.particles.size());
        gpu.queue.submit([encoder.finish()]);
    }

    fn step(&self, pass: &mut wgpu::ComputePass<'_>) {
        let groups = &self.groups;
        self.drift.run_as_told(pass, groups, SLOTS.particles);
        self.bear.run(pass, 1);
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.run_as_told(pass, groups, SLOTS.particles);
        self.reach_own.run_as_told(pass, groups, SLOTS.cells);
        self.reach_rows.run_as_told(pass, groups, SLOTS.cells);
        self.reach.run_as_told(pass, groups, SLOTS.cells);
        self.density.run_as_told(pass, groups, SLOTS.particles);
        self.gradients.run_as_told(pass, groups, SLOTS.particles);
        if let (Some(push), Some(on_obstacles)) = (&self.push, &self.on_obstacles) {
            push.run_as_told(pass, groups, SLOTS.particles);
            on_obstacles.run(pass, self.obstacles);
        }
        self.forces.run_as_told(pass, groups, SLOTS.particles);
        self.finish.run(pass, 1);
    }
}
