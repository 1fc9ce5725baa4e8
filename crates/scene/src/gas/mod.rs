//! What a gas scene says.
//!
//! A scene has two or three dimensions, as many as its `size` has numbers; every position, velocity and acceleration has as
//! many. Quantities are in reduced units, with Boltzmann's constant 1 and no names of units, or in SI units: m, s, kg,
//! K, and pressure in Pa (in two dimensions N/m).

mod check;
mod scene;
mod walls;

pub use scene::colour_of_kind;
pub use walls::*;

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The `[gas]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// The box: lengths of its sides at the start, two or three. Its corner is at the origin.
    pub size: Vec<f64>,
    /// What the numbers are measured in.
    #[serde(default)]
    pub units: Units,
    /// How the gas is moved on.
    #[serde(default)]
    pub method: Method,
    /// Acceleration of gravity. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Vec<f64>>,
    /// Relative normal speed of two balls after a hit over that before it, above 0, at most 1.
    #[serde(default = "one")]
    pub restitution: f64,
    /// Guard against inelastic collapse: two balls of which one was hit less than this time ago part without loss
    /// (TC model: Luding & McNamara, Granular Matter 1, 1998). Left out: a ten-thousandth of the time in which a ball
    /// at the mean thermal speed flies its own radius, the shortest of all species; 0 without loss.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_time_s: Option<f64>,
    /// Square wells round all balls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub well: Option<SquareWell>,
    /// Steady shear flow in a periodic box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear: Option<Shear>,
    /// All velocities are turned round at this time, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reversed_at_s: Option<f64>,
    /// The ball, by its id, whose trajectory is recorded. Explicit balls have the first ids, from 0, then those of the file, then the species in order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub follow: Option<u64>,
    /// The sides of the box.
    #[serde(default)]
    pub walls: Walls,
    /// A thin wall across the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partition: Option<Partition>,
    /// What is measured.
    #[serde(default)]
    pub measure: Measure,
    /// A file of balls that are there at the start, beside those of `ball` and `species`: extended XYZ or CSV.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_file: Option<PathBuf>,
    /// Balls given one by one.
    #[serde(default)]
    pub ball: Vec<Ball>,
    /// Balls given as species.
    #[serde(default)]
    pub species: Vec<Species>,
}

fn one() -> f64 {
    1.0
}

impl Gas {
    /// Number of dimensions: 2 or 3 in a scene that was checked.
    pub fn dimensions(&self) -> usize {
        self.size.len()
    }

    /// Acceleration of gravity along x, y and z.
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity.as_deref().map_or([0.0; 3], padded)
    }
}

/// Numbers along x, y and, where there is one, z, as three; the third is 0 in two dimensions.
pub fn padded(numbers: &[f64]) -> [f64; 3] {
    std::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(0.0))
}

/// What the numbers of a gas scene are measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Boltzmann's constant is 1; length, mass and time are whatever the scene takes for 1.
    #[default]
    Reduced,
    /// m, s, kg, K.
    Si,
}

impl Units {
    /// Boltzmann's constant in these units; in J/K exact by the definition of the kelvin (SI, 2019).
    pub fn boltzmann(self) -> f64 {
        match self {
            Self::Reduced => 1.0,
            Self::Si => 1.380649e-23,
        }
    }
}

/// How the gas is moved on.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// From collision to collision, with cells and an event queue: exact, and the cost of a collision does not grow with
    /// the number of balls.
    #[default]
    EventDriven,
    /// From collision to collision, with a list of the nearest event of each ball, as published (Deng, Hu, Li & Zhang,
    /// Physics and Engineering 22(5), 2012): exact, and the cost of a collision grows with the number of balls.
    List,
    /// In equal steps, all pairs tested after each: balls overlap and pass through one another; both are counted.
    FixedStep {
        /// The step.
        time_step_s: f64,
    },
}

/// Square wells round all balls: the potential energy of two is lower by a depth where they are near each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SquareWell {
    /// Depth, as an energy; negative for a step up (a square shoulder).
    pub depth: f64,
    /// Distance of centres at the rim of the well, over that at contact; above 1.
    pub width: f64,
}

/// Steady shear flow along x whose velocity grows along y, in a box that is periodic along all axes (Lees & Edwards, J. Phys. C 5, 1972,
/// 1921).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shear {
    /// Rate of shear, 1/s.
    pub rate_per_s: f64,
    /// Temperature at which the gas is held. Left out: shear heats it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
}

/// Balls given as a species. Give exactly one of `count` and `packing`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Species {
    /// Name, unique in the scene.
    pub name: String,
    /// Number of balls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// Area (in three dimensions volume) of the balls over that of their region.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub packing: Option<f64>,
    /// Radius of a ball.
    pub radius: f64,
    /// Mass of a ball.
    pub mass: f64,
    /// Temperature at the start.
    pub temperature: f64,
    /// How the speeds are spread at the start.
    #[serde(default)]
    pub speeds: Speeds,
    /// Velocity of all of them together at the start. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// Where they are at the start. Left out: in the whole box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// How they are placed there.
    #[serde(default)]
    pub start: Start,
    /// Colour in pictures, `#rrggbb`. Left out: the next of a list of eight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<String>,
}

/// How speeds are spread at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Speeds {
    /// After Maxwell.
    #[default]
    Maxwell,
    /// All the same, in directions at random; collisions then make Maxwell's of them.
    Equal,
}

/// How balls are placed at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Evenly on a lattice.
    Lattice,
    /// At random, without overlap; in dense gases grown until they have their radius.
    #[default]
    Random,
}

/// A part of the box with sides along the axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Corner at the smallest coordinates.
    pub from: Vec<f64>,
    /// Corner at the largest coordinates.
    pub to: Vec<f64>,
}

/// One ball.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// What it is; balls of one name are one set, and may be of the name of a species.
    #[serde(default = "ball")]
    pub name: String,
    /// Position of its centre at the start.
    pub position: Vec<f64>,
    /// Velocity at the start. Left out: at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// Radius.
    pub radius: f64,
    /// Mass.
    pub mass: f64,
    /// Colour in pictures, `#rrggbb`. Left out: that of its species, or the next of a list of eight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<String>,
}

fn ball() -> String {
    "ball".into()
}

/// What is measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Measure {
    /// Averages over time begin here, s. Left out: a tenth of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// Bars of the histograms of speed and of velocity.
    pub speed_bins: usize,
    /// Axis of the density profile.
    pub profile_axis: Axis,
    /// Layers of the density profile.
    pub profile_bins: usize,
    /// Distances up to which g(r) is counted. Left out: five diameters of the largest species, at most half the
    /// shortest side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pair_distance: Option<f64>,
    /// Bins of g(r).
    pub pair_bins: usize,
    /// Collisions of each ball in the lag from which, to twice that, the growth of Helfand's moments gives viscosity and thermal
    /// conductivity.
    pub lag_collisions: f64,
    /// Parts of the box in which number, temperature, pressure and flow are measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub region: Vec<NamedRegion>,
}

/// A region of measurement: a part of the box, with sides along the axes; it stays where it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedRegion {
    /// Name, unique in the scene.
    pub name: String,
    /// Corner at the smallest coordinates.
    pub from: Vec<f64>,
    /// Corner at the largest coordinates.
    pub to: Vec<f64>,
}

impl Default for Measure {
    fn default() -> Self {
        Self {
            from_s: None,
            speed_bins: 40,
            profile_axis: Axis::X,
            profile_bins: 50,
            pair_distance: None,
            pair_bins: 100,
            lag_collisions: 40.0,
            region: Vec::new(),
        }
    }
}
