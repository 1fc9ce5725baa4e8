//! How many particles stand on a square metre.

use crate::obstacles::Coverage;
use corpuscle_sph::kernel::cubic_spline;
use corpuscle_sph::{Lanes, LanesExt, Neighbours, PairSum, Simd, SimdBase};

/// Number density of particles, and how it changes with the smoothing length.
#[derive(Debug, Clone, Copy, Default)]
pub struct Density {
    /// How many particles like this one would stand on a square metre: sum (w_j / w_i) W(r, h_i) with the weights w, 1/m2. Of
    /// particles of one weight it is `number`. Its inverse is the area that the particle stands for.
    pub alike: f64,
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

/// The same for particles of unequal weights.
pub struct WeightedDensities<'a> {
    /// Squares of the reaches, m2.
    pub reach_squared: &'a [f64],
    /// Weights, m3.
    pub weights: &'a [f64],
}

impl PairSum<Density> for Densities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> Density {
        Density::sum(simd, found, 0.5 * self.reach_squared[particle].sqrt())
    }
}

impl PairSum<Density> for WeightedDensities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> Density {
        let h = 0.5 * self.reach_squared[particle].sqrt();
        let inverse_h = Lanes::splat(simd, 1.0 / h);
        let mut sum = Lanes::splat(simd, 0.0);
        for (index, r) in found.lanes(simd) {
            sum += cubic_spline::value(r, inverse_h) * Lanes::from_fn(simd, |lane| self.weights[index[lane]]);
        }
        let alike = cubic_spline::value_of_one(0.0, h) + sum.sum() / self.weights[particle];
        Density { alike, ..Density::sum(simd, found, h) }
    }
}

impl Density {
    /// Sums over one particle's neighbours.
    #[inline(always)]
    fn sum<S: Simd>(simd: S, found: Neighbours, h: f64) -> Self {
        let inverse_h = Lanes::splat(simd, 1.0 / h);
        let mut number = Lanes::splat(simd, 0.0);
        let mut r_slope = Lanes::splat(simd, 0.0);
        for (_, r) in found.lanes(simd) {
            number += cubic_spline::value(r, inverse_h);
            r_slope += r * cubic_spline::slope(r, inverse_h);
        }
        let number = number.sum() + cubic_spline::value_of_one(0.0, h);
        Density { alike: number, number, slope_in_h: (r_slope.sum() - 2.0 * number) / h }
    }

    /// As it is where obstacles cover a part of the kernel: the water that is seen stands for what is not.
    pub fn beside(self, covered: Coverage) -> Self {
        let seen = 1.0 - covered.part;
        Self {
            alike: self.alike / seen,
            number: self.number / seen,
            slope_in_h: self.slope_in_h / seen + self.number * covered.slope_in_h / (seen * seen),
        }
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
    use corpuscle_sph::{Cells, Near, NeighbourLists};
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

    /// Densities of particles given as (x, y, weight) with h = 1.25; in their own order.
    fn densities(particles: &[[f64; 3]], weighted: bool) -> Vec<Density> {
        let of = |k: usize| particles.iter().map(move |particle| particle[k]);
        let (x, y): (Vec<f64>, Vec<f64>) = (of(0).collect(), of(1).collect());
        let mut cells = Cells::default();
        let order = cells.sort(&x, &y, 1.5).to_vec();
        let sorted = |k| order.iter().map(|&from| particles[from as usize][k]).collect::<Vec<f64>>();
        let (x, y, weights) = (sorted(0), sorted(1), sorted(2));
        let reach_squared = &vec![2.5 * 2.5; x.len()];
        cells.set_reach(&vec![2.5; x.len()]);
        let mut out = vec![Density::default(); x.len()];
        let mut lists = NeighbourLists::default();
        if weighted {
            let sum = WeightedDensities { reach_squared, weights: &weights };
            lists.search(Near::Either, &cells, &x, &y, reach_squared, &mut out, &sum);
        } else {
            lists.search(Near::Either, &cells, &x, &y, reach_squared, &mut out, &Densities { reach_squared });
        }
        let mut own = out.clone();
        order.iter().zip(out).for_each(|(&from, density)| own[from as usize] = density);
        own
    }

    fn lattice() -> Vec<[f64; 3]> {
        (0..15).flat_map(|x| (0..15).map(move |y| [f64::from(x), f64::from(y), 2.0])).collect()
    }

    #[test]
    fn particles_of_one_weight_are_all_alike() {
        for (plain, weighted) in densities(&lattice(), false).iter().zip(densities(&lattice(), true)) {
            assert_eq!(plain.alike, plain.number);
            assert!((weighted.alike - plain.alike).abs() < 1e-14 && weighted.number == plain.number);
        }
    }

    /// Halves of a particle, close together, stand for half its area each and leave the areas of the others as they were.
    #[test]
    fn parts_of_a_particle_share_its_area() {
        let whole = densities(&lattice(), true);
        let mut parts = lattice();
        let middle = 15 * 7 + 7;
        parts[middle] = [7.0 - 0.1, 7.0, 1.0];
        parts.push([7.0 + 0.1, 7.0, 1.0]);
        let parts = densities(&parts, true);
        for (k, (part, whole)) in parts.iter().zip(&whole).enumerate() {
            let share = if k == middle { 2.0 } else { 1.0 };
            assert!((part.alike / whole.alike - share).abs() < 0.02, "{k}: {} {}", part.alike, whole.alike);
        }
    }
}
