//! Balls in steady shear.

use super::{advance, rows, standard_errors_off, theory, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Gas, Setup};
use corpuscle_model::ModelError;

pub(super) const SHEAR: Case = Case {
    name: "gas/shear",
    about: "Balls in steady shear between images that slide (Lees & Edwards 1972) at packings 0.1 and 0.3: stress over rate after Enskog \
            (Chapman & Cowling 1970) and as the growth of Helfand's moments in a gas at rest has it, the straight profile of the flow, work \
            against energy, and overlaps.",
    slow: true,
    reduced: 1.0,
    run: shear,
};

const COUNT: usize = 500;

/// Packings and rates of shear, a fortieth of the collision rate or less: stress is in proportion to the rate yet.
const FLOWS: [(f64, f64); 2] = [(0.1, 0.04), (0.3, 0.1)];

/// Collisions of each ball before and while it is measured, and from sample to sample.
const SETTLED: f64 = 200.0;
const MEASURED: f64 = 20_000.0;
const SAMPLED: f64 = 20.0;

/// Each seed is a measurement of its own.
const SEEDS: u64 = 6;

/// For Helfand's moments, as in `gas/transport`.
const LAG: f64 = 10.0;
const SAMPLED_AT_REST: f64 = 5.0;

fn shear(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for (packing, rate) in FLOWS {
            rows.extend(at(packing, rate)?);
        }
        Ok(rows)
    };
    rows(SHEAR.name, measure())
}

fn at(packing: f64, rate: f64) -> Result<Vec<Row>, ModelError> {
    let found = (1..=SEEDS).map(|seed| flow(packing, rate, seed)).collect::<Result<Vec<_>, _>>()?;
    let of = |value: &dyn Fn(&Flow) -> f64| Estimate::of(&found.iter().map(value).collect::<Vec<_>>());
    let worst = |value: &dyn Fn(&Flow) -> f64| found.iter().map(value).fold(0.0, f64::max);
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(SHEAR.name, &format!("{measure}_{:.0}", 100.0 * packing), value, "", bound)
    };
    let viscosity = of(&|flow| flow.viscosity / theory::enskog_viscosity(packing));
    let at_rest = (1..=SEEDS).map(|seed| at_rest(packing, seed)).collect::<Result<Vec<_>, _>>()?;
    let at_rest = Estimate::of(&at_rest);
    let apart = (viscosity.mean - at_rest.mean).abs() / viscosity.error.hypot(at_rest.error);
    let slope = of(&|flow| flow.slope / rate);
    Ok(vec![
        // 5 degrees of freedom: 4.0 standard errors for one in a hundred; of a difference, 10 and 3.2.
        row("viscosity_off_by_standard_errors", standard_errors_off(viscosity, 1.0), 4.0),
        row("viscosity_standard_error", viscosity.error, 0.02),
        row("viscosity_and_that_at_rest_apart_by_standard_errors", apart, 3.2),
        row("slope_of_flow_off_by_standard_errors", standard_errors_off(slope, 1.0), 4.0),
        row("slope_of_flow_standard_error", slope.error, 0.02),
        row("relative_energy_error", worst(&|flow| flow.energy_error), 1e-11),
        row("deepest_overlap_over_radius", worst(&|flow| flow.overlap), 1e-9),
    ])
}

/// What one run measures.
struct Flow {
    /// Viscosity, as at temperature 1: it is in proportion to the root of the temperature.
    viscosity: f64,
    /// Slope of the velocity over the height.
    slope: f64,
    energy_error: f64,
    overlap: f64,
}

fn flow(packing: f64, rate: f64, seed: u64) -> Result<Flow, ModelError> {
    let times = [SETTLED, SAMPLED, SETTLED + MEASURED].map(|collisions| time_of::<3>(collisions, packing));
    let setup = Setup::<3>::fluid(COUNT, packing).shear(rate, Some(1.0)).seed(seed);
    let mut gas = setup.measured(times[0], times[1]).build()?;
    advance(&mut gas, times[0])?;
    let (mut temperature, mut overlap, steps) = (0.0, 0.0_f64, 500);
    for step in 1..=steps {
        advance(&mut gas, times[0] + (times[2] - times[0]) * f64::from(step) / f64::from(steps))?;
        temperature += gas.temperature() / f64::from(steps);
        overlap = overlap.max(gas.deepest_overlap());
    }
    let energy = &corpuscle_model::Model::ledger(&gas).balances[0];
    let booked = energy.inflow + energy.outflow + energy.initial;
    let energy_error = (energy.initial + energy.inflow - energy.outflow - energy.now).abs() / booked;
    Ok(Flow { viscosity: gas.viscosity().mean / temperature.sqrt(), slope: slope(&gas), energy_error, overlap })
}

/// Slope of the straight line through the velocities of all layers (least squares).
fn slope(gas: &Gas<3>) -> f64 {
    let profile = gas.flow_profile();
    let count = profile.len() as f64;
    let mean = |part: usize| profile.iter().map(|point| point[part]).sum::<f64>() / count;
    let (height, velocity) = (mean(0), mean(1));
    let above: f64 = profile.iter().map(|point| (point[0] - height) * (point[1] - velocity)).sum();
    above / profile.iter().map(|point| (point[0] - height).powi(2)).sum::<f64>()
}

/// Viscosity of a gas at rest over Enskog's.
fn at_rest(packing: f64, seed: u64) -> Result<f64, ModelError> {
    let times = [SETTLED, SAMPLED_AT_REST, SETTLED + MEASURED].map(|collisions| time_of::<3>(collisions, packing));
    let mut setup = Setup::<3>::fluid(COUNT, packing).seed(seed).measured(times[0], times[1]);
    setup.measure.lag_collisions = LAG;
    let mut gas = setup.build()?;
    advance(&mut gas, times[2])?;
    Ok(gas.viscosity().mean / theory::enskog_viscosity(packing))
}
