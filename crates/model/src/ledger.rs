//! What should be conserved.

use crate::ExactSum;
use crate::name::{self, Name};
use serde::{Deserialize, Serialize};

/// The balances of a model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Ledger {
    /// One balance for each conserved quantity.
    pub balances: Vec<Balance>,
}

/// The account of one conserved quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Name with unit, as in files: `water_m3`.
    #[serde(deserialize_with = "name::read")]
    pub quantity: Name,
    /// Amount at the start.
    pub initial: f64,
    /// Amount that came in since.
    pub inflow: f64,
    /// Amount that went out since.
    pub outflow: f64,
    /// Amount now.
    pub now: f64,
    /// What an error is set against at least: of momentum the sum of its magnitudes; 0 where amounts have one sign.
    pub least: f64,
}

impl Balance {
    /// (now - initial - inflow + outflow) / max(initial + inflow, now + outflow, least), in magnitudes; 0 where there
    /// never was anything.
    pub fn relative_error(&self) -> f64 {
        let scale = (self.initial.abs() + self.inflow.abs()).max(self.now.abs() + self.outflow.abs()).max(self.least);
        if scale == 0.0 { 0.0 } else { (self.now - self.initial - self.inflow + self.outflow) / scale }
    }
}

/// What of a conserved quantity was there at the start, what came in and what went out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Amount at the start.
    pub initial: f64,
    /// Amount that came in since.
    pub inflow: ExactSum,
    /// Amount that went out since.
    pub outflow: ExactSum,
}

impl Account {
    /// Books an amount as inflow, or as outflow where it is negative.
    pub fn book(&mut self, amount: f64) {
        if amount >= 0.0 { self.inflow.add(amount) } else { self.outflow.add(-amount) }
    }

    /// The balance, with so much there now.
    pub fn balance(&self, quantity: &'static str, now: f64) -> Balance {
        let (inflow, outflow) = (self.inflow.value(), self.outflow.value());
        Balance { quantity, initial: self.initial, inflow, outflow, now, least: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::{Account, Balance};

    #[test]
    fn relative_error_counts_what_came_in_and_went_out() {
        let mut water =
            Balance { quantity: "water_m3", initial: 10.0, inflow: 5.0, outflow: 3.0, now: 12.0, least: 0.0 };
        assert_eq!(water.relative_error(), 0.0);
        water.now = 13.5;
        assert!((water.relative_error() - 1.5 / 16.5).abs() < 1e-15);
        let none = Balance { quantity: "water_m3", initial: 0.0, inflow: 0.0, outflow: 0.0, now: 0.0, least: 0.0 };
        assert_eq!(none.relative_error(), 0.0);
        let rounding = Balance { now: 1e-9, least: 1e-3, ..none };
        assert_eq!(rounding.relative_error(), 1e-6);
    }

    #[test]
    fn bookings_balance() {
        let mut account = Account { initial: 5.0, ..Account::default() };
        account.book(3.0);
        account.book(-1.0);
        assert_eq!(account.balance("water_m3", 7.0).relative_error(), 0.0);
    }
}
