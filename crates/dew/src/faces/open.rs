//! Open sides: the air outside goes in and out as the air before the side moves, and there is always more of it.
//!
//! Outside, air stands in columns across the side. Each column moves as the air in the room before it does on average, outwards or
//! inwards: the velocity is extrapolated evenly, the pressure is prescribed. That is the open boundary of Tafuni et al. (Computer Methods in
//! Applied Mechanics and Engineering 342, 2018, 604), with columns for its ghost nodes. Air that goes out meets the pressure of
//! the air outside, that of rest; air that comes in has come from rest, and its pressure is lower by rho u^2 / 2 (Bernoulli).

use crate::air::{Particle, Role, Scale};
use crate::constants::BEYOND;
use crate::inventory::Inventory;
use crate::room::{Face, Room};
use corpuscle_model::{ROUNDERS, ReproducibleSum};
use corpuscle_processes::Processes;

/// How far beyond an open side the last particle of a full column stands, m, nearer than what is let go of; particles are `apart` m apart, and
/// `h` is the smoothing length. A ten-thousandth more, so that rounding does not decide whether there is room for one.
pub(crate) fn deepest(h: f64, apart: f64) -> f64 {
    ((BEYOND * h / apart - 0.5).ceil() - 0.5 + 1e-4) * apart
}

/// The columns of air outside an open side.
#[derive(Debug, Clone)]
pub struct OpenSide {
    axis: usize,
    side: usize,
    /// The axes along the side.
    along: [usize; 2],
    /// Columns along both.
    counts: [usize; 2],
    /// Distance between columns, by axis, m.
    apart: [f64; 3],
    /// Columns that no solid stands in.
    free: Vec<bool>,
    /// Sum of the velocities across the side of the air before each column, m/s, and its number.
    before: Vec<(ReproducibleSum<f64>, u32)>,
    /// Mean velocity across the side before each column, m/s.
    velocity: Vec<f64>,
    /// How far the last of each column is beyond the side, m.
    outermost: Vec<f64>,
}

impl OpenSide {
    /// The open sides of a room; columns are free where `is_free` holds.
    pub(crate) fn all(room: &Room, scale: &Scale, is_free: impl Fn([f64; 3]) -> bool) -> Vec<Self> {
        let sides = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
        let open = sides.filter(|&(axis, side)| room.faces[axis][side] == Face::Open);
        open.map(|(axis, side)| Self::new(room, axis, side, scale, &is_free)).collect()
    }

    fn new(room: &Room, axis: usize, side: usize, scale: &Scale, is_free: impl Fn([f64; 3]) -> bool) -> Self {
        let along = [(axis + 1) % 3, (axis + 2) % 3];
        let apart = room.apart(scale.spacing);
        let counts = along.map(|other| room.counts(scale.spacing)[other]);
        let columns = counts[0] * counts[1];
        let mut new = Self {
            axis,
            side,
            along,
            counts,
            apart,
            free: Vec::new(),
            before: vec![(ReproducibleSum::NOTHING, 0); columns],
            velocity: vec![0.0; columns],
            outermost: vec![0.0; columns],
        };
        let last = new.deepest(scale);
        new.free = (0..columns).map(|column| is_free(new.position(room, column, last))).collect();
        new
    }

    /// How far beyond the side the last of a full column stands at the start, m.
    fn deepest(&self, scale: &Scale) -> f64 {
        deepest(scale.h(), self.apart[self.axis])
    }

    /// Columns that no solid stands in.
    #[cfg(feature = "gpu")]
    pub(crate) fn free(&self) -> &[bool] {
        &self.free
    }

    /// The position in the midst of a column so far beyond the side, m.
    fn position(&self, room: &Room, column: usize, depth: f64) -> [f64; 3] {
        let index = [column % self.counts[0], column / self.counts[0]];
        let mut position = [0.0; 3];
        position[self.axis] = [room.low[self.axis] - depth, room.high[self.axis] + depth][self.side];
        for i in 0..2 {
            let other = self.along[i];
            position[other] = room.low[other] + (index[i] as f64 + 0.5) * self.apart[other];
        }
        position
    }

    /// The column that a position is in.
    fn column(&self, room: &Room, position: [f64; 3]) -> usize {
        let index = [0, 1].map(|i| {
            let other = self.along[i];
            // A negative number becomes 0.
            (((position[other] - room.low[other]) / self.apart[other]) as usize).min(self.counts[i] - 1)
        });
        index[0] + self.counts[0] * index[1]
    }

    /// Samples the velocity of the air before each column.
    fn sample_velocities(
        &mut self,
        processes: &Processes,
        room: &Room,
        air: &[Particle],
        reach: f64,
        rise: impl Fn(&Particle) -> f64,
    ) {
        let outward = [-1.0, 1.0][self.side];
        self.before.fill((ReproducibleSum::NOTHING, 0));
        self.outermost.fill(f64::NEG_INFINITY);
        for particle in air {
            let depth = room.depth_beyond(particle.position, self.axis, self.side);
            match particle.role {
                Role::Inside if depth > -reach => {
                    let column = self.column(room, particle.position);
                    let (sum, count) = &mut self.before[column];
                    sum.add(particle.velocity[self.axis] + outward * rise(particle), &ROUNDERS);
                    *count += 1;
                }
                Role::Outside(axis, side) if (usize::from(axis), usize::from(side)) == (self.axis, self.side) => {
                    let column = self.column(room, particle.position);
                    self.outermost[column] = self.outermost[column].max(depth);
                }
                _ => {}
            }
        }
        if processes.count() > 1 {
            self.collect(processes);
        }
        for column in 0..self.velocity.len() {
            self.velocity[column] = self.mean_before(column);
        }
    }

    /// Puts together what all processes have sampled.
    fn collect(&mut self, processes: &Processes) {
        let is_any = |column: &usize| self.before[*column].1 > 0 || self.outermost[*column] > f64::NEG_INFINITY;
        let sample = |column: usize| (column, self.before[column].0, self.before[column].1, self.outermost[column]);
        let own: Vec<(usize, ReproducibleSum<f64>, u32, f64)> =
            (0..self.before.len()).filter(is_any).map(sample).collect();
        self.before.fill((ReproducibleSum::NOTHING, 0));
        self.outermost.fill(f64::NEG_INFINITY);
        for (column, theirs, count, outermost) in processes.gather_all(own).into_iter().flatten() {
            let sum = &mut self.before[column];
            *sum = (sum.0.with(&theirs), sum.1 + count);
            self.outermost[column] = self.outermost[column].max(outermost);
        }
    }

    /// The mean velocity before a column and those next to it, m/s.
    fn mean_before(&self, column: usize) -> f64 {
        let index = [column % self.counts[0], column / self.counts[0]];
        let range = [0, 1].map(|i| index[i].saturating_sub(1)..=(index[i] + 1).min(self.counts[i] - 1));
        let mut sum = [0.0; 2];
        for b in range[1].clone() {
            for a in range[0].clone() {
                let (velocity, count) = self.before[a + self.counts[0] * b];
                sum = [sum[0] + velocity.value(), sum[1] + f64::from(count)];
            }
        }
        sum[0] / sum[1].max(1.0)
    }
}

impl Inventory<'_> {
    /// The air outside open sides takes the velocity of the air before them, and where it has moved in there is more of it.
    pub(crate) fn move_outside(&mut self, sides: &mut [OpenSide]) {
        for open in sides {
            let (axis, side) = (open.axis, open.side);
            let rest = self.rest_density;
            let sound = self.air.sound_speed;
            let rise = |particle: &Particle| {
                let inward = [1.0, -1.0][side] * particle.velocity[axis];
                sound * (particle.density / rest - 1.0) + 0.5 * inward.max(0.0).powi(2) / sound
            };
            open.sample_velocities(self.processes, self.room, &self.state.air, self.scale.h(), rise);
            for particle in &mut self.state.air {
                if particle.role == Role::Outside(open.axis as u8, open.side as u8) {
                    particle.velocity = [0.0; 3];
                    particle.velocity[open.axis] = open.velocity[open.column(self.room, particle.position)];
                    (particle.acceleration, particle.spreading) = ([0.0; 3], [0.0; 3]);
                }
            }
            self.add_outside(open);
        }
    }

    /// Adds ambient air at the far end of columns that have moved in.
    fn add_outside(&mut self, open: &OpenSide) {
        let (deepest, apart) = (open.deepest(self.scale), open.apart[open.axis]);
        for column in (0..open.velocity.len()).filter(|&column| open.free[column]) {
            let mut depth = open.outermost[column].max(-0.5 * apart) + apart;
            while depth <= deepest {
                let position = open.position(self.room, column, depth);
                let Self { settings, state, .. } = self;
                let mut particle =
                    Particle::new(state.next_id, position, settings.ambient_temperature, settings.ambient_vapour);
                particle.role = Role::Outside(open.axis as u8, open.side as u8);
                particle.velocity[open.axis] = open.velocity[column];
                state.next_id += 1;
                if self.owns(position) {
                    self.state.air.push(particle);
                }
                depth += apart;
            }
        }
    }
}
