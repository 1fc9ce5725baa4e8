//! Memory for the particles of a model on the device, and the passes over them.

use super::super::droplet::Instance;
use super::ground::Ground;
use super::kernels::Kernels;
use corpuscle_gpu::{
    CellSort, DeviceParticles, Gpu, GpuError, Kernel, Pass, SortSlots, Stopwatch, Task, storage, wgpu,
};

/// Slots of the numbers of groups: see `water_begin.wgsl`.
const SLOTS: SortSlots = SortSlots { particles: 0, cells: 1, blocks: 2, once: 3 };
const ON_GROUND: u64 = 4;
const SETTLING: u64 = 5;
/// Threads in a group of those over the nodes of borders.
const BORDER_THREADS: u32 = 64;
/// Numbers in the slots, those of the draw and of splats after them included.
const TOLD: usize = 26;

/// Pairs of looks whether some water stands too steep, where some does. After a pair heights are where they were before.
const SETTLINGS: usize = 6;

/// For the particles of one model.
#[derive(Debug)]
pub(super) struct Tasks {
    /// Particles as they are drawn.
    pub instances: wgpu::Buffer,
    /// Numbers of groups, and the draw.
    pub groups: wgpu::Buffer,
    /// Foam by ids: what is read and what is written, in turn.
    memory: [wgpu::Buffer; 2],
    sort: CellSort,
    begin: Task,
    count: Task,
    columns: Task,
    told: Task,
    settle: [Task; 2],
    settled: Task,
    calm: Task,
    discs: Task,
    foam: [Task; 2],
    levels: Task,
    faces: Task,
    /// Which of the memories is read next.
    turn: usize,
}

/// Entries of the memory of foam for so many particles: twice as many, and a power of two.
pub(super) fn entries(room: usize) -> usize {
    (2 * room.max(1)).next_power_of_two()
}

impl Tasks {
    /// For particles in so many cells, over this ground, with the numbers of `water_device.wgsl`.
    pub fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        particles: &DeviceParticles,
        cells: usize,
        ground: &Ground,
        water: &wgpu::Buffer,
    ) -> Result<Self, GpuError> {
        let room = particles.room;
        let Ground { heights, levels, faces, .. } = ground;
        let seen = &particles.buffer;
        let sizes = &storage::<u32>(gpu, "sizes of water", 4)?;
        let groups = storage::<u32>(gpu, "groups of water", TOLD)?;
        let keys = &storage::<u32>(gpu, "keys of water", room)?;
        let columns = || storage::<[f32; 4]>(gpu, "columns of water", room);
        let (sites, settled, motions, calm) = (&columns()?, &columns()?, &columns()?, &columns()?);
        let matter = &storage::<[u32; 4]>(gpu, "matter of water", room)?;
        let fresh = &storage::<f32>(gpu, "fresh foam", room)?;
        let instances = storage::<Instance>(gpu, "droplets", room)?;
        let table = || storage::<f32>(gpu, "foam before", entries(room));
        let memory = [table()?, table()?];
        let sort = CellSort::new(gpu, room, cells, sizes, keys)?;
        let start = &sort.start;
        let foam =
            |before, after| on(gpu, &kernels.foam, &[water, start, settled, matter, fresh, before, after, &instances]);
        Ok(Self {
            begin: on(gpu, &kernels.begin, &[water, seen, sizes, &groups]),
            count: on(gpu, &kernels.count, &[water, seen, sizes, &sort.counts, &sort.places, keys]),
            columns: on(gpu, &kernels.columns, &[water, seen, start, &sort.order, heights, sites, motions, matter]),
            told: on(gpu, &kernels.told, &[water, start, &groups]),
            settle: [
                on(gpu, &kernels.settle, &[water, start, sites, motions, settled, sizes]),
                on(gpu, &kernels.settle, &[water, start, settled, motions, sites, sizes]),
            ],
            settled: on(gpu, &kernels.settled, &[sizes, &groups]),
            calm: on(gpu, &kernels.calm, &[water, start, sites, motions, settled, calm]),
            discs: on(gpu, &kernels.discs, &[water, start, settled, calm, matter, &instances, fresh, sizes]),
            levels: on(gpu, &kernels.levels, &[water, start, &instances, heights, sizes, levels]),
            faces: on(gpu, &kernels.faces, &[water, heights, levels, faces]),
            foam: [foam(&memory[0], &memory[1]), foam(&memory[1], &memory[0])],
            instances,
            groups,
            memory,
            sort,
            turn: 0,
        })
    }

    /// Takes over the foam of others, with as much memory or less.
    pub fn remember(&self, gpu: &Gpu, before: &Self) {
        let (from, to) = (&before.memory[before.turn], &self.memory[self.turn]);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("foam") });
        // One bit more of an id was no part of where its foam was before: it is in both halves.
        for part in 0..to.size() / from.size() {
            encoder.copy_buffer_to_buffer(from, 0, to, part * from.size(), from.size());
        }
        gpu.queue.submit([encoder.finish()]);
    }

    /// Makes the particles as they are drawn.
    pub fn run(&mut self, gpu: &Gpu, ground: &Ground, mut stopwatch: Option<&mut Stopwatch>) {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("water") });
        encoder.clear_buffer(&self.memory[1 - self.turn], 0, None);
        let mut pass = Pass::begin(&mut encoder, stopwatch.as_deref_mut());
        let groups = &self.groups;
        self.begin.run(&mut pass, 1);
        self.count.run_as_told(&mut pass, groups, SLOTS.particles);
        self.sort.sort(&mut pass, groups, SLOTS);
        self.told.run(&mut pass, 1);
        self.columns.run_as_told(&mut pass, groups, SLOTS.particles);
        for settle in [&self.settle; SETTLINGS].into_iter().flatten() {
            settle.run_as_told(&mut pass, groups, SETTLING);
            self.settled.run(&mut pass, 1);
        }
        self.calm.run_as_told(&mut pass, groups, SLOTS.particles);
        self.discs.run_as_told(&mut pass, groups, SLOTS.particles);
        self.foam[self.turn].run_as_told(&mut pass, groups, ON_GROUND);
        for task in [&self.levels, &self.faces] {
            task.run(&mut pass, ground.border_nodes().div_ceil(BORDER_THREADS));
        }
        drop(pass);
        stopwatch.iter().for_each(|stopwatch| stopwatch.end(&mut encoder));
        gpu.queue.submit([encoder.finish()]);
        self.turn = 1 - self.turn;
    }
}

fn on(gpu: &Gpu, kernel: &Kernel, buffers: &[&wgpu::Buffer]) -> Task {
    let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
    kernel.on(gpu, &resources)
}
