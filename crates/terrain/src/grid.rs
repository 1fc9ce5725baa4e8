//! The grid on which maps are given back.

use crate::frame::Frame;
use crate::{Bounds, Georeference};
use std::sync::Arc;

/// The terrain's own grid. Row 0 is the north row, column 0 the west column.
#[derive(Debug, Clone)]
pub struct MapGrid {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Where it lies, in the terrain's own coordinates.
    pub georeference: Georeference,
    pub(crate) frame: Arc<Frame>,
}

impl MapGrid {
    /// The grid of cells about `cell` wide that fills a rectangle in plain metres.
    pub(crate) fn over(bounds: Bounds, cell: f64) -> Self {
        let size = bounds.size();
        let [columns, rows] = size.map(|length| (length / cell).round().max(1.0) as usize);
        let cell = [size[0] / columns as f64, size[1] / rows as f64];
        let georeference = Georeference::plain([bounds.x_min, bounds.y_max], cell);
        Self { columns, rows, georeference, frame: Arc::new(Frame::plain()) }
    }

    /// Centre of a cell in model coordinates, m.
    pub fn centre(&self, column: usize, row: usize) -> [f64; 2] {
        self.point([column as f64, row as f64])
    }

    /// Fractional (column, row) of a position in model coordinates; whole numbers at the centres of cells. Outside the
    /// grid it goes on beyond `-0.5` or `columns - 0.5`.
    pub fn position(&self, x: f64, y: f64) -> [f64; 2] {
        self.georeference.position(self.frame.to_own([x, y]))
    }

    /// Cell size `[east, north]` in model metres, at the middle of the grid.
    pub fn cell_size(&self) -> [f64; 2] {
        self.cell_size_at([0.5 * (self.columns as f64 - 1.0), 0.5 * (self.rows as f64 - 1.0)])
    }

    /// Area of a cell, m2.
    pub fn cell_area(&self, column: usize, row: usize) -> f64 {
        let [east, north] = self.cell_size_at([column as f64, row as f64]);
        east * north
    }

    /// The point in model coordinates of a fractional (column, row).
    pub fn point(&self, position: [f64; 2]) -> [f64; 2] {
        self.frame.to_model(self.georeference.point(position))
    }

    /// Distances between the middles of opposite sides of the cell round a fractional (column, row).
    fn cell_size_at(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        let distance = |from: [f64; 2], to: [f64; 2]| {
            let [x0, y0] = self.point(from);
            let [x1, y1] = self.point(to);
            (x1 - x0).hypot(y1 - y0)
        };
        [distance([column - 0.5, row], [column + 0.5, row]), distance([column, row - 0.5], [column, row + 0.5])]
    }
}
