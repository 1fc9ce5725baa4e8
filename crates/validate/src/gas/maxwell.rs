//! A gas finds Maxwell's distribution, keeps its energy, never overlaps, and runs back.

use super::{SEED, advance, rows, time_of};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Gas, Setup, Species, Speeds};
use corpuscle_model::ModelError;

pub(super) const MAXWELL: Case = Case {
    name: "gas/maxwell",
    about: "Balls of equal speed have Maxwell's speeds after 20 collisions each (chi-square test); over 10^8 collisions energy \
            stays and nothing overlaps; with velocities turned round after 3 collisions each, every ball returns.",
    slow: true,
    reduced: 1.0,
    run: maxwell,
};

fn maxwell(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = speeds::<2>()?;
        rows.extend(speeds::<3>()?);
        rows.extend(long_run()?);
        rows.push(at_hits()?);
        rows.extend(there_and_back()?);
        Ok(rows)
    };
    rows(MAXWELL.name, measure())
}

fn row(measure: &str, value: f64, bound: f64) -> Row {
    Row::at_most(MAXWELL.name, measure, value, "", bound)
}

/// From equal speeds to Maxwell's.
fn speeds<const D: usize>() -> Result<Vec<Row>, ModelError> {
    let packing = 0.2;
    let mut setup = Setup::<D>::fluid(20_000, packing).seed(SEED);
    setup.species[0].speeds = Speeds::Equal;
    let mut gas = setup.build()?;
    let before = gas.maxwell_p_value();
    advance(&mut gas, time_of::<D>(20.0, packing))?;
    let after = gas.maxwell_p_value();
    Ok(vec![
        row(&format!("p_value_of_equal_speeds_{D}d"), before, 1e-6),
        Row::at_least(MAXWELL.name, &format!("p_value_after_20_collisions_{D}d"), after, "", 0.01),
    ])
}

/// Radius of a ball of the scene `gas/maxwell`, and how many there are.
const RADIUS: f64 = 4.0;
const COUNT: usize = 800;

/// The box of the scene `gas/maxwell`.
fn classroom() -> Setup<2> {
    let balls = Species { radius: RADIUS, ..Species::new("balls", Amount::Count(COUNT)) };
    Setup::new([800.0, 600.0]).species(balls).seed(SEED)
}

/// Collisions of a ball in a unit of time, from a short run.
fn rate_of(mut gas: Gas<2>) -> Result<f64, ModelError> {
    let time = 400.0;
    advance(&mut gas, time)?;
    Ok(2.0 * gas.collisions() as f64 / COUNT as f64 / time)
}

fn long_run() -> Result<Vec<Row>, ModelError> {
    let (collisions, frames) = (1e8, 2000);
    let step = 2.0 * collisions / COUNT as f64 / rate_of(classroom().build()?)? / f64::from(frames);
    let mut gas = classroom().build()?;
    let energy = gas.energy();
    let (mut drift, mut overlap) = (0.0_f64, 0.0_f64);
    for frame in 1.. {
        advance(&mut gas, f64::from(frame) * step)?;
        drift = drift.max((gas.energy() / energy - 1.0).abs());
        overlap = overlap.max(gas.deepest_overlap());
        if gas.collisions() as f64 >= collisions {
            break;
        }
    }
    Ok(vec![
        Row::at_least(MAXWELL.name, "collisions", gas.collisions() as f64, "", collisions),
        row("relative_energy_drift", drift, 1e-11),
        row("deepest_overlap_over_radius", overlap, 1e-9),
    ])
}

/// Deepest overlap at the moments of one ball's hits, when balls touch: a first run finds the times, a second stops there.
fn at_hits() -> Result<Row, ModelError> {
    let mut setup = classroom();
    setup.follow = Some(0);
    let mut gas = setup.build()?;
    advance(&mut gas, 2000.0)?;
    let hits = gas.path();
    let mut gas = classroom().build()?;
    let mut overlap = 0.0_f64;
    for (time, _) in hits {
        advance(&mut gas, time)?;
        overlap = overlap.max(gas.deepest_overlap());
    }
    Ok(row("deepest_overlap_at_hits_over_radius", overlap, 1e-9))
}

/// Farthest that a ball is from its start, over its radius, after so many collisions of each ball and all the way back.
fn distance_after_return(collisions: f64, rate: f64) -> Result<f64, ModelError> {
    let mut setup = classroom();
    let turn = collisions / rate;
    setup.reversed_at = Some(turn);
    let mut gas = setup.build()?;
    let start = gas.states();
    advance(&mut gas, 2.0 * turn)?;
    let apart = |(a, b): (&([f64; 2], _), &([f64; 2], _))| (a.0[0] - b.0[0]).hypot(a.0[1] - b.0[1]);
    Ok(start.iter().zip(&gas.states()).map(apart).fold(0.0, f64::max) / RADIUS)
}

/// What it returns by is the gas's own chaos: rounding errors grow with every collision.
fn there_and_back() -> Result<Vec<Row>, ModelError> {
    let rate = rate_of(classroom().build()?)?;
    let mut rows = Vec::new();
    for collisions in 1..=6 {
        let error = distance_after_return(f64::from(collisions), rate)?;
        let bound = if collisions <= 3 { 1e-6 } else { 1.0 };
        rows.push(row(&format!("return_error_over_radius_{collisions}"), error, bound));
    }
    Ok(rows)
}
