//! The event-driven engine: the earliest event, what it changes, what comes next of those it touched; again and again.
//!
//! Each ball keeps its own nearest event (Deng, Hu, Li and Zhang 2012). It is searched in the cells around the ball and queued in
//! a calendar. A ball whose partner is hit by another is disturbed: its event is found out of date when its time comes,
//! and a new one is searched then; no event of it can be earlier.

mod ahead;
mod compiled_once;
mod event;
mod grid;
mod near;
mod predict;
mod queue;
mod rebuild;
mod run;
mod saved;
mod slide;
mod watch;

pub(crate) use saved::Saved;

use crate::world::{Facing, World};
use ahead::Ahead;
use event::Event;
use grid::Grid;
use near::Near;
use queue::Queue;

/// Balls in a box and their coming events.
#[derive(Debug)]
pub(crate) struct Engine<const D: usize> {
    pub world: World<D>,
    events: Vec<Event<D>>,
    grid: Grid<D>,
    queue: Queue,
    near: Box<Near<D>>,
    ahead: Ahead,
    /// True where the memory of coming events is prefetched: in large gases.
    prefetches: bool,
    /// True where all balls have the same radius.
    alike: bool,
    /// True where a wall is not only met in the outermost cells.
    walls_roam: bool,
    /// Times at which the balls near each wall are updated again, and the first of these times.
    watches: Vec<f64>,
    next_watch: f64,
    /// Whole cells by which the image above has slid, in a sheared box.
    slid_cells: i64,
    /// Working memory: balls beside a wall.
    beside_wall: Vec<u32>,
    /// Events handled since the window was moved on.
    handled: u64,
    /// Cell edges crossed, and searches for a new event because the partner was lost.
    pub crossings: u64,
    pub disturbed: u64,
}

impl<const D: usize> Engine<D> {
    /// Makes the engine of a world and finds the next event of every ball.
    pub fn new(world: World<D>) -> Self {
        let grid = Grid::new([0.0; D], [1.0; D], [false; D], 1.0, 1.0, 1).expect("one cell without periodic sides");
        let mut engine = Engine {
            events: crate::memory::reserved(world.balls.len()),
            prefetches: world.balls.len() >= ahead::PREFETCH_MIN_BALLS,
            alike: world.kinds.windows(2).all(|pair| pair[0].radius == pair[1].radius),
            walls_roam: world.walls.iter().any(|wall| wall.facing == Facing::Both || wall.moves),
            world,
            grid,
            queue: Queue::new::<D>(&[], false),
            near: Box::new(Near::new()),
            ahead: Ahead::new(),
            watches: Vec::new(),
            next_watch: f64::INFINITY,
            slid_cells: 0,
            beside_wall: Vec::new(),
            handled: 0,
            crossings: 0,
            disturbed: 0,
        };
        engine.rebuild();
        engine
    }

    /// Bytes held for the balls and their events.
    pub fn bytes(&self) -> usize {
        let world = size_of::<crate::world::Ball<D>>() + size_of::<crate::world::Record<D>>();
        self.world.balls.len() * (world + size_of::<Event<D>>()) + self.grid.bytes() + self.queue.bytes()
    }
}
