//! The gas at one time.

use crate::world::{Moments, RegionSample};
use serde::{Deserialize, Serialize};

/// Sums and means at one time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sample {
    pub time: f64,
    pub temperature: f64,
    /// Kinetic energy of the motion relative to that of the whole and, in a sheared box, to the flow.
    pub kinetic: f64,
    pub volume: f64,
    /// Area (in three dimensions volume) open to the balls' centres.
    pub open: f64,
    /// Counts and sums since the start.
    pub collisions: u64,
    pub virial: f64,
    pub path: f64,
    /// What momentum and energy have moved since the start; 0 where that is not measured.
    pub moments: Moments,
    /// Momentum given to each wall since the start.
    pub walls: Vec<f64>,
    /// Area of each wall.
    pub areas: Vec<f64>,
    /// Mean-square displacement of each set since averages began.
    pub displacement: Vec<f64>,
    /// Entropy of mixing, where there are several sets.
    pub mixing: f64,
    /// Balls of each set beyond the partition.
    pub beyond: Vec<f64>,
    /// Regions of measurement.
    pub regions: Vec<RegionSample>,
}

/// The gas at one time, ball by ball in order of their numbers.
#[derive(Debug, Clone)]
pub(crate) struct Snapshot<const D: usize> {
    pub sample: Sample,
    pub position: Vec<[f64; D]>,
    /// As if the box did not repeat.
    pub unwrapped: Vec<[f64; D]>,
    pub velocity: Vec<[f64; D]>,
    /// Velocities relative to the flow and to the motion as a whole, where there is one of them; else empty.
    pub thermal: Vec<[f64; D]>,
    /// Velocity as a whole along the axes on which nothing changes it.
    pub drift: [f64; D],
    /// How far the image above has slid, in a sheared box; else 0.
    pub slid: f64,
    pub set: Vec<u32>,
    /// Where the box begins and ends along each axis.
    pub extent: [[f64; 2]; D],
    pub period: [f64; D],
}

impl<const D: usize> Snapshot<D> {
    /// Velocity of a ball relative to the flow of a sheared box and to the motion as a whole.
    pub fn thermal_velocity(&self, number: usize) -> &[f64; D] {
        self.thermal.get(number).unwrap_or(&self.velocity[number])
    }
}
