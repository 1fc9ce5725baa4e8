//! The loop over events.

use super::Engine;
use super::collide::speed;
use super::contact::{Falling, Growing, Mode, Straight};
use multiversion::multiversion;

/// Events handled for each ball before a new window begins.
const EVENTS_PER_WINDOW: u64 = 60;

/// Collisions in a row between which nothing moves, at which the engine gives up.
const STANDSTILL: u32 = 100_000;

/// Why the loop came back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pause {
    /// Nothing more happens up to the time asked for.
    Reached,
    /// The number of events asked for has been handled.
    Worked,
    /// A new window is due.
    WindowFull,
    /// Collisions follow each other without anything moving.
    Standstill,
    /// A time that is not a number.
    NotANumber,
}

impl<const D: usize> Engine<D> {
    /// Handles events up to `until` (in the window), `most` at most.
    pub fn run(&mut self, until: f64, most: u64) -> Pause {
        if self.field.growth != 0.0 {
            handle::<D, Growing>(self, until, most)
        } else if self.field.gravity != [0.0; D] {
            handle::<D, Falling>(self, until, most)
        } else {
            handle::<D, Straight>(self, until, most)
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn handle<const D: usize, M: Mode>(engine: &mut Engine<D>, until: f64, most: u64) -> Pause {
    let window = EVENTS_PER_WINDOW * engine.balls.len() as u64 + 1000;
    for _ in 0..most {
        let Some((time, ball)) = engine.queue.peek(&engine.events) else { return Pause::Reached };
        if time > until {
            return Pause::Reached;
        }
        if engine.handled >= window {
            return Pause::WindowFull;
        }
        engine.handled += 1;
        engine.queue.pop();
        engine.now = time;
        let ball = ball as usize;
        let event = engine.events[ball];
        let mut touched = [ball, ball];
        let mut count = 1;
        if let Some(partner) = event.what.ball() {
            if engine.events[partner].bends == event.partner_bends {
                engine.collide::<M>(ball, partner);
                touched[1] = partner;
                count = 2;
            } else {
                engine.tally.disturbed += 1;
            }
        } else if let Some((axis, up)) = event.what.as_edge() {
            engine.cross(ball, axis, up);
        } else if let Some(wall) = event.what.as_wall() {
            if engine.walls[wall].bends == event.partner_bends {
                engine.hit::<M>(ball, wall);
            } else {
                engine.tally.disturbed += 1;
            }
        }
        for &ball in &touched[..count] {
            engine.predict::<M>(ball);
        }
        if engine.standstill > STANDSTILL {
            return Pause::Standstill;
        }
    }
    Pause::Worked
}

impl<const D: usize> Engine<D> {
    /// A ball goes over into the next cell.
    #[inline(always)]
    fn cross(&mut self, ball: usize, axis: usize, up: bool) {
        self.tally.crossings += 1;
        self.leave_cell(ball);
        let event = &mut self.events[ball];
        let count = self.grid.levels[event.level as usize].count[axis];
        let cell = event.cell[axis];
        event.cell[axis] = if up { cell + 1 } else { cell - 1 };
        if event.cell[axis] > count {
            event.cell[axis] = 1;
            self.balls[ball].position[axis] -= self.field.period[axis];
            self.records[ball].image[axis] += 1;
        } else if event.cell[axis] == 0 {
            event.cell[axis] = count;
            self.balls[ball].position[axis] += self.field.period[axis];
            self.records[ball].image[axis] -= 1;
        }
        self.enter_cell(ball);
    }

    /// A ball rebounds from a wall.
    #[inline(always)]
    fn hit<M: Mode>(&mut self, ball: usize, wall: usize) {
        self.tally.wall_hits += 1;
        self.tally.path += speed(&self.balls[ball].velocity) * (self.now - self.balls[ball].time);
        self.bring::<M>(ball);
        let event = &mut self.events[ball];
        event.bends = event.bends.wrapping_add(1);
        let wall = &mut self.walls[wall];
        let velocity = &mut self.balls[ball].velocity[wall.axis];
        *velocity = 2.0 * wall.speed_at(self.now) - *velocity;
    }
}
