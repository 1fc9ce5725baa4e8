//! Mean height of the ground over a polygon.

use crate::MapGrid;
use crate::outline::Outline;
use crate::terrain::{Ground, Terrain};

impl Terrain {
    /// Mean height of the ground over a convex polygon, m: the integral of [`Terrain::height`] over the polygon,
    /// divided by its area. Beyond the bounds the ground has the height of the nearest position inside, as everywhere.
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

    /// Whether the cell of the map grid that holds a position in model coordinates, m, has data; false outside the grid
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
        Outline::new(corners, self.bounds)
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
