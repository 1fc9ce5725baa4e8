//! Counting sort into cells, on the device: count, scan, scatter, and order within each cell.
//!
//! The model's own kernel counts: for each particle it adds 1 to [`CellSort::counts`] of its cell and writes
//! [`CellSort::cell_slots`], the cell and what the count was before. [`CellSort::sort`] does the rest and leaves the counts at zero.
//! Particles of one cell come in the order of their keys, so that the result is the same however the threads ran.

use crate::{Gpu, GpuError, Kernel, Pass, SUMS_BEFORE, THREADS, Task, storage};

/// Counts that one group of threads adds up.
pub(crate) const BLOCK: usize = 1024;

crate::declare! {
    constants {
        /// Threads of a group.
        const GROUP: u32 = THREADS;
        /// Counts that one group adds up.
        const SORT_BLOCK: u32 = BLOCK as u32;
    }
    structs {
        /// Numbers of particles and cells: the beginning of the model's own status.
        struct Sizes {
            /// Particles.
            particles: u32,
            /// Cells.
            cells: u32,
        }
    }

    /// What the kernels of the sort work on.
    buffers Memory {
        /// How many there are.
        storage sizes: Sizes,
        /// Particles of each cell.
        storage counts: [u32],
        /// The cell of each particle, and how many of that cell were counted before.
        storage cell_slots: [[u32; 2]],
        /// First particle of each cell.
        storage start: [u32],
        /// The particles in sorted order.
        storage order: [u32],
        /// Particles in each block of cells, then in all before it.
        storage totals: [u32],
        /// What orders the particles of a cell.
        storage keys: [u32],
    }
}

/// Buffers and kernels that sort particles into cells, up to a number of each.
#[derive(Debug)]
pub struct CellSort {
    /// Particles of each cell: `u32`, atomic. Zero before the counting and after the sort.
    pub counts: wgpu::Buffer,
    /// The cell of each particle, and how many of that cell were counted before: two `u32`.
    pub cell_slots: wgpu::Buffer,
    /// First particle of each cell in sorted order, one entry more than cells: `u32`.
    pub start: wgpu::Buffer,
    /// The particles in sorted order: `u32`.
    pub order: wgpu::Buffer,
    tasks: Tasks,
}

#[derive(Debug)]
struct Tasks {
    blocks: Task,
    totals: Task,
    starts: Task,
    scatter: Task,
    tidy: Task,
}

/// Slots of the numbers of groups in the buffer for indirect dispatch: see [`Task::dispatch_indirect`].
#[derive(Debug, Clone, Copy)]
pub struct SortSlots {
    /// One thread a particle.
    pub particles: u32,
    /// One thread a cell.
    pub cells: u32,
    /// One group for [`sort_blocks`] cells.
    pub blocks: u32,
    /// One group in all, or none.
    pub once: u32,
}

impl SortSlots {
    /// The first slots of a model, in this order.
    pub const FIRST: Self = Self { particles: 0, cells: 1, blocks: 2, once: 3 };
}

/// Groups that add up the counts of so many cells.
pub fn sort_blocks(cells: usize) -> usize {
    cells.div_ceil(BLOCK)
}

impl CellSort {
    /// For `particles` and `cells` at most. `sizes` is a buffer whose first two `u32` are the numbers of particles and of cells at
    /// the time, `keys` holds a `u32` for each particle.
    ///
    /// # Errors
    /// [`GpuError::Memory`].
    pub fn new(
        gpu: &Gpu,
        particles: usize,
        cells: usize,
        sizes: &wgpu::Buffer,
        keys: &wgpu::Buffer,
    ) -> Result<Self, GpuError> {
        let most = crate::MOST_GROUPS as usize * THREADS as usize;
        if particles.max(cells) > most {
            return Err(GpuError::TooMany { count: particles.max(cells), most });
        }
        let memory = Memory {
            sizes: sizes.clone(),
            counts: storage::<u32>(gpu, "counts of cells", cells)?,
            cell_slots: storage::<[u32; 2]>(gpu, "slots in cells", particles)?,
            start: storage::<u32>(gpu, "starts of cells", cells + 1)?,
            order: storage::<u32>(gpu, "order", particles)?,
            totals: storage::<u32>(gpu, "totals of blocks", sort_blocks(cells))?,
            keys: keys.clone(),
        };
        macro_rules! task {
            ($name:literal) => {
                Kernel::new(gpu, $name, include_str!(concat!($name, ".wgsl")), &[SUMS_BEFORE]).on(gpu, &memory)
            };
        }
        let tasks = Tasks {
            blocks: task!("sort_blocks"),
            totals: task!("sort_totals"),
            starts: task!("sort_starts"),
            scatter: task!("sort_scatter"),
            tidy: task!("sort_tidy"),
        };
        let Memory { counts, cell_slots, start, order, .. } = memory;
        Ok(Self { counts, cell_slots, start, order, tasks })
    }

    /// Sorts what was counted.
    pub fn sort(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer, slots: SortSlots) {
        self.tasks.blocks.dispatch_indirect(pass, groups, slots.blocks);
        self.tasks.totals.dispatch_indirect(pass, groups, slots.once);
        self.tasks.starts.dispatch_indirect(pass, groups, slots.cells);
        self.tasks.scatter.dispatch_indirect(pass, groups, slots.particles);
        self.tasks.tidy.dispatch_indirect(pass, groups, slots.cells);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Buffers, check_layouts, check_shader};

    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        check_layouts(&Memory::declaration()).unwrap();
        macro_rules! check {
            ($($name:literal),*) => {$(
                let text = include_str!(concat!($name, ".wgsl"));
                let (text, _) = Memory::declaration().complete($name, text, &[SUMS_BEFORE]).unwrap();
                check_shader(&text).unwrap();
            )*};
        }
        check!("sort_blocks", "sort_totals", "sort_starts", "sort_scatter", "sort_tidy");
    }
}
