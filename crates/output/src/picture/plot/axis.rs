//! Axes of charts: positions of values, and their labels.

use crate::picture::ticks;
use corpuscle_model::ChartAxis;

/// An axis with its range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    step: f64,
    logarithmic: bool,
    /// Values are printed over ten to this power.
    power: i32,
}

impl Axis {
    /// An axis for values from `low` to `high`, with about `most` values printed. A linear one begins at 0 where
    /// `with_zero` is true or the values are not far from it.
    pub(super) fn of(axis: &ChartAxis, [low, high]: [f64; 2], with_zero: bool, most: usize) -> Self {
        if axis.logarithmic { Self::logarithmic(low, high) } else { Self::linear(low, high, with_zero, most) }
    }

    fn linear(low: f64, high: f64, with_zero: bool, most: usize) -> Self {
        let (mut low, mut high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let near_zero = low > 0.0 && low < 0.6 * high || high < 0.0 && high > 0.6 * low;
        if with_zero || near_zero {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        if high - low <= 1e-12 * high.abs().max(low.abs()) {
            // One value alone: some room round it.
            let room = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
            (low, high) = (low - room, high + room);
        }
        let step = ticks::step(high - low, most);
        let (low, high) = ((low / step + 1e-9).floor() * step, (high / step - 1e-9).ceil() * step);
        let size = low.abs().max(high.abs()).log10().floor() as i32;
        // Up to 10 000 and down to hundredths numbers are printed as they are.
        let power = if (-2..4).contains(&size) { 0 } else { size.div_euclid(3) * 3 };
        Self { low, high, step, logarithmic: false, power }
    }

    fn logarithmic(low: f64, high: f64) -> Self {
        let (low, high) = if 0.0 < low && low <= high { (low, high) } else { (1.0, 10.0) };
        let (low, high) = (low.log10().floor(), high.log10().ceil());
        let high = if high > low { high } else { low + 1.0 };
        Self { low, high, step: ((high - low) / 6.0).ceil(), logarithmic: true, power: 0 }
    }

    /// The same axis from exactly `low` to `high`, with about `most` values printed; for what fills the whole width.
    pub(super) fn cut_to(self, [low, high]: [f64; 2], most: usize) -> Self {
        if self.logarithmic || low >= high {
            self
        } else {
            Self { low, high, step: ticks::step(high - low, most), ..self }
        }
    }

    /// Position of a value between the low end (0) and the high end (1); none for a value that the axis cannot show.
    pub(super) fn part(&self, value: f64) -> f64 {
        let value = match self.logarithmic {
            true if value > 0.0 => value.log10(),
            true => f64::NAN,
            false => value,
        };
        (value - self.low) / (self.high - self.low)
    }

    /// Values to be printed, with their text.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let values = ticks::multiples(self.low, self.high, self.step);
        if self.logarithmic {
            return values.into_iter().map(|value| (10f64.powf(value), power_of_ten(value as i32))).collect();
        }
        let scale = 10f64.powi(self.power);
        values.into_iter().map(|value| (value, ticks::label(value / scale, self.step / scale))).collect()
    }

    /// The label of the axis: `Distance, 10⁻⁹ m`.
    pub(super) fn label(&self, axis: &ChartAxis) -> String {
        let power = if self.power == 0 { String::new() } else { power_of_ten(self.power) };
        let unit = [power, axis.unit.clone()].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ");
        [axis.label.clone(), unit].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// A power of ten as printed: `10⁻⁹`.
fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match exponent {
        0 => "1".into(),
        1 => "10".into(),
        _ => {
            let raised = exponent.to_string();
            let raised = raised.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]));
            format!("10{}", raised.collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn small_numbers_stand_over_a_power_of_ten() {
        let distance = ChartAxis { label: "Distance".into(), unit: "m".into(), logarithmic: false };
        let axis = Axis::of(&distance, [0.0, 3.9e-9], false, 5);
        assert_eq!(axis.label(&distance), "Distance, 10⁻⁹ m");
        assert_eq!(texts(&axis), ["0", "1", "2", "3", "4"]);
        assert_eq!(axis.part(2e-9), 0.5);
    }

    #[test]
    fn logarithmic_axes_print_powers_of_ten() {
        let axis = Axis::of(&ChartAxis { logarithmic: true, ..ChartAxis::default() }, [0.03, 500.0], false, 5);
        assert_eq!(texts(&axis), ["10⁻²", "10⁻¹", "1", "10", "10²", "10³"]);
        assert!(axis.part(0.0).is_nan() && (axis.part(0.1) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn an_axis_that_is_cut_has_values_enough() {
        let range = [46.0, 78.0];
        let axis = Axis::of(&ChartAxis::default(), range, false, 5).cut_to(range, 5);
        assert_eq!(texts(&axis), ["50", "60", "70"]);
    }

    #[test]
    fn one_value_nothing_and_values_far_from_zero() {
        let plain = ChartAxis::default();
        assert!((Axis::of(&plain, [2.0, 2.0], false, 4).part(2.0) - 0.5).abs() < 1e-12);
        assert_eq!(texts(&Axis::of(&plain, [f64::INFINITY, f64::NEG_INFINITY], true, 2)), ["0.0", "0.5", "1.0"]);
        assert_eq!(texts(&Axis::of(&plain, [99.0, 101.0], false, 4)), ["99.0", "99.5", "100.0", "100.5", "101.0"]);
    }
}
