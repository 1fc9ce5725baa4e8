//! Rain on a plane.

use super::super::{order, rows, strip};
use super::{advance, cells, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges, Flood, Rain, Series, Storage};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const RAIN: Case = Case {
    name: "flood/voronoi/rain-plane",
    about: "50 mm/h for 1200 s on a dry plane 100 m long (fall 0.05, n 0.1), and 1200 s after it, by scheme voronoi, three seeds, spacings of 1, 2 and \
            4 m: the hydrograph of the outflow in pieces of 30 s against the kinematic wave (Henderson & Wooding 1964), whose number is \
            13,000 here.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(RAIN.name, measure()),
};

const LENGTH: f64 = 100.0;
const WIDTH: f64 = 16.0;
const SLOPE: f64 = 0.05;
const MANNING: f64 = 0.1;

/// Rain, m/s, until a time, s; the run goes on as long again.
const INTENSITY: f64 = 0.05 / 3600.0;
const RAINS: f64 = 1200.0;

/// Pieces of the hydrograph, s.
const PIECE: f64 = 30.0;

/// Discharge of a depth, m2/s: q = alpha d^(5/3).
fn discharge(depth: f64) -> f64 {
    SLOPE.sqrt() / MANNING * depth.powf(5.0 / 3.0)
}

/// Discharge at the foot of the plane at a time, m2/s: d = i t until the wave from the top comes by, q = i L until the rain ends; after
/// that each depth d comes from i x = q(d) with its speed dq/dd.
fn at_foot(time: f64) -> f64 {
    let steady = INTENSITY * LENGTH;
    if time <= RAINS {
        return discharge(INTENSITY * time).min(steady);
    }
    let position = |depth: f64| discharge(depth) / INTENSITY + 5.0 / 3.0 * discharge(depth) / depth * (time - RAINS);
    let (mut low, mut high) = (0.0, INTENSITY * RAINS);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if position(middle) > LENGTH { high = middle } else { low = middle }
    }
    discharge(low).min(steady)
}

/// Mean discharge of a piece that ends at `end` s, m3/s.
fn of_piece(end: f64) -> f64 {
    let parts = 300;
    let at = |part: usize| end - PIECE * (part as f64 + 0.5) / parts as f64;
    WIDTH * (0..parts).map(|part| at_foot(at(part))).sum::<f64>() / parts as f64
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut errors = Vec::new();
    for spacing in [1.0, 2.0, 4.0] {
        errors.push(worst(|seed| hydrograph(spacing, seed, Storage::Mean))?);
    }
    let at_most = |measure, value, bound| Row::at_most(RAIN.name, measure, value, "", bound);
    Ok(vec![
        at_most("hydrograph_error_1m", errors[0][0], 0.01),
        at_most("hydrograph_error_2m", errors[1][0], 0.02),
        at_most("hydrograph_error_4m", errors[2][0], 0.04),
        Row::at_least(RAIN.name, "order", order(errors[0][0], errors[2][0], 4.0), "", 0.9),
        at_most("steady_outflow_error_1m", errors[0][1], 0.01),
    ])
}

/// Farthest that a piece of the hydrograph is from the kinematic wave, and the last one of the rain from the rain, over the latter.
pub(super) fn hydrograph(spacing: f64, seed: u64, storage: Storage) -> Result<[f64; 2], ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |x, _| (-SLOPE * x, [-SLOPE, 0.0])));
    let mm_per_h = 3.6e6 * INTENSITY;
    let series = Series::Table(vec![[0.0, mm_per_h], [RAINS, mm_per_h], [RAINS + 1e-6, 0.0]]);
    let rain = Some(Rain { intensity_mm_per_h: series, raster: None });
    let edges = Edges { west: Edge::Wall, ..strip(&Edge::Open) };
    let settings = Flood { rain, storage, wet_depth_m: 1e-9, ..settings(spacing, MANNING, edges) };
    let mut flood = set_up(&settings, seed, &terrain, &[])?;
    let whole = WIDTH * LENGTH * INTENSITY;
    // What is on the plane at the time shown, which is not that of the ledger.
    let stored =
        |flood: &corpuscle_flood::VoronoiFlood| cells(flood).iter().map(|cell| cell.area * cell.depth).sum::<f64>();
    let (mut before, mut off, mut steady) = (0.0, 0.0_f64, 0.0);
    for piece in 1..=(2.0 * RAINS / PIECE) as usize {
        let end = PIECE * piece as f64;
        advance(&mut flood, end)?;
        let now = stored(&flood);
        let fallen = if end <= RAINS { PIECE * whole } else { 0.0 };
        let outflow = (fallen + before - now) / PIECE;
        off = off.max((outflow - of_piece(end)).abs() / whole);
        if end == RAINS {
            steady = (outflow / whole - 1.0).abs();
        }
        before = now;
    }
    Ok([off, steady])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All the rain comes out in the end.
    #[test]
    fn the_kinematic_wave_loses_no_water() {
        let volume: f64 = (1..4000).map(|piece| PIECE * of_piece(PIECE * f64::from(piece))).sum();
        assert!((volume / (INTENSITY * RAINS * LENGTH * WIDTH) - 1.0).abs() < 1e-3, "{volume}");
    }
}
