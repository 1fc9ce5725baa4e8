//! What a gas is made of: the set-up, independent of scene files.

mod check;
pub(crate) mod file;
mod lattice;
mod pistons;
mod positions;
mod random;
mod velocities;
mod walls;

pub(crate) use random::Placed;
pub(crate) use walls::Schedule;

use crate::functions::pow;
use crate::{Gas, SetupError};

/// A gas to be made. Fields may be changed before [`Setup::build`]; what is not said is as in [`Setup::new`].
///
/// Units are reduced ones unless `boltzmann` says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup<const D: usize> {
    /// Lengths of the box's sides; its corner is at the origin.
    pub size: [f64; D],
    /// Lower and upper side along each axis.
    pub sides: [[Side; 2]; D],
    /// A thin wall across the box.
    pub partition: Option<Partition>,
    /// Acceleration of gravity.
    pub gravity: [f64; D],
    /// Relative normal speed of two balls after a collision over that before.
    pub restitution: f64,
    /// Collisions within this time after another are without loss; for `None` see [`Setup::contact_time`].
    pub contact_time: Option<f64>,
    /// Square wells round all balls.
    pub well: Option<SquareWell>,
    /// Steady shear of a periodic box.
    pub shear: Option<Shear>,
    /// Boltzmann's constant in the units used.
    pub boltzmann: f64,
    /// How the gas is moved on.
    pub method: Method,
    /// Seed of everything random.
    pub seed: u64,
    /// Balls given one by one; they have the first numbers.
    pub balls: Vec<Ball<D>>,
    /// Balls given as species.
    pub species: Vec<Species<D>>,
    /// All velocities are turned round at this time.
    pub reversed_at: Option<f64>,
    /// Number of the ball whose path is kept.
    pub follow: Option<usize>,
    /// What is measured.
    pub measure: Measure,
    /// Parts of the box in which number, temperature, pressure and flow are measured.
    pub regions: Vec<Region<D>>,
}

/// A region of measurement: a part of the box; it stays where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Region<const D: usize> {
    /// Name, unique.
    pub name: String,
    /// Corner at the smallest coordinates.
    pub from: [f64; D],
    /// Corner at the largest coordinates.
    pub to: [f64; D],
}

/// Square wells: the potential energy of two balls is lower by `depth` where their centres are nearer than `width` times the distance at
/// contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareWell {
    /// Depth, as an energy; negative for a step up.
    pub depth: f64,
    /// Distance of centres at the rim, over that at contact.
    pub width: f64,
}

/// Steady shear flow along x whose velocity grows along y, in a box that is periodic along all axes (Lees & Edwards, J. Phys. C 5, 1972,
/// 1921). Initial velocities are relative to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shear {
    /// Rate of shear: velocity over height.
    pub rate: f64,
    /// Temperature at which the gas is held by scaling velocities relative to the flow; for `None` the work of shear heats it.
    pub temperature: Option<f64>,
}

/// What one side of the box is.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Side {
    /// It stays where it is.
    #[default]
    Fixed,
    /// What leaves here comes in at the opposite side.
    Periodic,
    /// What hits it leaves as from a gas at this temperature behind a hole in its place.
    Thermal {
        /// Temperature.
        temperature: f64,
    },
    /// It moves at a velocity, whatever hits it.
    Moving {
        /// Velocity, positive towards larger coordinates.
        velocity: f64,
        /// When it stops.
        until: Option<f64>,
    },
    /// It is displaced by rows of `[time, displacement]`, straight from row to row, at rest before and after.
    Displaced(Vec<[f64; 2]>),
    /// It swings: displacement amplitude sin(2 pi t / period).
    Swinging {
        /// Largest displacement.
        amplitude: f64,
        /// Time of one swing.
        period: f64,
    },
    /// It slides freely between the gas and an outside pressure.
    Piston {
        /// Mass.
        mass: f64,
        /// Pressure from outside.
        pressure: f64,
        /// Velocity at the start, positive towards larger coordinates.
        velocity: f64,
    },
}

/// A thin wall across the box. A hole lets pass a ball whose centre is before it when the ball touches the wall's plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Partition {
    /// The axis that it stands across.
    pub axis: usize,
    /// Its position along that axis.
    pub at: f64,
    /// When it is taken away.
    pub lifted_at: Option<f64>,
    /// From and to of a hole in it, along each of the other axes.
    pub hole: Option<Vec<[f64; 2]>>,
}

/// How a gas is moved on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Method {
    /// From collision to collision, with cells and an event queue.
    #[default]
    EventDriven,
    /// From collision to collision, with a list of the nearest event of each ball, as published.
    List,
    /// In steps of this length, all pairs tested after each.
    FixedStep(f64),
}

/// One ball.
#[derive(Debug, Clone, PartialEq)]
pub struct Ball<const D: usize> {
    /// What it is; balls of one name are one set.
    pub name: String,
    /// Position of its centre.
    pub position: [f64; D],
    /// Velocity.
    pub velocity: [f64; D],
    /// Radius.
    pub radius: f64,
    /// Mass.
    pub mass: f64,
}

/// Balls given as a species.
#[derive(Debug, Clone, PartialEq)]
pub struct Species<const D: usize> {
    /// Name, unique.
    pub name: String,
    /// How many.
    pub amount: Amount,
    /// Radius of a ball.
    pub radius: f64,
    /// Mass of a ball.
    pub mass: f64,
    /// Temperature at the start, exactly, as far as the balls move relative to each other.
    pub temperature: f64,
    /// How speeds are spread.
    pub speeds: Speeds,
    /// Velocity of all of them together.
    pub velocity: [f64; D],
    /// Corners of the part of the box where they are; the whole box for `None`.
    pub region: Option<[[f64; D]; 2]>,
    /// How they are placed there.
    pub start: Start,
}

impl<const D: usize> Species<D> {
    /// Balls of radius 1/2 and mass 1 at temperature 1, at random in the whole box.
    pub fn new(name: &str, amount: Amount) -> Self {
        Species {
            name: name.into(),
            amount,
            radius: 0.5,
            mass: 1.0,
            temperature: 1.0,
            speeds: Speeds::Maxwell,
            velocity: [0.0; D],
            region: None,
            start: Start::Random,
        }
    }
}

/// How many balls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// This many.
    Count(usize),
    /// As many as fill this part of their region.
    Packing(f64),
}

/// How speeds are spread at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Speeds {
    /// After Maxwell.
    #[default]
    Maxwell,
    /// All the same.
    Equal,
}

/// How balls are placed at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// Evenly on a lattice.
    Lattice,
    /// At random; in dense gases grown until they have their radius (Lubachevsky and Stillinger, J. Stat. Phys. 60, 1990, 561).
    #[default]
    Random,
}

/// What is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// Averages begin here.
    pub from: f64,
    /// End of the run, where it is known: averages that begin later are never made, which a warning says.
    pub until: Option<f64>,
    /// Time between samples of the gas; for `None` nothing but the event counts is measured.
    pub every: Option<f64>,
    /// Bars of the histograms of speed and velocity.
    pub speed_bins: usize,
    /// Axis of the density profile.
    pub profile_axis: usize,
    /// Layers of the density profile.
    pub profile_bins: usize,
    /// Distance up to which g(r) is counted; five of the largest diameters for `None`, at most half the shortest side.
    pub pair_distance: Option<f64>,
    /// Bins of g(r).
    pub pair_bins: usize,
    /// Collisions of each ball in the lag from which, to twice that, the growth of moments gives viscosity and thermal conductivity.
    /// After it nothing must be left of the flows at its start: in dense fluids that lasts tens of collisions.
    pub lag_collisions: f64,
}

impl Default for Measure {
    fn default() -> Self {
        Measure {
            from: 0.0,
            until: None,
            every: None,
            speed_bins: 40,
            profile_axis: 0,
            profile_bins: 50,
            pair_distance: None,
            pair_bins: 100,
            lag_collisions: 40.0,
        }
    }
}

impl<const D: usize> Setup<D> {
    /// An empty box with fixed walls, without gravity, all collisions without loss.
    pub fn new(size: [f64; D]) -> Self {
        Setup {
            size,
            sides: std::array::from_fn(|_| [Side::Fixed, Side::Fixed]),
            partition: None,
            gravity: [0.0; D],
            restitution: 1.0,
            contact_time: None,
            well: None,
            shear: None,
            boltzmann: 1.0,
            method: Method::EventDriven,
            seed: 0,
            balls: Vec::new(),
            species: Vec::new(),
            reversed_at: None,
            follow: None,
            measure: Measure::default(),
            regions: Vec::new(),
        }
    }

    /// `count` balls of diameter 1, mass 1 and temperature 1 that fill `packing` of a periodic cube (in two dimensions a square).
    pub fn fluid(count: usize, packing: f64) -> Self {
        let size = pow(count as f64 * ball_volume::<D>(0.5) / packing, 1.0 / D as f64);
        Setup::new([size; D]).periodic().species(Species::new("balls", Amount::Count(count)))
    }

    /// True where the box repeats along an axis.
    pub(crate) fn repeats_along(&self, axis: usize) -> bool {
        self.sides[axis][0] == Side::Periodic
    }

    /// True where nothing but the balls themselves changes their momentum and energy.
    pub(crate) fn keeps_momentum_and_energy(&self) -> bool {
        let repeats = (0..D).all(|axis| self.repeats_along(axis)) && self.partition.is_none();
        repeats && self.shear.is_none() && self.restitution == 1.0 && self.gravity == [0.0; D]
    }

    /// All sides periodic.
    pub fn periodic(mut self) -> Self {
        self.sides = std::array::from_fn(|_| [Side::Periodic, Side::Periodic]);
        self
    }

    /// One side: the lower (0) or the upper (1) along an axis.
    pub fn side(mut self, axis: usize, end: usize, side: Side) -> Self {
        self.sides[axis][end] = side;
        self
    }

    /// One more ball.
    pub fn ball(mut self, position: [f64; D], velocity: [f64; D], radius: f64, mass: f64) -> Self {
        self.balls.push(Ball { name: "ball".into(), position, velocity, radius, mass });
        self
    }

    /// One more species.
    pub fn species(mut self, species: Species<D>) -> Self {
        self.species.push(species);
        self
    }

    /// Another seed.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Another method.
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Gravity.
    pub fn gravity(mut self, gravity: [f64; D]) -> Self {
        self.gravity = gravity;
        self
    }

    /// Collisions with loss.
    pub fn restitution(mut self, restitution: f64) -> Self {
        self.restitution = restitution;
        self
    }

    /// Square wells round all balls.
    pub fn well(mut self, depth: f64, width: f64) -> Self {
        self.well = Some(SquareWell { depth, width });
        self
    }

    /// Steady shear, at a temperature that is held or not.
    pub fn shear(mut self, rate: f64, temperature: Option<f64>) -> Self {
        self.shear = Some(Shear { rate, temperature });
        self
    }

    /// Samples the gas every `every`, and averages from `from` on.
    pub fn measured(mut self, from: f64, every: f64) -> Self {
        (self.measure.from, self.measure.every) = (from, Some(every));
        self
    }

    /// The guard time against inelastic collapse that is taken where none is given: a ten-thousandth of the time in which a ball
    /// at the mean thermal speed (one given by itself: at its own) flies its own radius, the shortest of all; 0 without loss.
    pub fn contact_time(&self) -> f64 {
        let thermal =
            |species: &Species<D>| 1e-4 * species.radius / (self.boltzmann * species.temperature / species.mass).sqrt();
        let own = |ball: &Ball<D>| 1e-4 * ball.radius / crate::world::speed(&ball.velocity);
        let times = self.species.iter().map(thermal).chain(self.balls.iter().map(own));
        let shortest = times.filter(|time| time.is_finite()).fold(f64::INFINITY, f64::min);
        match self.contact_time {
            Some(time) => time,
            None if self.restitution < 1.0 && shortest.is_finite() => shortest,
            None => 0.0,
        }
    }

    /// Makes the gas.
    ///
    /// # Errors
    /// [`SetupError`] where it cannot be.
    pub fn build(self) -> Result<Gas<D>, SetupError> {
        Gas::new(self)
    }
}

/// Area (in three dimensions volume) of a ball.
pub fn ball_volume<const D: usize>(radius: f64) -> f64 {
    use std::f64::consts::PI;
    if D == 2 { PI * radius * radius } else { 4.0 / 3.0 * PI * radius.powi(3) }
}
