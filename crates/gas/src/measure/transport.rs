//! Transport coefficients from the growth of Helfand's moments.

use super::estimate::duration;
use super::{Estimate, Sample};

/// Parts of the time, each a measurement of its own; the least number of them; and how many of the longer lags one must hold.
const PARTS: usize = 20;
const LEAST_PARTS: usize = 5;
const LAGS_PER_PART: usize = 2;

/// Half the rate at which the mean square of changes of moments grows (Helfand 1960), from a lag to twice that. Its error is from parts of
/// the time. Not a number where there are too few samples.
pub(crate) fn growth<const N: usize>(samples: &[Sample], lag: f64, moments: impl Fn(&Sample) -> [f64; N]) -> Estimate {
    let none = Estimate { mean: f64::NAN, error: f64::NAN };
    if samples.len() < 2 {
        return none;
    }
    let intervals = samples.len() - 1;
    let step = duration(samples) / intervals as f64;
    let lag = (lag / step).ceil().max(1.0);
    let longest_part = intervals as f64 / LEAST_PARTS as f64;
    if 2.0 * lag * LAGS_PER_PART as f64 > longest_part {
        return none;
    }
    let lag = lag as usize;
    let parts = PARTS.min(intervals / (2 * lag * LAGS_PER_PART));
    let edge = |part: usize| part * intervals / parts;
    let of = |part: usize| slope(&samples[edge(part)..=edge(part + 1)], lag, &moments) / (2.0 * step);
    Estimate::of(&(0..parts).map(of).collect::<Vec<_>>())
}

/// Growth of the mean square of changes between a lag and twice that, in a step.
fn slope<const N: usize>(samples: &[Sample], lag: usize, moments: impl Fn(&Sample) -> [f64; N]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for way in samples.windows(2 * lag + 1) {
        let [start, middle, end] = [&way[0], &way[lag], &way[2 * lag]].map(&moments);
        for moment in 0..N {
            let (half, whole) = (middle[moment] - start[moment], end[moment] - start[moment]);
            sum += whole * whole - half * half;
            count += 1.0;
        }
    }
    sum / count / lag as f64
}
