//! Water and momentum that came and went.

use serde::{Deserialize, Serialize};

/// A sum whose rounding errors do not add up (Neumaier 1974).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct ExactSum {
    sum: f64,
    lost: f64,
}

impl ExactSum {
    pub fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() { (self.sum - sum) + value } else { (value - sum) + self.sum };
        self.sum = sum;
    }

    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut sum = Self::default();
        values.into_iter().for_each(|value| sum.add(value));
        sum
    }
}

/// What was there at the start, what came in and what went out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Account {
    pub initial: f64,
    pub inflow: ExactSum,
    pub outflow: ExactSum,
}

impl Account {
    /// Books an amount as inflow, or as outflow where it is negative.
    pub fn book(&mut self, amount: f64) {
        if amount >= 0.0 { self.inflow.add(amount) } else { self.outflow.add(-amount) }
    }

    pub fn balance(&self, quantity: &'static str, now: f64) -> corpuscle_model::Balance {
        let (inflow, outflow) = (self.inflow.value(), self.outflow.value());
        corpuscle_model::Balance { quantity, initial: self.initial, inflow, outflow, now }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_amounts_are_not_lost_beside_large_ones() {
        let sum: ExactSum = std::iter::once(1e16).chain(std::iter::repeat_n(1.0, 1000)).chain([-1e16]).collect();
        assert_eq!(sum.value(), 1000.0);
    }

    #[test]
    fn bookings_balance() {
        let mut account = Account { initial: 5.0, ..Account::default() };
        account.book(3.0);
        account.book(-1.0);
        assert_eq!(account.balance("water_m3", 7.0).relative_error(), 0.0);
    }
}
