//! First-order exact slopes of the surface and the velocity.

use super::{Column, Slopes};
use crate::arrangement::Arrangement;
use crate::obstacles::Obstacles;
use corpuscle_sph::kernel::cubic_spline;
use corpuscle_sph::{BLOCK, LANES, Lanes, LanesExt, Level, Neighbours, Simd, SimdBase, dispatch, gather};
use rayon::prelude::*;

/// Difference of surface over depth, or of velocity over wave speed, at which water counts as moving.
const REST: f64 = 0.05;

/// Difference of surface over that of the ground at which water counts as tilted: below it, water lies as a lake does.
const TILT: f64 = 0.6;

/// Trace of the moment matrix (2 amid water, about 1 at its rim) from which a particle is in company.
const COMPANY: f64 = 0.4;

/// Finds the slopes of all particles.
pub(super) fn find(
    gravity: f64,
    arrangement: &Arrangement,
    columns: &[Column],
    obstacles: &Obstacles,
    slopes: &mut [Slopes],
) {
    slopes.par_chunks_mut(BLOCK).enumerate().for_each(|(block, slopes)| {
        dispatch!(Level::new(), simd => find_block(simd, gravity, arrangement, columns, obstacles, block * BLOCK, slopes));
    });
}

#[inline(always)]
fn find_block<S: Simd>(
    simd: S,
    gravity: f64,
    arrangement: &Arrangement,
    columns: &[Column],
    obstacles: &Obstacles,
    first: usize,
    slopes: &mut [Slopes],
) {
    for (k, slopes) in slopes.iter_mut().enumerate() {
        of_one(simd, gravity, columns, obstacles, arrangement.lists.of(first + k), first + k, slopes);
    }
}

#[inline(always)]
fn of_one<S: Simd>(
    simd: S,
    gravity: f64,
    columns: &[Column],
    obstacles: &Obstacles,
    list: Neighbours,
    i: usize,
    slopes: &mut Slopes,
) {
    let rows: &[[f64; LANES]] = bytemuck::must_cast_slice(columns);
    let own = columns[i];
    let inverse_h = Lanes::splat(simd, own.inverse_h);
    let end = Lanes::splat(simd, 2.0 / own.inverse_h);
    let zero = Lanes::splat(simd, 0.0);
    let [mut xx, mut xy, mut yy] = [zero; 3];
    let [mut surface_x, mut surface_y, mut u_x, mut u_y, mut v_x, mut v_y] = [zero; 6];
    let [mut surface_step, mut velocity_step, mut ground_step] = [zero; 3];
    for (index, r) in list.lanes(simd) {
        let [x, y, u, v, surface, depth, area, _] = gather(simd, rows, index);
        let ex = x - own.x;
        let ey = y - own.y;
        // The gradient of W at i is slope / r * (ex, ey); slope is 0 beyond the support.
        let weight = cubic_spline::slope(r, inverse_h) / r * area;
        let (weight_x, weight_y) = (weight * ex, weight * ey);
        xx += weight_x * ex;
        xy += weight_x * ey;
        yy += weight_y * ey;
        let ds = surface - own.surface;
        let du = u - own.u;
        let dv = v - own.v;
        surface_x += weight_x * ds;
        surface_y += weight_y * ds;
        u_x += weight_x * du;
        u_y += weight_y * du;
        v_x += weight_x * dv;
        v_y += weight_y * dv;
        surface_step = surface_step.max(r.select_below(end, ds.abs(), zero));
        let dz = ds - (depth - own.depth);
        ground_step = ground_step.max(r.select_below(end, dz.abs(), zero));
        velocity_step = velocity_step.max(r.select_below(end, du * du + dv * dv, zero));
    }
    let moment = [xx.sum(), xy.sum(), yy.sum()];
    let b = renormalisation(moment);
    let walls = of_walls(&own, obstacles);
    let all = [0, 1, 2].map(|k| moment[k] + walls.moment[k]);
    slopes.alone = (1.0 - (all[0] + all[2]) / COMPANY).max(0.0);
    slopes.renormalisation = if walls.moment == [0.0; 3] { b } else { renormalisation(all) };
    let turned = |x: f64, y: f64| [b[0] * x + b[1] * y, b[1] * x + b[2] * y];
    slopes.surface = turned(surface_x.sum(), surface_y.sum());
    slopes.u = turned(u_x.sum(), u_y.sum());
    slopes.v = turned(v_x.sum(), v_y.sum());
    let wave = (gravity * own.depth).sqrt();
    slopes.wave_speed = wave;
    let unrest =
        (surface_step.largest() / own.depth).max(velocity_step.largest().sqrt().max(walls.velocity_step) / wave) / REST;
    let tilt = surface_step.largest() / (TILT * ground_step.largest()).max(1e-12 * own.depth);
    slopes.rest = (-(unrest.min(tilt)).powi(2)).exp();
}

/// What walls near a particle add.
#[derive(Debug, Default)]
struct OfWalls {
    /// To the moment matrix.
    moment: [f64; 3],
    /// Largest difference between the velocity and its mirror image beyond a wall, m/s.
    velocity_step: f64,
}

/// Walls take part in the areas that the particle shares, but not in its slopes: what water does along a wall goes on there.
fn of_walls(own: &Column, obstacles: &Obstacles) -> OfWalls {
    let mut sum = OfWalls::default();
    let h = 1.0 / own.inverse_h;
    obstacles.each([own.x, own.y], 2.0 * h, |site, r, [ex, ey]| {
        let weight = site.area * cubic_spline::slope_of_one(r, h) / r.max(1e-9 * h);
        sum.moment =
            [sum.moment[0] + weight * ex * ex, sum.moment[1] + weight * ex * ey, sum.moment[2] + weight * ey * ey];
        let across = own.u * site.normal[0] + own.v * site.normal[1];
        sum.velocity_step = sum.velocity_step.max(2.0 * across.abs());
    });
    sum
}

/// Inverse of the moment matrix (xx, xy, yy), made invertible where the neighbours stand in a line or are missing.
fn renormalisation([mut xx, xy, mut yy]: [f64; 3]) -> [f64; 3] {
    let trace = xx + yy;
    if xx * yy - xy * xy <= 0.02 * trace * trace || trace <= 0.2 {
        let more = 0.1 * trace.max(0.1);
        xx += more;
        yy += more;
    }
    let inverse = 1.0 / (xx * yy - xy * xy);
    [yy * inverse, -xy * inverse, xx * inverse]
}
