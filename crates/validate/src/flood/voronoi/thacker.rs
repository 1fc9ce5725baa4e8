//! Water swinging in a paraboloid (Thacker 1981).

use super::super::rows;
use super::super::thacker::{Exact, bounds, bowl, curved, omega, plane};
use super::{Convergence, all_sides, run, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood as Settings};
use std::f64::consts::TAU;

pub(in super::super) const PLANAR: Case = Case {
    name: "flood/voronoi/thacker-planar",
    about: "A plane surface going round in a paraboloid after one period (Thacker 1981; parameters of SWASHES 1.05: h0 0.1 m, a 1 m, eta \
            0.5 m) by scheme voronoi, three seeds, spacings of 2, 4 and 8 cm. Peers: a prototype of the scheme 6.0e-3 at 2 cm, scheme \
            balanced 1.85e-2.",
    slow: true,
    reduced: 4.0,
    run: planar,
};

pub(in super::super) const RADIAL: Case = Case {
    name: "flood/voronoi/thacker-radial",
    about: "A radially symmetric wave in a paraboloid after one period (Thacker 1981; parameters of SWASHES 1.05: h0 0.1 m, a 1 m, r0 0.8 m) \
            by scheme voronoi, three seeds, spacings of 2, 4 and 8 cm. Peer: scheme balanced 1.48e-2 at 2 cm.",
    slow: true,
    reduced: 2.0,
    run: radial,
};

fn planar(_: &Options) -> Vec<Row> {
    rows(PLANAR.name, measure(PLANAR.name, plane, 2.0 * TAU / omega()))
}

fn radial(_: &Options) -> Vec<Row> {
    rows(RADIAL.name, measure(RADIAL.name, curved, TAU / omega()))
}

fn measure(case: &'static str, exact: Exact, period: f64) -> Result<Vec<Row>, ModelError> {
    let convergence = Convergence {
        case,
        spacings: [
            (0.02, "relative_l1_error_2cm", 7e-3),
            (0.04, "relative_l1_error_4cm", 4e-2),
            (0.08, "relative_l1_error_8cm", 1.2e-1),
        ],
        order: ("order", 1.7),
    };
    convergence.rows(|spacing, seed| Ok(error(&swing(exact, period, spacing, seed)?, exact, period)))
}

/// The water at `time` s, started as an exact solution has it.
pub(super) fn swing(exact: Exact, time: f64, spacing: f64, seed: u64) -> Result<VoronoiFlood, ModelError> {
    swing_with(&settings(spacing, 0.0, all_sides(&Edge::Wall)), exact, time, seed)
}

/// The same with settings.
pub(super) fn swing_with(settings: &Settings, exact: Exact, time: f64, seed: u64) -> Result<VoronoiFlood, ModelError> {
    let terrain = bowl();
    let depth = |x: f64, y: f64| exact(x, y, 0.0).0 - terrain.height(x, y);
    let water = StartWater {
        filling: Filling::Depth(Box::new(depth)),
        polygon: None,
        velocity: Box::new(move |x, y| exact(x, y, 0.0).1),
    };
    run(settings, seed, &terrain, &[water], time)
}

/// mean |h - h_exact| / mean h_exact on a grid of 2 cm.
pub(super) fn error(flood: &VoronoiFlood, exact: Exact, time: f64) -> f64 {
    let terrain = bowl();
    let bounds = bounds();
    let cells = 200;
    let at = |k: usize| bounds.x_min + (bounds.x_max - bounds.x_min) * (k as f64 + 0.5) / cells as f64;
    let (mut wrong, mut right) = (0.0, 0.0);
    for (x, y) in (0..cells * cells).map(|k| (at(k % cells), at(k / cells))) {
        let depth = (exact(x, y, time).0 - terrain.height(x, y)).max(0.0);
        right += depth;
        wrong += (flood.sample(x, y).depth - depth).abs();
    }
    wrong / right
}
