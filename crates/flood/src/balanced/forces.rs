//! Pair forces: a Riemann problem across the area that two particles share.

use super::{Column, Parameters, Slopes};
use crate::arrangement::Arrangement;
use corpuscle_sph::kernel::cubic_spline;
use corpuscle_sph::{BLOCK, LANES, Lanes, LanesExt, Level, Neighbours, Simd, SimdBase, dispatch, gather};
use rayon::prelude::*;

/// What acts on a particle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Force {
    /// Acceleration, m/s2.
    pub acceleration: [f64; 2],
    /// Force of the ground and of what is beyond the edges, over the density of water, m4/s2: what is not exchanged with
    /// other particles.
    pub external: [f64; 2],
}

/// The depth in which two particles push each other, at most, over the smaller of theirs.
pub(super) const SHARED: f64 = 3.0;

/// Finds the forces on all particles.
pub(super) fn find(
    parameters: &Parameters,
    arrangement: &Arrangement,
    columns: &[Column],
    slopes: &[Slopes],
    forces: &mut [Force],
) {
    forces.par_chunks_mut(BLOCK).enumerate().for_each(|(block, forces)| {
        dispatch!(Level::new(), simd => find_block(simd, parameters, arrangement, columns, slopes, block * BLOCK, forces));
    });
}

#[inline(always)]
fn find_block<S: Simd>(
    simd: S,
    parameters: &Parameters,
    arrangement: &Arrangement,
    columns: &[Column],
    slopes: &[Slopes],
    first: usize,
    forces: &mut [Force],
) {
    for (k, force) in forces.iter_mut().enumerate() {
        *force = on_one(simd, parameters, columns, slopes, arrangement.lists.of(first + k), first + k);
    }
}

/// Monotonised central limiter (van Leer 1977) of the two one-sided differences `a` and `b`.
#[inline(always)]
fn limited<S: Simd>(a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    let zero = a * 0.0;
    let magnitude = ((a.abs()).min(b.abs()) * 2.0).min((a + b).abs() * 0.5);
    let signed = a.select_below(zero, -magnitude, magnitude);
    (a * b).select_below(zero + f64::MIN_POSITIVE, zero, signed)
}

#[inline(always)]
fn on_one<S: Simd>(
    simd: S,
    parameters: &Parameters,
    columns: &[Column],
    slopes: &[Slopes],
    list: Neighbours,
    i: usize,
) -> Force {
    let &Parameters { gravity, viscosity, .. } = parameters;
    let column_rows: &[[f64; LANES]] = bytemuck::must_cast_slice(columns);
    let slope_rows: &[[f64; LANES]] = bytemuck::must_cast_slice(slopes);
    let own = columns[i];
    let sloped = slopes[i];
    let inverse_h = Lanes::splat(simd, own.inverse_h);
    let ground = own.surface - own.depth;
    let [bxx, bxy, byy] = sloped.renormalisation;
    let own_pressure = 0.5 * gravity * own.depth * own.depth * (1.0 - sloped.rest);
    let [mut fx, mut fy, mut external_x, mut external_y] = [Lanes::splat(simd, 0.0); 4];
    for (index, r) in list.lanes(simd) {
        let [x, y, u, v, surface, depth, area, near_inverse_h] = gather(simd, column_rows, index);
        let [near_bxx, near_bxy, near_byy, surface_x, surface_y, ground_x, ground_y, outside] =
            gather(simd, slope_rows, index.map(|near| 2 * near));
        let [u_x, u_y, v_x, v_y, wave_speed, ..] = gather(simd, slope_rows, index.map(|near| 2 * near + 1));

        let ex = x - own.x;
        let ey = y - own.y;
        let inverse_r = 1.0 / r;

        // Pair area A = V_i V_j [B_i grad W(h_i) + B_j grad W(h_j)], antisymmetric in i and j.
        let own_slope = cubic_spline::slope(r, inverse_h);
        let near_slope = cubic_spline::slope(r, near_inverse_h);
        let xx = own_slope * bxx + near_slope * near_bxx;
        let xy = own_slope * bxy + near_slope * near_bxy;
        let yy = own_slope * byy + near_slope * near_byy;
        let areas = area * own.area * inverse_r;
        let area_x = (xx * ex + xy * ey) * areas;
        let area_y = (xy * ex + yy * ey) * areas;

        // Reconstruction to the middle, surface and velocity along the pair (positive from i to j).
        let surface_step = surface - own.surface;
        let along = |x: Lanes<S>, y: Lanes<S>| x * ex + y * ey;
        let own_change = ex * sloped.surface[0] + ey * sloped.surface[1];
        let near_change = along(surface_x, surface_y);
        let surface_i = limited(own_change * 2.0 - surface_step, surface_step) * 0.5 + own.surface;
        let surface_j = surface - limited(near_change * 2.0 - surface_step, surface_step) * 0.5;

        let w_i = (ex * own.u + ey * own.v) * inverse_r;
        let w_j = (ex * u + ey * v) * inverse_r;
        let w_step = w_j - w_i;
        let own_change = along(ex * sloped.u[0] + ey * sloped.u[1], ex * sloped.v[0] + ey * sloped.v[1]) * inverse_r;
        let near_change = along(along(u_x, u_y), along(v_x, v_y)) * inverse_r;
        let w_i = w_i + limited(own_change * 2.0 - w_step, w_step) * 0.5;
        let w_j = w_j - limited(near_change * 2.0 - w_step, w_step) * 0.5;

        // Ground in the middle from heights and slopes at both ends (cubic Hermite); symmetric in i and j.
        let bend = (sloped.ground[0] - ground_x) * ex + (sloped.ground[1] - ground_y) * ey;
        let middle = ((surface - depth) + ground) * 0.5 + bend * 0.125;
        // Thin water on a slope must not feel the whole depth of its deep neighbour: that would shake it to pieces.
        let middle = middle.max(own.surface - SHARED * own.depth).max(surface - depth * SHARED);

        // Hydrostatic reconstruction (Audusse et al. 2004, eq. 2.9) and the Riemann problem in Lagrangian form, acoustic,
        // with the wave speeds of the two columns.
        let depth_i = (surface_i - middle).max(1e-6 * own.depth);
        let depth_j = (surface_j - middle).max(depth * 1e-6);
        let pressure_i = depth_i * depth_i * (0.5 * gravity);
        let pressure_j = depth_j * depth_j * (0.5 * gravity);
        let impedance_i = depth_i * sloped.wave_speed;
        let impedance_j = depth_j * wave_speed;
        let inverse_sum = 1.0 / (impedance_i + impedance_j);
        let both = impedance_i * impedance_j * inverse_sum;
        let pressure =
            ((impedance_j * pressure_i + impedance_i * pressure_j) * inverse_sum + both * (w_i - w_j)).positive();

        // At rest the own column's pressure against the middle cancels it exactly; in motion the symmetric form acts.
        let own_depth = (own.surface - middle).positive();
        let ground_push = own_pressure - (own_depth * own_depth) * (0.5 * gravity);
        fx += area_x * (pressure + ground_push);
        fy += area_y * (pressure + ground_push);
        // Artificial viscosity at signal speed (after Monaghan 1997, J. Comput. Phys. 136, 298), by the whole difference in
        // velocity: the reconstruction takes the noise of disordered particles for slopes, and rough fast water never calms.
        let drag = ((area_x * ex + area_y * ey) * inverse_r).positive() * both * viscosity;
        let drag_x = drag * (own.u - u);
        let drag_y = drag * (own.v - v);
        fx += drag_x;
        fy += drag_y;
        let external_push = pressure * outside + ground_push;
        external_x += area_x * external_push + drag_x * outside;
        external_y += area_y * external_push + drag_y * outside;
    }
    // Ground pushes by way of pairs; a particle without any slides down its slope as any body does.
    let volume = own.depth * own.area;
    let slide = sloped.ground.map(|slope| -gravity * slope * sloped.alone);
    Force {
        acceleration: [slide[0] - fx.sum() / volume, slide[1] - fy.sum() / volume],
        external: [slide[0] * volume - external_x.sum(), slide[1] * volume - external_y.sum()],
    }
}
