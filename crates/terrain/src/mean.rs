//! Mean height of the ground over a polygon.

use crate::terrain::Ground;
use crate::{Bounds, MapGrid, Terrain};

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

impl Outline<'_> {
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
    fn points(&self) -> impl Iterator<Item = (f64, [f64; 2])> {
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
    fn mean_corner(&self) -> [f64; 2] {
        let Some(first) = self.corners().next() else { return self.bounds.centre() };
        let share = 1.0 / self.corners.len() as f64;
        let add = |sum: [f64; 2], corner: [f64; 2]| [0, 1].map(|axis| sum[axis] + share * (corner[axis] - first[axis]));
        self.corners().fold(first, add)
    }
}

impl Terrain {
    /// Mean height of the ground over a convex polygon, m: the integral of [`Terrain::height`] over the polygon,
    /// divided by its area. Beyond the bounds the ground has the height of the nearest place inside, as everywhere.
    ///
    /// `polygon` holds the corners in model coordinates, m, in counter-clockwise order, the first not repeated at the
    /// end.
    ///
    /// Gridded ground is a bicubic polynomial on each patch between four nodes, and the mean is exact but for rounding:
    /// about 1e-15 of the differences in height within the polygon and one patch round it, divided by the polygon's
    /// width in patches. Polygons of less than 1e-5 patches across, or narrower than 1e-8 patches, and ground from a
    /// formula are integrated by a quadrature rule of degree 8 (16 points) on each triangle of the fan round the first
    /// corner. A polygon without area has the height at the mean of its corners. A coordinate that is not a number is
    /// taken for the south-west corner's of the bounds; a polygon without corners is the middle of the bounds.
    ///
    /// The surface is kept in blocks of 64 x 64 patches from the first look on, 33 bytes a patch; for polygons that hold
    /// runs of more than four whole patches in a row of the grid, sums of a block's patches too, 8 bytes a patch.
    pub fn mean_over(&self, polygon: &[[f64; 2]]) -> f64 {
        self.mean_over_outline(self.outline(polygon))
    }

    /// Mean height of the ground over a convex polygon as [`Terrain::mean_over`] gives it, and two heights between
    /// which the ground over the polygon lies, all in m: (mean, lowest, highest).
    ///
    /// Of gridded ground lowest and highest are those of the nodes of all patches that the polygon's bounding rectangle
    /// touches, between which the surface stays by construction. Of ground from a formula they are those of the points
    /// of the quadrature rule and the corners; between these points the ground may be lower or higher.
    pub fn mean_and_range_over(&self, polygon: &[[f64; 2]]) -> (f64, f64, f64) {
        let outline = self.outline(polygon);
        let mean = self.mean_over_outline(outline);
        let extend = |[low, high]: [f64; 2], height: f64| [low.min(height), high.max(height)];
        let [lowest, highest] = match &self.ground {
            Ground::Surface(surface) => surface.node_range_around(&outline, self.bounds),
            Ground::Function(_) => {
                let points = outline.points().map(|(_, point)| point).chain(outline.corners());
                points.map(|[x, y]| self.height(x, y)).fold([mean, mean], extend)
            }
        };
        (mean, lowest.min(mean), highest.max(mean))
    }

    /// Whether the cell of the map grid that holds a place in model coordinates, m, has data; false outside the grid
    /// and for a coordinate that is not a number. See [`Terrain::is_valid_cell`].
    pub fn has_data_at(&self, x: f64, y: f64) -> bool {
        let MapGrid { columns, rows, .. } = self.map_grid;
        let [column, row] = self.map_grid.position(x, y);
        let cell = |position: f64, count: usize| {
            let from_side = position + 0.5;
            // The outer sides belong to the outermost cells.
            (0.0..=count as f64).contains(&from_side).then(|| (from_side as usize).min(count.saturating_sub(1)))
        };
        cell(column, columns).zip(cell(row, rows)).is_some_and(|(column, row)| self.is_valid_cell(column, row))
    }

    fn outline<'a>(&self, corners: &'a [[f64; 2]]) -> Outline<'a> {
        Outline { corners, bounds: self.bounds }
    }

    fn mean_over_outline(&self, outline: Outline) -> f64 {
        let exact = match &self.ground {
            Ground::Surface(surface) => surface.mean_over(&outline, self.bounds),
            Ground::Function(_) => None,
        };
        exact.unwrap_or_else(|| self.mean_by_quadrature(outline))
    }

    fn mean_by_quadrature(&self, outline: Outline) -> f64 {
        let [x, y] = outline.mean_corner();
        let level = self.height(x, y);
        let add = |[area, sum]: [f64; 2], (weight, [x, y]): (f64, [f64; 2])| {
            [area + weight, sum + weight * (self.height(x, y) - level)]
        };
        let [area, sum] = outline.points().fold([0.0, 0.0], add);
        if area > 0.0 { level + sum / area } else { level }
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
