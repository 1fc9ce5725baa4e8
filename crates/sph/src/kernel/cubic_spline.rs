use super::SmoothingKernel;
use crate::{Lanes, LanesExt, Simd, SimdBase, SimdFloat};
use std::f64::consts::PI;

/// Cubic spline (Monaghan & Lattanzio 1985) of smoothing length h, support 2 h.
///
/// W = sigma {1 - 3/2 q^2 + 3/4 q^3 for q < 1, (2 - q)^3/4 for q < 2}, q = r/h, with sigma = 10/(7 pi h^2) in the plane, 1/(pi h^3) in space; here
/// without a branch as sigma/4 {(2 - q)_+^3 - 4 (1 - q)_+^3}. Its drawback, pairing, begins in the plane above some 25 neighbours.
///
/// The Laplacian is that of Brookshaw 1985, 2 |W'|/r.
#[derive(Debug, Clone, Copy)]
pub struct CubicSpline<const D: usize> {
    h: f64,
    per_h: f64,
}

/// Distances below this part of h are taken for it where a slope is divided by them.
const NEAREST: f64 = 1e-9;

impl<const D: usize> CubicSpline<D> {
    /// sigma/4 at h = 1.
    pub const SIGMA: f64 = {
        assert!(D == 2 || D == 3);
        if D == 2 { 10.0 / (28.0 * PI) } else { 1.0 / (4.0 * PI) }
    };

    /// The spline of smoothing length `h`, m, half its support.
    #[inline(always)]
    pub fn new(h: f64) -> Self {
        Self { h, per_h: 1.0 / h }
    }

    /// W(r), 1/m^D.
    #[inline(always)]
    pub fn value_at(&self, r: f64) -> f64 {
        let q = r / self.h;
        let outer = (2.0 - q).max(0.0);
        let inner = (1.0 - q).max(0.0);
        Self::SIGMA / self.h.powi(D as i32) * (outer * outer * outer - 4.0 * inner * inner * inner)
    }

    /// W of several distances, 1/m^D.
    #[inline(always)]
    pub fn values_at<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        self.cubes(r * self.per_h) * self.value_factor()
    }

    /// -dW/dr of several distances, 1/m^(D+1).
    #[inline(always)]
    pub fn slopes_at<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        self.slope_shape(r) * self.slope_factor()
    }

    #[inline(always)]
    fn cubes<S: Simd>(&self, q: Lanes<S>) -> Lanes<S> {
        let outer = (2.0 - q).positive();
        let inner = (1.0 - q).positive();
        outer * outer * outer - inner * inner * inner * 4.0
    }

    #[inline(always)]
    fn squares<S: Simd>(&self, q: Lanes<S>) -> Lanes<S> {
        let outer = (2.0 - q).positive();
        let inner = (1.0 - q).positive();
        outer * outer - inner * inner * 4.0
    }
}

impl<const D: usize> SmoothingKernel<D> for CubicSpline<D> {
    #[inline(always)]
    fn support(&self) -> f64 {
        2.0 * self.h
    }

    #[inline(always)]
    fn value(&self, r_squared: f64) -> f64 {
        self.value_at(r_squared.sqrt())
    }

    #[inline(always)]
    fn fall_over_r(&self, r_squared: f64) -> f64 {
        let r = r_squared.sqrt().max(NEAREST * self.h);
        self.slope(r) / r
    }

    #[inline(always)]
    fn slope(&self, r: f64) -> f64 {
        let q = r / self.h;
        let outer = (2.0 - q).max(0.0);
        let inner = (1.0 - q).max(0.0);
        3.0 * Self::SIGMA / self.h.powi(D as i32 + 1) * (outer * outer - 4.0 * inner * inner)
    }

    #[inline(always)]
    fn laplacian(&self, r: f64) -> f64 {
        let r = r.max(NEAREST * self.h);
        2.0 * self.slope(r) / r
    }

    #[inline(always)]
    fn value_shape<S: Simd>(&self, r_squared: Lanes<S>) -> Lanes<S> {
        self.cubes(r_squared.sqrt() * self.per_h)
    }

    #[inline(always)]
    fn value_factor(&self) -> f64 {
        self.per_h.powi(D as i32) * Self::SIGMA
    }

    #[inline(always)]
    fn slope_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        self.squares(r * self.per_h)
    }

    #[inline(always)]
    fn slope_factor(&self) -> f64 {
        self.per_h.powi(D as i32 + 1) * (3.0 * Self::SIGMA)
    }

    #[inline(always)]
    fn laplacian_shape<S: Simd>(&self, r: Lanes<S>) -> Lanes<S> {
        let q = (r * self.per_h).max(NEAREST);
        self.squares(q) / q
    }

    #[inline(always)]
    fn laplacian_factor(&self) -> f64 {
        self.per_h.powi(D as i32 + 2) * (6.0 * Self::SIGMA)
    }

    fn wgsl(&self) -> &'static str {
        include_str!("cubic_spline.wgsl")
    }
}
