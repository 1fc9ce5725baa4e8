//! What air does to air: pressure, viscosity, diffusion of heat and of vapour, in one pass over pairs.
//!
//! Every pair acts on both by the same number with opposite signs, so momentum, heat and vapour are conserved to rounding.

use super::{Arrangement, Properties, Scale};
use crate::normalisation::{self, Tensor};
use bytemuck::{Pod, Zeroable};
use corpuscle_sph::kernel::SmoothingKernel;
use corpuscle_sph::{BLOCK, LANES, Lanes, LanesExt, Level, Simd, SimdBase, SimdFloat, dispatch, gather};
use rayon::prelude::*;

/// What the pass reads of an index: two rows of numbers to gather.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct Column {
    /// Position, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Pressure over the square of the density, Pa m6/kg2.
    pub pressure: f64,
    /// Temperature, K.
    pub temperature: f64,
    /// Part of the mass that is vapour (or relative humidity).
    pub vapour: f64,
    /// By which the Laplacian is exact where particles stand as they do.
    pub tensor: Tensor,
    /// Kirchhoff's transform of the temperature, K: see [`Properties::transformed`].
    pub transformed: f64,
}

/// What neighbours do to a particle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rates {
    /// By pressure and viscosity, m/s2.
    pub acceleration: [f64; 3],
    /// Gradient of how crowded it is, 1/m, towards where it is not: -2 sum V grad W, 0 on a lattice.
    pub spread: [f64; 3],
    /// K/s.
    pub warming: f64,
    /// 1/s.
    pub moistening: f64,
    /// Sum of the weights of the Laplacian, 1/m2: a diffusivity times it is the particle's entry in the diagonal of the
    /// diffusion matrix.
    pub weights: f64,
}

/// Neighbours that approach each other are held up by the pressure of their impact, rho min(3 a, c) a for an approach at a
/// (Zhang, Hu & Adams 2017: a Riemann solver of low dissipation). It is of second order in how velocities differ, so slow and
/// it does not affect smooth flow; without it the noise of air that is fast for its particles' distance grows until it bursts.
pub(crate) const DAMPING: f64 = 3.0;

/// Sums over all pairs of air. Viscosity and diffusivity of a pair are those at the mean of its temperatures.
pub fn sum(arrangement: &Arrangement, columns: &[Column], scale: &Scale, air: &Properties, rates: &mut [Rates]) {
    rates.par_chunks_mut(BLOCK).enumerate().for_each(|(block, rates)| {
        dispatch!(Level::new(), simd => sum_block(simd, arrangement, columns, scale, air, block * BLOCK, rates));
    });
}

#[inline(always)]
fn sum_block<S: Simd>(
    simd: S,
    arrangement: &Arrangement,
    columns: &[Column],
    scale: &Scale,
    air: &Properties,
    first: usize,
    rates: &mut [Rates],
) {
    for (k, rates) in rates.iter_mut().enumerate() {
        let index = arrangement.index_of[first + k] as usize;
        *rates = of_one(simd, columns, arrangement.lists.numbers_of(index), index, scale, air);
    }
}

#[inline(always)]
fn of_one<S: Simd>(
    simd: S,
    columns: &[Column],
    list: &[u32],
    own_index: usize,
    scale: &Scale,
    air: &Properties,
) -> Rates {
    let rows: &[[f64; LANES]] = bytemuck::must_cast_slice(columns);
    let own = &columns[own_index];
    let [a, b, c, d, e, f] = own.tensor;
    let Scale { volume, kernel, to_gradient, moment, .. } = *scale;
    // a = sum m (p_i/rho_i^2 + p_j/rho_j^2) |W'| (r_i - r_j)/r (Monaghan 1992, equation 3.1).
    let of_pressure = air.density * volume * to_gradient * kernel.slope_factor();
    let of_spread = 2.0 * volume * to_gradient * kernel.slope_factor();
    // Both sides' tensors, halved.
    let of_laplacian = 0.5 * volume * kernel.laplacian_factor() / moment;
    // Distances below this are those of an index to itself.
    let nothing = Lanes::splat(simd, 1e-18 * kernel.support() * kernel.support());
    let zero = Lanes::splat(simd, 0.0);
    let [limit, sound, per_density] =
        [DAMPING, air.sound_speed, 1.0 / air.density].map(|value| Lanes::splat(simd, value));
    let [viscosity_per_kelvin, diffusivity_per_kelvin] =
        [air.coefficients.viscosity, air.coefficients.vapour_diffusivity];
    let own_above = 0.5 * own.temperature - air.reference_temperature;
    let [mut ax, mut ay, mut az, mut shear_x, mut shear_y, mut shear_z] = [zero; 6];
    let [mut spread_x, mut spread_y, mut spread_z] = [zero; 3];
    let [mut warming, mut moistening, mut weights] = [zero; 3];
    for index in list.chunks_exact(LANES) {
        let first: [usize; LANES] = std::array::from_fn(|lane| 2 * index[lane] as usize);
        let [x, y, z, u, v, w, pressure, temperature] = gather(simd, rows, first);
        let [vapour, xx, yy, zz, xy, xz, yz, transformed] = gather(simd, rows, first.map(|row| row + 1));
        let (dx, dy, dz) = (own.position[0] - x, own.position[1] - y, own.position[2] - z);
        let r_squared = dx * dx + dy * dy + dz * dz;
        let r = r_squared.max(nothing).sqrt();
        let inverse = 1.0 / r;
        let slope = kernel.slope_shape(r) * inverse;
        let closing = (own.velocity[0] - u) * dx + (own.velocity[1] - v) * dy + (own.velocity[2] - w) * dz;
        let approach = ((zero - closing) * inverse).max(zero);
        let damping = (approach * limit).min(sound) * approach * per_density;
        let push = (pressure + own.pressure + damping) * slope * of_pressure;
        ax += push * dx;
        ay += push * dy;
        az += push * dz;
        spread_x += slope * dx;
        spread_y += slope * dy;
        spread_z += slope * dz;
        // Of an index to itself, which fills lists up, it is 0.
        let both = [xx + a, yy + b, zz + c, xy + d, xz + e, yz + f];
        let weight =
            kernel.laplacian_shape(r) * (normalisation::along(both, [dx, dy, dz]) * inverse * inverse) * of_laplacian;
        // Both sides' temperature, from the reference.
        let above = temperature * 0.5 + own_above;
        let viscous = weight * (above * viscosity_per_kelvin + 1.0);
        shear_x += viscous * (u - own.velocity[0]);
        shear_y += viscous * (v - own.velocity[1]);
        shear_z += viscous * (w - own.velocity[2]);
        warming += weight * (transformed - own.transformed);
        moistening += weight * (above * diffusivity_per_kelvin + 1.0) * (vapour - own.vapour);
        weights += weight;
    }
    let acceleration = [(ax, shear_x), (ay, shear_y), (az, shear_z)];
    Rates {
        acceleration: acceleration.map(|(push, shear)| push.sum() + air.viscosity * shear.sum()),
        spread: [spread_x, spread_y, spread_z].map(|along| of_spread * along.sum()),
        warming: air.heat_diffusivity() * warming.sum(),
        moistening: air.vapour_diffusivity * moistening.sum(),
        weights: weights.sum(),
    }
}
