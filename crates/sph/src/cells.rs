//! Square cells over the particles: counting sort, so that those of one cell and of one row of cells lie together.

use crate::counting::{self, range};
use rayon::prelude::*;

/// A grid of square cells with the particles of each, as ranges of the sorted order.
#[derive(Debug, Default)]
pub struct Cells {
    x_min: f64,
    y_min: f64,
    size: f64,
    /// 1 / size: a product takes a fraction of a quotient's time.
    per_size: f64,
    columns: usize,
    rows: usize,
    /// First particle of each cell, row by row; one entry more than cells.
    start: Vec<u32>,
    /// Cell of each particle, in the order given to [`Cells::sort`].
    cell: Vec<u32>,
    /// Largest reach that touches each cell: how far a particle in it must look.
    reach: Vec<f64>,
    /// The same from the particles of the cell's own row.
    along_rows: Vec<f64>,
    order: Vec<u32>,
}

/// Fewer particles or cells than this are not worth a thread of their own.
pub const FEWEST: usize = 2048;

impl Cells {
    /// Sorts the places `x`, `y` into cells of about `size` (larger where the area would take too many) and returns the
    /// order: entry k is the particle that comes k-th. Stable: particles of one cell keep their order.
    pub fn sort(&mut self, x: &[f64], y: &[f64], size: f64) -> &[u32] {
        self.lay_over(x, y, size);
        let cells = self.columns * self.rows;
        let Self { x_min, y_min, per_size, columns, rows, .. } = *self;
        let cell_of = |(&x, &y): (&f64, &f64)| {
            let column = ((x - x_min) * per_size) as usize;
            let row = ((y - y_min) * per_size) as usize;
            (row.min(rows - 1) * columns + column.min(columns - 1)) as u32
        };
        x.par_iter().zip(y).with_min_len(FEWEST).map(cell_of).collect_into_vec(&mut self.cell);
        counting::sort(&self.cell, cells, &mut self.start, &mut self.order);
        &self.order
    }

    fn lay_over(&mut self, x: &[f64], y: &[f64], size: f64) {
        let (x_min, x_max) = range(x);
        let (y_min, y_max) = range(y);
        (self.x_min, self.y_min) = (x_min, y_min);
        let most = (4 * x.len()).max(65_536) as f64;
        let area = (x_max - x_min + size) * (y_max - y_min + size);
        self.size = size.max((area / most).sqrt()).max((x_max - x_min).max(y_max - y_min) / most);
        self.per_size = 1.0 / self.size;
        self.columns = ((x_max - x_min) * self.per_size) as usize + 1;
        self.rows = ((y_max - y_min) * self.per_size) as usize + 1;
    }

    /// Learns how far particles look: `reach[k]` of the k-th particle in sorted order. After this a search from any
    /// place covers all particles that reach it, whether or not it reaches them.
    ///
    /// A reach spreads to the cells that it touches first along the rows, then from row to row: a few cells more than a
    /// circle would touch, for far less work.
    pub fn set_reach(&mut self, reach: &[f64]) {
        let Self { size, columns, rows, .. } = *self;
        let in_cells = |reach: f64| (reach / size) as usize + 1;
        self.along_rows.resize(columns * rows, 0.0);
        let (start, along_rows) = (&self.start, &mut self.along_rows);
        let rows_together = (FEWEST / columns).max(1);
        let spread_along_row = |(row, line): (usize, &mut [f64])| {
            line.fill(0.0);
            for column in 0..columns {
                let cell = row * columns + column;
                let inside = start[cell] as usize..start[cell + 1] as usize;
                let largest = reach[inside].iter().copied().fold(0.0, f64::max);
                if largest > 0.0 {
                    let cells = in_cells(largest);
                    let touched = column.saturating_sub(cells)..(column + cells + 1).min(columns);
                    line[touched].iter_mut().for_each(|seen| *seen = seen.max(largest));
                }
            }
            line.iter().copied().fold(0.0, f64::max)
        };
        let lines = along_rows.par_chunks_mut(columns).enumerate().with_min_len(rows_together);
        let largest = lines.map(spread_along_row).reduce(|| 0.0, f64::max);
        let farthest = in_cells(largest);
        let along_rows = &self.along_rows;
        let spread_to_rows = |(row, line): (usize, &mut [f64])| {
            line.copy_from_slice(&along_rows[row * columns..][..columns]);
            for other in row.saturating_sub(farthest)..(row + farthest + 1).min(rows) {
                // What touches this row from that one reaches farther than the rows between them.
                let between = (row.abs_diff(other).saturating_sub(1)) as f64 * size;
                for (seen, &near) in line.iter_mut().zip(&along_rows[other * columns..][..columns]) {
                    if near >= between && near > *seen {
                        *seen = near;
                    }
                }
            }
        };
        self.reach.resize(columns * rows, 0.0);
        self.reach.par_chunks_mut(columns).enumerate().with_min_len(rows_together).for_each(spread_to_rows);
    }

    /// How far a search from (x, y) must look to find all particles that reach it.
    #[inline]
    pub fn reach_at(&self, x: f64, y: f64) -> f64 {
        let column = (((x - self.x_min) * self.per_size).max(0.0) as usize).min(self.columns - 1);
        let row = (((y - self.y_min) * self.per_size).max(0.0) as usize).min(self.rows - 1);
        self.reach[row * self.columns + column]
    }

    /// Ranges of the sorted order that cover all particles within `reach` of (x, y), one a row of cells.
    #[inline]
    pub fn ranges(&self, x: f64, y: f64, reach: f64) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let column = |x: f64| (((x - self.x_min) * self.per_size).max(0.0) as usize).min(self.columns - 1);
        let row = |y: f64| (((y - self.y_min) * self.per_size).max(0.0) as usize).min(self.rows - 1);
        let (first, last) = (column(x - reach), column(x + reach));
        (row(y - reach)..=row(y + reach)).map(move |row| {
            let line = row * self.columns;
            self.start[line + first] as usize..self.start[line + last + 1] as usize
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.start.capacity() + self.cell.capacity() + self.order.capacity()) + 16 * self.reach.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranges_cover_all_within_reach(
            places in prop::collection::vec((-50.0..50.0f64, -20.0..80.0f64, 0.1..9.0f64), 0..120),
            size in 0.5..20.0f64,
        ) {
            let x: Vec<f64> = places.iter().map(|p| p.0).collect();
            let y: Vec<f64> = places.iter().map(|p| p.1).collect();
            let mut cells = Cells::default();
            let order = cells.sort(&x, &y, size).to_vec();
            let mut all = order.clone();
            all.sort_unstable();
            prop_assert!(all.iter().enumerate().all(|(k, &p)| k == p as usize));
            let reach: Vec<f64> = order.iter().map(|&p| places[p as usize].2).collect();
            cells.set_reach(&reach);
            for (i, place) in places.iter().enumerate() {
                let found: Vec<u32> = cells
                    .ranges(x[i], y[i], cells.reach_at(x[i], y[i]))
                    .flat_map(|range| order[range].to_vec())
                    .collect();
                for (j, other) in places.iter().enumerate() {
                    let distance = ((x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2)).sqrt();
                    if distance < place.2.max(other.2) {
                        prop_assert!(found.contains(&(j as u32)));
                    }
                }
            }
        }
    }
}
