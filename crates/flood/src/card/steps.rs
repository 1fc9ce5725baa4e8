//! The order of the passes.

use super::layout::Status;
use super::tasks::Tasks;
use corpuscle_gpu::{Gpu, Pass, SortSlots, THREADS, sort_blocks, wgpu};

/// Slots of the numbers of groups: see `flood_finish.wgsl`.
const SLOTS: SortSlots = SortSlots { particles: 0, cells: 1, blocks: 2, once: 3 };

/// Slots beyond those of the sort: particles that it rains on, and cells of the ground.
const WEATHER: [u64; 2] = [4, 5];

/// The slot of particles in the air.
const IN_AIR: u64 = 7;

/// The slot of particles that may be split and merged.
const REFINED: u64 = 8;

impl Tasks {
    /// Decides whether to go on, and then takes so many steps, or fewer: from where it is to halt they do nothing.
    pub fn steps(&self, pass: &mut Pass<'_>, count: u32) {
        self.end_step(pass);
        for _ in 0..count {
            self.step(pass);
        }
    }

    /// Decides whether to go on, reads the gauges where a row is due, and looks at the maps where it is time to.
    fn end_step(&self, pass: &mut Pass<'_>) {
        self.finish.run(pass, 1);
        if let Some(maps) = &self.maps {
            maps.look(pass, &self.groups);
        }
        if let Some(gauges) = &self.gauges {
            gauges.take(pass, &self.groups);
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
        let mut pass = Pass::begin(&mut encoder, None);
        self.leave.run_as_told(&mut pass, &self.groups, SLOTS.particles);
        self.sort(&mut pass);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.sorted, 0, &self.particles, 0, self.particles.size());
        gpu.queue.submit([encoder.finish()]);
    }

    /// Sorts what has counted itself, and finds how far each cell must look.
    fn sort(&self, pass: &mut Pass<'_>) {
        let groups = &self.groups;
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.run_as_told(pass, groups, SLOTS.particles);
        self.reach_own.run_as_told(pass, groups, SLOTS.cells);
        self.reach_rows.run_as_told(pass, groups, SLOTS.cells);
        self.reach.run_as_told(pass, groups, SLOTS.cells);
    }

    /// Takes one step more, where there is to be one.
    pub fn step(&self, pass: &mut Pass<'_>) {
        let groups = &self.groups;
        if let Some(carry) = &self.carry {
            carry.run_as_told(pass, groups, SLOTS.particles);
        }
        match &self.moves {
            Some(moves) => moves.run_as_told(pass, groups, SLOTS.particles),
            None => self.move_and_exchange(pass),
        }
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
        self.end_step(pass);
    }

    /// Moves the particles, and what comes in and goes out while they do.
    fn move_and_exchange(&self, pass: &mut Pass<'_>) {
        let groups = &self.groups;
        self.drift.run_as_told(pass, groups, SLOTS.particles);
        if let Some([plan, make_room, refine]) = &self.refine {
            plan.run_as_told(pass, groups, REFINED);
            make_room.run(pass, 1);
            refine.run_as_told(pass, groups, REFINED);
        }
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
    }
}
