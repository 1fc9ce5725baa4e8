//! A gas: what is in the box, how it is moved on, what happens by plan, and what is measured.

mod advance;
mod build;
mod live_change;
mod model;
mod observe;
mod state;

pub use live_change::LiveChange;

use crate::measure::{Measures, Set};
use crate::method::Mover;
use crate::setup::{Schedule, Setup};
use live_change::LiveTally;

/// Hard balls in a box, from collision to collision.
///
/// Made by [`Setup::build`]; advanced and read by its [`corpuscle_model::Model`].
#[derive(Debug)]
pub struct Gas<const D: usize> {
    setup: Setup<D>,
    mover: Mover<D>,
    /// Names of the sets of balls, their masses and colours.
    sets: Vec<Set>,
    /// What moves each wall by plan.
    plans: Vec<Option<Plan>>,
    /// The partition's wall.
    partition: Option<usize>,
    lifted: bool,
    reversed: bool,
    /// Number of the next sample.
    next_sample: u64,
    measures: Measures,
    /// Energy and momentum at the start.
    initial: [f64; 2],
    shown: f64,
    /// Path and number of its ends at the last check of the balls' room.
    checked: (f64, u64),
    si: bool,
    /// What live changes added and removed.
    live: LiveTally,
}

/// A wall's plan, how far it has come, and where the wall started.
#[derive(Debug, Clone, PartialEq)]
struct Plan {
    schedule: Schedule,
    next: usize,
    home: f64,
}

/// What happens by plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Due {
    Knot(usize),
    Lift,
    Reverse,
    /// A piston that is dragged is where it is to be.
    Arrive(usize),
    /// The thermostat scales velocities.
    Regulate,
    Sample,
}

impl<const D: usize> Gas<D> {
    /// Gives the balls of a name a colour in charts, `#rrggbb`.
    pub(crate) fn paint(&mut self, name: &str, colour: Option<&str>) {
        if let Some(set) = self.sets.iter_mut().find(|set| set.name == name) {
            set.colour = colour.map(str::to_owned);
        }
    }

    /// Whether numbers are in SI units.
    pub(crate) fn count_in_si(&mut self, si: bool) {
        self.si = si;
    }
}
