//! A heavy ball among light ones.

use super::{SEED, advance, rows};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Setup};
use corpuscle_model::ModelError;

pub(super) const BROWNIAN: Case = Case {
    name: "gas/brownian",
    about: "A ball of twenty times the mass and twice the radius among 200 light ones: its mean kinetic energy is theirs \
            (equipartition), and its mean-square displacement becomes a straight line (Einstein 1905).",
    slow: true,
    reduced: 1.0,
    run: brownian,
};

const MASS: f64 = 20.0;
const LIGHT: usize = 200;

fn brownian(_: &Options) -> Vec<Row> {
    rows(BROWNIAN.name, measure())
}

/// Kinetic energies and positions of the heavy ball at equal times.
struct Watched {
    step: f64,
    /// Of the heavy ball over the light ones' mean, as far as both move relative to the centre of mass.
    energy: Vec<f64>,
    positions: Vec<[f64; 3]>,
}

fn watch(time: f64, step: f64) -> Result<Watched, ModelError> {
    let setup = Setup::<3>::fluid(LIGHT, 0.3);
    let middle = setup.size.map(|length| 0.5 * length);
    let mut gas = setup.ball(middle, [0.0; 3], 1.0, MASS).seed(SEED).build()?;
    let settled = 50.0;
    advance(&mut gas, settled)?;
    // With no momentum of the whole, a ball of mass m has the part 1 - m / M of what it has in an endless gas.
    let total = MASS + LIGHT as f64;
    let per_light = (1.0 - 1.0 / total) / (1.0 - MASS / total);
    let mut watched = Watched { step, energy: Vec::new(), positions: Vec::new() };
    for sample in 0..(time / step) as u64 {
        advance(&mut gas, settled + sample as f64 * step)?;
        let heavy = 0.5 * MASS * gas.states()[0].1.iter().map(|v| v * v).sum::<f64>();
        let light = (gas.kinetic_energy() - heavy) / LIGHT as f64;
        watched.energy.push(heavy / light * per_light);
        watched.positions.push(gas.unwrapped()[0]);
    }
    Ok(watched)
}

impl Watched {
    /// Growth of the mean-square displacement from one lag to another in a unit of time.
    fn slope(positions: &[[f64; 3]], lags: [usize; 2], step: f64) -> f64 {
        let displacement = |lag: usize| {
            let squares = positions
                .windows(lag + 1)
                .map(|way| (0..3).map(|axis| (way[lag][axis] - way[0][axis]).powi(2)).sum::<f64>());
            squares.sum::<f64>() / (positions.len() - lag) as f64
        };
        (displacement(lags[1]) - displacement(lags[0])) / ((lags[1] - lags[0]) as f64 * step)
    }

    /// Means over parts of the time.
    fn parts<T>(values: &[T], of: impl Fn(&[T]) -> f64) -> Estimate {
        let parts: Vec<f64> = values.chunks_exact(values.len() / 20).map(of).collect();
        Estimate::of(&parts)
    }
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let watched = watch(4000.0, 0.5)?;
    let energy = Watched::parts(&watched.energy, |part| part.iter().sum::<f64>() / part.len() as f64);
    // The ball forgets its velocity within about 1: all lags are late.
    let lags = |from: f64, to: f64| [from, to].map(|lag| (lag / watched.step) as usize);
    let slopes = |lags| Watched::parts(&watched.positions, |part| Watched::slope(part, lags, watched.step));
    let (early, late) = (slopes(lags(5.0, 10.0)), slopes(lags(10.0, 20.0)));
    let row = |measure, value, bound| Row::at_most(BROWNIAN.name, measure, value, "", bound);
    Ok(vec![
        row("energy_less_light_ones_in_standard_errors", (energy.mean - 1.0).abs() / energy.error, 3.0),
        row("relative_standard_error_of_energy", energy.error, 0.03),
        row(
            "late_slope_less_early_in_standard_errors",
            (late.mean - early.mean).abs() / late.error.hypot(early.error),
            3.0,
        ),
        row("relative_standard_error_of_slope", late.error / late.mean, 0.1),
    ])
}
