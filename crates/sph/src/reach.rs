//! Search radii in the plane where particles have different supports.

use crate::{Cells, FEWEST};
use rayon::prelude::*;

impl Cells<2> {
    /// Sets how far particles reach: `reach[k]` of the k-th particle in sorted order, m. After this a search from any
    /// position covers all particles that reach it, whether or not it reaches them.
    ///
    /// A reach spreads to the cells that it touches first along the rows, then from row to row: a few cells more than a
    /// circle would touch, for far less work.
    pub fn set_reach(&mut self, reach: &[f64]) {
        let (size, [columns, rows]) = (self.size[0], self.count);
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

    /// Search radius from a position that finds all particles whose support covers it.
    #[inline]
    pub fn reach_at(&self, position: [f64; 2]) -> f64 {
        self.reach[self.along(1, position[1]) * self.count[0] + self.along(0, position[0])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_search_finds_all_that_reach_the_point(
            points in prop::collection::vec((-50.0..50.0f64, -20.0..80.0f64, 0.1..9.0f64), 0..120),
            size in 0.5..20.0f64,
        ) {
            let x: Vec<f64> = points.iter().map(|p| p.0).collect();
            let y: Vec<f64> = points.iter().map(|p| p.1).collect();
            let mut cells = Cells::default();
            let order = cells.sort([&x, &y], [size, size]).to_vec();
            let reach: Vec<f64> = order.iter().map(|&p| points[p as usize].2).collect();
            cells.set_reach(&reach);
            for (i, point) in points.iter().enumerate() {
                let at = [x[i], y[i]];
                let found: Vec<u32> =
                    cells.ranges_within(at, cells.reach_at(at)).flat_map(|range| order[range].to_vec()).collect();
                for (j, other) in points.iter().enumerate() {
                    let distance = ((x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2)).sqrt();
                    if distance < point.2.max(other.2) {
                        prop_assert!(found.contains(&(j as u32)));
                    }
                }
            }
        }
    }
}
