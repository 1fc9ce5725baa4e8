//! How well speeds agree with Maxwell's distribution.

use statrs::distribution::{Beta, ChiSquared, ContinuousCDF};

/// Fewest balls expected in a class of the chi-square test.
const FEWEST: f64 = 10.0;

/// Most classes.
const MOST_CLASSES: usize = 100;

/// The distribution of one ball's speed in a gas whose energy is known.
///
/// In a gas of n balls with f free components of motion, all states of one energy as likely as each other, the part that one ball has
/// of the energy is distributed as Beta(d/2, (f - d)/2); for large n that is Maxwell's distribution (in two dimensions
/// Rayleigh's). `most` is the square of the largest speed that the ball can have: all energy its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Maxwell {
    share: Beta,
    most: f64,
}

impl Maxwell {
    /// For balls of mass `mass` among balls of total mass `total` in `dimensions` dimensions, with `freedom` free components of motion
    /// and kinetic energy `energy`. `bound` where the momentum is conserved and 0. `None` where there are too few.
    pub fn new(dimensions: usize, freedom: f64, energy: f64, mass: f64, total: f64, bound: bool) -> Option<Self> {
        let share = Beta::new(0.5 * dimensions as f64, 0.5 * (freedom - dimensions as f64)).ok()?;
        let most = 2.0 * energy / mass * if bound { 1.0 - mass / total } else { 1.0 };
        (most > 0.0).then_some(Maxwell { share, most })
    }

    /// Part of the balls with a square of the speed below this.
    pub fn below(&self, speed2: f64) -> f64 {
        self.share.cdf((speed2 / self.most).clamp(0.0, 1.0))
    }
}

/// The chance that speeds after Maxwell deviate from the distribution by more than these do, by a chi-square test over classes of
/// equal expectation. Each pair is the square of a ball's speed, and its distribution. Not a number with too few balls.
pub(crate) fn p_value(speeds: impl ExactSizeIterator<Item = (f64, Maxwell)>) -> f64 {
    let count = speeds.len();
    let classes = ((count as f64 / FEWEST) as usize).min(MOST_CLASSES).min((2.0 * (count as f64).powf(0.4)) as usize);
    if classes < 4 {
        return f64::NAN;
    }
    let mut counts = vec![0.0; classes];
    for (speed2, distribution) in speeds {
        let class = (distribution.below(speed2) * classes as f64) as usize;
        counts[class.min(classes - 1)] += 1.0;
    }
    let expected = count as f64 / classes as f64;
    let chi2: f64 = counts.iter().map(|count| (count - expected).powi(2) / expected).sum();
    // One for the number of balls, one for their energy.
    ChiSquared::new((classes - 2) as f64).map_or(f64::NAN, |distribution| distribution.sf(chi2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn gas(scale: impl Fn(usize) -> f64) -> f64 {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let speeds: Vec<f64> = (0..5000)
            .map(|ball| (0..2).map(|_| (scale(ball) * crate::random::normal(&mut random)).powi(2)).sum())
            .collect();
        let energy = 0.5 * speeds.iter().sum::<f64>();
        let maxwell = Maxwell::new(2, 10_000.0, energy, 1.0, 5000.0, false).unwrap();
        p_value(speeds.iter().map(|&speed2| (speed2, maxwell)))
    }

    #[test]
    fn maxwell_is_told_from_what_is_not() {
        assert!(gas(|_| 1.0) > 0.01, "{}", gas(|_| 1.0));
        assert!(gas(|ball| if ball % 2 == 0 { 1.0 } else { 1.6 }) < 1e-3);
    }
}
