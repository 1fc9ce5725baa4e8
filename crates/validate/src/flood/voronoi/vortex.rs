//! A vortex that a current carries along.

use super::super::{GRAVITY, order, rows};
use super::{all_sides, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Edge;
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub(in super::super) const VORTEX: Case = Case {
    name: "flood/voronoi/vortex",
    about: "A vortex of up to 1.1 m/s in water 2 m deep that a current of 3 m/s carries through a periodic box of 64 m three times, by scheme voronoi, \
            three seeds, spacings of 0.5, 1 and 2 m; exact: it stays as it is (g dh/dr = v2/r). A prototype with cells that stay comes to 0.20 in the \
            velocity at 1 m, with cells that move with the water to 0.05.",
    slow: true,
    reduced: 4.0,
    run: |_: &Options| rows(VORTEX.name, measure()),
};

/// Side of the periodic box, m.
const LENGTH: f64 = 64.0;

/// Depth far from the vortex, m.
const DEPTH: f64 = 2.0;

/// Velocity of the current, eastwards, m/s.
const CURRENT: f64 = 3.0;

/// Angular velocity in the middle of the vortex, 1/s, and the distance at which it is exp(-1/2) of that, m.
const ANGULAR: f64 = 0.3;
const RADIUS: f64 = 6.0;

/// Time in which the current passes the box three times, s.
pub(in crate::flood) const TIME: f64 = 3.0 * LENGTH / CURRENT;

/// Spacings from fine to wide, m.
pub(in crate::flood) const SPACINGS: [f64; 3] = [0.5, 1.0, 2.0];

/// Depth and velocity of a vortex whose middle is in the middle of the box, less the current: v = ANGULAR r exp(-r2 / (2 RADIUS2)), with the depth
/// for which its slope bears the centripetal acceleration, g dh/dr = v2/r (Holton 2004, "An Introduction to Dynamic Meteorology", section 3.2.4).
fn vortex([x, y]: [f64; 2]) -> (f64, [f64; 2]) {
    let to_middle = |at: f64| at - LENGTH * (at / LENGTH).floor() - 0.5 * LENGTH;
    let (x, y) = (to_middle(x), to_middle(y));
    let turn = ANGULAR * (-(x * x + y * y) / (2.0 * RADIUS * RADIUS)).exp();
    let dip = turn * turn * RADIUS * RADIUS / (2.0 * GRAVITY);
    (DEPTH - dip, [-turn * y, turn * x])
}

/// The vortex at the start, in the current.
pub(in crate::flood) fn start(spacing: f64, seed: u64) -> Result<VoronoiFlood, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: LENGTH };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |_, _| (0.0, [0.0; 2])));
    let water = StartWater {
        filling: Filling::Depth(Box::new(|x, y| vortex([x, y]).0)),
        polygon: None,
        velocity: Box::new(|x, y| {
            let [u, v] = vortex([x, y]).1;
            [CURRENT + u, v]
        }),
    };
    set_up(&settings(spacing, 0.0, all_sides(&Edge::Periodic)), seed, &terrain, &[water])
}

/// Errors of velocity and depth at the end: sum of area times |u - u_exact| over that of area times |u_exact - current|, and the same of the depth, over
/// that of the dip.
pub(in crate::flood) fn errors(flood: &VoronoiFlood) -> [f64; 2] {
    let [mut wrong, mut whole] = [[0.0; 2]; 2];
    for cell in flood.wet_cells() {
        let [x, y] = cell.centroid;
        let (depth, [u, v]) = vortex([x - CURRENT * flood.time(), y]);
        wrong[0] += cell.area * (cell.velocity[0] - CURRENT - u).hypot(cell.velocity[1] - v);
        whole[0] += cell.area * u.hypot(v);
        wrong[1] += cell.area * (cell.depth - depth).abs();
        whole[1] += cell.area * (DEPTH - depth);
    }
    [wrong[0] / whole[0], wrong[1] / whole[1]]
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut found = [[0.0; 2]; 3];
    for (found, spacing) in found.iter_mut().zip(SPACINGS) {
        *found = worst(|seed| {
            let mut flood = start(spacing, seed)?;
            flood.advance_to(TIME, &AtomicBool::new(false))?;
            Ok(errors(&flood))
        })?;
    }
    let of_velocity = [("velocity_error_50cm", 5.2e-2), ("velocity_error_1m", 2.2e-1), ("velocity_error_2m", 5.9e-1)];
    let of_depth = [("depth_error_50cm", 8.5e-2), ("depth_error_1m", 4e-1), ("depth_error_2m", 1.2)];
    let orders = [("velocity_order", 1.7), ("depth_order", 1.85)];
    let mut rows = Vec::new();
    for (quantity, (of_quantity, (measure, least))) in [of_velocity, of_depth].into_iter().zip(orders).enumerate() {
        let errors = found.map(|found| found[quantity]);
        let of_spacings = of_quantity.into_iter().zip(errors);
        rows.extend(of_spacings.map(|((name, bound), error)| Row::at_most(VORTEX.name, name, error, "", bound)));
        rows.push(Row::at_least(VORTEX.name, measure, order(errors[0], errors[2], 4.0), "", least));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The vortex solves the stationary shallow-water equations: div(h u) = 0 and (u . grad) u + g grad h = 0.
    #[test]
    fn the_vortex_is_stationary() {
        let e = 1e-4;
        let slope = |at: [f64; 2], axis: usize, value: &dyn Fn([f64; 2]) -> f64| {
            let shifted = |by: f64| std::array::from_fn(|k| at[k] + if k == axis { by } else { 0.0 });
            (value(shifted(e)) - value(shifted(-e))) / (2.0 * e)
        };
        for at in [[30.0, 35.0], [38.5, 31.0], [25.0, 24.0]] {
            let flow = |axis: usize| move |at: [f64; 2]| vortex(at).0 * vortex(at).1[axis];
            let gathered = slope(at, 0, &flow(0)) + slope(at, 1, &flow(1));
            assert!(gathered.abs() < 1e-8, "{gathered}");
            let [u, v] = vortex(at).1;
            for axis in 0..2 {
                let velocity = move |at: [f64; 2]| vortex(at).1[axis];
                let inertia = u * slope(at, 0, &velocity) + v * slope(at, 1, &velocity);
                let pushed = GRAVITY * slope(at, axis, &|at| vortex(at).0);
                assert!((inertia + pushed).abs() < 1e-7 && pushed.abs() > 1e-3, "{inertia} {pushed}");
            }
        }
    }
}
