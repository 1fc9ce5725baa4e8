//! Density sums of scheme `sph-swe`, at each particle's own smoothing length.

use corpuscle_sph::kernel::poly6;
use corpuscle_sph::{Lanes, LanesExt, Neighbours, PairSum, Simd, SimdBase};

/// sum_j W_poly6(r_ij, h_i), the particle itself included, 1/m2: times the volume that all particles have, the depth.
pub(super) struct NumberDensities<'a> {
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
}

/// sum_j V_j W_poly6(r_ij, h_i), the particle itself included, m: the depth, for particles of unequal volumes.
pub(super) struct Depths<'a> {
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
    /// Volumes, m3.
    pub volumes: &'a [f64],
}

impl PairSum<f64> for NumberDensities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let h_squared = self.reach_squared[particle];
        let mut sum = Lanes::splat(simd, 0.0);
        for (_, r) in found.lanes(simd) {
            sum += over_the_centre(r, h_squared);
        }
        poly6(0.0, h_squared.sqrt()) * (1.0 + sum.sum())
    }
}

impl PairSum<f64> for Depths<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let h_squared = self.reach_squared[particle];
        let mut sum = Lanes::splat(simd, 0.0);
        for (index, r) in found.lanes(simd) {
            sum += over_the_centre(r, h_squared) * Lanes::from_fn(simd, |lane| self.volumes[index[lane]]);
        }
        poly6(0.0, h_squared.sqrt()) * (self.volumes[particle] + sum.sum())
    }
}

/// W_poly6(r, h) over W_poly6(0, h).
#[inline(always)]
fn over_the_centre<S: Simd>(r: Lanes<S>, h_squared: f64) -> Lanes<S> {
    let inside = (1.0 - r * r * (1.0 / h_squared)).positive();
    inside * inside * inside
}
