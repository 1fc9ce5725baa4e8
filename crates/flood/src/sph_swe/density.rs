//! Density sums of scheme `sph-swe`, at each particle's own smoothing length.

use corpuscle_scene::KernelName;
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use corpuscle_sph::{Lanes, LanesExt, Neighbours, PairSum, Simd, SimdBase};

/// sum_j W(r_ij, h_i), the particle itself included, 1/m2: times the volume that all particles have, the depth.
pub(super) struct NumberDensities<'a> {
    /// The kernel.
    pub kernel: KernelName,
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
}

/// sum_j V_j W(r_ij, h_i), the particle itself included, m: the depth, for particles of unequal volumes.
pub(super) struct Depths<'a> {
    /// The kernel.
    pub kernel: KernelName,
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
    /// Volumes, m3.
    pub volumes: &'a [f64],
}

impl PairSum<f64> for NumberDensities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let kernel = Kernel::<2>::new(self.kernel, self.reach_squared[particle].sqrt());
        let mut sum = Lanes::splat(simd, 0.0);
        for (_, r) in found.lanes(simd) {
            sum += kernel.value_shape(r * r);
        }
        kernel.value_factor() * (at_centre(&kernel) + sum.sum())
    }
}

impl PairSum<f64> for Depths<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let kernel = Kernel::<2>::new(self.kernel, self.reach_squared[particle].sqrt());
        let mut sum = Lanes::splat(simd, 0.0);
        for (index, r) in found.lanes(simd) {
            sum += kernel.value_shape(r * r) * Lanes::from_fn(simd, |lane| self.volumes[index[lane] as usize]);
        }
        kernel.value_factor() * (self.volumes[particle] * at_centre(&kernel) + sum.sum())
    }
}

/// The kernel's shape at its centre.
#[inline(always)]
fn at_centre(kernel: &Kernel<2>) -> f64 {
    kernel.value(0.0) / kernel.value_factor()
}
