//! What is measured in a part of the box.

use super::Sample;
use super::estimate::{average, change, duration};
use crate::world::RegionSample;

/// A region over some samples, the last of which is now.
pub(crate) struct OverTime<'a> {
    pub recent: &'a [Sample],
    /// Number of the region.
    pub number: usize,
}

impl OverTime<'_> {
    /// The region now.
    pub fn now(&self) -> RegionSample {
        self.recent.last().map_or_else(RegionSample::default, |sample| sample.regions[self.number].clone())
    }

    /// Temperature now, from the motion relative to the mean velocity of the balls in it; not a number for fewer than two.
    pub fn temperature(&self, dimensions: usize, boltzmann: f64) -> f64 {
        let RegionSample { number, mass, kinetic, momentum, .. } = self.now();
        if number < 2.0 {
            return f64::NAN;
        }
        let drift = momentum.iter().map(|p| p * p).sum::<f64>() / (2.0 * mass);
        2.0 * (kinetic - drift) / (dimensions as f64 * (number - 1.0) * boltzmann)
    }

    /// Pressure over the samples: momentum that balls carry, relative to the mean flow, and exchange in the region (Irving & Kirkwood, J. Chem.
    /// Phys. 18, 1950, 817, averaged over its volume).
    pub fn pressure(&self, dimensions: usize) -> f64 {
        if self.recent.len() < 2 {
            return f64::NAN;
        }
        let mass = self.mean(|region| region.mass);
        let flow: f64 = (0..dimensions).map(|axis| self.mean(|region| region.momentum[axis]).powi(2)).sum();
        let carried = 2.0 * self.mean(|region| region.kinetic) - if mass > 0.0 { flow / mass } else { 0.0 };
        let exchanged = change(self.recent, |sample| sample.regions[self.number].virial) / duration(self.recent);
        (carried + exchanged) / (dimensions as f64 * self.mean(|region| region.volume))
    }

    /// Balls that flow along an axis, in a unit of time through a unit of area (in two dimensions length), over the samples.
    pub fn flow(&self, axis: usize) -> f64 {
        if self.recent.len() < 2 {
            return f64::NAN;
        }
        self.mean(|region| region.velocity[axis]) / self.mean(|region| region.volume)
    }

    fn mean(&self, of: impl Fn(&RegionSample) -> f64) -> f64 {
        average(self.recent, |sample| of(&sample.regions[self.number]))
    }
}
