//! Balls with square wells.

use super::{advance, rows, standard_errors_off, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Estimate, Gas, Setup, ball_volume};
use corpuscle_model::ModelError;

pub(super) const SQUARE_WELL: Case = Case {
    name: "gas/square-well",
    about: "Balls with square wells: pressure of thin gases by the second and third virial coefficients (Kihara 1953), the jump of g(r) and \
            the part of pairs that escape at the rim by Boltzmann's factor, energy and overlaps over ten million events.",
    slow: true,
    reduced: 1.0,
    run: square_well,
};

/// Each seed is a measurement of its own.
const SEEDS: u64 = 6;

/// Steps of a run, after each of which the temperature is read.
const STEPS: usize = 200;

/// Width and depth of wells in thin gases; the last is a step.
const THIN: [(&str, f64, f64); 3] = [("narrow", 1.5, 0.7), ("wide", 1.8, 0.4), ("step", 1.5, -0.7)];
const THIN_PACKING: f64 = 0.01;
const THIN_COUNT: usize = 1000;

/// Width and depth of wells in a fluid.
const WIDTH: f64 = 1.5;
const DEPTH: f64 = 0.8;

fn square_well(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Vec::new();
        for (name, width, depth) in THIN {
            rows.extend(thin(name, width, depth)?);
        }
        rows.extend(rim()?);
        rows.extend(exactness()?);
        Ok(rows)
    };
    rows(SQUARE_WELL.name, measure())
}

fn row(measure: &str, value: f64, bound: f64) -> Row {
    Row::at_most(SQUARE_WELL.name, measure, value, "", bound)
}

/// Second virial coefficient over that of hard balls, 2 pi/3 of the diameter cubed: 1 - (width^3 - 1) x, x = exp(depth/kT) - 1
/// (Hirschfelder, Curtiss & Bird, Molecular Theory of Gases and Liquids, 1954, equation 3.5-9).
fn second(width: f64, x: f64) -> f64 {
    1.0 - (width.powi(3) - 1.0) * x
}

/// Third virial coefficient over the square of that of [`second`], for widths up to 2 (Kihara, Rev. Mod. Phys. 25, 1953, 831).
fn third(width: f64, x: f64) -> f64 {
    let [two, three, four, six] = [2, 3, 4, 6].map(|power| width.powi(power));
    let first = six - 18.0 * four + 32.0 * three - 15.0;
    let middle = 2.0 * six - 36.0 * four + 32.0 * three + 18.0 * two - 16.0;
    let last = 6.0 * six - 18.0 * four + 18.0 * two - 6.0;
    (5.0 - first * x - middle * x * x - last * x.powi(3)) / 8.0
}

/// Advances by a time in steps; the mean temperature.
fn mean_temperature(gas: &mut Gas<3>, time: f64) -> Result<f64, ModelError> {
    let start = corpuscle_model::Model::time(gas);
    let mut sum = 0.0;
    for step in 1..=STEPS {
        advance(gas, start + time * step as f64 / STEPS as f64)?;
        sum += gas.temperature();
    }
    Ok(sum / STEPS as f64)
}

/// What balls add to the pressure of points, over what the virial coefficients say of N balls: with a fixed momentum and a fixed
/// number there are N - 1 other balls for each.
fn thin(name: &str, width: f64, depth: f64) -> Result<Vec<Row>, ModelError> {
    let ratio = |seed: u64| {
        let settled = time_of::<3>(20.0, THIN_PACKING);
        let lasting = time_of::<3>(400.0, THIN_PACKING);
        let setup = Setup::<3>::fluid(THIN_COUNT, THIN_PACKING).well(depth, width).seed(seed);
        let mut gas = setup.measured(settled, lasting / 100.0).build()?;
        advance(&mut gas, settled)?;
        let temperature = mean_temperature(&mut gas, lasting)?;
        let x = (depth / temperature).exp_m1();
        let part = 1.0 - 1.0 / THIN_COUNT as f64;
        let density = 4.0 * THIN_PACKING;
        let known = part * second(width, x) * density + third(width, x) * density * density;
        Ok((gas.compressibility().mean - part) / known)
    };
    let found = (1..=SEEDS).map(ratio).collect::<Result<Vec<f64>, ModelError>>()?;
    let found = Estimate::of(&found);
    // 5 degrees of freedom: 4.0 standard errors for one in a hundred.
    Ok(vec![
        row(&format!("virial_off_by_standard_errors_{name}"), standard_errors_off(found, 1.0), 4.0),
        row(&format!("virial_standard_error_{name}"), found.error, 0.01),
    ])
}

/// At the rim g jumps by Boltzmann's factor, and this part of the pairs that come to it from inside has the energy to escape.
fn rim() -> Result<Vec<Row>, ModelError> {
    let (count, packing) = (1000, 0.2);
    let found = |seed: u64| {
        let (settled, lasting) = (time_of::<3>(50.0, packing), time_of::<3>(500.0, packing));
        let mut setup =
            Setup::<3>::fluid(count, packing).well(DEPTH, WIDTH).seed(seed).measured(settled, lasting / 8000.0);
        (setup.measure.pair_distance, setup.measure.pair_bins) = (Some(2.0), 200);
        let mut gas = setup.build()?;
        advance(&mut gas, settled)?;
        let before = gas.rim_events();
        let temperature = mean_temperature(&mut gas, lasting)?;
        let [_, escapes, returns] = gas.rim_events();
        let (escapes, returns) = (escapes - before[1], returns - before[2]);
        let factor = (-DEPTH / temperature).exp();
        let g = gas.pair_distribution();
        let edge = g.partition_point(|point| point[0] < WIDTH);
        // Straight on from the middles of two shells.
        let to_rim = |near: usize, far: usize| 1.5 * g[near][1] - 0.5 * g[far][1];
        let jump = to_rim(edge, edge + 1) / to_rim(edge - 1, edge - 2);
        Ok([jump / factor, escapes as f64 / (escapes + returns) as f64 / factor])
    };
    let found = (1..=SEEDS).map(found).collect::<Result<Vec<[f64; 2]>, ModelError>>()?;
    let mut rows = Vec::new();
    for (which, name, error) in [(0, "jump_of_g", 0.01), (1, "escapes", 0.002)] {
        let ratio = Estimate::of(&found.iter().map(|found| found[which]).collect::<Vec<_>>());
        rows.push(row(&format!("{name}_off_by_standard_errors"), standard_errors_off(ratio, 1.0), 4.0));
        rows.push(row(&format!("{name}_standard_error"), ratio.error, error));
    }
    Ok(rows)
}

/// Energy, overlaps, and work of nothing over many events of a fluid between walls.
fn exactness() -> Result<Vec<Row>, ModelError> {
    let count = 1000;
    let side = (count as f64 * ball_volume::<3>(0.5) / 0.3).cbrt();
    let balls = corpuscle_gas::Species::new("balls", corpuscle_gas::Amount::Count(count));
    let mut gas = Setup::<3>::new([side; 3]).species(balls).well(2.0, WIDTH).build()?;
    let (energy, kinetic) = (gas.energy(), gas.kinetic_energy());
    let scale = energy.abs().max(kinetic);
    let (mut drift, mut overlap, mut time) = (0.0_f64, 0.0_f64, 0.0);
    let events = |gas: &Gas<3>| gas.collisions() + gas.rim_events().iter().sum::<u64>();
    while events(&gas) < 10_000_000 {
        time += 1.0;
        advance(&mut gas, time)?;
        drift = drift.max((gas.energy() - energy).abs() / scale);
        overlap = overlap.max(gas.deepest_overlap());
    }
    Ok(vec![
        Row::at_least(SQUARE_WELL.name, "events", events(&gas) as f64, "", 1e7),
        row("relative_energy_drift", drift, 1e-11),
        row("deepest_overlap_over_radius", overlap, 1e-9),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// -1/3 of the integral over two distances and the angle between them (Hirschfelder, Curtiss & Bird 1954, equation 3.2-6).
    fn third_by_sums(width: f64, x: f64) -> f64 {
        // The diameter lies between two steps for each of the widths below.
        let steps = 420;
        let step = width / f64::from(steps);
        let distance = |at: u32| (f64::from(at) + 0.5) * step;
        let mayer = |r: f64| if r < 1.0 { -1.0 } else { x };
        // Integral of the distance times its function.
        let up_to = |r: f64| {
            let r = r.min(width);
            if r < 1.0 { -0.5 * r * r } else { -0.5 + 0.5 * x * (r * r - 1.0) }
        };
        let mut sum = 0.0;
        for r in (0..steps).map(distance) {
            for s in (0..steps).map(distance) {
                sum += mayer(r) * mayer(s) * r * s * (up_to(r + s) - up_to((r - s).abs()));
            }
        }
        -8.0 * PI * PI / 3.0 * sum * step * step / (2.0 * PI / 3.0).powi(2)
    }

    #[test]
    fn the_third_virial_coefficient_is_its_integral() {
        for (width, x) in [(1.5, 0.0), (1.5, 0.95), (1.5, -0.5), (1.75, 0.4), (2.0, 1.0)] {
            let (formula, sum) = (third(width, x), third_by_sums(width, x));
            assert!((formula - sum).abs() < 2e-3 * sum.abs().max(1.0), "{width} {x}: {formula} {sum}");
        }
        assert_eq!(second(1.5, 0.0), 1.0);
    }
}
