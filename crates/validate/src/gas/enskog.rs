//! Collision rate and self-diffusion of balls.

use super::{SEED, advance};
use super::{measured_fluid, rows, theory, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Gas, Setup};
use corpuscle_model::ModelError;

pub(super) const ENSKOG: Case = Case {
    name: "gas/enskog",
    about: "Collisions of a ball in a unit of time after Enskog, at packings 0.1 and 0.3, disks and balls; self-diffusion of balls \
            over Enskog's against molecular dynamics (Erpenbeck & Wood 1991). Disks diffuse the faster the longer one waits.",
    slow: true,
    reduced: 1.0,
    run: enskog,
};

fn enskog(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for packing in [0.1, 0.3] {
            rows.push(collision_rate::<2>(packing)?);
            rows.push(collision_rate::<3>(packing)?);
        }
        rows.extend(diffusion(0.1, 30.0, 20)?);
        rows.extend(diffusion(0.3, 20.0, 20)?);
        rows.push(disks()?);
        Ok(rows)
    };
    rows(ENSKOG.name, measure())
}

fn collision_rate<const D: usize>(packing: f64) -> Result<Row, ModelError> {
    let gas = measured_fluid(Setup::<D>::fluid(4000, packing), packing, 50.0, 500.0)?;
    let error = (gas.collision_rate().mean / theory::collision_rate::<D>(packing) - 1.0).abs();
    let measure = format!("relative_rate_error_{D}d_{:.0}", 100.0 * packing);
    Ok(Row::at_most(ENSKOG.name, &measure, error, "", 0.01))
}

/// Unwrapped positions of all balls at equal times.
fn positions<const D: usize>(gas: &mut Gas<D>, step: f64, count: usize) -> Result<Vec<Vec<[f64; D]>>, ModelError> {
    let start = corpuscle_model::Model::time(gas);
    let position = |sample: usize| {
        advance(gas, start + sample as f64 * step)?;
        Ok(gas.unwrapped())
    };
    (0..count).map(position).collect()
}

/// Mean-square displacement over `lag` samples of some of the balls, averaged over all times to start from.
fn displacement<const D: usize>(positions: &[Vec<[f64; D]>], lag: usize, balls: std::ops::Range<usize>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for pair in positions.windows(lag + 1) {
        for (from, to) in pair[0][balls.clone()].iter().zip(&pair[lag][balls.clone()]) {
            sum += (0..D).map(|axis| (to[axis] - from[axis]).powi(2)).sum::<f64>();
            count += 1.0;
        }
    }
    sum / count
}

/// Diffusion coefficient from the growth of the mean-square displacement between two lags (Einstein 1905); its error from parts of
/// the balls.
fn slope<const D: usize>(positions: &[Vec<[f64; D]>], lags: [usize; 2], step: f64) -> Estimate {
    let (balls, parts) = (positions[0].len(), 20);
    let time = (lags[1] - lags[0]) as f64 * step * (2 * D) as f64;
    let of = |part: usize| {
        let range = part * balls / parts..(part + 1) * balls / parts;
        (displacement(positions, lags[1], range.clone()) - displacement(positions, lags[0], range)) / time
    };
    Estimate::of(&(0..parts).map(of).collect::<Vec<_>>())
}

/// Self-diffusion of balls from lags of once and twice `lag`, which is longer than the slowest vortex in the box lasts; sampled for so
/// many lags.
fn diffusion(packing: f64, lag: f64, lags: usize) -> Result<Vec<Row>, ModelError> {
    let (count, samples) = (4000, 4);
    let mut gas = Setup::<3>::fluid(count, packing).seed(SEED).build()?;
    advance(&mut gas, time_of::<3>(50.0, packing))?;
    let step = lag / samples as f64;
    let positions = positions(&mut gas, step, lags * samples + 1)?;
    let found = slope(&positions, [samples, 2 * samples], step);
    let images = theory::slowed_by_images(gas.volume().cbrt(), theory::enskog_viscosity(packing));
    let ratio = (found.mean + images) / theory::enskog_diffusion(packing);
    let error = (ratio / theory::diffusion_over_enskog(packing) - 1.0).abs();
    let row = |measure: &str, value: f64, bound: f64| {
        Row::at_most(ENSKOG.name, &format!("{measure}_3d_{:.0}", 100.0 * packing), value, "", bound)
    };
    Ok(vec![
        row("relative_diffusion_error", error, 0.03),
        row("relative_diffusion_standard_error", found.error / found.mean, 0.015),
    ])
}

/// Disks: diffusion from displacements over 80 collisions of each over that from 5. Alder & Wainwright, Phys. Rev. A 1 (1970) 18: it
/// goes on growing, and has no limit.
fn disks() -> Result<Row, ModelError> {
    let packing = 0.3;
    let mut gas = Setup::<2>::fluid(10_000, packing).seed(SEED).build()?;
    advance(&mut gas, time_of::<2>(50.0, packing))?;
    let step = time_of::<2>(5.0, packing);
    let positions = positions(&mut gas, step, 61)?;
    let (early, late) = (slope(&positions, [1, 2], step), slope(&positions, [8, 16], step));
    let growth = (late.mean - early.mean) / early.error.hypot(late.error);
    Ok(Row::at_least(ENSKOG.name, "diffusion_2d_grows_by_standard_errors", growth, "", 3.0))
}
