//! Counting sort into cells, on the device: count, scan, scatter, and order within each cell.
//!
//! The model's own kernel counts: for each particle it adds 1 to [`CellSort::counts`] of its cell and writes
//! [`CellSort::places`], the cell and what the count was before. [`CellSort::sort`] does the rest and leaves the counts at zero.
//! Particles of one cell come in the order of their keys, so that the result is the same however the threads ran.

use crate::{Gpu, GpuError, Kernel, Pass, SUMS_BEFORE, ShaderLibrary, THREADS, Task, storage};

/// Counts that one group of threads adds up.
const BLOCK: usize = 1024;

const LIBRARY: ShaderLibrary<'_> = &[("sort_groups", include_str!("sort_groups.wgsl")), SUMS_BEFORE];

/// Memory and kernels for sorting at most so many particles into at most so many cells.
#[derive(Debug)]
pub struct CellSort {
    /// Particles of each cell: `u32`, atomic. Zero before the counting and after the sort.
    pub counts: wgpu::Buffer,
    /// The cell of each particle, and how many of that cell were counted before: two `u32`.
    pub places: wgpu::Buffer,
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

/// Where the numbers of groups stand in the buffer that tells them: see [`Task::run_as_told`].
#[derive(Debug, Clone, Copy)]
pub struct SortSlots {
    /// One thread a particle.
    pub particles: u64,
    /// One thread a cell.
    pub cells: u64,
    /// One group for [`sort_blocks`] cells.
    pub blocks: u64,
    /// One group in all, or none.
    pub once: u64,
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
        let counts = storage::<u32>(gpu, "counts of cells", cells)?;
        let places = storage::<[u32; 2]>(gpu, "places in cells", particles)?;
        let start = storage::<u32>(gpu, "starts of cells", cells + 1)?;
        let order = storage::<u32>(gpu, "order", particles)?;
        let totals = storage::<u32>(gpu, "totals of blocks", sort_blocks(cells))?;
        let task = |name, text, buffers: &[&wgpu::Buffer]| {
            let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
            Kernel::new(gpu, name, text, LIBRARY).on(gpu, &resources)
        };
        let tasks = Tasks {
            blocks: task("sort_blocks", include_str!("sort_blocks.wgsl"), &[sizes, &counts, &start, &totals]),
            totals: task("sort_totals", include_str!("sort_totals.wgsl"), &[sizes, &totals]),
            starts: task("sort_starts", include_str!("sort_starts.wgsl"), &[sizes, &start, &totals]),
            scatter: task("sort_scatter", include_str!("sort_scatter.wgsl"), &[sizes, &places, &start, &order]),
            tidy: task("sort_tidy", include_str!("sort_tidy.wgsl"), &[sizes, &start, keys, &order]),
        };
        Ok(Self { counts, places, start, order, tasks })
    }

    /// Sorts what was counted.
    pub fn sort(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer, slots: SortSlots) {
        self.tasks.blocks.run_as_told(pass, groups, slots.blocks);
        self.tasks.totals.run_as_told(pass, groups, slots.once);
        self.tasks.starts.run_as_told(pass, groups, slots.cells);
        self.tasks.scatter.run_as_told(pass, groups, slots.particles);
        self.tasks.tidy.run_as_told(pass, groups, slots.cells);
    }
}
