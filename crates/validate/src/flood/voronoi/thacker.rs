//! Water swinging in a paraboloid (Thacker 1981).

use super::super::{GRAVITY, rows};
use super::{Convergence, all_sides, run, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood};
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in super::super) const PLANAR: Case = Case {
    name: "flood/voronoi/thacker-planar",
    about: "A plane surface going round in a paraboloid after one period (Thacker 1981; parameters of SWASHES 1.05: h0 0.1 m, a 1 m, eta \
            0.5 m) by scheme voronoi, three seeds, spacings of 2, 4 and 8 cm. Peer: a prototype of the scheme 6.0e-3 at 2 cm.",
    slow: true,
    reduced: 4.0,
    run: planar,
};

pub(in super::super) const RADIAL: Case = Case {
    name: "flood/voronoi/thacker-radial",
    about: "A radially symmetric wave in a paraboloid after one period (Thacker 1981; parameters of SWASHES 1.05: h0 0.1 m, a 1 m, r0 0.8 m) \
            by scheme voronoi, three seeds, spacings of 2, 4 and 8 cm.",
    slow: true,
    reduced: 2.0,
    run: radial,
};

/// Depth of the paraboloid's middle below its rim, m, and radius of the rim, m.
const H0: f64 = 0.1;
const A: f64 = 1.0;

pub(super) fn bounds() -> Bounds {
    Bounds { x_min: -2.0, x_max: 2.0, y_min: -2.0, y_max: 2.0 }
}

pub(super) fn bowl() -> Arc<Terrain> {
    Arc::new(Terrain::analytic(bounds(), 0.02, |x, y| {
        (H0 * ((x * x + y * y) / (A * A) - 1.0), [x, y].map(|x| 2.0 * H0 * x / (A * A)))
    }))
}

/// Height of the surface and velocity at a position and a time.
pub(super) type Exact = fn(x: f64, y: f64, t: f64) -> (f64, [f64; 2]);

pub(super) fn omega() -> f64 {
    (8.0 * GRAVITY * H0).sqrt() / A
}

/// Thacker's curved surface, with A = (a^2 - r0^2)/(a^2 + r0^2).
pub(super) fn curved(x: f64, y: f64, t: f64) -> (f64, [f64; 2]) {
    let r0 = 0.8;
    let amplitude = (A * A - r0 * r0) / (A * A + r0 * r0);
    let root = (1.0 - amplitude * amplitude).sqrt();
    let swing = 1.0 - amplitude * (omega() * t).cos();
    let r_squared = x * x + y * y;
    let surface =
        H0 * (root / swing - 1.0 - r_squared / (A * A) * ((1.0 - amplitude * amplitude) / (swing * swing) - 1.0));
    let rate = 0.5 * omega() * amplitude * (omega() * t).sin() / swing;
    (surface, [rate * x, rate * y])
}

/// Thacker's plane surface; its frequency is half the curved one's for the same bowl, squared.
pub(super) fn plane(x: f64, y: f64, t: f64) -> (f64, [f64; 2]) {
    let eta = 0.5;
    let omega = (2.0 * GRAVITY * H0).sqrt() / A;
    let (sin, cos) = (omega * t).sin_cos();
    let surface = eta * H0 / (A * A) * (2.0 * x * cos + 2.0 * y * sin - eta);
    (surface, [-eta * omega * sin, eta * omega * cos])
}

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
pub(super) fn swing_with(settings: &Flood, exact: Exact, time: f64, seed: u64) -> Result<VoronoiFlood, ModelError> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Both solutions must satisfy dh/dt + div(h u) = 0 where they are wet.
    #[test]
    fn exact_solutions_conserve_water() {
        let e = 1e-5;
        for exact in [curved as Exact, plane] {
            for (x, y, t) in [(0.2, 0.1, 0.3), (-0.1, 0.2, 1.1), (0.1, -0.2, 2.0)] {
                let depth = |x: f64, y: f64, t: f64| exact(x, y, t).0 - H0 * (x * x + y * y - 1.0);
                assert!(depth(x, y, t) > 0.0);
                let flux = |x: f64, y: f64, axis: usize| depth(x, y, t) * exact(x, y, t).1[axis];
                let rate = (depth(x, y, t + e) - depth(x, y, t - e)) / (2.0 * e);
                let out = (flux(x + e, y, 0) - flux(x - e, y, 0) + flux(x, y + e, 1) - flux(x, y - e, 1)) / (2.0 * e);
                assert!((rate + out).abs() < 1e-6, "{rate} {out}");
            }
        }
    }
}
