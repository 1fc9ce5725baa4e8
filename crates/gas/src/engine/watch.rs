//! Free walls, whose every hit changes their motion.
//!
//! A ball that such a wall may now meet before its next event needs a new event. Balls near the wall are updated at once, at a cost
//! in proportion to the wall's area, not with the number of balls; those farther off when the wall has come as much nearer to them as
//! leaves it short of them still, if no hit has come before. Balls that come near by themselves test the wall when they cross the
//! edge of a cell.

use super::Engine;
use crate::world::{Facing, Mode, NONE, first_contact};

/// Displacement of a wall after which balls near it are updated again, over the side of the finest cells.
const WALL_STEP: f64 = 0.5;

impl<const D: usize> Engine<D> {
    /// Updates the events of balls after a free wall's motion changed now.
    pub(super) fn free_wall_changed<M: Mode>(&mut self, wall: usize) {
        let time = self.watch_after_step(wall);
        self.watches[wall] = time;
        if time > self.world.now {
            let mut near = std::mem::take(&mut self.beside_wall);
            self.find_beside(wall, &mut near);
            near.drain(..).for_each(|ball| self.update_for_wall::<M>(ball as usize, wall));
            self.beside_wall = near;
        } else {
            // So fast that it reaches every ball at once.
            self.watches[wall] = f64::INFINITY;
            (0..self.events.len()).for_each(|ball| self.update_for_wall::<M>(ball, wall));
        }
        self.next_watch = self.watches.iter().copied().fold(f64::INFINITY, f64::min);
    }

    /// Updates the balls near the wall that is due first.
    #[cold]
    pub(super) fn watch<M: Mode>(&mut self) {
        self.world.now = self.next_watch;
        if let Some(wall) = self.watches.iter().position(|&time| time == self.next_watch) {
            self.free_wall_changed::<M>(wall);
        }
    }

    /// Clears the due times: the events of all balls account for all walls.
    pub(super) fn watch_none(&mut self) {
        self.watches = vec![f64::INFINITY; self.world.walls.len()];
        self.next_watch = f64::INFINITY;
    }

    /// Finds the next event of a ball, if it is a hit by the wall.
    pub(super) fn update_for_wall<M: Mode>(&mut self, ball: usize, wall: usize) {
        let radius = self.world.radius(ball);
        let time = self.world.walls[wall].meeting::<D, M>(&self.world.balls[ball], radius, &self.world.field);
        if time < self.events[ball].time {
            self.predict::<M>(ball);
        }
    }

    fn step(&self, axis: usize) -> f64 {
        WALL_STEP * self.grid.levels[0].size[axis]
    }

    /// When a wall will have gone a step towards the gas.
    fn watch_after_step(&self, wall: usize) -> f64 {
        let (wall, now) = (&self.world.walls[wall], self.world.now);
        let outward = if wall.facing == Facing::Up { -1.0 } else { 1.0 };
        now + first_contact(self.step(wall.axis), outward * wall.speed_at(now), outward * wall.acceleration)
    }

    /// Balls that a wall may hit before it has gone a step, and others near it, in the order of their numbers.
    fn find_beside(&self, wall: usize, found: &mut Vec<u32>) {
        let wall = &self.world.walls[wall];
        let inward = if wall.facing == Facing::Up { 1.0 } else { -1.0 };
        for (number, level) in self.grid.levels.iter().enumerate() {
            // A ball is no wider than a cell. One step more, for rounding errors.
            let reach = 0.5 * level.size[wall.axis] + 2.0 * self.step(wall.axis);
            let mut edge = self.grid.low;
            edge[wall.axis] = wall.position_at(self.world.now) + inward * reach;
            let last = self.grid.cell_of(number as u8, &edge)[wall.axis];
            let mut cell = [1; D];
            let mut end = level.count;
            if wall.facing == Facing::Up {
                end[wall.axis] = last;
            } else {
                cell[wall.axis] = last;
            }
            let begin = cell;
            'cells: loop {
                let mut ball = self.grid.heads[self.grid.index(number as u8, &cell)];
                while ball != NONE {
                    found.push(ball);
                    ball = self.world.balls[ball as usize].next;
                }
                for axis in 0..D {
                    cell[axis] += 1;
                    if cell[axis] <= end[axis] {
                        continue 'cells;
                    }
                    cell[axis] = begin[axis];
                }
                break;
            }
        }
        // The order within a cell is not kept over an interruption.
        found.sort_unstable();
    }
}
