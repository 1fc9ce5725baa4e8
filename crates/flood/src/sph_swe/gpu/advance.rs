//! Batches of steps, and what they did.

use super::OnGpu;
use super::shared::{BROKEN, Birth, Grid, SPOKEN, Status};
use super::span::{Progress, Span};
use super::tasks::Tasks;
use crate::sph_swe::measured::Reading;
use crate::sph_swe::step::CELL_OVER_H;
use corpuscle_gpu::{GpuError, Pass, read, wgpu};
use std::time::Instant;

/// The cells are laid out anew after so many steps; in between the host reads no more than it must.
const LAID_OUT: u64 = 64;

/// A batch of steps takes about so long at most, s: then the host looks whether it is to stop.
const BATCH: f64 = 0.2;

impl OnGpu {
    /// Whether the room may not do for `births` more until it is time to ask again; none where it is not time to.
    pub fn lacks_room(&self, births: impl FnOnce(f64) -> usize) -> bool {
        let horizon = LAID_OUT as f64 * f64::from(self.parameters.time_step);
        self.steps.is_multiple_of(LAID_OUT) && self.particles() + births(horizon) > self.room
    }

    /// Takes some steps, through all of a span at most. Nothing comes back between two steps. Gives what was done, and of the rows of gauges that are due those
    /// that were passed.
    pub fn advance(&mut self, span: Span<'_>) -> Result<(Progress, Vec<Reading>), GpuError> {
        let Span { now, until, most, look, looks, looked, births, due } = span;
        if self.steps.is_multiple_of(LAID_OUT) {
            self.lay_out()?;
            self.status.clock = [0.0; 2];
            self.clock_began = now;
        }
        let births: Vec<_> = births
            .iter()
            .map(|birth| Birth {
                velocity: birth.velocity.map(|along| along as f32),
                time: (birth.time + now - self.clock_began) as f32,
                zone: self.zones[birth.source],
            })
            .collect();
        self.gpu.queue.write_buffer(&self.tasks.memory.births, 0, bytemuck::cast_slice(&births));
        let to_layout = LAID_OUT - self.steps % LAID_OUT;
        let planned = (until.min(look) / f64::from(self.status.step)).ceil().clamp(1.0, LAID_OUT as f64) as u32;
        let count = planned.min(most).min(self.batch).min(to_layout as u32);
        self.status = Status {
            halted: SPOKEN,
            steps: 0,
            particle_steps: [0; 2],
            until: until as f32,
            look: look as f32,
            births: births.len() as u32,
            born: 0,
            elapsed: [0.0; 2],
            outflow: [0.0; 2],
            inflow: [0.0; 2],
            momentum_lost: [0.0; 2],
            momentum_gained: [0.0; 2],
            ..self.status
        };
        self.tell_due(due);
        self.tell_looks(now, looks, looked);
        let began = Instant::now();
        self.gpu.queue.write_buffer(&self.tasks.memory.status, 0, bytemuck::bytes_of(&self.status));
        self.order(|tasks, pass| tasks.steps(pass, count));
        let (status, readings) = self.learn(due.len())?;
        self.status = status;
        let took = began.elapsed().as_secs_f64();
        self.busy += took;
        self.stopwatch.iter_mut().try_for_each(|stopwatch| stopwatch.read(&self.gpu))?;
        let next = if took < 0.5 * BATCH { 2 * count.max(self.batch / 2) } else { (count / 2).max(1) };
        self.batch = next.min(LAID_OUT as u32);
        self.steps += u64::from(self.status.steps);
        self.ahead |= self.status.steps > 0;
        Ok((self.progress(), readings))
    }

    /// No batch of steps takes more time than this, s.
    pub fn longest_batch(&self) -> f64 {
        LAID_OUT as f64 * f64::from(self.parameters.time_step)
    }

    /// Has the device do something.
    fn order(&mut self, task: impl FnOnce(&Tasks, &mut Pass<'_>)) {
        let mut encoder =
            self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("flood") });
        let mut pass = Pass::begin(&mut encoder, self.stopwatch.as_mut());
        task(&self.tasks, &mut pass);
        drop(pass);
        self.stopwatch.iter().for_each(|stopwatch| stopwatch.end(&mut encoder));
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn progress(&self) -> Progress {
        let Status { steps, particle_steps: [low, high], step, halted, mean_h, .. } = self.status;
        let total = |[sum, rest]: [f32; 2]| f64::from(sum) + f64::from(rest);
        Progress {
            steps: u64::from(steps),
            particle_steps: (u64::from(high) << 32) + u64::from(low),
            elapsed: total(self.status.elapsed),
            step: f64::from(step),
            outflow: total(self.status.outflow),
            inflow: total(self.status.inflow),
            momentum_lost: total(self.status.momentum_lost),
            momentum_gained: total(self.status.momentum_gained),
            external: self.status.outer_force.map(f64::from),
            mean_h: f64::from(mean_h),
            born: self.status.born as usize,
            next_id: u64::from(self.status.next_id),
            looks: self.status.looks_taken as usize,
            looked: f64::from(self.status.looked),
            broken: halted == BROKEN,
        }
    }

    /// Lays the cells over the water as it stands, as [`corpuscle_sph::Cells`] does.
    fn lay_out(&mut self) -> Result<(), GpuError> {
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
        // Water that is nowhere needs no cells.
        let within = |value: f64, axis: usize| {
            let [from, to] = [0, 1].map(|side| f64::from(self.parameters.bounds[2 * axis + side]));
            let beyond = to - from;
            value.max(from - beyond).min(to + beyond)
        };
        [low, high] = [low, high].map(|corner| [within(corner[0], 0), within(corner[1], 1)]);
        let [width, height] = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
        // Water that has broken down may tell nothing of its reach.
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
        self.gpu.queue.write_buffer(&self.tasks.memory.parameters, 0, bytemuck::bytes_of(&self.parameters));
        self.tasks.arrange(&self.gpu, &Status { step: 0.0, ..self.status });
        let arranged: Status = read(&self.gpu, &self.tasks.memory.status, 1)?[0];
        self.status.particles = arranged.particles;
        Ok(())
    }
}
