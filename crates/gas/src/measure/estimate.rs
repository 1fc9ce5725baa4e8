//! Means and their errors.

use super::{Measures, Sample};

/// A mean over time with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Standard error of the mean, from means over parts of the time; not a number where there are too few.
    pub error: f64,
}

impl Estimate {
    /// Mean of independent values of equal weight.
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Estimate { mean, error: if count > 1.0 { (squares / (count - 1.0) / count).sqrt() } else { f64::NAN } }
    }

    /// As many times as large.
    pub fn times(self, factor: f64) -> Self {
        Estimate { mean: self.mean * factor, error: self.error * factor.abs() }
    }
}

/// Parts of the time over which means are taken.
const BLOCKS: usize = 20;

impl Measures {
    /// Samples from `from` on.
    pub fn after(&self, from: f64) -> &[Sample] {
        let first = self.samples.partition_point(|sample| sample.time < from);
        &self.samples[first..]
    }

    /// Samples since averages began, or began anew.
    pub fn since_started(&self) -> &[Sample] {
        if self.started.is_nan() { &[] } else { self.after(self.started) }
    }

    /// Mean of a value between two samples, over equal parts of the time from `from` on, or since averages began anew.
    pub fn estimate(&self, from: f64, value: impl Fn(&[Sample]) -> f64) -> Estimate {
        let samples = self.after(from.max(self.started));
        if samples.len() < 2 {
            return Estimate { mean: f64::NAN, error: f64::NAN };
        }
        let intervals = samples.len() - 1;
        let blocks = BLOCKS.min(intervals);
        let edge = |block: usize| block * intervals / blocks;
        let values: Vec<f64> = (0..blocks).map(|block| value(&samples[edge(block)..=edge(block + 1)])).collect();
        Estimate { mean: value(samples), ..Estimate::of(&values) }
    }
}

/// Time from the first to the last of some samples.
pub(crate) fn duration(samples: &[Sample]) -> f64 {
    samples[samples.len() - 1].time - samples[0].time
}

/// Change of something from the first to the last of some samples.
pub(crate) fn change(samples: &[Sample], value: impl Fn(&Sample) -> f64) -> f64 {
    value(&samples[samples.len() - 1]) - value(&samples[0])
}

/// Mean over the time of some samples (trapezoidal).
pub(crate) fn average(samples: &[Sample], value: impl Fn(&Sample) -> f64) -> f64 {
    let area: f64 =
        samples.windows(2).map(|pair| 0.5 * (value(&pair[0]) + value(&pair[1])) * (pair[1].time - pair[0].time)).sum();
    area / duration(samples)
}
