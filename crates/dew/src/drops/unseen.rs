//! Drops too small to be followed one by one: how large they are and how much they cover.

use super::Cap;
use std::f64::consts::PI;

/// Part of a surface that drops cover which grow and merge: it stays so while their radius grows (Fritter, Knobler & Beysens, Phys. Rev. A 43,
/// 1991, 2858; 0.55 for hemispheres).
const MERGING_COVERAGE: f64 = 0.55;

/// Unresolved drops on an area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Unseen {
    /// Radius of the disk that a mean one covers, m.
    pub radius: f64,
    /// Part of the area that they cover.
    pub covered: f64,
}

impl Unseen {
    /// Of so much water, as a thickness in m, on `per_area` sites, 1/m2: each site has a drop, which grows as the cube root of the water,
    /// until they touch; from then on they merge, the part that they cover stays, and their radius grows as the water
    /// (Fritter et al. 1991).
    pub fn new(thickness: f64, per_area: f64, cap: Cap) -> Self {
        if thickness <= 0.0 {
            return Self::default();
        }
        let unit = cap.volume(1.0);
        let apart = (thickness / (per_area * unit)).cbrt();
        let covered = per_area * PI * apart * apart;
        if covered <= MERGING_COVERAGE {
            return Self { radius: apart, covered };
        }
        Self { radius: PI * thickness / (MERGING_COVERAGE * unit), covered: MERGING_COVERAGE }
    }
}

#[cfg(test)]
mod tests {
    use super::{Cap, MERGING_COVERAGE, Unseen};
    use std::f64::consts::PI;

    #[test]
    fn drops_hold_the_water_and_grow_by_its_cube_root_and_then_by_it() {
        let cap = Cap::new(1.2);
        let of = |thickness: f64| Unseen::new(thickness, 1e9, cap);
        for thickness in [1e-12, 1e-9, 1e-7, 1e-6, 1e-4] {
            let Unseen { radius, covered } = of(thickness);
            let number = covered / (PI * radius * radius);
            assert!((number * cap.volume(radius) / thickness - 1.0).abs() < 1e-12);
            assert!(number <= 1e9 * (1.0 + 1e-12) && covered <= MERGING_COVERAGE);
        }
        assert!((of(8e-10).radius / of(1e-10).radius - 2.0).abs() < 1e-12);
        assert!((of(8e-5).radius / of(1e-5).radius - 8.0).abs() < 1e-12);
        assert_eq!(of(0.0), Unseen::default());
    }
}
