//! Setting up, and starting afresh from time to time.

use super::Engine;
use super::ball::{Ball, Event, Kind, NONE, Record, What};
use super::collide::{Rebound, Tally};
use super::contact::{Falling, Field, Growing, Mode, Near, Straight};
use super::grid::Grid;
use super::memory;
use super::queue::Queue;
use super::wall::Wall;
use multiversion::multiversion;

/// A ball as it is put in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start<const D: usize> {
    pub position: [f64; D],
    pub velocity: [f64; D],
    pub kind: u32,
    pub species: u32,
}

/// Balls in a cell that make the least work, in two and three dimensions.
const fn balls_per_cell(dimensions: usize) -> f64 {
    if dimensions == 2 { 0.7 } else { 0.6 }
}

impl<const D: usize> Engine<D> {
    pub fn new(
        low: [f64; D],
        length: [f64; D],
        kinds: Vec<Kind>,
        starts: &[Start<D>],
        walls: Vec<Wall>,
        field: Field<D>,
        rebound: Rebound,
    ) -> Self {
        let mut balls = memory::reserved(starts.len());
        let mut records = memory::reserved(starts.len());
        let mut events = memory::reserved(starts.len());
        for (id, start) in starts.iter().enumerate() {
            let Start { position, velocity, kind, species } = *start;
            balls.push(Ball { position, velocity, time: 0.0, kind, next: NONE });
            records.push(Record { id: id as u32, species, image: [0; D], collided: f64::NEG_INFINITY });
            events.push(no_event());
        }
        let periodic = field.period.map(|period| period > 0.0);
        let grid = Grid::new([0.0; D], [1.0; D], [false; D], 1.0, 1.0, 1).expect("one cell without periodic sides");
        let mut engine = Engine {
            queue: Queue::new(&events),
            balls,
            events,
            records,
            alike: kinds.windows(2).all(|pair| pair[0].radius == pair[1].radius),
            kinds,
            field,
            walls_roam: walls.iter().any(|wall| !wall.at_edge),
            walls,
            rebound,
            low,
            length,
            grid,
            near: Box::new(Near::new()),
            now: 0.0,
            origin: crate::sum::ExactSum::default(),
            handled: 0,
            tally: Tally::default(),
            standstill: 0,
        };
        let _ = periodic;
        engine.rebuild();
        engine
    }

    /// Begins a new window now: all balls at the same time, in space-filling order, in new cells, with everything predicted
    /// afresh.
    pub fn rebuild(&mut self) {
        if self.field.growth != 0.0 {
            self.rebuild_as::<Growing>();
        } else if self.field.gravity != [0.0; D] {
            self.rebuild_as::<Falling>();
        } else {
            self.rebuild_as::<Straight>();
        }
    }

    pub(super) fn rebuild_as<M: Mode>(&mut self) {
        self.shift::<M>();
        self.grid = self.fitting_grid();
        self.sort();
        self.fill_cells();
        self.handled = 0;
        foresee_all::<D, M>(self);
        self.queue = Queue::new(&self.events);
        for (ball, event) in self.events.iter().enumerate() {
            self.queue.push(event.time, ball as u32, event.stamp);
        }
    }

    /// Makes now the beginning of the window.
    fn shift<M: Mode>(&mut self) {
        for ball in 0..self.balls.len() {
            self.bring::<M>(ball);
            self.balls[ball].time = 0.0;
            self.records[ball].collided -= self.now;
        }
        for wall in &mut self.walls {
            wall.since -= self.now;
        }
        self.field.scale = self.field.scale_at::<M>(self.now);
        self.origin.add(self.now);
        self.now = 0.0;
    }

    /// A grid for the balls as they are.
    fn fitting_grid(&self) -> Grid<D> {
        let mut diameters: Vec<f64> = self.balls.iter().map(|ball| 2.0 * self.kinds[ball.kind as usize].radius).collect();
        let periodic = self.field.period.map(|period| period > 0.0);
        let count = diameters.len().max(1);
        let volume: f64 = self.length.iter().product();
        let thin = (volume * balls_per_cell(D) / count as f64).powf(1.0 / D as f64);
        let largest = diameters.iter().copied().fold(0.0, f64::max);
        let usual = if diameters.is_empty() {
            1.0
        } else {
            let nth = count * 9 / 10;
            *diameters.select_nth_unstable_by(nth.min(count - 1), f64::total_cmp).1
        };
        let finest = if largest < 2.0 * usual { largest } else { usual }.max(thin);
        // Slightly wide: a ball may be a rounding error beyond its cell.
        let finest = finest * (1.0 + 1e-9);
        Grid::new(self.low, self.length, periodic, finest, largest * (1.0 + 1e-9), 8 * count + 64)
            .or_else(|| Grid::new(self.low, self.length, periodic, largest * (1.0 + 1e-9), largest, 8 * count + 64))
            .expect("the box is at least three balls wide across periodic sides")
    }

    /// Puts balls that are near each other in space near each other in memory: in Morton order of their cells.
    fn sort(&mut self) {
        let key = |ball: &Ball<D>| -> u64 {
            let cell = self.grid.cell_of(0, &ball.position);
            (0..16).map(|bit| (0..D).map(|axis| u64::from(cell[axis] >> bit & 1) << (bit * D + axis)).sum::<u64>()).sum()
        };
        let mut order: Vec<(u64, u32)> = self.balls.iter().zip(0..).map(|(ball, number)| (key(ball), number)).collect();
        order.sort_unstable();
        let mut balls = memory::reserved(self.balls.len());
        balls.extend(order.iter().map(|&(_, from)| self.balls[from as usize]));
        let mut records = memory::reserved(self.balls.len());
        records.extend(order.iter().map(|&(_, from)| self.records[from as usize]));
        (self.balls, self.records) = (balls, records);
    }

    fn fill_cells(&mut self) {
        for ball in 0..self.balls.len() {
            let level = self.grid.level_of(2.0 * self.kinds[self.balls[ball].kind as usize].radius);
            let cell = self.grid.cell_of(level, &self.balls[ball].position);
            self.events[ball] = Event { level, cell, ..no_event() };
            self.enter_cell(ball);
        }
    }

    /// Puts a ball in the list of its cell.
    #[inline(always)]
    pub(super) fn enter_cell(&mut self, ball: usize) {
        let event = &self.events[ball];
        let index = self.grid.index(event.level, &event.cell);
        self.balls[ball].next = std::mem::replace(&mut self.grid.heads[index], ball as u32);
    }

    /// Takes a ball off the list of its cell.
    #[inline(always)]
    pub(super) fn leave_cell(&mut self, ball: usize) {
        let event = &self.events[ball];
        let index = self.grid.index(event.level, &event.cell);
        let next = self.balls[ball].next;
        let mut at = self.grid.heads[index] as usize;
        if at == ball {
            self.grid.heads[index] = next;
            return;
        }
        while self.balls[at].next as usize != ball {
            at = self.balls[at].next as usize;
        }
        self.balls[at].next = next;
    }

    /// Bytes held for the balls and their events.
    pub fn bytes(&self) -> usize {
        let each = size_of::<Ball<D>>() + size_of::<Event<D>>() + size_of::<Record<D>>();
        self.balls.len() * each + self.grid.bytes() + self.queue.bytes()
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn foresee_all<const D: usize, M: Mode>(engine: &mut Engine<D>) {
    for ball in 0..engine.balls.len() {
        engine.foresee::<M>(ball);
    }
}

fn no_event<const D: usize>() -> Event<D> {
    let (time, what, cell) = (f64::INFINITY, What::NOTHING, [1; D]);
    Event { time, what, partner_bends: 0, bends: 0, stamp: 0, cell, level: 0 }
}
