//! Thin sheets on slopes.

use super::super::rows;
use super::noise::squares;
use super::{all_sides, run, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::Edge;
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const SHEETS: Case = Case {
    name: "flood/voronoi/sheets",
    about: "A sheet of 2 cm, uneven by 20 %, at rest on endless slopes of 0.05, 0.1 and 0.3 (n 0.03, particles 2 m apart), after 60 s by scheme \
            voronoi, three seeds: its mean velocity against Manning's formula, and its least depth. Peer: smoothed particles of fixed volumes are 21, 57 and \
            78 % too fast, and break into clumps.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(SHEETS.name, measure()),
};

/// Slopes, and the names of their rows.
const SLOPES: [(f64, [&str; 2]); 3] = [
    (0.05, ["velocity_error_slope_5", "least_depth_slope_5"]),
    (0.1, ["velocity_error_slope_10", "least_depth_slope_10"]),
    (0.3, ["velocity_error_slope_30", "least_depth_slope_30"]),
];

const DEPTH: f64 = 0.02;
const MANNING: f64 = 0.03;

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut rows = Vec::new();
    for (slope, [velocity, depth]) in SLOPES {
        let [off, least] = worst(|seed| sheet(slope, seed).map(|[off, least]| [off, -least]))?;
        rows.push(Row::at_most(SHEETS.name, velocity, off, "", 0.01));
        rows.push(Row::at_least(SHEETS.name, depth, -least, "m", 0.5 * DEPTH));
    }
    Ok(rows)
}

/// Error of the mean velocity, and the least depth of all cells, m.
fn sheet(slope: f64, seed: u64) -> Result<[f64; 2], ModelError> {
    let spacing = 2.0;
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 30.0 };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, move |x, _| (-slope * x, [-slope, 0.0])));
    let uneven = squares(spacing, seed);
    let water = StartWater {
        filling: Filling::Depth(Box::new(move |x, y| DEPTH * (1.0 + 0.2 * uneven(x, y)))),
        polygon: None,
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let flood = run(&settings(spacing, MANNING, all_sides(&Edge::Periodic)), seed, &terrain, &[water], 60.0)?;
    let (mut volume, mut momentum, mut least, mut wet) = (0.0, 0.0, f64::INFINITY, 0);
    for cell in flood.wet_cells() {
        volume += cell.area * cell.depth;
        momentum += cell.area * cell.depth * cell.velocity[0];
        least = cell.depth.min(least);
        wet += 1;
    }
    let [length, width] = bounds.size();
    let mean = volume / (length * width);
    let normal = mean.powf(2.0 / 3.0) * slope.sqrt() / MANNING;
    let least = if wet == flood.cells() { least } else { 0.0 };
    Ok([(momentum / volume / normal - 1.0).abs(), least])
}
