//! Pressure, both ways, against the best equations of state.

use super::{measured_fluid, rows, theory};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Setup, Species, ball_volume};
use corpuscle_model::ModelError;

pub(super) const EQUATION_OF_STATE: Case = Case {
    name: "gas/equation-of-state",
    about: "P V / N T of hard disks at packings 0.3, 0.5 and 0.65 (Kolafa & Rottner 2006) and of hard balls at 0.1, 0.3 and \
            0.49 (Kolafa), from the virial of the collisions; and between walls, where the walls must say the same.",
    slow: true,
    reduced: 1.0,
    run: equation_of_state,
};

const DISKS: [f64; 3] = [0.3, 0.5, 0.65];
const BALLS: [f64; 3] = [0.1, 0.3, 0.49];

fn equation_of_state(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for packing in DISKS {
            rows.extend(periodic::<2>(packing)?);
        }
        for packing in BALLS {
            rows.extend(periodic::<3>(packing)?);
        }
        for packing in DISKS {
            rows.extend(walled::<2>(packing)?);
        }
        // At 0.49 the balls beside walls freeze, layer by layer: pressures drift, and their standard errors mean nothing.
        for packing in &BALLS[..2] {
            rows.extend(walled::<3>(*packing)?);
        }
        Ok(rows)
    };
    rows(EQUATION_OF_STATE.name, measure())
}

/// `relative_error` of disks at 0.3: `relative_error_2d_30`.
fn named<const D: usize>(measure: &str, packing: f64) -> String {
    format!("{measure}_{D}d_{:.0}", 100.0 * packing)
}

/// Against the equation of state.
fn periodic<const D: usize>(packing: f64) -> Result<Vec<Row>, ModelError> {
    let gas = measured_fluid(Setup::<D>::fluid(4000, packing), packing, 100.0, 1500.0)?;
    let (found, known) = (gas.compressibility(), theory::compressibility::<D>(packing));
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(EQUATION_OF_STATE.name, &named::<D>(measure, packing), value, "", bound)
    };
    Ok(vec![
        row("relative_error", (found.mean / known - 1.0).abs(), 3e-3),
        row("standard_error", found.error / known, 1.5e-3),
    ])
}

/// Pressure in a box with walls: from the virial of all hits, and on the walls. By the virial theorem the two are the same on average,
/// whatever the size of the box.
fn walled<const D: usize>(packing: f64) -> Result<Vec<Row>, ModelError> {
    let count = 1000;
    let side = (count as f64 * ball_volume::<D>(0.5) / packing).powf(1.0 / D as f64);
    let setup = Setup::new([side; D]).species(Species::new("balls", Amount::Count(count)));
    let gas = measured_fluid(setup, packing, 100.0, 2500.0)?;
    let (virial, walls) = (gas.pressure_virial(), gas.pressure_walls());
    let apart = (virial.mean - walls.mean).abs() / virial.error.hypot(walls.error);
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(EQUATION_OF_STATE.name, &named::<D>(measure, packing), value, "", bound)
    };
    Ok(vec![
        row("virial_standard_error", virial.error / virial.mean, 5e-3),
        row("walls_standard_error", walls.error / walls.mean, 5e-3),
        row("virial_and_walls_apart", apart, 3.0),
    ])
}
