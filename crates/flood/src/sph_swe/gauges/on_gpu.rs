//! Gauges that the device reads itself: rows stay there until the host downloads them together with the status.

use super::Reading;
use crate::sampling::Sample;
use crate::sph_swe::gpu::OnGpu;
use crate::sph_swe::gpu::shared::{GAUGES, Memory, OF_OBSTACLE, OF_POSITION, POSITIONS, STORED, Status, TOTALS};
use crate::sph_swe::gpu::tasks::{Shader, Tasks, task};
use corpuscle_gpu::{Gpu, GpuError, Pass, Task, from_pair, read_together, storage, to_pair, wgpu};

/// Most rows that are stored on the device at a time.
pub(in crate::sph_swe) const MOST_ROWS: usize = 64;

/// Shaders that sum the water, write its totals and those of obstacles, and sample positions.
pub(in crate::sph_swe) const SHADERS: [Shader; 3] = [
    ("sph_volumes", include_str!("sph_volumes.wgsl")),
    ("sph_totals", include_str!("sph_totals.wgsl")),
    ("sph_gauges", include_str!("sph_gauges.wgsl")),
];

/// The slot of each in the numbers of groups.
const SLOTS: [u32; 3] = [GAUGES, GAUGES + 1, GAUGES + 2];

/// Number of positions and obstacles in each row.
#[derive(Debug, Clone, Copy)]
struct Extent {
    positions: usize,
    obstacles: usize,
}

impl Extent {
    /// Words before the first row.
    fn first(self) -> usize {
        POSITIONS as usize + 2 * self.positions
    }

    /// Words before the positions of a row.
    fn before_positions(self) -> usize {
        (TOTALS + OF_OBSTACLE * self.obstacles as u32) as usize
    }

    /// Words of a row.
    fn stride(self) -> usize {
        self.before_positions() + OF_POSITION as usize * self.positions
    }
}

/// The tasks that fill the rows.
#[derive(Debug)]
pub(in crate::sph_swe) struct Gauges {
    /// The positions in model coordinates.
    positions: Vec<[f64; 2]>,
    extent: Extent,
    tasks: [Task; 3],
}

impl Gauges {
    /// Fills the rows that are due, if any.
    pub fn take(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer) {
        self.tasks.iter().zip(SLOTS).for_each(|(task, slot)| task.dispatch_indirect(pass, groups, slot));
    }
}

impl Tasks {
    /// The status after a batch, and the words of `count` rows of gauges.
    pub(in crate::sph_swe) async fn download(&self, gpu: &Gpu, count: usize) -> Result<(Status, Vec<u32>), GpuError> {
        let Memory { status, rows, .. } = &self.memory;
        let extent = self.gauges.as_ref().filter(|_| count > 0).map(|gauges| gauges.extent);
        let [first, end] = extent.map_or([0; 2], |extent| [extent.first(), extent.first() + count * extent.stride()]);
        let parts = [(status, size_of::<Status>()), (rows, 4 * end)];
        let [status, words] = read_together(gpu, parts, bytemuck::pod_collect_to_vec::<u8, u32>).await?;
        Ok((bytemuck::pod_read_unaligned(bytemuck::cast_slice(&status)), words[first..].to_vec()))
    }
}

impl OnGpu {
    /// Sets the positions of the gauges.
    pub fn measure(&mut self, positions: &[[f64; 2]]) -> Result<(), GpuError> {
        if self.tasks.gauges.as_ref().is_some_and(|gauges| gauges.positions == positions) {
            return Ok(());
        }
        let extent = Extent { positions: positions.len(), obstacles: self.obstacles.count };
        let (first, stride) = (extent.first(), extent.stride());
        let rows = storage::<u32>(self.gpu(), "rows of gauges", first + MOST_ROWS * stride)?;
        let header = [first, stride, extent.obstacles].map(|number| number as u32);
        let relative = positions.iter().flat_map(|position| self.origin.relative(*position).map(f32::to_bits));
        let uploaded: Vec<u32> = header.into_iter().chain(relative).collect();
        self.gpu().queue.write_buffer(&rows, 0, bytemuck::cast_slice(&uploaded));
        self.tasks.memory.rows = rows;
        let tasks = SHADERS.map(|shader| task(self.gpu(), shader, &self.tasks.memory));
        self.tasks.gauges = Some(Gauges { positions: positions.to_vec(), extent, tasks });
        Ok(())
    }

    /// Uploads the times at which rows are due, s.
    pub(in crate::sph_swe) fn upload_gauge_times(&mut self, due: &[f64]) {
        let due: Vec<[f32; 2]> = due.iter().map(|&time| to_pair(time - self.clock_began)).collect();
        self.gpu().queue.write_buffer(&self.tasks.memory.due, 0, bytemuck::cast_slice(&due));
        self.status.rows_uploaded = due.len() as u32;
        (self.status.rows_taken, self.status.rows_due) = (0, 0);
        self.status.gauge_positions = self.tasks.gauges.as_ref().map_or(0, |gauges| gauges.positions.len() as u32);
    }

    /// The rows of gauges of a batch. Inflow and outflow count from the start of the batch.
    pub(in crate::sph_swe) fn readings(&self, words: &[u32]) -> Vec<Reading> {
        let Some(gauges) = &self.tasks.gauges else { return Vec::new() };
        let taken = (self.status.rows_taken + self.status.rows_due) as usize;
        let rows = words.chunks_exact(gauges.extent.stride()).take(taken);
        rows.map(|row| self.reading(row, gauges.extent)).collect()
    }

    fn reading(&self, row: &[u32], extent: Extent) -> Reading {
        let number = |at: usize| f64::from(f32::from_bits(row[at]));
        let pair = |at: usize| from_pair([at, at + 1].map(|at| f32::from_bits(row[at])));
        let first = |obstacle: usize| (TOTALS + OF_OBSTACLE * obstacle as u32) as usize;
        let force = |obstacle: usize| [0, 1].map(|axis| number(first(obstacle) + axis));
        let impulse = |obstacle: usize| {
            let at = first(obstacle);
            [0, 1].map(|axis| self.impulse(obstacle, axis, pair(at + 2 + 2 * axis), row[at + 6 + axis] as i32))
        };
        let samples = row[extent.before_positions()..].chunks_exact(OF_POSITION as usize).map(|sample| {
            let [depth, east, north] = [0, 1, 2].map(|at| f64::from(f32::from_bits(sample[at])));
            Sample { depth, velocity: [east, north] }
        });
        Reading {
            samples: samples.collect(),
            on_obstacles: (0..extent.obstacles).map(force).collect(),
            impulses: (0..extent.obstacles).map(impulse).collect(),
            inflow: pair(0),
            outflow: pair(2),
            stored: number(STORED as usize),
        }
    }
}
