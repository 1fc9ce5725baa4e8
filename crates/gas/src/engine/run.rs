//! The loop over events.

use super::Engine;
use super::compiled_once::compiled_once;
use crate::pause::Pause;
use crate::world::{Mode, NONE, in_mode};
use multiversion::multiversion;

/// Events handled for each ball before a new window begins.
const EVENTS_PER_WINDOW: u64 = 60;

impl<const D: usize> Engine<D> {
    /// Handles events up to `until` (in the window), `most` at most.
    pub fn run(&mut self, until: f64, most: u64) -> Pause {
        compiled_once!(self.run_in_mode(until: f64, most: u64) -> Pause)
    }

    fn run_in_mode(&mut self, until: f64, most: u64) -> Pause {
        in_mode!(self.world.motion(), M => handle::<D, M>(self, until, most))
    }

    /// True where a new window is due.
    fn window_is_full(&self) -> bool {
        self.handled >= EVENTS_PER_WINDOW * self.events.len() as u64 + 1000
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn handle<const D: usize, M: Mode>(engine: &mut Engine<D>, until: f64, most: u64) -> Pause {
    let prefetches = engine.prefetches;
    for _ in 0..most {
        let (time, ball) = engine.queue.peek(&engine.events).unwrap_or((f64::INFINITY, NONE));
        if time.min(engine.next_watch) > until || (ball == NONE && engine.next_watch == f64::INFINITY) {
            return Pause::Reached;
        }
        if engine.next_watch <= time {
            if M::SHEARS {
                engine.slide_on::<M>();
            } else {
                engine.watch::<M>();
            }
            continue;
        }
        if engine.window_is_full() {
            return Pause::WindowFull;
        }
        if prefetches {
            engine.look_ahead();
        }
        engine.handled += 1;
        engine.queue.pop();
        engine.world.now = time;
        let (touched, count) = engine.happen::<M>(ball as usize);
        for &ball in &touched[..count] {
            engine.predict::<M>(ball);
        }
        if engine.world.stands_still() {
            return Pause::Standstill;
        }
    }
    Pause::Worked
}

impl<const D: usize> Engine<D> {
    /// Lets the event of a ball happen, if it is not out of date; the balls for which something else comes next, and their number.
    #[inline(always)]
    fn happen<M: Mode>(&mut self, ball: usize) -> ([usize; 2], usize) {
        let event = self.events[ball];
        if let Some(partner) = event.what.ball() {
            if self.events[partner].bends == event.partner_bends {
                if M::WELLS && event.what.is_rim() {
                    self.world.cross_rim::<M>(ball, partner);
                } else {
                    self.world.collide::<M>(ball, partner);
                }
                for ball in [ball, partner] {
                    self.events[ball].bends = self.events[ball].bends.wrapping_add(1);
                }
                return ([ball, partner], 2);
            }
            self.disturbed += 1;
        } else if let Some((axis, up)) = event.what.as_edge() {
            self.cross::<M>(ball, axis, up);
        } else if let Some(wall) = event.what.as_wall() {
            if self.world.walls[wall].bends == event.partner_bends {
                self.hit::<M>(ball, wall);
            } else {
                self.disturbed += 1;
            }
        }
        ([ball, ball], 1)
    }

    /// Moves a ball into the next cell.
    #[inline(always)]
    fn cross<M: Mode>(&mut self, ball: usize, axis: usize, up: bool) {
        self.crossings += 1;
        self.leave_cell(ball);
        let event = &mut self.events[ball];
        let count = self.grid.levels[event.level as usize].count[axis];
        let cell = event.cell[axis];
        event.cell[axis] = if up { cell + 1 } else { cell - 1 };
        if event.cell[axis] > count {
            event.cell[axis] = 1;
            self.wrap::<M>(ball, axis, 1);
        } else if event.cell[axis] == 0 {
            event.cell[axis] = count;
            self.wrap::<M>(ball, axis, -1);
        }
        self.enter_cell(ball);
    }

    /// Puts a ball into the next image of the box.
    #[inline(always)]
    fn wrap<M: Mode>(&mut self, ball: usize, axis: usize, direction: i32) {
        if !(M::SHEARS && axis == 1) {
            self.world.wrap(ball, axis, direction);
            return;
        }
        self.world.wrap_in_shear(ball, direction);
        let event = &mut self.events[ball];
        event.cell[0] = self.grid.cell_of(event.level, &self.world.balls[ball].position)[0];
    }

    /// A ball rebounds from a wall.
    #[cold]
    fn hit<M: Mode>(&mut self, ball: usize, wall: usize) {
        let bends = self.world.walls[wall].bends;
        self.world.hit::<M>(ball, wall);
        self.events[ball].bends = self.events[ball].bends.wrapping_add(1);
        if self.world.walls[wall].bends != bends {
            self.free_wall_changed::<M>(wall);
        }
    }

    /// Updates the events of balls after a wall's motion changed now by its schedule: those that it will hit before their next event.
    pub fn wall_changed(&mut self, wall: usize) {
        compiled_once!(self.wall_changed_in_mode(wall: usize));
    }

    fn wall_changed_in_mode(&mut self, wall: usize) {
        in_mode!(self.world.motion(), M => self.wall_changed_as::<M>(wall));
    }

    fn wall_changed_as<M: Mode>(&mut self, wall: usize) {
        (0..self.events.len()).for_each(|ball| self.update_for_wall::<M>(ball, wall));
    }
}
