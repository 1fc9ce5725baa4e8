//! How many particles stand on a square metre.

use corpuscle_sph::kernel::cubic_spline;
use corpuscle_sph::{Lanes, Searched};

/// Number density of particles, and how it changes with the smoothing length.
#[derive(Debug, Clone, Copy, Default)]
pub struct Density {
    /// n = sum W(r, h), itself included, 1/m2.
    pub number: f64,
    /// dn/dh, 1/m3.
    pub slope_in_h: f64,
}

impl Density {
    /// Sums over one particle's neighbours.
    #[inline(always)]
    pub fn sum(found: &Searched, h: f64) -> Self {
        let inverse_h = Lanes::splat(1.0 / h);
        let mut number = Lanes::ZERO;
        let mut r_slope = Lanes::ZERO;
        // Distances beyond the support count as the support's end, where the kernel vanishes.
        let end = Lanes::splat(4.0 * h * h);
        for r_squared in found.lanes() {
            let r_squared = r_squared.min(end).max(Lanes::splat(1e-24 * h * h));
            let r = r_squared.sqrt();
            number += cubic_spline::value(r, inverse_h);
            r_slope += r_squared * cubic_spline::slope_over_r(r, Lanes::splat(1.0) / r, inverse_h);
        }
        let number = number.sum() + cubic_spline::value_of_one(0.0, h);
        Density { number, slope_in_h: (r_slope.sum() - 2.0 * number) / h }
    }

    /// The smoothing length for which n = (eta / h)^2, by one Newton step from `h`, kept within a fifth of it.
    pub fn next_h(&self, h: f64, eta: f64) -> f64 {
        let residual = self.number * h * h - eta * eta;
        let slope = self.slope_in_h * h * h + 2.0 * self.number * h;
        // Alone, a particle's n falls as 1/h^2 and the slope vanishes: it then looks as far as it may.
        let change = if slope > 1e-6 * self.number * h { -residual / slope } else { h };
        h + change.clamp(-0.2 * h, 0.2 * h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_length_settles_where_number_and_length_agree() {
        // A square lattice of distance 1: n must come out as 1 and h as eta.
        let squares: Vec<f64> = (-6..=6_i32)
            .flat_map(|x| (-6..=6_i32).map(move |y| f64::from(x * x + y * y)))
            .filter(|&r_squared| r_squared > 0.0)
            .collect();
        let mut h = 0.9;
        let mut density = Density::default();
        for _ in 0..8 {
            let mut near: Vec<f64> = squares.iter().copied().filter(|&r| r < 4.0 * h * h).collect();
            near.resize(near.len().next_multiple_of(corpuscle_sph::LANES), f64::INFINITY);
            density = Density::sum(&Searched { particle: 0, r_squared: &near }, h);
            h = density.next_h(h, 1.25);
        }
        assert!((density.number - 1.0).abs() < 2e-2, "{}", density.number);
        assert!((density.number * h * h - 1.25 * 1.25).abs() < 1e-9);
    }
}
