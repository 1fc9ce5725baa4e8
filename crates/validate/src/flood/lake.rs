//! Water at rest stays at rest.

use super::device::rounding;
use super::{rows, run, settings, water_everywhere};
use crate::{Case, Options, Row};
use corpuscle_flood::Particle;
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(super) const LAKE_AT_REST: Case = Case {
    name: "flood/lake-at-rest",
    about: "A lake over a 5 m Gaussian bump, and round a dry island, for 60 s: exact answer 0. Peers: symmetric \
            pressure form 4.3e-3 m/s, linearly corrected surface-difference form 1.4e-9 m/s (measured by the authors).",
    slow: false,
    reduced: 3.0,
    run: lake_at_rest,
};

fn lake_at_rest(_: &Options) -> Vec<Row> {
    rows(LAKE_AT_REST.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let row = |measure, value, bound| Row::at_most(LAKE_AT_REST.name, measure, value, "m/s", bound);
    Ok(vec![row("max_speed", fastest(6.0)?, rounding(1e-6, 1e-4)), row("max_speed_dry_island", fastest(4.0)?, 1e-3)])
}

/// Speed of the fastest particle after 60 s with the lake at `level` m, m/s.
fn fastest(level: f64) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 100.0 };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |x, y| {
        let (dx, dy, width) = (x - 50.0, y - 50.0, 10.0);
        let height = 5.0 * (-0.5 * (dx * dx + dy * dy) / (width * width)).exp();
        (height, [-dx, -dy].map(|d| d / (width * width) * height))
    }));
    let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let settings = settings(60.0, 1.0, 6.0, walls);
    let ground = Arc::clone(&terrain);
    let water = water_everywhere(bounds, move |x, y| level - ground.height(x, y), |_, _| [0.0; 2]);
    let flood = run(&settings, &terrain, &[water], 60.0)?;
    Ok(flood.particles().iter().map(Particle::speed).fold(0.0, f64::max))
}
