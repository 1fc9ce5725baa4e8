//! Measures of a gas, sampled at times that depend only on the set-up.

pub(crate) mod charts;
pub(crate) mod estimate;
mod flow;
mod laws;
mod maxwell;
mod mixing;
mod pairs;
pub(crate) mod region;
mod sample;
pub(crate) mod transport;

pub use estimate::Estimate;
pub(crate) use maxwell::{Maxwell, p_value};
pub(crate) use mixing::mixing_entropy;
pub(crate) use sample::{Sample, Snapshot};

use crate::setup::{Measure, Setup};
use flow::Flow;
use pairs::Pairs;
use serde::{Deserialize, Serialize};

/// Samples between two counts of pairs, which take longer than the rest.
const SAMPLES_PER_PAIR_COUNT: usize = 8;

/// Balls of one name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Set {
    /// The name.
    pub name: String,
    /// Mass of a ball: of the first of them.
    pub mass: f64,
    /// Colour that the scene gives, if any.
    pub colour: Option<String>,
}

/// Everything measured so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Measures {
    pub samples: Vec<Sample>,
    /// Samples since averages began.
    pub averaged: usize,
    /// Speeds are counted as if the temperature had stayed: in a gas that cools by itself.
    pub cools: bool,
    /// Counts of speeds for each set, bars of one width.
    pub speeds: Vec<Vec<u64>>,
    /// Counts of velocities along x for each set, from minus to plus the largest speed.
    pub velocities: Vec<Vec<u64>>,
    /// Largest speed of each set's histograms.
    pub largest: Vec<f64>,
    /// Sums of temperature over these samples.
    pub temperatures: f64,
    /// Counts along the profile's axis for each set.
    pub profile: Vec<Vec<u64>>,
    pub pairs: Pairs,
    /// Velocity along x over y, in a sheared box.
    pub flow: Option<Flow>,
    /// Positions of all balls, by number, when averages began.
    pub starts: Vec<f64>,
    /// When that was.
    pub started: f64,
}

impl Measures {
    pub fn new<const D: usize>(setup: &Setup<D>, sets: usize, largest: Vec<f64>) -> Self {
        let measure = &setup.measure;
        Measures {
            cools: setup.restitution < 1.0,
            samples: Vec::new(),
            averaged: 0,
            speeds: vec![vec![0; measure.speed_bins]; sets],
            velocities: vec![vec![0; measure.speed_bins]; sets],
            largest,
            temperatures: 0.0,
            profile: vec![vec![0; measure.profile_bins]; sets],
            pairs: Pairs::new(setup.pair_distance(), measure.pair_bins),
            flow: setup.shear.map(|_| Flow::new(measure.profile_bins)),
            starts: Vec::new(),
            started: f64::NAN,
        }
    }

    /// Whether these are measures of the same set-up as `new`, of a gas with so many walls, regions and balls.
    pub fn fit<const D: usize>(&self, new: &Self, walls: usize, regions: usize, balls: usize) -> bool {
        let lengths = |bars: &[Vec<u64>]| bars.iter().map(Vec::len).collect::<Vec<_>>();
        let sets = new.speeds.len();
        let is_of_sets = |values: &[f64]| values.is_empty() || values.len() == sets;
        let sample_fits = |sample: &Sample| {
            sample.walls.len() == walls
                && sample.areas.len() == walls
                && sample.regions.len() == regions
                && is_of_sets(&sample.displacement)
                && is_of_sets(&sample.beyond)
        };
        let histograms =
            |measures: &Self| [&measures.speeds, &measures.velocities, &measures.profile].map(|bars| lengths(bars));
        histograms(self) == histograms(new)
            && self.largest.len() == sets
            && self.pairs.counts.len() == new.pairs.counts.len()
            && self.starts.len().is_multiple_of(D)
            && self.starts.len() / D <= balls
            && self.averaged <= self.samples.len()
            && self.samples.iter().all(sample_fits)
    }

    /// Restarts the averages, with histograms up to other speeds; samples over time stay.
    pub fn begin_anew<const D: usize>(&mut self, setup: &Setup<D>, largest: Vec<f64>) {
        let mut samples = std::mem::take(&mut self.samples);
        // Counted from other positions.
        samples.iter_mut().for_each(|sample| sample.displacement.clear());
        *self = Measures { samples, ..Self::new(setup, self.speeds.len(), largest) };
    }

    /// Adds a snapshot of the gas.
    pub fn add<const D: usize>(&mut self, snapshot: &Snapshot<D>, measure: &Measure) {
        let mut sample = snapshot.sample.clone();
        if sample.time >= measure.from {
            if self.started.is_nan() {
                self.started = sample.time;
                self.starts = snapshot.unwrapped.iter().flatten().copied().collect();
            }
            sample.displacement = self.displacements(snapshot);
            self.count(snapshot, measure);
        }
        self.samples.push(sample);
    }

    /// Mean-square displacement of each set since averages began, relative to the motion as a whole.
    pub fn displacements<const D: usize>(&self, snapshot: &Snapshot<D>) -> Vec<f64> {
        let sets = self.speeds.len();
        let (mut sums, mut counts) = (vec![0.0; sets], vec![0.0; sets]);
        // Along x a shear flow carries balls away.
        let first = usize::from(self.flow.is_some());
        for (number, start) in self.starts.chunks_exact(D).enumerate() {
            let position = &snapshot.unwrapped[number];
            let set = snapshot.set[number] as usize;
            let carried = snapshot.drift.map(|velocity| velocity * (snapshot.sample.time - self.started));
            sums[set] += (first..D).map(|axis| (position[axis] - start[axis] - carried[axis]).powi(2)).sum::<f64>();
            counts[set] += 1.0;
        }
        sums.iter().zip(counts).map(|(sum, count)| sum / count).collect()
    }

    fn count<const D: usize>(&mut self, snapshot: &Snapshot<D>, measure: &Measure) {
        let axis = measure.profile_axis.min(D - 1);
        let [low, high] = snapshot.extent[axis];
        let now = snapshot.sample.temperature;
        let first = self.samples.first().map_or(now, |sample| sample.temperature);
        let (temperature, factor) = if self.cools { (first, (first / now).sqrt()) } else { (now, 1.0) };
        for number in 0..snapshot.velocity.len() {
            let velocity = snapshot.thermal_velocity(number);
            let set = snapshot.set[number] as usize;
            let speed = factor * velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
            let largest = self.largest[set];
            tally(&mut self.speeds[set], speed / largest);
            tally(&mut self.velocities[set], 0.5 + 0.5 * factor * velocity[0] / largest);
            tally(&mut self.profile[set], (snapshot.position[number][axis] - low) / (high - low));
        }
        if let Some(flow) = &mut self.flow {
            flow.count(snapshot);
        }
        self.temperatures += temperature;
        if self.averaged.is_multiple_of(SAMPLES_PER_PAIR_COUNT) {
            self.pairs.count(snapshot);
        }
        self.averaged += 1;
    }

    /// Mean temperature over these samples.
    pub fn temperature(&self) -> f64 {
        self.temperatures / self.averaged as f64
    }
}

/// Counts a number from 0 to 1 in its bar; what is outside is left out.
fn tally(bars: &mut [u64], part: f64) {
    if (0.0..1.0).contains(&part) {
        let bar = (part * bars.len() as f64) as usize;
        bars[bar.min(bars.len() - 1)] += 1;
    }
}
