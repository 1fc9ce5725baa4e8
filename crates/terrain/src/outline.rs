//! Convex polygons over which heights are averaged, and the points of a quadrature rule in them.

use crate::Bounds;

/// Weight and the second and third barycentric coordinate of the points of a quadrature rule for triangles, exact for
/// polynomials up to degree 8. Source: Dunavant, "High degree efficient symmetrical Gaussian quadrature rules for the
/// triangle", International Journal for Numerical Methods in Engineering 21 (1985), 1129-1148.
#[rustfmt::skip]
const TRIANGLE_RULE: [(f64, [f64; 2]); 16] = [
    (0.144_315_607_677_787, [1.0 / 3.0, 1.0 / 3.0]),
    (0.095_091_634_267_285, [0.459_292_588_292_723, 0.459_292_588_292_723]),
    (0.095_091_634_267_285, [0.081_414_823_414_554, 0.459_292_588_292_723]),
    (0.095_091_634_267_285, [0.459_292_588_292_723, 0.081_414_823_414_554]),
    (0.103_217_370_534_718, [0.170_569_307_751_760, 0.170_569_307_751_760]),
    (0.103_217_370_534_718, [0.658_861_384_496_480, 0.170_569_307_751_760]),
    (0.103_217_370_534_718, [0.170_569_307_751_760, 0.658_861_384_496_480]),
    (0.032_458_497_623_198, [0.050_547_228_317_031, 0.050_547_228_317_031]),
    (0.032_458_497_623_198, [0.898_905_543_365_938, 0.050_547_228_317_031]),
    (0.032_458_497_623_198, [0.050_547_228_317_031, 0.898_905_543_365_938]),
    (0.027_230_314_174_435, [0.263_112_829_634_638, 0.728_492_392_955_404]),
    (0.027_230_314_174_435, [0.728_492_392_955_404, 0.263_112_829_634_638]),
    (0.027_230_314_174_435, [0.008_394_777_409_958, 0.728_492_392_955_404]),
    (0.027_230_314_174_435, [0.728_492_392_955_404, 0.008_394_777_409_958]),
    (0.027_230_314_174_435, [0.008_394_777_409_958, 0.263_112_829_634_638]),
    (0.027_230_314_174_435, [0.263_112_829_634_638, 0.008_394_777_409_958]),
];

/// Corners are at most this many times the size of the bounds outside them: farther ones, infinite ones too, are moved
/// there.
const MAX_DISTANCE: f64 = 1e6;

/// A convex polygon whose corners are made finite.
#[derive(Clone, Copy)]
pub(crate) struct Outline<'a> {
    corners: &'a [[f64; 2]],
    bounds: Bounds,
}

impl<'a> Outline<'a> {
    pub(crate) fn new(corners: &'a [[f64; 2]], bounds: Bounds) -> Self {
        Self { corners, bounds }
    }

    /// Its corners in model coordinates, m; a coordinate that is not a number is the south-west corner's of the bounds.
    #[inline]
    pub(crate) fn corners(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> + Clone {
        let Bounds { x_min, x_max, y_min, y_max } = self.bounds;
        let [east, north] = self.bounds.size().map(|length| MAX_DISTANCE * length);
        let finite = |value: f64, min: f64, max: f64, distance: f64| {
            if value.is_nan() { min } else { value.max(min - distance).min(max + distance) }
        };
        self.corners.iter().map(move |[x, y]| [finite(*x, x_min, x_max, east), finite(*y, y_min, y_max, north)])
    }

    /// Points of a quadrature rule of degree 8 on each triangle of the fan round the first corner, with weights in m2.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, [f64; 2])> {
        let first = self.corners().next().unwrap_or_else(|| self.bounds.centre());
        let sides = self.corners().skip(1).zip(self.corners().skip(2));
        sides.flat_map(move |(second, third)| {
            let [a, b] = [second, third].map(|corner| [corner[0] - first[0], corner[1] - first[1]]);
            // Of a convex polygon all areas have one sign, but for rounding.
            let area = 0.5 * (a[0] * b[1] - a[1] * b[0]).abs();
            TRIANGLE_RULE.iter().map(move |(weight, [s, t])| {
                (area * weight, [0, 1].map(|axis| first[axis] + s * a[axis] + t * b[axis]))
            })
        })
    }

    /// Mean of the corners, m; of an empty polygon the middle of the bounds.
    pub(crate) fn mean_corner(&self) -> [f64; 2] {
        let Some(first) = self.corners().next() else { return self.bounds.centre() };
        let share = 1.0 / self.corners.len() as f64;
        let add = |sum: [f64; 2], corner: [f64; 2]| [0, 1].map(|axis| sum[axis] + share * (corner[axis] - first[axis]));
        self.corners().fold(first, add)
    }
}

#[cfg(test)]
mod tests {
    use super::TRIANGLE_RULE;

    #[test]
    fn the_triangle_rule_is_exact_up_to_degree_8() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (i, j) in (0..=8).flat_map(|i| (0..=8 - i).map(move |j| (i, j))) {
            let sum: f64 = TRIANGLE_RULE.iter().map(|(w, [s, t])| w * s.powi(i) * t.powi(j)).sum();
            // Over a triangle of area 1: 2 i! j! / (i + j + 2)!
            let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
            assert!((sum - exact).abs() < 1e-14, "{i} {j}: {sum} {exact}");
        }
    }
}
