//! Round values along an axis.

/// Round steps of which at most `most` fit into `span`: 1, 2 or 5 times a power of ten.
pub fn step(span: f64, most: usize) -> f64 {
    let least = span / most.max(1) as f64;
    if !(least.is_finite() && least > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * power >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// The multiples of `step` from `low` to `high`.
pub fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let slack = 1e-9 * (high - low).abs();
    let first = ((low - slack) / step).ceil() as i64;
    let last = ((high + slack) / step).floor() as i64;
    (first..=last).map(|index| index as f64 * step).collect()
}

/// A multiple of `step` with no more decimals than the step needs.
pub fn label(value: f64, step: f64) -> String {
    let decimals = (0..9).find(|decimals| {
        let scaled = step * 10f64.powi(*decimals);
        (scaled - scaled.round()).abs() < 1e-6 * scaled
    });
    let decimals = decimals.unwrap_or(9) as usize;
    format!("{:.decimals$}", if value == 0.0 { 0.0 } else { value }).replace('-', "−")
}

/// The unit of a time axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeUnit {
    /// As printed: `h`.
    pub name: &'static str,
    /// Its length, s.
    pub seconds: f64,
    /// Steps that read well in this unit.
    steps: &'static [f64],
}

impl TimeUnit {
    /// Time in reduced units, which has no unit.
    pub const REDUCED: Self = Self { name: "", seconds: 1.0, steps: &[] };

    /// The unit for a run of this length, s.
    pub fn of(length: f64) -> Self {
        match length {
            345_600.0.. => Self { name: "days", seconds: 86400.0, steps: &[0.5, 1.0, 2.0, 5.0, 10.0] },
            7_200.0.. => Self { name: "h", seconds: 3600.0, steps: &[0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0] },
            240.0.. => Self { name: "min", seconds: 60.0, steps: &[0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0] },
            _ => Self { name: "s", seconds: 1.0, steps: &[] },
        }
    }

    /// A step in this unit, of which at most `most` fit into `span` (in this unit).
    pub fn step(self, span: f64, most: usize) -> f64 {
        let least = span / most as f64;
        self.steps.iter().copied().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or_else(|| step(span, most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_no_more_than_asked() {
        assert_eq!(step(10.0, 5), 2.0);
        assert_eq!(step(0.83, 5), 0.2);
        assert_eq!(step(1234.0, 4), 500.0);
        assert_eq!(step(0.0, 4), 1.0);
        assert_eq!(multiples(-0.3, 1.0, 0.5), [0.0, 0.5, 1.0]);
        assert_eq!(label(0.30000000000000004, 0.1), "0.3");
        assert_eq!(label(-500.0, 250.0), "−500");
        assert_eq!(label(0.25, 0.25), "0.25");
    }

    #[test]
    fn time_axes_use_the_steps_of_a_clock() {
        let hours = TimeUnit::of(5.0 * 3600.0);
        assert_eq!((hours.name, hours.step(5.0, 6)), ("h", 1.0));
        assert_eq!(TimeUnit::of(20.0 * 3600.0).step(20.0, 6), 6.0);
        assert_eq!(TimeUnit::of(30.0).step(30.0, 6), 5.0);
    }
}
