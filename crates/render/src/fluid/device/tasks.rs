//! Memory for the particles of a model on the device, and the passes over them.

use super::ground::Ground;
use super::kernels::Kernels;
use super::shared::{BORDER_GROUP, Memory, ON_GROUND, SETTLING, Sizes};
use crate::shared::{DropletInstance, SPLAT_COUNT};
use corpuscle_gpu::{CellSort, DeviceParticles, Gpu, GpuError, Pass, SortSlots, Stopwatch, Task, storage, wgpu};

/// Slots of the numbers of groups: see [`Memory::groups`].
const SLOTS: SortSlots = SortSlots::FIRST;

/// Pairs of passes that limit slopes, at most. After a pair heights are in the buffer where they were before.
const SETTLINGS: usize = 6;

/// For the particles of one model.
#[derive(Debug)]
pub(super) struct Tasks {
    pub memory: Memory,
    /// Foam by ids: what is read and what is written, in turn.
    tables: [wgpu::Buffer; 2],
    sort: CellSort,
    begin: Task,
    count: Task,
    columns: Task,
    draw_arguments: Task,
    settle: [Task; 2],
    settled: Task,
    calm: Task,
    discs: Task,
    foam: [Task; 2],
    levels: Task,
    faces: Task,
    /// Index of the table that is read next.
    turn: usize,
}

/// Entries of the memory of foam for so many particles: twice as many, and a power of two.
pub(super) fn entries(room: usize) -> usize {
    (2 * room.max(1)).next_power_of_two()
}

impl Tasks {
    /// For particles in so many cells, over this ground, with the numbers of the picture.
    pub fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        particles: &DeviceParticles,
        cells: usize,
        ground: &Ground,
        water: &wgpu::Buffer,
    ) -> Result<Self, GpuError> {
        let room = particles.room;
        let sizes = storage::<Sizes>(gpu, "sizes of water", 1)?;
        let keys = storage::<u32>(gpu, "keys of water", room)?;
        let sort = CellSort::new(gpu, room, cells, &sizes, &keys)?;
        let columns = || storage::<[f32; 4]>(gpu, "columns of water", room);
        let table = || storage::<f32>(gpu, "foam before", entries(room));
        let tables = [table()?, table()?];
        let memory = Memory {
            water: water.clone(),
            seen: particles.buffer.clone(),
            sizes,
            groups: storage::<u32>(gpu, "groups of water", SPLAT_COUNT as usize + 1)?,
            counts: sort.counts.clone(),
            cell_slots: sort.cell_slots.clone(),
            keys,
            start: sort.start.clone(),
            order: sort.order.clone(),
            heights: ground.heights.clone(),
            sites: columns()?,
            motions: columns()?,
            settled: columns()?,
            calmed: columns()?,
            matter: storage::<[u32; 4]>(gpu, "matter of water", room)?,
            foam: storage::<f32>(gpu, "fresh foam", room)?,
            before: tables[0].clone(),
            after: tables[1].clone(),
            instances: storage::<DropletInstance>(gpu, "droplets", room)?,
            levels: ground.levels.clone(),
            vertices: ground.faces.clone(),
        };
        // What one pass leaves is what the next begins with.
        let back = Memory { sites: memory.settled.clone(), settled: memory.sites.clone(), ..memory.clone() };
        let calm = Memory { sites: memory.settled.clone(), motions: memory.calmed.clone(), ..memory.clone() };
        let [before, after] = tables.clone();
        let turned = Memory { before: after, after: before, ..calm.clone() };
        Ok(Self {
            begin: kernels.begin.on(gpu, &memory),
            count: kernels.count.on(gpu, &memory),
            columns: kernels.columns.on(gpu, &memory),
            draw_arguments: kernels.draw_arguments.on(gpu, &memory),
            settle: [&memory, &back].map(|memory| kernels.settle.on(gpu, memory)),
            settled: kernels.settled.on(gpu, &memory),
            calm: kernels.calm.on(gpu, &memory),
            discs: kernels.discs.on(gpu, &calm),
            levels: kernels.levels.on(gpu, &memory),
            faces: kernels.faces.on(gpu, &memory),
            foam: [&calm, &turned].map(|memory| kernels.foam.on(gpu, memory)),
            memory,
            tables,
            sort,
            turn: 0,
        })
    }

    /// Copies the stored foam of another, with as much memory or less.
    pub fn remember(&self, gpu: &Gpu, before: &Self) {
        let (from, to) = (&before.tables[before.turn], &self.tables[self.turn]);
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
        encoder.clear_buffer(&self.tables[1 - self.turn], 0, None);
        let mut pass = Pass::begin(&mut encoder, stopwatch.as_deref_mut());
        let groups = &self.memory.groups;
        self.begin.run(&mut pass, 1);
        self.count.dispatch_indirect(&mut pass, groups, SLOTS.particles);
        self.sort.sort(&mut pass, groups, SLOTS);
        self.draw_arguments.run(&mut pass, 1);
        self.columns.dispatch_indirect(&mut pass, groups, SLOTS.particles);
        for settle in [&self.settle; SETTLINGS].into_iter().flatten() {
            settle.dispatch_indirect(&mut pass, groups, SETTLING);
            self.settled.run(&mut pass, 1);
        }
        self.calm.dispatch_indirect(&mut pass, groups, SLOTS.particles);
        self.discs.dispatch_indirect(&mut pass, groups, SLOTS.particles);
        self.foam[self.turn].dispatch_indirect(&mut pass, groups, ON_GROUND);
        for task in [&self.levels, &self.faces] {
            task.run(&mut pass, ground.border_nodes().div_ceil(BORDER_GROUP));
        }
        drop(pass);
        stopwatch.iter().for_each(|stopwatch| stopwatch.end(&mut encoder));
        gpu.queue.submit([encoder.finish()]);
        self.turn = 1 - self.turn;
    }
}
