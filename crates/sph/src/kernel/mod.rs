//! Smoothing kernels in two and three dimensions.
//!
//! Each stands in a file of its own with its WGSL beside it: its formula, normalisation, support and source. [`Kernel`] is the one
//! that a scene has chosen; the GPU gets the same one by [`Kernel::wgsl`].

mod cubic_spline;
mod mueller;
mod wendland_c2;

pub use cubic_spline::CubicSpline;
pub use mueller::Mueller;
pub use wendland_c2::WendlandC2;

use crate::{Lanes, Simd};
use corpuscle_scene::KernelName;

/// A smoothing kernel in `D` dimensions: what sums over neighbours weigh with. `r` is the distance of two particles, m.
///
/// A weight comes for one pair, and for [`LANES`](crate::LANES) pairs as a shape, which is to be multiplied by its factor: a sum over
/// shapes is multiplied once.
pub trait SmoothingKernel<const D: usize>: Copy + Send + Sync {
    /// Distance beyond which all is 0, m.
    fn support(&self) -> f64;

    /// Weight of densities, W, 1/m^D, from the square of the distance.
    fn value(&self, r_squared: f64) -> f64;

    /// -dW/dr over r of the weight of densities, 1/m^(D+2), from the square of the distance.
    fn fall_over_r(&self, r_squared: f64) -> f64;

    /// Weight of pressure, -dW/dr, 1/m^(D+1): times the unit vector from i to j it is the gradient with respect to the position of i.
    fn slope(&self, r: f64) -> f64;

    /// Weight of diffusion, 1/m^(D+2): the sum of V_j (A_j - A_i) times it is the Laplacian of A.
    fn laplacian(&self, r: f64) -> f64;

    /// [`SmoothingKernel::value`] over [`SmoothingKernel::value_factor`].
    fn value_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S>;

    /// Factor of the weight of densities.
    fn value_factor(&self) -> f64;

    /// [`SmoothingKernel::slope`] over [`SmoothingKernel::slope_factor`].
    fn slope_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S>;

    /// Some amounts times [`SmoothingKernel::slope_shape`].
    #[inline(always)]
    fn times_slope_shape<S: Simd>(&self, amount: Lanes<S>, r: Lanes<S>) -> Lanes<S> {
        amount * self.slope_shape(r)
    }

    /// Factor of the weight of pressure.
    fn slope_factor(&self) -> f64;

    /// [`SmoothingKernel::laplacian`] over [`SmoothingKernel::laplacian_factor`].
    fn laplacian_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S>;

    /// Factor of the weight of diffusion.
    fn laplacian_factor(&self) -> f64;

    /// Shapes as WGSL, of q = r/h: `value_shape(q_squared)`, `slope_shape(q)`, `laplacian_shape(q)`.
    fn wgsl(&self) -> &'static str;
}

/// Name of the piece that shaders import for [`Kernel::device_piece`].
pub const KERNEL_PIECE: &str = "smoothing_kernel";

/// Name and text of a piece that shaders import for the cubic spline, whichever kernel was chosen; that spline's own piece imports it too.
pub const CUBIC_SPLINE_SHAPE: (&str, &str) = ("cubic_spline_shape", include_str!("cubic_spline_shape.wgsl"));

/// The kernel that was chosen, of some support.
#[derive(Debug, Clone, Copy)]
pub enum Kernel<const D: usize> {
    /// That of Müller et al.
    Mueller(Mueller<D>),
    /// The cubic spline.
    CubicSpline(CubicSpline<D>),
    /// Wendland's C2.
    WendlandC2(WendlandC2<D>),
}

impl<const D: usize> Kernel<D> {
    /// The kernel of that name with support `h`, m.
    #[inline(always)]
    pub fn new(name: KernelName, h: f64) -> Self {
        match name {
            KernelName::Mueller => Self::Mueller(Mueller::new(h)),
            KernelName::CubicSpline => Self::CubicSpline(CubicSpline::new(0.5 * h)),
            KernelName::WendlandC2 => Self::WendlandC2(WendlandC2::new(h)),
        }
    }

    /// Factors at support 1, for value, slope and Laplacian: those of the shapes in WGSL. At support h they are these over h^D, h^(D+1) and h^(D+2).
    pub fn device_factors(name: KernelName) -> [f64; 3] {
        let kernel = Self::new(name, 1.0);
        [kernel.value_factor(), kernel.slope_factor(), kernel.laplacian_factor()]
    }

    /// The same as a shader's piece: its shapes, and their factors at support 1 as `VALUE_FACTOR`, `SLOPE_FACTOR` and `LAPLACIAN_FACTOR`. Beside it
    /// shaders need [`CUBIC_SPLINE_SHAPE`].
    pub fn device_piece(name: KernelName) -> String {
        let [value, slope, laplacian] = Self::device_factors(name);
        format!(
            "const VALUE_FACTOR = {value:?}f;\nconst SLOPE_FACTOR = {slope:?}f;\nconst LAPLACIAN_FACTOR = {laplacian:?}f;\n{}",
            Self::new(name, 1.0).wgsl()
        )
    }
}

/// Has the chosen one answer.
macro_rules! chosen {
    ($self:expr, $kernel:ident => $answer:expr) => {
        match $self {
            Kernel::Mueller($kernel) => $answer,
            Kernel::CubicSpline($kernel) => $answer,
            Kernel::WendlandC2($kernel) => $answer,
        }
    };
}

impl<const D: usize> SmoothingKernel<D> for Kernel<D> {
    #[inline(always)]
    fn support(&self) -> f64 {
        chosen!(self, kernel => kernel.support())
    }

    #[inline(always)]
    fn value(&self, r_squared: f64) -> f64 {
        chosen!(self, kernel => kernel.value(r_squared))
    }

    #[inline(always)]
    fn fall_over_r(&self, r_squared: f64) -> f64 {
        chosen!(self, kernel => kernel.fall_over_r(r_squared))
    }

    #[inline(always)]
    fn slope(&self, r: f64) -> f64 {
        chosen!(self, kernel => kernel.slope(r))
    }

    #[inline(always)]
    fn laplacian(&self, r: f64) -> f64 {
        chosen!(self, kernel => kernel.laplacian(r))
    }

    #[inline(always)]
    fn value_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S> {
        chosen!(self, kernel => kernel.value_shape(r_squared))
    }

    #[inline(always)]
    fn value_factor(&self) -> f64 {
        chosen!(self, kernel => kernel.value_factor())
    }

    #[inline(always)]
    fn slope_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        chosen!(self, kernel => kernel.slope_shape(r))
    }

    #[inline(always)]
    fn times_slope_shape<S: Simd>(&self, amount: Lanes<S>, r: Lanes<S>) -> Lanes<S> {
        chosen!(self, kernel => kernel.times_slope_shape(amount, r))
    }

    #[inline(always)]
    fn slope_factor(&self) -> f64 {
        chosen!(self, kernel => kernel.slope_factor())
    }

    #[inline(always)]
    fn laplacian_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        chosen!(self, kernel => kernel.laplacian_shape(r))
    }

    #[inline(always)]
    fn laplacian_factor(&self) -> f64 {
        chosen!(self, kernel => kernel.laplacian_factor())
    }

    fn wgsl(&self) -> &'static str {
        chosen!(self, kernel => kernel.wgsl())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Level, SimdBase, dispatch};
    use std::f64::consts::PI;

    /// Integral of f(r) over the circle or the ball of radius `support`, by the midpoint rule.
    fn over_all<const D: usize>(support: f64, f: impl Fn(f64) -> f64) -> f64 {
        let parts = 20_000;
        let dr = support / f64::from(parts);
        let round = |r: f64| if D == 2 { 2.0 * PI * r } else { 4.0 * PI * r * r };
        (0..parts).map(|part| (f64::from(part) + 0.5) * dr).map(|r| round(r) * f(r) * dr).sum()
    }

    fn is_normalised<const D: usize>(name: KernelName) {
        let kernel = Kernel::<D>::new(name, 1.3);
        let d = D as f64;
        assert!((over_all::<D>(1.3, |r| kernel.value(r * r)) - 1.0).abs() < 1e-6, "{name:?}");
        // By parts, the integral of a kernel is that of r/D |W'|.
        assert!((over_all::<D>(1.3, |r| r / d * kernel.slope(r)) - 1.0).abs() < 1e-6, "{name:?}");
        assert!((over_all::<D>(1.3, |r| r * r / d * kernel.fall_over_r(r * r)) - 1.0).abs() < 1e-6, "{name:?}");
        // The Laplacian of r^2/(2 D) is 1.
        assert!((over_all::<D>(1.3, |r| r * r / (2.0 * d) * kernel.laplacian(r)) - 1.0).abs() < 1e-6, "{name:?}");
    }

    #[test]
    fn weights_are_normalised() {
        for name in KernelName::ALL {
            is_normalised::<2>(name);
            is_normalised::<3>(name);
        }
    }

    fn falls_as_its_value<const D: usize>(name: KernelName) {
        let (kernel, e) = (Kernel::<D>::new(name, 0.7), 1e-6);
        for r in [0.05, 0.3, 0.6, 0.69, 0.71] {
            let value = |r: f64| kernel.value(r * r);
            let difference = (value(r - e) - value(r + e)) / (2.0 * e);
            let scale = kernel.value(0.0) / 0.7;
            assert!((r * kernel.fall_over_r(r * r) - difference).abs() < 1e-7 * scale, "{name:?} at {r}: {difference}");
        }
    }

    #[test]
    fn the_fall_of_the_value_is_its_derivative() {
        for name in KernelName::ALL {
            falls_as_its_value::<2>(name);
            falls_as_its_value::<3>(name);
        }
    }

    #[inline(always)]
    fn agree<const D: usize, S: Simd>(simd: S, name: KernelName) {
        let kernel = Kernel::<D>::new(name, 0.7);
        let close = |a: f64, b: f64, of: f64| assert!((a - b).abs() <= 1e-12 * of, "{name:?}: {a} and {b}");
        for r in [1e-9, 0.05, 0.3, 0.35, 0.69, 0.7, 0.71, 2.0, 1e150] {
            let at = Lanes::splat(simd, r);
            close(kernel.value_shape(at * at)[5] * kernel.value_factor(), kernel.value(r * r), kernel.value(0.0));
            close(kernel.slope_shape(at)[3] * kernel.slope_factor(), kernel.slope(r), kernel.slope(0.2));
            let laplacian = kernel.laplacian_shape(at)[0] * kernel.laplacian_factor();
            close(laplacian, kernel.laplacian(r), 1e5 * kernel.laplacian(0.1));
            if r >= 0.7 {
                assert!(kernel.value(r * r) == 0.0 && kernel.slope(r) == 0.0 && laplacian == 0.0, "{name:?}");
            }
        }
    }

    #[test]
    fn lanes_agree_with_one_pair() {
        for name in KernelName::ALL {
            dispatch!(Level::new(), simd => agree::<2, _>(simd, name));
            dispatch!(Level::new(), simd => agree::<3, _>(simd, name));
        }
    }
}
