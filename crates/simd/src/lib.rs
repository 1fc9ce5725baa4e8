//! Several numbers at once: vector instructions of the CPU at hand, chosen at run time by `fearless_simd`.
//!
//! Every operation used here gives the same bits on every CPU: no fused multiplication and addition, and sums in
//! one fixed order.

#![warn(missing_docs)]

use fearless_simd::f64x8;
pub use fearless_simd::prelude::{Select, SimdBase, SimdFloat, SimdFrom, SimdMask};
pub use fearless_simd::{Level, Simd, dispatch};

/// How many numbers a [`Lanes`] holds: one AVX-512 register, two AVX2 registers.
pub const LANES: usize = 8;

/// Several `f64`, operated on lane by lane.
pub type Lanes<S> = f64x8<S>;

/// Operations of pair loops on lanes beyond arithmetic.
pub trait LanesExt<S: Simd>: Copy {
    /// The number itself where it is positive, else 0.
    fn positive(self) -> Self;

    /// `yes` where `self < limit`, else `no`.
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self;

    /// Sum of the lanes, in one fixed order.
    fn sum(self) -> f64;

    /// Largest of the lanes.
    fn largest(self) -> f64;
}

impl<S: Simd> LanesExt<S> for Lanes<S> {
    #[inline(always)]
    fn positive(self) -> Self {
        self.max(0.0)
    }

    #[inline(always)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        self.simd_lt(limit).select(yes, no)
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h]: [f64; LANES] = self.into();
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        let lanes: [f64; LANES] = self.into();
        lanes.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Reads the rows that `index` names, one a lane, and turns them: the k-th result holds the k-th number of every row.
///
/// Whole rows in, then three rounds of interleaving: far fewer instructions than fetching number by number.
#[inline(always)]
pub fn gather<S: Simd>(simd: S, rows: &[[f64; LANES]], index: [usize; LANES]) -> [Lanes<S>; LANES] {
    transposed(index.map(
        #[inline(always)]
        |row| Lanes::simd_from(simd, rows[row]),
    ))
}

/// Rows turned to columns: the k-th result holds the k-th number of every row.
#[inline(always)]
pub fn transposed<S: Simd>(mut rows: [Lanes<S>; LANES]) -> [Lanes<S>; LANES] {
    for _ in 0..3 {
        let [a, b, c, d, e, f, g, h] = rows;
        let ((a, e), (b, f), (c, g), (d, h)) = (a.interleave(e), b.interleave(f), c.interleave(g), d.interleave(h));
        rows = [a, e, b, f, c, g, d, h];
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[inline(always)]
    fn calculations<S: Simd>(simd: S) {
        let a = Lanes::from_fn(simd, |lane| lane as f64);
        let b = Lanes::splat(simd, 2.0);
        assert_eq!((a * b + 1.0 - b / 4.0)[3], 6.5);
        assert_eq!((-a).abs().sum(), 28.0);
        assert_eq!(a.largest(), 7.0);
        assert_eq!(a.select_below(b, b, b * 0.0).sum(), 4.0);
        assert_eq!((a - b).positive().sqrt()[6], 2.0);
        let rows: Vec<[f64; LANES]> =
            (0..20).map(|row| std::array::from_fn(|column| f64::from(row) + 0.01 * column as f64)).collect();
        let index = [3, 19, 0, 7, 7, 1, 12, 5];
        let turned = gather(simd, &rows, index);
        for (column, numbers) in turned.iter().enumerate() {
            for (lane, &row) in index.iter().enumerate() {
                assert_eq!(numbers[lane], rows[row][column]);
            }
        }
    }

    #[test]
    fn lanes_work_lane_by_lane() {
        dispatch!(Level::new(), simd => calculations(simd));
        dispatch!(Level::baseline(), simd => calculations(simd));
    }
}
