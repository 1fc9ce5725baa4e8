//! Smoothing kernels in three dimensions, of one smoothing length (Mueller, Charypar & Gross 2003).

use crate::{Lanes, LanesExt, Simd};
use std::f64::consts::PI;

/// The three kernels with support `h`; `r` is the distance of two particles. Each comes for one pair and for lanes.
///
/// - poly6, 315/(64 pi h^9) (h^2 - r^2)^3, 1/m3: flat at the centre, so it is used for density only;
/// - spiky (Desbrun & Gascuel 1996), 15/(pi h^6) (h - r)^3: its slope does not vanish at the centre, so it keeps close
///   particles apart;
/// - viscosity, whose Laplacian is 45/(pi h^6) (h - r): positive everywhere, so diffusion never runs backwards.
#[derive(Debug, Clone, Copy)]
pub struct Kernels {
    h: f64,
    h_squared: f64,
    of_poly6: f64,
    of_spiky: f64,
}

impl Kernels {
    /// Kernels of support `h`, m.
    pub fn new(h: f64) -> Self {
        let of_poly6 = 315.0 / (64.0 * PI * h.powi(9));
        Self { h, h_squared: h * h, of_poly6, of_spiky: 45.0 / (PI * h.powi(6)) }
    }

    /// Support, m: beyond it all is 0.
    pub fn support(&self) -> f64 {
        self.h
    }

    /// Poly6, 1/m3, from the square of the distance.
    #[inline(always)]
    pub fn poly6(&self, r_squared: f64) -> f64 {
        let inside = (self.h_squared - r_squared).max(0.0);
        self.of_poly6 * inside * inside * inside
    }

    /// Magnitude of the gradient of the spiky kernel, 45/(pi h^6) (h - r)^2, 1/m4.
    #[inline(always)]
    pub fn spiky_slope(&self, r: f64) -> f64 {
        let inside = (self.h - r).max(0.0);
        self.of_spiky * inside * inside
    }

    /// Laplacian of the viscosity kernel, 1/m5.
    #[inline(always)]
    pub fn viscosity_laplacian(&self, r: f64) -> f64 {
        self.of_spiky * (self.h - r).max(0.0)
    }

    /// [`Kernels::poly6`] over [`Kernels::poly6`]'s factor, m6: for sums that are multiplied by
    /// [`Kernels::poly6_factor`] once.
    #[inline(always)]
    pub fn poly6_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S> {
        let inside = (self.h_squared - r_squared).positive();
        inside * inside * inside
    }

    /// Factor of poly6, 315/(64 pi h^9), 1/m9.
    pub fn poly6_factor(&self) -> f64 {
        self.of_poly6
    }

    /// (h - r) where it is positive, m: the Laplacian of the viscosity kernel over [`Kernels::spiky_factor`], and the root
    /// of the spiky kernel's slope over it.
    #[inline(always)]
    pub fn inside<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        (self.h - r).positive()
    }

    /// Common factor of the spiky slope and the viscosity Laplacian, 45/(pi h^6), 1/m6.
    pub fn spiky_factor(&self) -> f64 {
        self.of_spiky
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Level, SimdBase, dispatch};

    /// Integral of f(r) over the ball of radius h, by the midpoint rule.
    fn over_the_ball(h: f64, f: impl Fn(f64) -> f64) -> f64 {
        let parts = 20_000;
        let dr = h / f64::from(parts);
        (0..parts).map(|part| (f64::from(part) + 0.5) * dr).map(|r| 4.0 * PI * r * r * f(r) * dr).sum()
    }

    #[test]
    fn kernels_integrate_to_one() {
        let kernels = Kernels::new(1.3);
        assert!((over_the_ball(1.3, |r| kernels.poly6(r * r)) - 1.0).abs() < 1e-6);
        // By parts, the integral of a kernel is that of r/3 |W'|.
        assert!((over_the_ball(1.3, |r| r / 3.0 * kernels.spiky_slope(r)) - 1.0).abs() < 1e-6);
        // By Green's second identity with r^2/6, whose Laplacian is 1.
        assert!((over_the_ball(1.3, |r| r * r / 6.0 * kernels.viscosity_laplacian(r)) - 1.0).abs() < 1e-6);
    }

    #[inline(always)]
    fn agree<S: Simd>(simd: S) {
        let kernels = Kernels::new(0.7);
        for r in [0.0, 0.3, 0.69, 0.71, 2.0] {
            let at = Lanes::splat(simd, r);
            let inside = kernels.inside(at)[3];
            assert!((kernels.poly6_shape(at * at)[5] * kernels.poly6_factor() - kernels.poly6(r * r)).abs() < 1e-12);
            assert!((inside * inside * kernels.spiky_factor() - kernels.spiky_slope(r)).abs() < 1e-12);
            assert!((inside * kernels.spiky_factor() - kernels.viscosity_laplacian(r)).abs() < 1e-12);
        }
    }

    #[test]
    fn lanes_agree_with_one_pair() {
        dispatch!(Level::new(), simd => agree(simd));
    }
}
