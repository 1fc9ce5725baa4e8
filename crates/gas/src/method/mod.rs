//! The ways to move a gas on, behind one face.

mod fixed_step;
mod list;

pub(crate) use fixed_step::{Faults, FixedStep};
pub(crate) use list::List;
pub use list::{Nearest, With};

use crate::engine::Engine;
use crate::pause::Pause;
use crate::world::World;

/// A gas and how it is moved on.
#[derive(Debug)]
pub(crate) enum Mover<const D: usize> {
    EventDriven(Box<Engine<D>>),
    List(List<D>),
    FixedStep(FixedStep<D>),
}

impl<const D: usize> Mover<D> {
    pub fn world(&self) -> &World<D> {
        match self {
            Self::EventDriven(engine) => &engine.world,
            Self::List(list) => &list.world,
            Self::FixedStep(steps) => &steps.world,
        }
    }

    pub fn world_mut(&mut self) -> &mut World<D> {
        match self {
            Self::EventDriven(engine) => &mut engine.world,
            Self::List(list) => &mut list.world,
            Self::FixedStep(steps) => &mut steps.world,
        }
    }

    /// Handles what happens up to `until` (in the window), `most` events at most.
    pub fn run(&mut self, until: f64, most: u64) -> Pause {
        match self {
            Self::EventDriven(engine) => engine.run(until, most),
            Self::List(list) => list.run(until, most),
            Self::FixedStep(steps) => steps.run(until, most),
        }
    }

    /// Begins a new window now.
    pub fn begin_window(&mut self) {
        match self {
            Self::EventDriven(engine) => engine.rebuild(),
            Self::List(list) => list.begin_window(),
            Self::FixedStep(steps) => steps.begin_window(),
        }
    }

    /// Takes notice that a wall's motion changed now.
    pub fn wall_changed(&mut self, wall: usize) {
        match self {
            Self::EventDriven(engine) => engine.wall_changed(wall),
            Self::List(list) => list.find_all_events(),
            Self::FixedStep(_) => {}
        }
    }

    /// Bytes held for the balls and what is to come of them.
    pub fn bytes(&self) -> usize {
        match self {
            Self::EventDriven(engine) => engine.bytes(),
            Self::List(list) => list.bytes(),
            Self::FixedStep(steps) => steps.bytes(),
        }
    }
}
