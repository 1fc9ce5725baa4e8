//! Cases of the gas model.

mod adiabatic;
mod atmosphere;
pub(crate) mod bench;
mod brownian;
mod effusion;
mod enskog;
mod equation_of_state;
mod figure;
mod frames;
mod granular;
mod maxwell;
mod mixing;
mod shear;
mod square_well;
mod theory;
mod transport;
mod wall_pressure;

use crate::{Case, Row};
use corpuscle_gas::{Estimate, Gas, Setup};
use corpuscle_model::{Model, ModelError};
use std::sync::atomic::AtomicBool;

pub(crate) const CASES: &[Case] = &[
    maxwell::MAXWELL,
    equation_of_state::EQUATION_OF_STATE,
    enskog::ENSKOG,
    adiabatic::ADIABATIC,
    figure::FIGURE_11,
    granular::GRANULAR,
    mixing::MIXING,
    frames::FRAME_INDEPENDENCE,
    brownian::BROWNIAN,
    atmosphere::ATMOSPHERE,
    effusion::EFFUSION,
    wall_pressure::WALL_PRESSURE,
    transport::TRANSPORT,
    square_well::SQUARE_WELL,
    shear::SHEAR,
];

/// Seed of everything random.
const SEED: u64 = 1;

/// Advances a gas to a time.
fn advance<const D: usize>(gas: &mut Gas<D>, time: f64) -> Result<(), ModelError> {
    gas.advance_to(time, &AtomicBool::new(false))
}

/// Time in which a ball of a fluid as of [`Setup::fluid`] has so many collisions.
fn time_of<const D: usize>(collisions: f64, packing: f64) -> f64 {
    collisions / theory::collision_rate::<D>(packing)
}

/// How many standard errors a mean is from what is known.
fn standard_errors_off(found: Estimate, known: f64) -> f64 {
    (found.mean - known).abs() / found.error
}

/// Rows of a case, or the row of its failure.
fn rows(case: &'static str, result: Result<Vec<Row>, ModelError>) -> Vec<Row> {
    result.unwrap_or_else(|error| vec![Row::broken(case, &error.to_string())])
}

/// A fluid in a periodic box that has had `settled` collisions of each ball, then `measured` while averages were taken.
fn measured_fluid<const D: usize>(
    setup: Setup<D>,
    packing: f64,
    settled: f64,
    measured: f64,
) -> Result<Gas<D>, ModelError> {
    let from = time_of::<D>(settled, packing);
    let lasting = time_of::<D>(measured, packing);
    let mut gas = setup.seed(SEED).measured(from, lasting / SAMPLES).build()?;
    advance(&mut gas, from + lasting)?;
    Ok(gas)
}

/// Samples of a gas over an average.
const SAMPLES: f64 = 100.0;
