//! Gauges that the device reads itself: rows that wait there until the host takes them, together with what it learns of the steps.

use super::Card;
use super::air::NO_AIR;
use super::layout::{Patch, Status};
use super::resource::shader;
use super::tasks::Tasks;
use crate::gauges::Reading;
use crate::sampling::Sample;
use corpuscle_gpu::{GpuError, Pass, THREADS, Task, read, read_together, storage, wgpu};

/// Rows that wait at a time, at most.
pub(crate) const MOST_ROWS: usize = 64;

/// Numbers before the places, of a row before its flows, of an obstacle and of a place: see `flood_rows.wgsl`.
const HEADER: usize = 4;
const TOTALS: usize = 11;
const OF_OBSTACLE: usize = 8;
const OF_PLACE: usize = 3;

/// Slots of the numbers of groups: see `flood_finish.wgsl`.
const VOLUMES: u64 = 9;
const ROWS: u64 = 10;
const PLACES: u64 = 11;

/// How much each row tells of.
#[derive(Debug, Clone, Copy)]
struct Extent {
    places: usize,
    flows: usize,
    obstacles: usize,
}

impl Extent {
    /// Numbers before the first row.
    fn first(self) -> usize {
        HEADER + 2 * self.places
    }

    /// Numbers before the places of a row.
    fn before_places(self) -> usize {
        TOTALS + self.flows + OF_OBSTACLE * self.obstacles
    }

    /// Numbers in a row.
    fn stride(self) -> usize {
        self.before_places() + OF_PLACE * self.places
    }
}

/// Rows on the device, and what fills them.
#[derive(Debug)]
pub(super) struct Gauges {
    /// The places in model coordinates.
    places: Vec<[f64; 2]>,
    extent: Extent,
    rows: wgpu::Buffer,
    volumes: Task,
    totals: Task,
    samples: Task,
}

impl Gauges {
    fn new(card: &Card, places: &[[f64; 2]]) -> Result<Self, GpuError> {
        let Card { gpu, tasks, walls, works, .. } = card;
        let extent = Extent { places: places.len(), flows: works.flow_count(), obstacles: walls.count };
        let (first, stride) = (extent.first(), extent.stride());
        let rows = storage::<u32>(gpu, "rows of gauges", first + MOST_ROWS * stride)?;
        let header = [first, stride, extent.flows, extent.obstacles].map(|number| number as u32);
        let relative = places.iter().flat_map(|place| card.origin.relative(*place).map(f32::to_bits));
        let told: Vec<u32> = header.into_iter().chain(relative).collect();
        gpu.queue.write_buffer(&rows, 0, bytemuck::cast_slice(&told));
        let patches = (card.parameters.patches[0] * card.parameters.patches[1]) as usize;
        let of_water = card.room.max(card.room_in_air()).max(patches);
        let sums = storage::<[f32; 2]>(gpu, "sums of water", of_water.div_ceil(THREADS as usize))?;
        let no_ground = storage::<Patch>(gpu, "no cells of the ground", 0)?;
        let no_air = storage::<u8>(gpu, "no water in the air", NO_AIR)?;
        let ground = card.weather.as_ref().map_or(&no_ground, |weather| &weather.ground);
        let air = card.air.as_ref().map_or(&no_air, |air| &air.buffer);
        let Tasks { parameters, status, particles, due, sort, near, .. } = tasks;
        Ok(Self {
            places: places.to_vec(),
            extent,
            volumes: shader!(gpu, "flood_volumes", [parameters, status, particles, ground, air, sums]),
            totals: shader!(
                gpu,
                "flood_totals",
                [parameters, status, sums, works.buffer, walls.on_obstacles, walls.knocks, due, rows]
            ),
            samples: shader!(
                gpu,
                "flood_gauges",
                [parameters, status, particles, sort.start, (), card.nodes, near, walls.start, walls.sites, rows]
            ),
            rows,
        })
    }

    /// Has what is due taken, if anything is.
    pub fn take(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer) {
        self.volumes.run_as_told(pass, groups, VOLUMES);
        self.totals.run_as_told(pass, groups, ROWS);
        self.samples.run_as_told(pass, groups, PLACES);
    }
}

impl Card {
    /// Has gauges look at these places from now on.
    pub fn measure(&mut self, places: &[[f64; 2]]) -> Result<(), GpuError> {
        if self.tasks.gauges.as_ref().is_none_or(|gauges| gauges.places != places) {
            self.tasks.gauges = Some(Gauges::new(self, places)?);
        }
        Ok(())
    }

    /// Says when rows are due, s from now.
    pub(super) fn tell_due(&mut self, due: &[f64]) {
        let due: Vec<f32> = due.iter().map(|&time| time as f32).collect();
        self.gpu.queue.write_buffer(&self.tasks.due, 0, bytemuck::cast_slice(&due));
        self.status.rows_told = due.len() as u32;
        (self.status.rows_taken, self.status.rows_due) = (0, 0);
        self.status.gauge_places = self.tasks.gauges.as_ref().map_or(0, |gauges| gauges.places.len() as u32);
    }

    /// What the host learns of the steps, and the rows that were taken in them, of `told` at most. What came and went, it did since the host last
    /// spoke.
    pub(super) fn learn(&self, told: usize) -> Result<(Status, Vec<Reading>), GpuError> {
        let of_steps = (&self.tasks.status, size_of::<Status>());
        let Some(gauges) = self.tasks.gauges.as_ref().filter(|_| told > 0) else {
            return Ok((read::<Status>(&self.gpu, of_steps.0, 1)?[0], Vec::new()));
        };
        let (first, stride) = (gauges.extent.first(), gauges.extent.stride());
        let of_gauges = (&gauges.rows, 4 * (first + told * stride));
        let [status, words] = read_together(&self.gpu, [of_steps, of_gauges], bytemuck::pod_collect_to_vec::<u8, u32>)?;
        let status: Status = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&status));
        let taken = (status.rows_taken + status.rows_due) as usize;
        let rows = words[first..].chunks_exact(stride).take(taken);
        Ok((status, rows.map(|row| self.reading(row, gauges.extent)).collect()))
    }

    fn reading(&self, row: &[u32], extent: Extent) -> Reading {
        let number = |at: usize| f64::from(f32::from_bits(row[at]));
        let account = |at: usize| number(at) - number(at + 1);
        let first = TOTALS + extent.flows;
        let force = |obstacle: usize| [0, 1].map(|axis| number(first + OF_OBSTACLE * obstacle + axis));
        let impulse = |obstacle: usize| {
            let at = first + OF_OBSTACLE * obstacle;
            [0, 1].map(|axis| self.impulse(obstacle, axis, account(at + 2 + 2 * axis), row[at + 6 + axis] as i32))
        };
        let samples = row[extent.before_places()..].chunks_exact(OF_PLACE).map(|sample| {
            let [depth, east, north] = [0, 1, 2].map(|at| f64::from(f32::from_bits(sample[at])));
            Sample { depth, velocity: [east, north] }
        });
        Reading {
            samples: samples.collect(),
            flows: (TOTALS..first).map(number).collect(),
            on_obstacles: (0..extent.obstacles).map(force).collect(),
            impulses: (0..extent.obstacles).map(impulse).collect(),
            inflow: account(0) + account(4),
            outflow: account(2) + account(6),
            rained: account(4),
            infiltrated: account(6),
            stored: number(8),
            film: number(9),
        }
    }
}
