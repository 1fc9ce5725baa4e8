//! Cooling of a granular gas.

use super::{advance, rows, theory};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Setup};
use corpuscle_model::{Model, ModelError};

pub(super) const GRANULAR: Case = Case {
    name: "gas/granular",
    about: "Balls that lose a fiftieth of their approach speed in every collision cool after Haff (J. Fluid Mech. 134, 1983, 401): \
            T = T0 / (1 + t / tau)^2, tau from Enskog's collision rate (van Noije & Ernst, Granular Matter 1, 1998, 57). Boxes too small for whirls to grow; down to T0 / 100.",
    slow: false,
    reduced: 1.0,
    run: granular,
};

const RESTITUTION: f64 = 0.98;
const PACKING: f64 = 0.1;

fn granular(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = cooling::<2>(800, 10)?;
        rows.extend(cooling::<3>(2000, 6)?);
        Ok(rows)
    };
    rows(GRANULAR.name, measure())
}

/// Deviation of the speeds from Maxwell's in a cooling gas: a2 of van Noije & Ernst, eq. 18.
fn kurtosis(d: f64) -> f64 {
    let e = RESTITUTION;
    16.0 * (1.0 - e) * (1.0 - 2.0 * e * e) / (9.0 + 24.0 * d + (8.0 * d - 41.0) * e + 30.0 * e * e * (1.0 - e))
}

/// 1 / sqrt(T) is a straight line, whose slope is 1 / tau.
fn cooling<const D: usize>(count: usize, runs: u64) -> Result<Vec<Row>, ModelError> {
    // Each collision takes (1 - e^2) T on average; for each ball there are rate / 2 of them, and d T / 2 of energy.
    let loss = (1.0 - RESTITUTION * RESTITUTION) * (1.0 + 3.0 / 16.0 * kurtosis(D as f64));
    let tau = 2.0 * D as f64 / (theory::collision_rate::<D>(PACKING) * loss);
    let (fall, samples) = (9.0, 90);
    let (mut roots, mut times) = (vec![0.0; samples + 1], Vec::new());
    let mut unbalanced = 0.0_f64;
    for seed in 1..=runs {
        let mut gas = Setup::<D>::fluid(count, PACKING).restitution(RESTITUTION).seed(seed).build()?;
        let start = gas.temperature();
        for (sample, mean) in roots.iter_mut().enumerate() {
            advance(&mut gas, fall * tau * sample as f64 / samples as f64)?;
            *mean += (start / gas.temperature()).sqrt() / runs as f64;
        }
        times.push(fall / ((start / gas.temperature()).sqrt() - 1.0));
        unbalanced = unbalanced.max(gas.ledger().balances[0].relative_error().abs());
    }
    let found = Estimate::of(&times);
    let line = |sample: usize| 1.0 + (roots[samples] - 1.0) * sample as f64 / samples as f64;
    let bent = (0..=samples).map(|sample| (roots[sample] / line(sample) - 1.0).abs()).fold(0.0, f64::max);
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(GRANULAR.name, &format!("{measure}_{D}d"), value, "", bound)
    };
    Ok(vec![
        row("relative_error_of_cooling_time", (found.mean - 1.0).abs(), 0.01),
        row("standard_error_of_cooling_time", found.error, 0.005),
        row("deviation_from_straight_line", bent, 0.01),
        row("energy_relative_error", unbalanced, 1e-12),
    ])
}
