//! Waves of small height.

use super::super::{GRAVITY, rows};
use super::{Cell, Convergence, all_sides, cells, run, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::Edge;
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in super::super) const WAVES: Case = Case {
    name: "flood/voronoi/smooth-wave",
    about: "Waves of small height on water 1 m deep in a periodic box by scheme voronoi, three seeds, spacings of 0.5, 1 and 2 m: a simple wave \
            of 1 cm, 64 m long, after one length of its way (exact by its characteristics, Stoker 1957, section 10.3), and a standing wave \
            of 0.1 mm in both directions, 32 m long, after one period (linear theory; what it leaves out is some 1e-4 of it).",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(WAVES.name, measure()),
};

/// m.
const DEPTH: f64 = 1.0;

fn measure() -> Result<Vec<Row>, ModelError> {
    let simple = Convergence {
        case: WAVES.name,
        spacings: [
            (0.5, "simple_wave_error_50cm", 3.5e-3),
            (1.0, "simple_wave_error_1m", 1.3e-2),
            (2.0, "simple_wave_error_2m", 4.5e-2),
        ],
        order: ("simple_wave_order", 1.8),
    };
    let standing = Convergence {
        case: WAVES.name,
        spacings: [
            (0.5, "standing_wave_error_50cm", 5e-3),
            (1.0, "standing_wave_error_1m", 3e-2),
            (2.0, "standing_wave_error_2m", 2e-1),
        ],
        order: ("standing_wave_order", 1.8),
    };
    let mut rows = simple.rows(simple_wave)?;
    rows.extend(standing.rows(standing_wave)?);
    Ok(rows)
}

/// Length of the simple wave, m, and its height over the depth at rest, m.
const LENGTH: f64 = 64.0;
const HEIGHT: f64 = 0.01;

/// Depth and velocity at the start: u = 2 (c - c0).
fn simple(x: f64) -> (f64, f64) {
    let depth = DEPTH + HEIGHT * (TAU * x / LENGTH).sin();
    (depth, 2.0 * ((GRAVITY * depth).sqrt() - (GRAVITY * DEPTH).sqrt()))
}

/// Depth after `time` s: it came along u + c, as it was.
fn simple_after(x: f64, time: f64) -> f64 {
    let mut from = x;
    for _ in 0..50 {
        let (depth, velocity) = simple(from);
        from = x - time * (velocity + (GRAVITY * depth).sqrt());
    }
    simple(from).0
}

fn simple_wave(spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let time = LENGTH / (GRAVITY * DEPTH).sqrt();
    let start = (|x: f64, _: f64| simple(x).0, |x: f64, _: f64| [simple(x).1, 0.0]);
    error([LENGTH, 16.0], spacing, seed, time, start, |[x, _]| simple_after(x, time))
}

fn standing_wave(spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let (length, height) = (32.0, 1e-4);
    let number = TAU / length;
    let period = TAU / (number * (2.0 * GRAVITY * DEPTH).sqrt());
    let depth = move |x: f64, y: f64| DEPTH + height * (number * x).cos() * (number * y).cos();
    error([length; 2], spacing, seed, period, (depth, |_: f64, _: f64| [0.0; 2]), |[x, y]| depth(x, y))
}

/// mean |h - h_exact| / mean |h_exact - h0| over the cells of a periodic box.
fn error(
    [width, breadth]: [f64; 2],
    spacing: f64,
    seed: u64,
    time: f64,
    (depth, velocity): (impl Fn(f64, f64) -> f64 + Sync, impl Fn(f64, f64) -> [f64; 2] + Sync),
    exact: impl Fn([f64; 2]) -> f64,
) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: width, y_min: 0.0, y_max: breadth };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |_, _| (0.0, [0.0; 2])));
    let water = StartWater { filling: Filling::Depth(Box::new(depth)), polygon: None, velocity: Box::new(velocity) };
    let flood = run(&settings(spacing, 0.0, all_sides(&Edge::Periodic)), seed, &terrain, &[water], time)?;
    let cells = cells(&flood);
    let sum = |of: &dyn Fn(&Cell) -> f64| cells.iter().map(|cell| cell.area * of(cell)).sum::<f64>();
    Ok(sum(&|cell| (cell.depth - exact(cell.at)).abs()) / sum(&|cell| (exact(cell.at) - DEPTH).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// dh/dt + d(hu)/dx = 0 along the simple wave.
    #[test]
    fn the_simple_wave_conserves_water() {
        let (x, time, e) = (20.0, 7.0, 1e-3);
        let velocity = |depth: f64| 2.0 * ((GRAVITY * depth).sqrt() - (GRAVITY * DEPTH).sqrt());
        let flux = |x: f64| simple_after(x, time) * velocity(simple_after(x, time));
        let rate = (simple_after(x, time + e) - simple_after(x, time - e)) / (2.0 * e);
        let out = (flux(x + e) - flux(x - e)) / (2.0 * e);
        assert!((rate + out).abs() < 1e-9 && rate.abs() > 1e-5, "{rate} {out}");
    }
}
