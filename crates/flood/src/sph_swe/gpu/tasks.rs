//! The passes of a step, and their order.

use super::shared::{Memory, Status};
use super::upload::GpuInputs;
use crate::sph_swe::gauges::on_gpu::Gauges;
use crate::sph_swe::maps::on_gpu::GpuMaps;
use corpuscle_gpu::{
    COMPENSATED_SUMS, CellSort, GROUP_REDUCTION, Gpu, Kernel as GpuKernel, Pass, SUMS_BEFORE, ShaderLibrary, SortSlots,
    THREADS, Task, sort_blocks, wgpu,
};
use corpuscle_sph::kernel::{CUBIC_SPLINE_SHAPE, KERNEL_PIECE, Kernel};

/// Pieces that the shaders import, but for the smoothing kernel.
const LIBRARY: ShaderLibrary<'_> = &[
    SUMS_BEFORE,
    COMPENSATED_SUMS,
    GROUP_REDUCTION,
    CUBIC_SPLINE_SHAPE,
    ("sph_common", include_str!("sph_common.wgsl")),
    ("sph_ground", include_str!("../ground/sph_ground.wgsl")),
    ("friction_rate", include_str!("../../friction/friction_rate.wgsl")),
    ("sph_friction", include_str!("../friction/sph_friction.wgsl")),
    ("sph_rows", include_str!("../gauges/sph_rows.wgsl")),
    ("sph_spline", include_str!("../sampling/sph_spline.wgsl")),
    ("sph_neighbours", include_str!("../neighbours/sph_neighbours.wgsl")),
    ("sph_outlines", include_str!("../obstacles/sph_outlines.wgsl")),
    ("sph_water", include_str!("../sampling/sph_water.wgsl")),
];

/// These pieces and the smoothing kernel.
fn pieces_with(kernel: &str) -> Vec<(&str, &str)> {
    let kernels = [(KERNEL_PIECE, kernel), ("sph_kernels", include_str!("sph_kernels.wgsl"))];
    LIBRARY.iter().copied().chain(kernels).collect()
}

/// Name and text of a shader.
pub(in crate::sph_swe) type Shader = (&'static str, &'static str);

const DRIFT: Shader = ("sph_drift", include_str!("../motion/sph_drift.wgsl"));
const SPAWN: Shader = ("sph_spawn", include_str!("../inflow/sph_spawn.wgsl"));
const LAND: Shader = ("sph_land", include_str!("../falling/sph_land.wgsl"));
const LANDED: Shader = ("sph_landed", include_str!("../falling/sph_landed.wgsl"));
const LEAVE: Shader = ("sph_leave", include_str!("../boundaries/sph_leave.wgsl"));
const REORDER: Shader = ("sph_reorder", include_str!("../neighbours/sph_reorder.wgsl"));
const REACH_OWN: Shader = ("sph_reach_own", include_str!("../neighbours/sph_reach_own.wgsl"));
const REACH_ROWS: Shader = ("sph_reach_rows", include_str!("../neighbours/sph_reach_rows.wgsl"));
const REACH: Shader = ("sph_reach", include_str!("../neighbours/sph_reach.wgsl"));
const DENSITY: Shader = ("sph_density", include_str!("../density/sph_density.wgsl"));
const PUSH: Shader = ("sph_push", include_str!("../obstacles/sph_push.wgsl"));
const ON_OBSTACLES: Shader = ("sph_on_obstacles", include_str!("../obstacles/sph_on_obstacles.wgsl"));
const FORCES: Shader = ("sph_forces", include_str!("../forces/sph_forces.wgsl"));
const FINISH: Shader = ("sph_finish", include_str!("sph_finish.wgsl"));

/// Slots of the numbers of groups: see `sph_finish.wgsl`.
const SLOTS: SortSlots = SortSlots::FIRST;

/// The slot of drops in the air.
const IN_AIR: u32 = 4;

/// Everything on the device.
#[derive(Debug)]
pub(in crate::sph_swe) struct Tasks {
    pub memory: Memory,
    sort: CellSort,
    drift: Task,
    /// Where water comes in.
    spawn: Option<Task>,
    /// Where water falls: what falls, and what of it has landed.
    land: Option<[Task; 2]>,
    leave: Task,
    reorder: Task,
    /// In each cell, along rows, and in all.
    reaches: [Task; 3],
    density: Task,
    /// Where there are obstacles: their push on particles, and the particles' on them.
    push: Option<[Task; 2]>,
    obstacles: u32,
    forces: Task,
    finish: Task,
    /// Where the scene has gauges.
    pub gauges: Option<Gauges>,
    /// Where the GPU keeps the maps.
    pub maps: Option<GpuMaps>,
}

/// A shader that needs no smoothing kernel, with what it works on.
pub(in crate::sph_swe) fn task(gpu: &Gpu, (name, text): Shader, memory: &Memory) -> Task {
    GpuKernel::new(gpu, name, text, LIBRARY).on(gpu, memory)
}

impl Tasks {
    /// The passes of a run that work on `memory`.
    pub fn new(gpu: &Gpu, memory: Memory, sort: CellSort, inputs: &GpuInputs<'_>) -> Self {
        let kernel = Kernel::<2>::device_piece(inputs.scheme.kernel);
        let pieces = pieces_with(&kernel);
        let task = |(name, text): Shader| GpuKernel::new(gpu, name, text, &pieces).on(gpu, &memory);
        let obstacles = inputs.surroundings.obstacles.names.len() as u32;
        Self {
            drift: task(DRIFT),
            spawn: (!inputs.sources.is_empty()).then(|| task(SPAWN)),
            land: (inputs.falling > 0).then(|| [LAND, LANDED].map(task)),
            leave: task(LEAVE),
            reorder: task(REORDER),
            reaches: [REACH_OWN, REACH_ROWS, REACH].map(task),
            density: task(DENSITY),
            push: (obstacles > 0).then(|| [PUSH, ON_OBSTACLES].map(task)),
            obstacles,
            forces: task(FORCES),
            finish: task(FINISH),
            gauges: None,
            maps: None,
            memory,
            sort,
        }
    }

    /// Decides whether to go on, and then takes so many steps, or fewer: from where it is to halt they do nothing.
    pub fn steps(&self, pass: &mut Pass<'_>, count: u32) {
        self.end_step(pass);
        for _ in 0..count {
            self.step(pass);
        }
    }

    /// Decides whether to go on, reads the gauges where a row is due, and samples the maps where it is time to.
    fn end_step(&self, pass: &mut Pass<'_>) {
        self.finish.run(pass, 1);
        let groups = &self.memory.groups;
        self.maps.iter().for_each(|maps| maps.sample(pass, groups));
        self.gauges.iter().for_each(|gauges| gauges.take(pass, groups));
    }

    /// Brings the particles into the order of new cells. The status says that the next step is 0 s long, so that nothing moves.
    pub fn arrange(&self, gpu: &Gpu, status: &Status) {
        let Memory { particles, sorted, groups, .. } = &self.memory;
        let threads = |count: u32| [count.div_ceil(THREADS), 1, 1];
        let blocks = [sort_blocks(status.cells as usize) as u32, 1, 1];
        let counts = [threads(status.particles), threads(status.cells), blocks, [1, 1, 1]];
        gpu.queue.write_buffer(&self.memory.status, 0, bytemuck::bytes_of(status));
        gpu.queue.write_buffer(groups, 0, bytemuck::cast_slice(&counts));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("arrange") });
        let mut pass = Pass::begin(&mut encoder, None);
        self.leave.dispatch_indirect(&mut pass, groups, SLOTS.particles);
        self.sort(&mut pass);
        drop(pass);
        encoder.copy_buffer_to_buffer(sorted, 0, particles, 0, particles.size());
        gpu.queue.submit([encoder.finish()]);
    }

    /// Sorts the particles that were counted, and finds the search radius of each cell.
    fn sort(&self, pass: &mut Pass<'_>) {
        let groups = &self.memory.groups;
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.dispatch_indirect(pass, groups, SLOTS.particles);
        self.reaches.iter().for_each(|task| task.dispatch_indirect(pass, groups, SLOTS.cells));
    }

    /// Takes one step more, where there is to be one.
    fn step(&self, pass: &mut Pass<'_>) {
        let groups = &self.memory.groups;
        self.drift.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some(spawn) = &self.spawn {
            spawn.run(pass, 1);
        }
        if let Some([land, landed]) = &self.land {
            land.dispatch_indirect(pass, groups, IN_AIR);
            landed.run(pass, 1);
        }
        self.leave.dispatch_indirect(pass, groups, SLOTS.particles);
        self.sort(pass);
        self.density.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some([push, on_obstacles]) = &self.push {
            push.dispatch_indirect(pass, groups, SLOTS.particles);
            on_obstacles.run(pass, self.obstacles);
        }
        self.forces.dispatch_indirect(pass, groups, SLOTS.particles);
        self.end_step(pass);
    }
}

#[cfg(test)]
mod tests {
    use super::super::seen;
    use super::*;
    use crate::sph_swe::gauges::on_gpu::SHADERS;
    use crate::sph_swe::maps::on_gpu::SHADER;
    use corpuscle_gpu::{Buffers, MOST_STORAGE_BUFFERS, check_shader};

    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        let passes = [
            DRIFT,
            SPAWN,
            LAND,
            LANDED,
            LEAVE,
            REORDER,
            REACH_OWN,
            REACH_ROWS,
            REACH,
            DENSITY,
            PUSH,
            ON_OBSTACLES,
            FORCES,
            FINISH,
        ];
        let others = SHADERS.into_iter().chain([SHADER, seen::SHADER]);
        for (name, text) in passes.into_iter().chain(others) {
            let declaration = Memory::declaration();
            for kernel in corpuscle_scene::KernelName::ALL {
                let kernel = Kernel::<2>::device_piece(kernel);
                let (text, used) = declaration.complete(name, text, &pieces_with(&kernel)).unwrap();
                check_shader(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
                let stored = used.iter().filter(|number| !declaration.bindings[**number as usize].is_uniform).count();
                assert!(stored <= MOST_STORAGE_BUFFERS, "{name} has {stored} storage buffers");
            }
        }
    }
}
