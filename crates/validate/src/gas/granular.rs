//! A gas that cools by its own collisions.

use super::{advance, rows, theory};
use crate::{Case, Options, Row};
use corpuscle_gas::Setup;
use corpuscle_model::{Model, ModelError};

pub(super) const GRANULAR: Case = Case {
    name: "gas/granular",
    about: "Balls that lose a twentieth of their approach speed in every collision cool after Haff (J. Fluid Mech. 134, 1983, 401): \
            T = T0 / (1 + t / tau)^2, tau from Enskog's collision rate (van Noije & Ernst, Granular Matter 1, 1998, 57). Boxes too small for whirls to grow; down to T0 / 100.",
    slow: false,
    run: granular,
};

const RESTITUTION: f64 = 0.95;
const PACKING: f64 = 0.1;
const RUNS: u64 = 6;

fn granular(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = cooling::<2>(400)?;
        rows.extend(cooling::<3>(4000)?);
        Ok(rows)
    };
    rows(GRANULAR.name, measure())
}

/// How far speeds are from Maxwell's in a gas that cools: a2 of van Noije & Ernst, eq. 18.
fn kurtosis(d: f64) -> f64 {
    let e = RESTITUTION;
    16.0 * (1.0 - e) * (1.0 - 2.0 * e * e) / (9.0 + 24.0 * d + (8.0 * d - 41.0) * e + 30.0 * e * e * (1.0 - e))
}

fn cooling<const D: usize>(count: usize) -> Result<Vec<Row>, ModelError> {
    // Each collision takes (1 - e^2) T on average; for each ball there are rate / 2 of them, and d T / 2 of energy.
    let loss = (1.0 - RESTITUTION * RESTITUTION) * (1.0 + 3.0 / 16.0 * kurtosis(D as f64));
    let tau = 2.0 * D as f64 / (theory::collision_rate::<D>(PACKING) * loss);
    let (fall, looks) = (9.0, 90);
    let mut roots = vec![0.0; looks + 1];
    let mut unbalanced = 0.0_f64;
    for seed in 1..=RUNS {
        let mut gas = Setup::<D>::fluid(count, PACKING).restitution(RESTITUTION).seed(seed).build()?;
        let start = gas.temperature();
        for (look, root) in roots.iter_mut().enumerate() {
            advance(&mut gas, fall * tau * look as f64 / looks as f64)?;
            *root += (start / gas.temperature()).sqrt() / RUNS as f64;
        }
        unbalanced = unbalanced.max(gas.ledger().balances[0].relative_error().abs());
    }
    // 1 / sqrt(T) is a straight line, whose slope is 1 / tau.
    let found = fall * tau / (roots[looks] - 1.0);
    let line = |look: usize| 1.0 + fall * tau * look as f64 / looks as f64 / found;
    let bent = (0..=looks).map(|look| (roots[look] / line(look) - 1.0).abs()).fold(0.0, f64::max);
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(GRANULAR.name, &format!("{measure}_{D}d"), value, "", bound)
    };
    Ok(vec![
        row("relative_error_of_cooling_time", (found / tau - 1.0).abs(), 0.02),
        row("deviation_from_straight_line", bent, 0.02),
        row("energy_relative_error", unbalanced, 1e-12),
    ])
}
