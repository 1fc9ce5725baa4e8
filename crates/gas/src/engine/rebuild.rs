//! Starting afresh, at first and from time to time.

use super::Engine;
use super::ahead::Ahead;
use super::compiled_once::compiled_once;
use super::event::{Event, What};
use super::grid::Grid;
use super::queue::Queue;
use crate::functions::pow;
use crate::world::{Ball, Mode, NONE, in_mode};
use multiversion::multiversion;

/// Balls in a cell that make the least work, in two and three dimensions.
const fn balls_per_cell(dimensions: usize) -> f64 {
    if dimensions == 2 { 0.7 } else { 0.6 }
}

/// A cell's side over what it must hold: a ball may be a rounding error beyond its cell.
const SLACK: f64 = 1.0 + 1e-9;

impl<const D: usize> Engine<D> {
    /// Begins a new window now: all balls at the same time, in space-filling order, in new cells, with everything predicted
    /// afresh.
    pub fn rebuild(&mut self) {
        compiled_once!(self.rebuild_in_mode());
    }

    fn rebuild_in_mode(&mut self) {
        in_mode!(self.world.motion(), M => self.rebuild_as::<M>());
    }

    fn rebuild_as<M: Mode>(&mut self) {
        self.world.begin_window::<M>();
        self.grid = self
            .fitting_grid()
            .expect("checked before: the box is at least three of the largest balls wide across periodic sides");
        self.sort();
        self.fill_cells();
        self.handled = 0;
        self.watch_none();
        if M::SHEARS {
            self.begin_slide();
        }
        foresee_all::<D, M>(self);
        self.fill_queue();
    }

    /// A queue of the events of all balls.
    pub(super) fn fill_queue(&mut self) {
        self.queue = Queue::new(&self.events, self.prefetches);
        self.ahead = Ahead::new();
        for (ball, event) in self.events.iter().enumerate() {
            self.queue.push(event.time, ball as u32, event.stamp);
        }
    }

    /// A grid for the box as it was at the beginning of the window; none for a box that is less than three of the largest balls wide across
    /// periodic sides.
    pub(super) fn fitting_grid(&self) -> Option<Grid<D>> {
        let world = &self.world;
        let mut diameters: Vec<f64> = (0..world.balls.len()).map(|ball| world.reach(ball)).collect();
        let periodic = world.field.period.map(|period| period > 0.0);
        let count = diameters.len().max(1);
        let volume: f64 = world.length.iter().product();
        let thin = pow(volume * balls_per_cell(D) / count as f64, 1.0 / D as f64);
        let largest = diameters.iter().copied().fold(0.0, f64::max);
        let nth = (diameters.len() * 9 / 10).min(diameters.len().saturating_sub(1));
        let usual = if diameters.is_empty() { 1.0 } else { *diameters.select_nth_unstable_by(nth, f64::total_cmp).1 };
        // Rows at the faces of a sheared box have one size of cells.
        let one_level = largest < 2.0 * usual || world.field.is_sheared();
        let finest = if one_level { largest } else { usual };
        Grid::new(world.low, world.length, periodic, finest.max(thin) * SLACK, largest * SLACK, 8 * count + 64)
    }

    /// Puts balls that are near each other in space near each other in memory: in Morton order of their cells.
    fn sort(&mut self) {
        let key = |ball: &Ball<D>| -> u64 {
            let cell = self.grid.cell_of(0, &ball.position);
            (0..16)
                .map(|bit| (0..D).map(|axis| u64::from(cell[axis] >> bit & 1) << (bit * D + axis)).sum::<u64>())
                .sum()
        };
        let mut keys: Vec<(u64, u32)> =
            self.world.balls.iter().zip(0..).map(|(ball, number)| (key(ball), number)).collect();
        keys.sort_unstable();
        let order: Vec<u32> = keys.into_iter().map(|(_, from)| from).collect();
        self.world.reorder(&order);
    }

    fn fill_cells(&mut self) {
        self.events.clear();
        for ball in 0..self.world.balls.len() {
            let level = self.grid.level_of(self.world.reach(ball));
            let cell = self.grid.cell_of(level, &self.world.balls[ball].position);
            let (time, what) = (f64::INFINITY, What::NOTHING);
            self.events.push(Event { time, what, partner_bends: 0, bends: 0, stamp: 0, cell, level });
            self.enter_cell(ball);
        }
    }

    /// Puts a ball in the list of its cell.
    #[inline(always)]
    pub(super) fn enter_cell(&mut self, ball: usize) {
        let event = &self.events[ball];
        let index = self.grid.index(event.level, &event.cell);
        self.world.balls[ball].next = std::mem::replace(&mut self.grid.heads[index], ball as u32);
    }

    /// Takes a ball off the list of its cell.
    #[inline(always)]
    pub(super) fn leave_cell(&mut self, ball: usize) {
        let event = &self.events[ball];
        let index = self.grid.index(event.level, &event.cell);
        let balls = &mut self.world.balls;
        let next = std::mem::replace(&mut balls[ball].next, NONE);
        let mut at = self.grid.heads[index] as usize;
        if at == ball {
            self.grid.heads[index] = next;
            return;
        }
        while balls[at].next as usize != ball {
            at = balls[at].next as usize;
        }
        balls[at].next = next;
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn foresee_all<const D: usize, M: Mode>(engine: &mut Engine<D>) {
    for ball in 0..engine.events.len() {
        engine.foresee::<M>(ball);
    }
}
