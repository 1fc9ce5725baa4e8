//! Batches of steps, and what they did.

use super::layout::{self, CardBirth, Grid, Status};
use super::tasks::Tasks;
use super::{Card, Progress, Span};
use crate::gauges::Reading;
use crate::rain::Ground;
use corpuscle_gpu::{GpuError, Pass, read, wgpu};
use std::time::Instant;

/// Size of a cell over the mean reach, as on the CPU in scheme balanced.
const CELL_OVER_REACH: f64 = 0.6;

/// The same in scheme sph-swe.
const CELL_OVER_REACH_SPH_SWE: f64 = 1.4;

/// The cells are laid out anew after so many steps; in between the host reads no more than it must.
const LAID_OUT: u64 = 64;

/// A batch of steps takes about so long at most, s: then the host looks whether it is to stop.
const BATCH: f64 = 0.2;

impl Card {
    /// Whether the room may not do for `births` more, and where particles are split for half of them, until it is time to ask again; none
    /// where it is not time to.
    pub fn lacks_room(&self, births: impl FnOnce(f64) -> usize) -> bool {
        let horizon = LAID_OUT as f64 * f64::from(self.parameters.longest_step);
        let particles = self.status.particles as usize;
        // What is split faster stays whole until there is more room.
        let halves = if self.parameters.widest > 0.0 { particles / 2 } else { 0 };
        self.steps.is_multiple_of(LAID_OUT)
            && particles + self.status.falling as usize + halves + births(horizon) > self.room
    }

    /// Takes some steps, through all of a span at most. It rains on `ground`. Nothing comes back between two steps. Gives what was done, and of
    /// the rows of gauges that are due those that were passed.
    pub fn advance(&mut self, span: Span<'_>, ground: Option<&Ground>) -> Result<(Progress, Vec<Reading>), GpuError> {
        let Span { now, until, most, look, looks, looked, births, due } = span;
        if self.steps.is_multiple_of(LAID_OUT) {
            self.lay_out()?;
            let [sum, lacking] = self.status.clock;
            self.status.wetted -= sum - lacking;
            let longest_step = self.step_to_come();
            self.status.clock = [0.0; 2];
            (self.clock_began, self.dry_before) = (now, -f64::from(self.status.wetted).min(0.0));
            if let (Some(weather), Some(ground)) = (&self.weather, ground) {
                weather.rates.tell(&self.gpu, ground, now, self.dry_before, (LAID_OUT + 1) as f64 * longest_step);
            }
        }
        let births: Vec<_> = births
            .iter()
            .map(|birth| CardBirth {
                velocity: birth.velocity.map(|along| along as f32),
                time: (birth.time + now - self.clock_began) as f32,
                zone: self.works.sources[birth.source],
            })
            .collect();
        let horizon = (LAID_OUT + 1) as f64 * f64::from(self.parameters.longest_step);
        self.works.tell(&self.gpu, self.clock_began, self.dry_before, horizon);
        self.gpu.queue.write_buffer(&self.tasks.births, 0, bytemuck::cast_slice(&births));
        let to_layout = LAID_OUT - self.steps % LAID_OUT;
        let planned = (until.min(look) / f64::from(self.status.step)).ceil().clamp(1.0, LAID_OUT as f64) as u32;
        let count = planned.min(most).min(self.batch).min(to_layout as u32);
        self.status = Status {
            halted: layout::SPOKEN,
            steps_before: self.status.steps_before.wrapping_add(self.status.steps),
            steps: 0,
            particle_steps: [0; 2],
            until: until as f32,
            look: look as f32,
            births: births.len() as u32,
            born: 0,
            elapsed: [0.0; 2],
            rained: [0.0; 2],
            infiltrated: [0.0; 2],
            outflow: [0.0; 2],
            inflow: [0.0; 2],
            momentum_lost: [0.0; 2],
            momentum_gained: [0.0; 2],
            ..self.status
        };
        self.tell_due(due);
        self.tell_looks(now, looks, looked);
        let began = Instant::now();
        self.gpu.queue.write_buffer(&self.tasks.status, 0, bytemuck::bytes_of(&self.status));
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
        LAID_OUT as f64 * f64::from(self.parameters.longest_step)
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

    /// Twice as long a step as the next, or as those since the cells were last laid out, s; the longest that there can be, at most.
    fn step_to_come(&self) -> f64 {
        let mean = self.status.clock[0] / LAID_OUT as f32;
        f64::from((2.0 * mean.max(self.status.step)).min(self.parameters.longest_step))
    }

    fn progress(&self) -> Progress {
        let Status { steps, particle_steps: [low, high], step, halted, mean_h, .. } = self.status;
        let total = |[sum, lacking]: [f32; 2]| f64::from(sum) - f64::from(lacking);
        Progress {
            steps: u64::from(steps),
            particle_steps: (u64::from(high) << 32) + u64::from(low),
            elapsed: total(self.status.elapsed),
            step: f64::from(step),
            outflow: total(self.status.outflow),
            inflow: total(self.status.inflow),
            momentum_lost: total(self.status.momentum_lost),
            momentum_gained: total(self.status.momentum_gained),
            rained: total(self.status.rained),
            infiltrated: total(self.status.infiltrated),
            from_outside: self.status.from_outside.map(f64::from),
            mean_h: f64::from(mean_h),
            born: self.status.born as usize,
            next_id: u64::from(self.status.next_id),
            looks: self.status.looks_taken as usize,
            looked: f64::from(self.status.looked),
            broken: halted == layout::BROKEN,
        }
    }

    /// Lays the cells over the water as it stands, as [`corpuscle_sph::Cells`] does.
    fn lay_out(&mut self) -> Result<(), GpuError> {
        let Status { low, high, mean_h, particles, .. } = self.status;
        let any = particles > 0;
        let over_reach =
            if self.parameters.scheme == layout::SPH_SWE { CELL_OVER_REACH_SPH_SWE } else { CELL_OVER_REACH };
        let cell_over_h = over_reach * f64::from(self.parameters.reach_over_h);
        let [mut low, mut high] =
            [low, high].map(|corner| corner.map(|value| if any { f64::from(value) } else { 0.0 }));
        let mut smallest = if any { cell_over_h * f64::from(mean_h) } else { self.bounds.size()[0] };
        if self.weather.is_some() || self.status.falling > 0 {
            // Drops fall anywhere.
            let [west, east, south, north] = self.parameters.bounds.map(f64::from);
            (low, high) = ([low[0].min(west), low[1].min(south)], [high[0].max(east), high[1].max(north)]);
            smallest = if any { smallest } else { cell_over_h * f64::from(self.parameters.new_h) };
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
        self.parameters.farthest = (2.0 * f64::from(self.parameters.largest_h) / cell) as u32 + 1;
        // One more cell holds what has left.
        self.status.cells = columns * rows + 1;
        self.gpu.queue.write_buffer(&self.tasks.parameters, 0, bytemuck::bytes_of(&self.parameters));
        self.tasks.arrange(&self.gpu, &Status { step: 0.0, ..self.status });
        let arranged: Status = read(&self.gpu, &self.tasks.status, 1)?[0];
        self.status.particles = arranged.particles;
        Ok(())
    }
}
