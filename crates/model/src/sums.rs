//! Sums of many numbers.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A sum whose rounding errors do not add up (Neumaier 1974). It depends on the order of its terms in its last digits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct CompensatedSum {
    sum: f64,
    lost: f64,
}

impl CompensatedSum {
    /// Adds a value.
    pub fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() { (self.sum - sum) + value } else { (value - sum) + self.sum };
        self.sum = sum;
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

impl FromIterator<f64> for CompensatedSum {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut sum = Self::default();
        values.into_iter().for_each(|value| sum.add(value));
        sum
    }
}

/// Bits of a digit.
const DIGIT: u32 = 32;

/// Digits of a sum: those of the smallest to the largest double-precision number, and two for what they carry.
const DIGITS: usize = 68;

/// Exponent of the lowest bit: that of the smallest number above 0.
const LOWEST: i32 = -1074;

/// Additions after which digits are carried: each adds less than 2^32 to a digit of 63 bits.
const CARRY_EVERY: u32 = 1 << 30;

/// An exact sum of double-precision numbers: the same for any order of its terms, and for any way of adding them in parts. It is a number with fixed point
/// whose digits have room for carries (Neal 2015, "Fast exact summation using small and large superaccumulators", section 2). A
/// term that is not finite makes it not a number.
#[derive(Debug, Clone, Copy)]
pub struct ExactSum {
    /// The sum is that of digits[k] 2^(32 k + LOWEST).
    digits: [i64; DIGITS],
    /// Additions since digits were carried.
    added: u32,
    is_finite: bool,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { digits: [0; DIGITS], added: 0, is_finite: true }
    }
}

impl ExactSum {
    /// Number of integers that a sum is made of.
    pub const ADDENDS: usize = DIGITS + 1;

    /// Adds a value.
    #[inline]
    pub fn add(&mut self, value: f64) {
        let bits = value.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as usize;
        let fraction = bits & ((1 << 52) - 1);
        if exponent == 0x7ff {
            self.is_finite = false;
            return;
        }
        let (mantissa, shift) = if exponent == 0 { (fraction, 0) } else { (fraction | 1 << 52, exponent - 1) };
        let (digit, within) = (shift / DIGIT as usize, shift % DIGIT as usize);
        let parts = u128::from(mantissa) << within;
        let sign = 1 - 2 * (bits >> 63) as i64;
        for k in 0..3 {
            self.digits[digit + k] += sign * (parts >> (DIGIT * k as u32) & 0xffff_ffff) as i64;
        }
        self.added += 1;
        if self.added == CARRY_EVERY {
            self.carry();
        }
    }

    /// Adds all terms of another sum.
    pub fn add_sum(&mut self, other: &Self) {
        self.carry();
        let mut other = *other;
        other.carry();
        self.digits.iter_mut().zip(other.digits).for_each(|(digit, more)| *digit += more);
        self.added = 2;
        self.is_finite &= other.is_finite;
    }

    /// The sum as integers: those of a sum of sums are the sums of theirs.
    pub fn addends(&self) -> [i64; Self::ADDENDS] {
        let mut sum = *self;
        sum.carry();
        let not_finite = i64::from(!sum.is_finite);
        std::array::from_fn(|k| if k < DIGITS { sum.digits[k] } else { not_finite })
    }

    /// The sum of up to 2^30 sums whose [`ExactSum::addends`] add up to these.
    pub fn of_addends(addends: &[i64; Self::ADDENDS]) -> Self {
        let mut sum = Self { is_finite: addends[DIGITS] == 0, ..Self::default() };
        sum.digits.copy_from_slice(&addends[..DIGITS]);
        sum.carry();
        sum
    }

    /// Carries, so that all digits but the last are from 0 to 2^32 - 1.
    fn carry(&mut self) {
        let mut carried = 0;
        for digit in &mut self.digits[..DIGITS - 1] {
            let sum = *digit + carried;
            *digit = sum & 0xffff_ffff;
            carried = sum >> DIGIT;
        }
        self.digits[DIGITS - 1] += carried;
        self.added = 0;
    }

    /// The sum so far, rounded to the nearest number (below 1e-290 in magnitude, to one of the two nearest).
    pub fn value(&self) -> f64 {
        if !self.is_finite {
            return f64::NAN;
        }
        let mut sum = *self;
        sum.carry();
        let is_negative = sum.digits[DIGITS - 1] < 0;
        if is_negative {
            sum.digits.iter_mut().for_each(|digit| *digit = -*digit);
            sum.carry();
        }
        let Some(top) = sum.digits.iter().rposition(|digit| *digit != 0) else { return 0.0 };
        let first = top.saturating_sub(3);
        let high = (first..=top).rev().fold(0, |high: u128, k| high << DIGIT | sum.digits[k] as u128);
        // Whatever lies below counts where the bits above end half-way between two numbers.
        let rest = sum.digits[..first].iter().any(|digit| *digit != 0);
        let magnitude = scaled((high | u128::from(rest)) as f64, DIGIT as i32 * first as i32 + LOWEST);
        if is_negative { -magnitude } else { magnitude }
    }
}

/// A number times a power of two.
fn scaled(mut number: f64, mut exponent: i32) -> f64 {
    while exponent < -1000 {
        number *= 2.0_f64.powi(-500);
        exponent += 500;
    }
    while exponent > 900 {
        number *= 2.0_f64.powi(500);
        exponent -= 500;
    }
    number * 2.0_f64.powi(exponent)
}

impl PartialEq for ExactSum {
    fn eq(&self, other: &Self) -> bool {
        let [mut a, mut b] = [*self, *other];
        a.carry();
        b.carry();
        a.digits == b.digits && a.is_finite == b.is_finite
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut sum = Self::default();
        values.into_iter().for_each(|value| sum.add(value));
        sum
    }
}

/// As written to files and sent to other processes: digits that are not 0, with their positions.
#[derive(Serialize, Deserialize)]
struct Written {
    digits: Vec<(u8, i64)>,
    is_finite: bool,
}

impl Serialize for ExactSum {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut sum = *self;
        sum.carry();
        let digits = sum.digits.iter().enumerate().filter(|(_, digit)| **digit != 0);
        let digits = digits.map(|(position, digit)| (position as u8, *digit)).collect();
        Written { digits, is_finite: sum.is_finite }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ExactSum {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = Written::deserialize(deserializer)?;
        let mut sum = Self { is_finite: written.is_finite, ..Self::default() };
        for (position, digit) in written.digits {
            let position = usize::from(position);
            let least = if position == DIGITS - 1 { -1 << DIGIT } else { 0 };
            let fits = (least..1 << DIGIT).contains(&digit);
            let of = sum.digits.get_mut(position).filter(|_| fits);
            *of.ok_or_else(|| serde::de::Error::custom("a digit of a sum is damaged"))? = digit;
        }
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn small_amounts_are_not_lost_beside_large_ones() {
        let values = || std::iter::once(1e16).chain(std::iter::repeat_n(1.0, 1000)).chain([-1e16]);
        assert_eq!(values().collect::<CompensatedSum>().value(), 1000.0);
        assert_eq!(values().collect::<ExactSum>().value(), 1000.0);
    }

    /// Cases whose exact sums are known: what cancels out, the largest and the smallest numbers, halves that rounding decides.
    #[test]
    fn sums_are_exact() {
        let smallest = f64::from_bits(1);
        let cases: [(&[f64], f64); 9] = [
            (&[], 0.0),
            (&[1e300, 1.0, -1e300], 1.0),
            (&[-1e300, -1e-300, 1e300], -1e-300),
            (&[f64::MAX, f64::MAX, -f64::MAX, -f64::MAX, smallest], smallest),
            (&[0.1; 10], 1.0),
            (&[1.0, 2.0_f64.powi(-53)], 1.0),
            (&[1.0, 2.0_f64.powi(-53), 1e-300], 1.0 + f64::EPSILON),
            (&[1.0, 2.0_f64.powi(-53), -1e-300], 1.0),
            (&[-1.0, -2.0_f64.powi(-53), -1e-300], -1.0 - f64::EPSILON),
        ];
        for (values, expected) in cases {
            assert_eq!(values.iter().copied().collect::<ExactSum>().value(), expected, "{values:?}");
        }
        assert!([1.0, f64::INFINITY].into_iter().collect::<ExactSum>().value().is_nan());
    }

    proptest! {
        /// Any order and any parts give the same sum, one number its own, and integers their exact sum.
        #[test]
        fn order_and_parts_do_not_matter(values in prop::collection::vec(any::<f64>(), 1..40), cut in 0_usize..40) {
            let values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
            let whole: ExactSum = values.iter().copied().collect();
            let backwards: ExactSum = values.iter().rev().copied().collect();
            let (first, second) = values.split_at(cut.min(values.len()));
            let mut parts: ExactSum = first.iter().copied().collect();
            parts.add_sum(&second.iter().copied().collect());
            prop_assert_eq!(whole, backwards);
            prop_assert_eq!(whole, parts);
            let [a, b] = [first, second].map(|part| part.iter().copied().collect::<ExactSum>().addends());
            prop_assert_eq!(whole, ExactSum::of_addends(&std::array::from_fn(|k| a[k] + b[k])));
            for value in values {
                let alone: ExactSum = std::iter::once(value).collect();
                prop_assert!(alone.value() == value || value.abs() < 1e-290, "{} is {}", value, alone.value());
            }
        }

        #[test]
        fn integers_have_their_exact_sum(values in prop::collection::vec(-1_i64 << 53..1 << 53, 1..100)) {
            let sum: ExactSum = values.iter().map(|value| *value as f64).collect();
            prop_assert_eq!(sum.value(), values.iter().map(|value| i128::from(*value)).sum::<i128>() as f64);
        }

        #[test]
        fn written_sums_are_read_back(values in prop::collection::vec(-1e30..1e30, 0..10)) {
            let sum: ExactSum = values.into_iter().collect();
            let bytes = postcard::to_stdvec(&sum).unwrap();
            prop_assert_eq!(postcard::from_bytes::<ExactSum>(&bytes).unwrap(), sum);
        }

        /// Forged sums are read, as numbers, or refused.
        #[test]
        fn forged_sums_are_no_trouble(digits in prop::collection::vec((any::<u8>(), any::<i64>()), 0..5)) {
            let bytes = postcard::to_stdvec(&Written { digits, is_finite: true }).unwrap();
            if let Ok(mut sum) = postcard::from_bytes::<ExactSum>(&bytes) {
                sum.add(1.0);
                sum.add_sum(&sum.clone());
                prop_assert!(!sum.value().is_nan());
            }
        }
    }
}
