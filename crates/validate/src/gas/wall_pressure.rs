//! Pressure on walls.

use super::{advance, rows, standard_errors_off, theory, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Estimate, Setup, Species, ball_volume};
use corpuscle_model::ModelError;

pub(super) const WALL_PRESSURE: Case = Case {
    name: "gas/wall-pressure",
    about: "Balls between two walls, at packings of about 0.1, 0.3 and 0.49 in the middle: the momentum that the walls take is the \
            pressure of Carnahan & Starling (1969) at the density in the middle, whatever layers there are beside the walls.",
    slow: true,
    reduced: 1.0,
    run: wall_pressure,
};

/// Packing of the whole, walls included, that makes about 0.1, 0.3 and 0.49 in the middle.
const PACKINGS: [(u32, f64); 3] = [(10, 0.097), (30, 0.292), (49, 0.484)];

const COUNT: usize = 2000;

/// Distance of the walls, and the part in the middle where the density is counted.
const LENGTH: f64 = 20.0;
const MIDDLE: [f64; 2] = [6.0, 14.0];

/// Collisions of each ball before and while it is measured, and samples.
const SETTLED: f64 = 100.0;
const MEASURED: f64 = 500.0;
const SAMPLES: u64 = 200;

/// Each seed is a measurement of its own.
const SEEDS: u64 = 8;

fn wall_pressure(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for (name, packing) in PACKINGS {
            rows.extend(at(name, packing)?);
        }
        Ok(rows)
    };
    rows(WALL_PRESSURE.name, measure())
}

fn at(name: u32, packing: f64) -> Result<Vec<Row>, ModelError> {
    let ratios = (1..=SEEDS).map(|seed| over_theory(packing, seed)).collect::<Result<Vec<_>, _>>()?;
    let found = Estimate::of(&ratios);
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(WALL_PRESSURE.name, &format!("{measure}_{name}"), value, "", bound)
    };
    // 7 degrees of freedom: 3.5 standard errors for one in a hundred.
    Ok(vec![
        row("off_by_standard_errors", standard_errors_off(found, 1.0), 3.5),
        row("standard_error", found.error, 5e-3),
    ])
}

/// Pressure on the walls over that at the density in the middle.
fn over_theory(packing: f64, seed: u64) -> Result<f64, ModelError> {
    let side = (COUNT as f64 * ball_volume::<3>(0.5) / (packing * LENGTH)).sqrt();
    let mut setup = Setup::<3>::new([LENGTH, side, side]).periodic();
    setup.sides[0] = Default::default();
    let (from, lasting) = (time_of::<3>(SETTLED, packing), time_of::<3>(MEASURED, packing));
    let step = lasting / SAMPLES as f64;
    let setup = setup.species(Species::new("balls", Amount::Count(COUNT))).measured(from, step);
    let mut gas = setup.seed(seed).build()?;
    let mut middle = 0;
    for sample in 0..=SAMPLES {
        advance(&mut gas, from + sample as f64 * step)?;
        middle += gas.states().iter().filter(|(position, _)| (MIDDLE[0]..MIDDLE[1]).contains(&position[0])).count();
    }
    let density = middle as f64 / ((SAMPLES + 1) as f64 * (MIDDLE[1] - MIDDLE[0]) * side * side);
    let x = density * ball_volume::<3>(0.5);
    let pressure = density * gas.temperature() * theory::carnahan_starling(x);
    Ok(gas.pressure_walls().mean / pressure)
}
