//! What a wall does to a ball that hits it.

use super::World;
use super::contact::Mode;
use super::wall::{Facing, Wall};
use crate::random::{flux, normal};
use corpuscle_model::CompensatedSum;
use serde::{Deserialize, Serialize};

/// Sums over the hits of a wall.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct WallTally {
    pub hits: u64,
    /// Momentum given to the wall, along its axis.
    pub momentum: CompensatedSum,
    /// Energy given to the gas, where it was gained and where it was lost.
    pub gained: CompensatedSum,
    pub lost: CompensatedSum,
    /// Momentum along the other axes given to the gas (thermal walls).
    pub dragged: CompensatedSum,
}

impl WallTally {
    /// Work done on the gas, and heat given to it.
    pub fn energy(&self) -> f64 {
        self.gained.value() - self.lost.value()
    }
}

impl<const D: usize> World<D> {
    /// A ball that touches a wall now rebounds.
    pub fn hit<M: Mode>(&mut self, ball: usize, wall: usize) {
        let flown = self.now - self.balls[ball].time.max(self.walls[wall].since);
        self.book_flight::<M>(ball);
        self.bring::<M>(ball);
        let axis = self.walls[wall].axis;
        let (mass, radius) = (self.mass(ball), self.radius(ball));
        let before = self.balls[ball].velocity;
        let mut push = self.walls[wall].speed_at(self.now);
        if M::GROWS {
            // The ball's surface must part from the wall, not its centre.
            let away = if position_is_above(&self.walls[wall], self.balls[ball].position[axis], self.now) {
                1.0
            } else {
                -1.0
            };
            push += away * radius * self.field.growth;
        }
        let (mut after, mut speed_of_wall) = (before, None);
        if let Some(temperature) = self.walls[wall].temperature {
            after = self.reemit(wall, push, (temperature / mass).sqrt());
        } else if let Some(heavy) = self.walls[wall].mass {
            // By energy and momentum on the line of centres, with the wall as the other ball.
            let total = mass + heavy;
            after[axis] = ((mass - heavy) * before[axis] + 2.0 * heavy * push) / total;
            speed_of_wall = Some(((heavy - mass) * push + 2.0 * mass * before[axis]) / total);
        } else {
            after[axis] = 2.0 * push - before[axis];
        }
        if !after.iter().all(|along| along.is_finite()) {
            return self.refuse(ball);
        }
        if let Some(speed) = speed_of_wall {
            let now = self.now;
            self.walls[wall].bend(now, speed);
        }
        self.balls[ball].velocity = after;
        self.book_hit(wall, mass, &before, &after);
        // The wall pushes the ball's surface, not its centre: with this the virial's pressure is that on the walls.
        let virial = radius * mass * (before[axis] - after[axis]).abs();
        self.tally.virial += virial;
        if !self.regions.is_empty() {
            let centre = self.balls[ball].position;
            let mut to_wall = [0.0; D];
            to_wall[axis] = self.walls[wall].position_at(self.now) - centre[axis];
            self.count_in_regions(centre, to_wall, virial);
        }
        self.watch(flown * (before[axis] - push).abs() * radius, radius * radius);
        self.note_bend(ball);
    }

    /// A velocity as of a gas behind a hole in the wall's place: after Maxwell along the wall, weighted by the flux across it.
    fn reemit(&mut self, wall: usize, push: f64, thermal: f64) -> [f64; D] {
        let mut after: [f64; D] = std::array::from_fn(|_| thermal * normal(&mut self.random));
        let away = if self.walls[wall].facing == Facing::Up { 1.0 } else { -1.0 };
        after[self.walls[wall].axis] = push + away * thermal * flux(&mut self.random);
        after
    }

    fn book_hit(&mut self, wall: usize, mass: f64, before: &[f64; D], after: &[f64; D]) {
        let axis = self.walls[wall].axis;
        let tally = &mut self.wall_tallies[wall];
        tally.hits += 1;
        tally.momentum.add(mass * (before[axis] - after[axis]));
        for axis in 0..D {
            let gain = 0.5 * mass * (after[axis] - before[axis]) * (after[axis] + before[axis]);
            if gain >= 0.0 {
                tally.gained.add(gain)
            } else {
                tally.lost.add(-gain)
            }
            if axis != self.walls[wall].axis {
                tally.dragged.add(mass * (after[axis] - before[axis]));
            }
        }
    }
}

fn position_is_above(wall: &Wall, position: f64, now: f64) -> bool {
    match wall.facing {
        Facing::Up => true,
        Facing::Down => false,
        Facing::Both => position > wall.position_at(now),
    }
}
