//! Square cells over the particles: counting sort, so that those of one cell and of one row of cells lie together.

/// A grid of square cells with the particles of each, as ranges of the sorted order.
#[derive(Debug, Default)]
pub struct Cells {
    x_min: f64,
    y_min: f64,
    size: f64,
    columns: usize,
    rows: usize,
    /// First particle of each cell, row by row; one entry more than cells.
    start: Vec<u32>,
    /// Cell of each particle, in the order given to [`Cells::sort`].
    cell: Vec<u32>,
    /// Largest reach that touches each cell: how far a particle in it must look.
    reach: Vec<f64>,
    order: Vec<u32>,
}

impl Cells {
    /// Sorts the places `x`, `y` into cells of about `size` (larger where the area would take too many) and returns the
    /// order: entry k is the particle that comes k-th. Stable: particles of one cell keep their order.
    pub fn sort(&mut self, x: &[f64], y: &[f64], size: f64) -> &[u32] {
        self.lay_over(x, y, size);
        let cells = self.columns * self.rows;
        self.start.clear();
        self.start.resize(cells + 1, 0);
        self.cell.clear();
        self.cell.extend(x.iter().zip(y).map(|(&x, &y)| {
            let column = ((x - self.x_min) / self.size) as usize;
            let row = ((y - self.y_min) / self.size) as usize;
            (row.min(self.rows - 1) * self.columns + column.min(self.columns - 1)) as u32
        }));
        for &cell in &self.cell {
            self.start[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.start[cell + 1] += self.start[cell];
        }
        self.order.clear();
        self.order.resize(x.len(), 0);
        for (particle, &cell) in self.cell.iter().enumerate() {
            let place = &mut self.start[cell as usize];
            self.order[*place as usize] = particle as u32;
            *place += 1;
        }
        // Each start has moved to its cell's end, which is the next cell's start.
        self.start.copy_within(0..cells, 1);
        self.start[0] = 0;
        &self.order
    }

    fn lay_over(&mut self, x: &[f64], y: &[f64], size: f64) {
        let (x_min, x_max) = range(x);
        let (y_min, y_max) = range(y);
        (self.x_min, self.y_min) = (x_min, y_min);
        let most = (4 * x.len()).max(65_536) as f64;
        let area = (x_max - x_min + size) * (y_max - y_min + size);
        self.size = size.max((area / most).sqrt()).max((x_max - x_min).max(y_max - y_min) / most);
        self.columns = ((x_max - x_min) / self.size) as usize + 1;
        self.rows = ((y_max - y_min) / self.size) as usize + 1;
    }

    /// Learns how far particles look: `reach[k]` of the k-th particle in sorted order. After this a search from any
    /// place covers all particles that reach it, whether or not it reaches them.
    pub fn set_reach(&mut self, reach: &[f64]) {
        self.reach.clear();
        self.reach.resize(self.columns * self.rows, 0.0);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                let inside = self.start[cell] as usize..self.start[cell + 1] as usize;
                let largest = reach[inside].iter().copied().fold(0.0, f64::max);
                if largest > 0.0 {
                    self.touch(column, row, largest);
                }
            }
        }
    }

    fn touch(&mut self, column: usize, row: usize, reach: f64) {
        let cells = (reach / self.size) as usize + 1;
        for row in row.saturating_sub(cells)..(row + cells + 1).min(self.rows) {
            let line = row * self.columns;
            for seen in
                &mut self.reach[line + column.saturating_sub(cells)..line + (column + cells + 1).min(self.columns)]
            {
                *seen = seen.max(reach);
            }
        }
    }

    /// How far a search from (x, y) must look to find all particles that reach it.
    #[inline]
    pub fn reach_at(&self, x: f64, y: f64) -> f64 {
        let column = (((x - self.x_min) / self.size).max(0.0) as usize).min(self.columns - 1);
        let row = (((y - self.y_min) / self.size).max(0.0) as usize).min(self.rows - 1);
        self.reach[row * self.columns + column]
    }

    /// Ranges of the sorted order that cover all particles within `reach` of (x, y), one a row of cells.
    #[inline]
    pub fn ranges(&self, x: f64, y: f64, reach: f64) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let column = |x: f64| (((x - self.x_min) / self.size).max(0.0) as usize).min(self.columns - 1);
        let row = |y: f64| (((y - self.y_min) / self.size).max(0.0) as usize).min(self.rows - 1);
        let (first, last) = (column(x - reach), column(x + reach));
        (row(y - reach)..=row(y + reach)).map(move |row| {
            let line = row * self.columns;
            self.start[line + first] as usize..self.start[line + last + 1] as usize
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.start.capacity() + self.cell.capacity() + self.order.capacity()) + 8 * self.reach.capacity()
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    if values.is_empty() {
        return (0.0, 0.0);
    }
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
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
