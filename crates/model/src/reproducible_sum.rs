//! Sums in inner loops that do not depend on the order of their terms: neither on the number of threads nor on that of processes.

use crate::ExactSum;
use serde::{Deserialize, Serialize};
use std::ops::{Add, Sub};

/// Multiples of these are added up exactly, one after another: 2^-8, 2^-50 and 2^-92.
const UNITS: [f64; 3] = [1.0 / 256.0, 1.0 / (1_u64 << 50) as f64, 1.0 / (1_u128 << 92) as f64];

/// Half as much again as the first number whose neighbours are a unit away: added and taken off again it rounds to multiples of the unit.
pub const ROUNDERS: [f64; 3] = {
    let half_as_much_again = 1.5 * (1_u64 << 52) as f64;
    [half_as_much_again * UNITS[0], half_as_much_again * UNITS[1], half_as_much_again * UNITS[2]]
};

/// A reproducible sum (Demmel & Nguyen 2013, "Fast reproducible floating-point summation", section 4): each term is cut into multiples of fixed
/// units, whose sums are exact, and the rest, below 2^-93, is left out. For up to 4096 terms below 2^33 in magnitude; sums of larger ones
/// depend on the order by rounding.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ReproducibleSum<T> {
    parts: [T; 3],
}

impl<T: Copy + Add<Output = T> + Sub<Output = T>> ReproducibleSum<T> {
    /// An empty sum.
    #[inline(always)]
    pub fn of(zero: T) -> Self {
        Self { parts: [zero; 3] }
    }

    /// Adds a term; `rounders` are [`ROUNDERS`].
    #[inline(always)]
    pub fn add(&mut self, term: T, rounders: &[T; 3]) {
        let mut rest = term;
        for (part, rounder) in self.parts.iter_mut().zip(rounders) {
            let rounded = (rest + *rounder) - *rounder;
            *part = *part + rounded;
            rest = rest - rounded;
        }
    }

    /// The same with another type of its parts.
    #[inline(always)]
    pub fn map<U>(self, part: impl Fn(T) -> U) -> ReproducibleSum<U> {
        ReproducibleSum { parts: self.parts.map(part) }
    }
}

impl ReproducibleSum<f64> {
    /// An empty sum.
    pub const NOTHING: Self = Self { parts: [0.0; 3] };

    /// The sum of the terms of both.
    pub fn with(&self, other: &Self) -> Self {
        Self { parts: std::array::from_fn(|k| self.parts[k] + other.parts[k]) }
    }

    /// The sum, rounded.
    pub fn value(&self) -> f64 {
        let [large, middle, small] = self.parts;
        large + (middle + small)
    }

    /// Adds it to an exact sum.
    pub fn add_to(&self, sum: &mut ExactSum) {
        self.parts.iter().filter(|part| **part != 0.0).for_each(|part| sum.add(*part));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sum(terms: &[f64]) -> ReproducibleSum<f64> {
        let mut sum = ReproducibleSum::of(0.0);
        terms.iter().for_each(|term| sum.add(*term, &ROUNDERS));
        sum
    }

    proptest! {
        /// Large and small terms in any order and in any parts: the same sum, and that of exact addition.
        #[test]
        fn order_and_parts_do_not_matter(
            terms in prop::collection::vec((-1.0..1.0, -90_i32..33).prop_map(|(term, exponent)| term * 2.0_f64.powi(exponent)), 1..500),
            cut in 0_usize..500,
        ) {
            let whole = sum(&terms);
            let backwards: Vec<f64> = terms.iter().rev().copied().collect();
            prop_assert_eq!(whole, sum(&backwards));
            let (first, second) = terms.split_at(cut.min(terms.len()));
            let [mut of_whole, mut of_parts] = [ExactSum::default(); 2];
            whole.add_to(&mut of_whole);
            [first, second].iter().for_each(|part| sum(part).add_to(&mut of_parts));
            prop_assert_eq!(of_whole, of_parts);
            prop_assert_eq!(sum(first).with(&sum(second)), whole);
            prop_assert!((whole.value() - of_whole.value()).abs() <= 2.0 * f64::EPSILON * of_whole.value().abs());
            let exact: ExactSum = terms.iter().copied().collect();
            prop_assert!((of_whole.value() - exact.value()).abs() <= 1e-25 + 1e-16 * exact.value().abs());
        }
    }
}
