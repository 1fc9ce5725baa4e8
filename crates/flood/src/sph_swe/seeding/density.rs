//! How many particles stand on a square metre.

use crate::sph_swe::obstacles::Coverage;
use corpuscle_sph::kernel::CubicSpline;
use corpuscle_sph::{Lanes, LanesExt, Neighbours, PairSum, Simd, SimdBase};

/// Number density of particles, and how it changes with the smoothing length.
#[derive(Debug, Clone, Copy, Default)]
pub struct Density {
    /// n = sum W(r, h), itself included, 1/m2.
    pub number: f64,
    /// dn/dh, 1/m3.
    pub slope_in_h: f64,
}

/// Sums densities; holds the squares of the reaches, twice the smoothing lengths.
pub struct Densities<'a> {
    /// Squares of the reaches, m2.
    pub reach_squared: &'a [f64],
}

impl PairSum<Density> for Densities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> Density {
        Density::sum(simd, found, 0.5 * self.reach_squared[particle].sqrt())
    }
}

impl Density {
    /// Sums over one particle's neighbours.
    #[inline(always)]
    fn sum<S: Simd>(simd: S, found: Neighbours, h: f64) -> Self {
        let spline = CubicSpline::<2>::new(h);
        let mut number = Lanes::splat(simd, 0.0);
        let mut r_slope = Lanes::splat(simd, 0.0);
        for (_, r) in found.lanes(simd) {
            number += spline.values_at(r);
            r_slope += r * spline.slopes_at(r);
        }
        let number = number.sum() + spline.value_at(0.0);
        Density { number, slope_in_h: (r_slope.sum() - 2.0 * number) / h }
    }

    /// As it is where obstacles cover a part of the kernel: the water that is seen stands for what is not.
    pub fn beside(self, covered: Coverage) -> Self {
        let seen = 1.0 - covered.part;
        Self {
            number: self.number / seen,
            slope_in_h: self.slope_in_h / seen + self.number * covered.slope_in_h / (seen * seen),
        }
    }

    /// The smoothing length for which n = (eta / h)^2, by one Newton step from `h`, kept within a fifth of it.
    pub fn next_h(&self, h: f64, eta: f64) -> f64 {
        let residual = self.number * h * h - eta * eta;
        let slope = self.slope_in_h * h * h + 2.0 * self.number * h;
        // Without neighbours a particle's n falls as 1/h^2 and the slope vanishes: its smoothing length is then the largest.
        let change = if slope > 1e-6 * self.number * h { -residual / slope } else { h };
        h + change.clamp(-0.2 * h, 0.2 * h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_sph::{FAR_AWAY, LANES, Level, dispatch};

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
            let mut distance: Vec<f64> = squares.iter().filter(|&&r| r < 4.0 * h * h).map(|r| r.sqrt()).collect();
            distance.resize(distance.len().next_multiple_of(LANES), FAR_AWAY);
            let index = vec![0; distance.len()];
            let found = Neighbours { index: &index, distance: &distance };
            density = dispatch!(Level::new(), simd => Density::sum(simd, found, h));
            h = density.next_h(h, 1.25);
        }
        assert!((density.number - 1.0).abs() < 2e-2, "{}", density.number);
        assert!((density.number * h * h - 1.25 * 1.25).abs() < 1e-9);
    }
}
