//! Water and momentum that came and went.

use corpuscle_model::ExactSum;
use serde::{Deserialize, Serialize};

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
    fn bookings_balance() {
        let mut account = Account { initial: 5.0, ..Account::default() };
        account.book(3.0);
        account.book(-1.0);
        assert_eq!(account.balance("water_m3", 7.0).relative_error(), 0.0);
    }
}
