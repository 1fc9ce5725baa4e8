use super::SmoothingKernel;
use crate::{Lanes, LanesExt, Simd, SimdFloat};
use std::f64::consts::PI;

/// The C2 kernel of Wendland 1995, support h: (1 - q)^4 (1 + 4 q), q = r/h, times 7/(pi h^2) in the plane, 21/(2 pi h^3) in space (Dehnen & Aly 2012,
/// table 1). Particles never pair, with however many neighbours.
///
/// The Laplacian is that of Brookshaw 1985, 2 |W'|/r.
#[derive(Debug, Clone, Copy)]
pub struct WendlandC2<const D: usize> {
    h: f64,
    per_h: f64,
    /// Of (1 - q)^4 (1 + 4 q), 1/m^D.
    of_value: f64,
}

impl<const D: usize> WendlandC2<D> {
    /// The kernel of support `h`, m.
    #[inline(always)]
    pub fn new(h: f64) -> Self {
        const { assert!(D == 2 || D == 3) };
        let at_one = if D == 2 { 7.0 / PI } else { 10.5 / PI };
        let per_h = 1.0 / h;
        Self { h, per_h, of_value: at_one * per_h.powi(D as i32) }
    }

    /// (1 - q)^3 where it is positive: all weights have it.
    #[inline(always)]
    fn cube(&self, q: f64) -> f64 {
        let inside = (1.0 - q).max(0.0);
        inside * inside * inside
    }

    #[inline(always)]
    fn cubes<S: Simd>(&self, q: Lanes<S>) -> Lanes<S> {
        let inside = (1.0 - q).positive();
        inside * inside * inside
    }
}

impl<const D: usize> SmoothingKernel<D> for WendlandC2<D> {
    #[inline(always)]
    fn support(&self) -> f64 {
        self.h
    }

    #[inline(always)]
    fn value(&self, r_squared: f64) -> f64 {
        let q = r_squared.sqrt() * self.per_h;
        self.of_value * self.cube(q) * (1.0 - q) * (1.0 + 4.0 * q)
    }

    #[inline(always)]
    fn fall_over_r(&self, r_squared: f64) -> f64 {
        20.0 * self.of_value * self.per_h * self.per_h * self.cube(r_squared.sqrt() * self.per_h)
    }

    #[inline(always)]
    fn slope(&self, r: f64) -> f64 {
        let q = r * self.per_h;
        self.slope_factor() * q * self.cube(q)
    }

    #[inline(always)]
    fn laplacian(&self, r: f64) -> f64 {
        self.laplacian_factor() * self.cube(r * self.per_h)
    }

    #[inline(always)]
    fn value_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S> {
        let q = r_squared.sqrt() * self.per_h;
        self.cubes(q) * (1.0 - q) * (q * 4.0 + 1.0)
    }

    #[inline(always)]
    fn value_factor(&self) -> f64 {
        self.of_value
    }

    #[inline(always)]
    fn slope_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        let q = r * self.per_h;
        q * self.cubes(q)
    }

    #[inline(always)]
    fn slope_factor(&self) -> f64 {
        20.0 * self.of_value * self.per_h
    }

    #[inline(always)]
    fn laplacian_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        self.cubes(r * self.per_h)
    }

    #[inline(always)]
    fn laplacian_factor(&self) -> f64 {
        40.0 * self.of_value * self.per_h * self.per_h
    }

    fn wgsl(&self) -> &'static str {
        include_str!("wendland_c2.wgsl")
    }
}
