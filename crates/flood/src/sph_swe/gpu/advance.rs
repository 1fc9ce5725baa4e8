//! Batches of steps, and their results.

use super::OnGpu;
use super::batch::{BatchRequest, BatchResult};
use super::shared::{Grid, SpawnRequest, Status};
use crate::sph_swe::gauges::Reading;
use crate::sph_swe::step::CELL_OVER_H;
use corpuscle_gpu::{BATCH_START, Gpu, GpuError, Halt, MOST_STEPS, from_halves, from_pair, read, to_pair};

/// Steps after which the cells are laid out anew; in between the host reads only the status.
const LAID_OUT: u64 = MOST_STEPS as u64;

impl OnGpu {
    /// Whether the buffers may lack room for the particles spawned until the next check; false between checks. `max_spawned` bounds their number within
    /// a time, s.
    pub fn lacks_room(&self, max_spawned: impl FnOnce(f64) -> usize) -> bool {
        let horizon = LAID_OUT as f64 * f64::from(self.parameters.time_step);
        self.steps.is_multiple_of(LAID_OUT) && self.particles() + max_spawned(horizon) > self.room
    }

    /// Takes some steps, through all of a request at most. Nothing is downloaded between two steps. Returns the result, and the rows of gauges that fell
    /// due.
    pub async fn advance(&mut self, request: BatchRequest<'_>) -> Result<(BatchResult, Vec<Reading>), GpuError> {
        let BatchRequest { until, most, host_sample, map_times, last_sample, spawn_requests, due } = request;
        if self.steps.is_multiple_of(LAID_OUT) {
            self.lay_out().await?;
            self.clock_began = self.time();
            self.status.clock = [0.0; 2];
        }
        let spawn_requests: Vec<_> = spawn_requests
            .iter()
            .map(|request| SpawnRequest {
                velocity: request.velocity.map(|along| along as f32),
                time: (request.time - self.clock_began) as f32,
                zone: self.zones[request.source],
            })
            .collect();
        self.gpu().queue.write_buffer(&self.tasks.memory.spawn_requests, 0, bytemuck::cast_slice(&spawn_requests));
        let to_layout = LAID_OUT - self.steps % LAID_OUT;
        let target = until.min(host_sample);
        let count = self.batches.steps(target - self.time(), f64::from(self.status.step), most.min(to_layout));
        self.status = Status {
            halted: BATCH_START,
            steps: 0,
            particle_steps: [0; 2],
            until: to_pair(until - self.clock_began),
            host_sample: to_pair(target - self.clock_began),
            spawn_requests: spawn_requests.len() as u32,
            spawned: 0,
            outflow: [0.0; 2],
            inflow: [0.0; 2],
            momentum_lost: [0.0; 2],
            momentum_gained: [0.0; 2],
            clock_began: self.clock_began as f32,
            ..self.status
        };
        self.upload_gauge_times(due);
        self.upload_map_times(map_times, last_sample);
        let tasks = &self.tasks;
        let status = (&tasks.memory.status, &self.status);
        let download = async |gpu: &Gpu| tasks.download(gpu, due.len()).await;
        let (status, words) = self.batches.run(count, status, |pass| tasks.steps(pass, count), download).await?;
        self.status = status;
        let readings = self.readings(&words);
        self.steps += u64::from(self.status.steps);
        self.ahead |= self.status.steps > 0;
        Ok((self.progress(), readings))
    }

    /// Time at the end of the last step, s.
    fn time(&self) -> f64 {
        self.clock_began + from_pair(self.status.clock)
    }

    /// No batch of steps takes more time than this, s.
    pub fn longest_batch(&self) -> f64 {
        LAID_OUT as f64 * f64::from(self.parameters.time_step)
    }

    fn progress(&self) -> BatchResult {
        let Status { steps, particle_steps, step, halted, mean_h, .. } = self.status;
        BatchResult {
            steps: u64::from(steps),
            particle_steps: from_halves(particle_steps),
            time: self.time(),
            step: f64::from(step),
            outflow: from_pair(self.status.outflow),
            inflow: from_pair(self.status.inflow),
            momentum_lost: from_pair(self.status.momentum_lost),
            momentum_gained: from_pair(self.status.momentum_gained),
            external: self.status.outer_force.map(f64::from),
            mean_h: f64::from(mean_h),
            spawned: self.status.spawned as usize,
            next_id: u64::from(self.status.next_id),
            map_samples: self.status.map_times_taken as usize,
            last_sample: self.clock_began + from_pair(self.status.last_sample),
            broken: Halt::of(halted) == Halt::Broken,
        }
    }

    /// Lays the cells over the water as it stands, as [`corpuscle_sph::Cells`] does.
    async fn lay_out(&mut self) -> Result<(), GpuError> {
        let Status { low, high, mean_h, particles, .. } = self.status;
        let any = particles > 0;
        let [mut low, mut high] =
            [low, high].map(|corner| corner.map(|value| if any { f64::from(value) } else { 0.0 }));
        let mut smallest = if any { CELL_OVER_H * f64::from(mean_h) } else { self.bounds.size()[0] };
        if self.status.falling > 0 {
            // Drops fall anywhere.
            let [west, east, south, north] = self.parameters.bounds.map(f64::from);
            (low, high) = ([low[0].min(west), low[1].min(south)], [high[0].max(east), high[1].max(north)]);
            smallest = if any { smallest } else { CELL_OVER_H * f64::from(self.parameters.new_h) };
        }
        // Cells cover no more than the terrain and its own size beyond each side.
        let within = |value: f64, axis: usize| {
            let [from, to] = [0, 1].map(|side| f64::from(self.parameters.bounds[2 * axis + side]));
            let beyond = to - from;
            value.max(from - beyond).min(to + beyond)
        };
        [low, high] = [low, high].map(|corner| [within(corner[0], 0), within(corner[1], 1)]);
        let [width, height] = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
        // After a breakdown the smoothing lengths may not be finite.
        if !(smallest.is_finite() && smallest > 0.0) {
            smallest = self.bounds.size()[0];
        }
        let most = (self.most_cells - 1) as f64;
        let columns_and_rows = |cell: f64| [width, height].map(|length| (length / cell).floor() + 1.0);
        let mut cell = smallest;
        while columns_and_rows(cell).iter().product::<f64>() > most {
            cell *= 1.1;
        }
        let [columns, rows] = columns_and_rows(cell).map(|number| number as u32);
        self.parameters.grid = Grid {
            corner: low.map(|value| value as f32),
            cell: cell as f32,
            per_cell: (1.0 / cell) as f32,
            columns,
            rows,
            unused: [0.0; 2],
        };
        self.parameters.farthest = (f64::from(self.parameters.widest_h) / cell) as u32 + 1;
        // One more cell holds what has left.
        self.status.cells = columns * rows + 1;
        self.gpu().queue.write_buffer(&self.tasks.memory.parameters, 0, bytemuck::bytes_of(&self.parameters));
        self.tasks.arrange(self.gpu(), &Status { step: 0.0, ..self.status });
        let arranged: Status = read(self.gpu(), &self.tasks.memory.status, 1).await?[0];
        self.status.particles = arranged.particles;
        Ok(())
    }
}
