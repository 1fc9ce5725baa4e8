//! The grid on which maps are given back.

/// The terrain's own grid. Row 0 is the north row, column 0 the west column.
#[derive(Debug, Clone, PartialEq)]
pub struct MapGrid {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// The outer corner at the north-west, in the terrain's own coordinates.
    pub(crate) corner: [f64; 2],
    /// Cell size `[east, south]`, in the terrain's own coordinates.
    pub(crate) cell: [f64; 2],
}

impl MapGrid {
    /// The grid of cells about `cell` wide that fills a rectangle.
    pub(crate) fn over(bounds: crate::Bounds, cell: f64) -> Self {
        let size = bounds.size();
        let [columns, rows] = size.map(|length| (length / cell).round().max(1.0) as usize);
        Self {
            columns,
            rows,
            corner: [bounds.x_min, bounds.y_max],
            cell: [size[0] / columns as f64, size[1] / rows as f64],
        }
    }

    /// Centre of a cell in model coordinates, m.
    pub fn centre(&self, column: usize, row: usize) -> [f64; 2] {
        [self.corner[0] + (column as f64 + 0.5) * self.cell[0], self.corner[1] - (row as f64 + 0.5) * self.cell[1]]
    }

    /// Fractional (column, row) of a place in model coordinates; whole numbers at the centres of cells. Outside the
    /// grid it goes on beyond `-0.5` or `columns - 0.5`.
    pub fn position(&self, x: f64, y: f64) -> [f64; 2] {
        [(x - self.corner[0]) / self.cell[0] - 0.5, (self.corner[1] - y) / self.cell[1] - 0.5]
    }

    /// Cell size `[east, north]` in model metres, at the middle of the grid.
    pub fn cell_size(&self) -> [f64; 2] {
        self.cell
    }

    /// Area of a cell, m2.
    pub fn cell_area(&self, _column: usize, _row: usize) -> f64 {
        self.cell[0] * self.cell[1]
    }
}
