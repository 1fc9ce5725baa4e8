//! Smoothing kernels in two dimensions.
//!
//! Each says its formula, its normalisation, its support and where it comes from. `r` is the distance of two
//! particles, `h` the smoothing length.

use crate::{Lanes, LanesExt, Simd};
use std::f64::consts::PI;

/// Cubic spline (Monaghan & Lattanzio 1985), support 2h.
///
/// W = 10/(7 pi h^2) {1 - 3/2 q^2 + 3/4 q^3 for q < 1, (2 - q)^3/4 for q < 2}, q = r/h; written here without a branch as
/// 10/(28 pi h^2) {(2 - q)_+^3 - 4 (1 - q)_+^3}. Its drawback, pairing, begins above some 25 neighbours.
pub mod cubic_spline {
    use super::*;

    /// Normalisation in two dimensions over h^2.
    pub const SIGMA: f64 = 10.0 / (28.0 * PI);

    /// W(r, h), 1/m2.
    #[inline(always)]
    pub fn value<S: Simd>(r: Lanes<S>, inverse_h: Lanes<S>) -> Lanes<S> {
        let q = r * inverse_h;
        let outer = (2.0 - q).positive();
        let inner = (1.0 - q).positive();
        (outer * outer * outer - inner * inner * inner * 4.0) * (inverse_h * inverse_h * SIGMA)
    }

    /// -dW/dr, 1/m3: times the unit vector from i to j it is the gradient of W with respect to the place of i.
    #[inline(always)]
    pub fn slope<S: Simd>(r: Lanes<S>, inverse_h: Lanes<S>) -> Lanes<S> {
        let q = r * inverse_h;
        let outer = (2.0 - q).positive();
        let inner = (1.0 - q).positive();
        (outer * outer - inner * inner * 4.0) * (inverse_h * inverse_h * inverse_h * (3.0 * SIGMA))
    }

    /// -dW/dr of one pair, 1/m3.
    #[inline(always)]
    pub fn slope_of_one(r: f64, h: f64) -> f64 {
        let q = r / h;
        let outer = (2.0 - q).max(0.0);
        let inner = (1.0 - q).max(0.0);
        3.0 * SIGMA / (h * h * h) * (outer * outer - 4.0 * inner * inner)
    }

    /// W(r, h) of one pair, 1/m2.
    #[inline(always)]
    pub fn value_of_one(r: f64, h: f64) -> f64 {
        let q = r / h;
        let outer = (2.0 - q).max(0.0);
        let inner = (1.0 - q).max(0.0);
        SIGMA / (h * h) * (outer * outer * outer - 4.0 * inner * inner * inner)
    }
}

/// Poly6 (Mueller, Charypar & Gross 2003), support h: 4/(pi h^8) (h^2 - r^2)^3. Flat at the centre, so it is used for
/// density only. 1/m2.
#[inline(always)]
pub fn poly6(r_squared: f64, h: f64) -> f64 {
    let h_squared = h * h;
    let inside = (h_squared - r_squared).max(0.0);
    4.0 / (PI * h_squared * h_squared * h_squared * h_squared) * inside * inside * inside
}

/// Magnitude of the gradient of poly6, over r: 24/(pi h^8) (h^2 - r^2)^2. 1/m4.
#[inline(always)]
pub fn poly6_slope_over_r(r_squared: f64, h: f64) -> f64 {
    let h_squared = h * h;
    let inside = (h_squared - r_squared).max(0.0);
    24.0 / (PI * h_squared * h_squared * h_squared * h_squared) * inside * inside
}

/// Magnitude of the gradient of the spiky kernel (Desbrun & Gascuel 1996, in two dimensions 10/(pi h^5) (h - r)^3),
/// support h: 30/(pi h^5) (h - r)^2. Does not vanish at the centre, so it keeps close particles apart. 1/m3.
#[inline(always)]
pub fn spiky_slope(r: f64, h: f64) -> f64 {
    let inside = (h - r).max(0.0);
    30.0 / (PI * h * h * h * h * h) * inside * inside
}

/// Laplacian of the viscosity kernel (Mueller, Charypar & Gross 2003), support h: 40/(pi h^5) (h - r). Positive
/// everywhere, so viscosity never feeds motion. 1/m4.
#[inline(always)]
pub fn viscosity_laplacian(r: f64, h: f64) -> f64 {
    40.0 / (PI * h * h * h * h * h) * (h - r).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Level, SimdBase, dispatch};

    /// Integral of f(r) over the plane inside `support`, by the midpoint rule.
    fn over_the_plane(support: f64, f: impl Fn(f64) -> f64) -> f64 {
        let parts = 20_000;
        let dr = support / parts as f64;
        (0..parts)
            .map(|part| {
                let r = (part as f64 + 0.5) * dr;
                2.0 * PI * r * f(r) * dr
            })
            .sum()
    }

    #[test]
    fn kernels_integrate_to_one() {
        let h = 1.3;
        assert!((over_the_plane(2.0 * h, |r| cubic_spline::value_of_one(r, h)) - 1.0).abs() < 1e-6);
        assert!((over_the_plane(h, |r| poly6(r * r, h)) - 1.0).abs() < 1e-6);
        // The spiky kernel is the integral of its slope from r to h; by parts, its own integral is that of r/2 |W'|.
        assert!((over_the_plane(h, |r| 0.5 * r * spiky_slope(r, h)) - 1.0).abs() < 1e-6);
        // Green's second identity with r^2/4, whose Laplacian is 1, gives the same for the viscosity kernel; its normal
        // derivative and value vanish at h.
        assert!((over_the_plane(h, |r| 0.25 * r * r * viscosity_laplacian(r, h)) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn slope_of_poly6_is_its_derivative() {
        let (h, e) = (0.7, 1e-6);
        for r in [0.05, 0.3, 0.6, 0.69, 0.71] {
            let value = |r: f64| poly6(r * r, h);
            let difference = (value(r + e) - value(r - e)) / (2.0 * e);
            assert!((-r * poly6_slope_over_r(r * r, h) - difference).abs() < 1e-6, "at {r}: {difference}");
        }
    }

    #[inline(always)]
    fn agree<S: Simd>(simd: S) {
        let h = 0.7;
        let splat = |value: f64| Lanes::splat(simd, value);
        for r in [0.05, 0.3, 0.69, 0.71, 1.2, 1.39, 1.5] {
            let w = cubic_spline::value(splat(r), splat(1.0 / h))[5];
            assert!((w - cubic_spline::value_of_one(r, h)).abs() < 1e-13);
            let e = 1e-6;
            let difference = (cubic_spline::value_of_one(r + e, h) - cubic_spline::value_of_one(r - e, h)) / (2.0 * e);
            let slope = cubic_spline::slope(splat(r), splat(1.0 / h))[0];
            assert!((-slope - difference).abs() < 1e-6, "at {r}: {} against {difference}", -slope);
        }
    }

    #[test]
    fn lanes_agree_with_one_pair_and_with_the_difference_quotient() {
        dispatch!(Level::new(), simd => agree(simd));
    }
}
