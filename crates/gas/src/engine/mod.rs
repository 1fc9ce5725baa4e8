//! The event-driven engine: the earliest event, what it changes, what comes next of those it touched; again and again.

pub(crate) mod ball;
mod collide;
pub(crate) mod contact;
mod grid;
mod memory;
mod predict;
mod queue;
mod rebuild;
mod run;
pub(crate) mod wall;

pub(crate) use collide::{Rebound, Tally};
pub(crate) use rebuild::Start;
pub(crate) use run::Pause;

use ball::{Ball, Event, Kind, Record};
use contact::{Field, Near};
use grid::Grid;
use queue::Queue;
use wall::Wall;

/// Balls in a box and all that is to come of them.
///
/// Times inside are counted from the beginning of a window, which is moved on at fixed numbers of events, so that they stay
/// short and keep their digits.
#[derive(Debug)]
pub(crate) struct Engine<const D: usize> {
    pub balls: Vec<Ball<D>>,
    events: Vec<Event<D>>,
    pub records: Vec<Record<D>>,
    pub kinds: Vec<Kind>,
    /// True where all balls have the same radius.
    alike: bool,
    pub field: Field<D>,
    pub walls: Vec<Wall>,
    /// True where a wall is not only met in the outermost cells.
    walls_roam: bool,
    pub rebound: Rebound,
    low: [f64; D],
    length: [f64; D],
    grid: Grid<D>,
    queue: Queue,
    near: Box<Near<D>>,
    /// Time of the last event, in the window.
    now: f64,
    /// Beginning of the window.
    origin: crate::sum::ExactSum,
    /// Events since the window was moved on.
    handled: u64,
    pub tally: Tally,
    /// Collisions in a row between which nothing moved.
    standstill: u32,
}

impl<const D: usize> Engine<D> {
    /// Time of the last event.
    pub fn time(&self) -> f64 {
        self.origin.value() + self.now
    }
}
