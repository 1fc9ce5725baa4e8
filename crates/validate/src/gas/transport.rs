//! Viscosity and thermal conductivity.

use super::{advance, rows, standard_errors_off, theory, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Setup};
use corpuscle_model::ModelError;

pub(super) const TRANSPORT: Case = Case {
    name: "gas/transport",
    about: "Shear viscosity and thermal conductivity of balls at packings 0.1 and 0.3, from the growth of Helfand's moments, after Enskog \
            (Chapman & Cowling 1970).",
    slow: true,
    reduced: 1.0,
    run: transport,
};

/// With fewer the fluctuations of a box whose energy does not change are seen: at packing 0.1 a hundred balls conduct 5 % less.
const COUNT: usize = 500;

/// Collisions of each ball before and while it is measured, and from sample to sample.
const SETTLED: f64 = 100.0;
const MEASURED: f64 = 20_000.0;
const SAMPLED: f64 = 5.0;

/// What flows correlate with is over by then at these packings.
const LAG: f64 = 10.0;

/// Each seed is a measurement of its own. Of six the standard error itself is off by a third.
const SEEDS: u64 = 12;

fn transport(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for packing in [0.1, 0.3] {
            rows.extend(at(packing)?);
        }
        Ok(rows)
    };
    rows(TRANSPORT.name, measure())
}

fn at(packing: f64) -> Result<Vec<Row>, ModelError> {
    let found = (1..=SEEDS).map(|seed| coefficients(packing, seed)).collect::<Result<Vec<_>, _>>()?;
    let known = [theory::enskog_viscosity(packing), theory::enskog_conductivity(packing)];
    let mut rows = Vec::new();
    for (which, name) in ["viscosity", "conductivity"].into_iter().enumerate() {
        let ratio = Estimate::of(&found.iter().map(|found| found[which] / known[which]).collect::<Vec<_>>());
        let row = |measure: &str, value: f64, bound: f64| {
            Row::at_most(TRANSPORT.name, &format!("{name}_{measure}_{:.0}", 100.0 * packing), value, "", bound)
        };
        // 11 degrees of freedom: 3.1 standard errors for one in a hundred.
        rows.push(row("off_by_standard_errors", standard_errors_off(ratio, 1.0), 3.1));
        rows.push(row("standard_error", ratio.error, 0.02));
    }
    Ok(rows)
}

/// Viscosity and thermal conductivity.
fn coefficients(packing: f64, seed: u64) -> Result<[f64; 2], ModelError> {
    let times = [SETTLED, SAMPLED, SETTLED + MEASURED].map(|collisions| time_of::<3>(collisions, packing));
    let mut setup = Setup::<3>::fluid(COUNT, packing).seed(seed).measured(times[0], times[1]);
    setup.measure.lag_collisions = LAG;
    let mut gas = setup.build()?;
    advance(&mut gas, times[2])?;
    Ok([gas.viscosity().mean, gas.conductivity().mean])
}
