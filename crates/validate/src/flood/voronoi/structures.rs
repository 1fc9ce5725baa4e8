//! Weirs and outflows by rating.

use super::super::rows;
use super::{advance, all_sides, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood, Link, LinkLaw, Obstacle, Outflow, Weir};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const STRUCTURES: Case = Case {
    name: "flood/voronoi/structures",
    about: "What a weir (Poleni, Villemonte 1947) leads from one pool to another in 120 s, free and drowned, and what an outflow takes by its rating in 200 s, \
            against their equations solved by small steps, by scheme voronoi, three seeds, particles 1, 2 and 4 m apart. The equations have level pools; \
            where water is taken the level is drawn down a little.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(STRUCTURES.name, measure()),
};

/// Sides of each pool, m, and thickness of the wall between them.
const SIDE: f64 = 30.0;
const WALL: f64 = 6.0;

const WEIR: Weir = Weir { crest_m: 1.0, width_m: 2.0, coefficient: 1.705 };

/// Steps in which the equations are solved.
const STEPS: u32 = 10_000;

fn measure() -> Result<Vec<Row>, ModelError> {
    let row = |measure, value| Row::at_most(STRUCTURES.name, measure, value, "", 0.005);
    let mut out = Vec::new();
    for (spacing, free, drowned, outflow) in [
        (1.0, "relative_error_of_free_weir_1m", "relative_error_of_drowned_weir_1m", "relative_error_of_outflow_1m"),
        (2.0, "relative_error_of_free_weir_2m", "relative_error_of_drowned_weir_2m", "relative_error_of_outflow_2m"),
        (4.0, "relative_error_of_free_weir_4m", "relative_error_of_drowned_weir_4m", "relative_error_of_outflow_4m"),
    ] {
        let found = worst(|seed| {
            let weir = |depths| passed(spacing, seed, depths, 120.0, over_weir, over);
            Ok([
                weir([1.6, 0.8])?,
                weir([1.6, 1.3])?,
                passed(spacing, seed, [1.5, 0.5], 200.0, out_of_first, |level, _| 2.0 * level)?,
            ])
        })?;
        out.extend([row(free, found[0]), row(drowned, found[1])]);
        out.push(row(outflow, found[2]));
    }
    Ok(out)
}

/// A weir from the middle of one pool to that of the other.
fn over_weir(settings: &mut Flood) {
    let middle = 0.5 * SIDE;
    settings.link = vec![Link {
        name: "weir".into(),
        from: [middle, middle],
        to: [SIDE + WALL + middle, middle],
        both_ways: true,
        law: LinkLaw::Weir(WEIR),
    }];
}

/// Its discharge, m3/s: Q = C b h^(3/2), drowned (1 - (h_2 / h)^(3/2))^0.385 of it (Villemonte 1947).
fn over(upper: f64, lower: f64) -> f64 {
    let [head, behind] = [upper, lower].map(|level| (level - WEIR.crest_m).max(0.0));
    WEIR.coefficient * WEIR.width_m * head.powf(1.5) * (1.0 - (behind / head).min(1.0).powf(1.5)).powf(0.385)
}

/// An outflow along a line across the first pool, of 2 m2/s times the level.
fn out_of_first(settings: &mut Flood) {
    settings.outflow = vec![Outflow {
        name: "sluice".into(),
        at: None,
        line: Some(vec![[20.0, 2.0], [20.0, 28.0]]),
        polygon: None,
        rating: vec![[0.0, 0.0], [2.0, 4.0]],
    }];
}

/// How far what has left the first of two pools after `time` s is from what `discharge` of the two levels gives.
fn passed(
    spacing: f64,
    seed: u64,
    depths: [f64; 2],
    time: f64,
    change: fn(&mut Flood),
    discharge: fn(f64, f64) -> f64,
) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 2.0 * SIDE + WALL, y_min: 0.0, y_max: SIDE };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])));
    let mut settings = settings(spacing, 0.03, all_sides(&Edge::Wall));
    let wall = vec![[SIDE, 0.0], [SIDE + WALL, 0.0], [SIDE + WALL, SIDE], [SIDE, SIDE]];
    settings.obstacle = vec![Obstacle { name: "wall".into(), polygon: Some(wall), ..Obstacle::default() }];
    change(&mut settings);
    let water = StartWater {
        filling: Filling::Depth(Box::new(move |x, _| depths[usize::from(x > SIDE + 0.5 * WALL)])),
        polygon: None,
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let mut flood = set_up(&settings, seed, &terrain, &[water])?;
    let start = volumes(&flood);
    advance(&mut flood, time)?;
    let [mut first, mut second] = start;
    let area = SIDE * SIDE;
    for _ in 0..STEPS {
        let out = discharge(first / area, second / area) * time / f64::from(STEPS);
        (first, second) = (first - out, second + if settings.link.is_empty() { 0.0 } else { out });
    }
    Ok(((start[0] - volumes(&flood)[0]) / (start[0] - first) - 1.0).abs())
}

/// Water in the two pools, m3.
fn volumes(flood: &VoronoiFlood) -> [f64; 2] {
    let mut volumes = [0.0; 2];
    for cell in flood.wet_cells() {
        volumes[usize::from(cell.centroid[0] > SIDE + 0.5 * WALL)] += cell.area * cell.depth;
    }
    volumes
}
