//! The force of a stream on a cylinder.

use super::super::{GRAVITY, rows};
use super::{advance, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Circle, Edge, Edges, Obstacle};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const CYLINDER_FORCE: Case = Case {
    name: "flood/voronoi/cylinder-force",
    about: "A stream of 4 m/s, 1 m deep, in a channel 12 m wide past a cylinder of 3 m by scheme voronoi, three seeds at three spacings: the force on its wall, as \
            gauges tell it, against the momentum that flows in through a section before it and out through one behind it.",
    slow: true,
    reduced: 2.0,
    run: |_: &Options| rows(CYLINDER_FORCE.name, measure()),
};

const LENGTH: f64 = 40.0;
const WIDTH: f64 = 12.0;
const RADIUS: f64 = 1.5;
const MIDDLE: [f64; 2] = [16.0, 6.0];
const SPEED: f64 = 4.0;
const DEPTH: f64 = 1.0;

/// The control sections before and behind the cylinder, m.
const SECTIONS: [f64; 2] = [8.0, 26.0];

/// Times of the samples, s: from the first to the second, and their number.
const LOOKED: [f64; 2] = [1.0, 3.0];
const SAMPLES: u32 = 200;

/// Positions across a section.
const ACROSS: u32 = 240;

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut rows = Vec::new();
    let mut water: f64 = 0.0;
    let spacings = [(1.0, "force_error_1m", 0.02), (0.5, "force_error_05m", 0.01), (0.25, "force_error_025m", 0.005)];
    for (spacing, force, bound) in spacings {
        let [error, unbalanced] = worst(|seed| of_seed(spacing, seed))?;
        rows.push(Row::at_most(CYLINDER_FORCE.name, force, error, "", bound));
        water = water.max(unbalanced);
    }
    rows.push(Row::at_most(
        CYLINDER_FORCE.name,
        "water_relative_error",
        water,
        "",
        super::super::device::water_rounding(),
    ));
    Ok(rows)
}

/// Relative difference of the mean force on the wall and the loss of momentum between the sections, and the ledger's error.
fn of_seed(spacing: f64, seed: u64) -> Result<[f64; 2], ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, 0.5, |_, _| (0.0, [0.0; 2])));
    let edges = Edges { west: Edge::Periodic, east: Edge::Periodic, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(spacing, 0.0, edges);
    settings.obstacle = vec![Obstacle {
        name: "cylinder".into(),
        circle: Some(Circle { centre: MIDDLE, radius_m: RADIUS }),
        ..Obstacle::default()
    }];
    let water = StartWater {
        filling: Filling::Depth(Box::new(|_, _| DEPTH)),
        polygon: None,
        velocity: Box::new(|_, _| [SPEED, 0.0]),
    };
    let mut flood = set_up(&settings, seed, &terrain, &[water])?;
    let columns = flood.gauge_columns();
    let impulse = columns.iter().position(|column| column.header() == "cylinder.impulse_east_N_s").unwrap_or(0);
    let [from, to] = LOOKED;
    advance(&mut flood, from)?;
    let (before, held) = (flood.gauge_row()[impulse], momentum_between(&flood));
    let mut through = 0.0;
    for sample in 1..=SAMPLES {
        let time = from + (to - from) * f64::from(sample) / f64::from(SAMPLES);
        advance(&mut flood, time)?;
        through += flux(&flood, SECTIONS[0]) - flux(&flood, SECTIONS[1]);
    }
    let on_wall = (flood.gauge_row()[impulse] - before) / (to - from);
    let lost = through / f64::from(SAMPLES) - (momentum_between(&flood) - held) / (to - from);
    Ok([(on_wall / lost - 1.0).abs(), flood.ledger().balances[0].relative_error().abs()])
}

/// Flux of momentum and pressure through a section across the channel, N: rho (d u^2 + g d^2 / 2).
fn flux(flood: &VoronoiFlood, x: f64) -> f64 {
    let width = WIDTH / f64::from(ACROSS);
    let at = |part: u32| {
        let water = flood.sample(x, (f64::from(part) + 0.5) * width);
        1000.0 * water.depth * (water.velocity[0].powi(2) + 0.5 * GRAVITY * water.depth) * width
    };
    (0..ACROSS).map(at).sum()
}

/// Momentum along the channel of the water between the sections, N s.
fn momentum_between(flood: &VoronoiFlood) -> f64 {
    let [from, to] = SECTIONS;
    let between = flood.wet_cells().filter(|cell| (from..to).contains(&cell.centroid[0]));
    between.map(|cell| 1000.0 * cell.area * cell.depth * cell.velocity[0]).sum()
}
