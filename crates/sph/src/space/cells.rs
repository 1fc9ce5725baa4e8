//! Boxes over particles in space: counting sort, so that those of one box and of one row of boxes lie together.

use crate::FEWEST;
use crate::counting::{self, range};
use rayon::prelude::*;
use std::ops::Range;

/// A grid of boxes with the particles of each, as ranges of the sorted order. Boxes are short along x, where rows of
/// them are searched in one run, and as long as the reach along y and z.
#[derive(Debug, Default)]
pub struct Cells {
    low: [f64; 3],
    inverse: [f64; 3],
    size: [f64; 3],
    count: [usize; 3],
    /// First particle of each box, x fastest; one entry more than boxes.
    start: Vec<u32>,
    /// Box of each particle, in the order given to [`Cells::sort`].
    cell: Vec<u32>,
    order: Vec<u32>,
}

/// Boxes in a reach along x: more fit the search closer, fewer are less to count.
const COLUMNS_IN_REACH: f64 = 4.0;

impl Cells {
    /// Sorts places into boxes of about `reach` (larger where the room would take too many) and returns the order: entry k
    /// is the particle that comes k-th. Stable: particles of one box keep their order.
    pub fn sort(&mut self, [x, y, z]: [&[f64]; 3], reach: f64) -> &[u32] {
        self.lay_over([x, y, z], reach);
        let mut cell = std::mem::take(&mut self.cell);
        let cell_of = |((&x, &y), &z): ((&f64, &f64), &f64)| {
            ((self.along(2, z) * self.count[1] + self.along(1, y)) * self.count[0] + self.along(0, x)) as u32
        };
        x.par_iter().zip(y).zip(z).with_min_len(FEWEST).map(cell_of).collect_into_vec(&mut cell);
        self.cell = cell;
        let cells = self.count.iter().product();
        counting::sort(&self.cell, cells, &mut self.start, &mut self.order);
        &self.order
    }

    fn lay_over(&mut self, places: [&[f64]; 3], reach: f64) {
        let ranges = places.map(range);
        let most = (16 * places[0].len()).max(262_144) as f64;
        let mut size = [reach / COLUMNS_IN_REACH, reach, reach];
        let boxes = |size: [f64; 3]| {
            [0, 1, 2].map(|axis| ((ranges[axis].1 - ranges[axis].0) / size[axis]).floor() + 1.0).iter().product::<f64>()
        };
        while boxes(size) > most {
            size = size.map(|size| 1.5 * size);
        }
        self.low = ranges.map(|range| range.0);
        self.size = size;
        self.inverse = size.map(|size| 1.0 / size);
        self.count = [0, 1, 2].map(|axis| ((ranges[axis].1 - ranges[axis].0) * self.inverse[axis]) as usize + 1);
    }

    #[inline(always)]
    fn along(&self, axis: usize, value: f64) -> usize {
        // A negative number becomes 0.
        (((value - self.low[axis]) * self.inverse[axis]) as usize).min(self.count[axis] - 1)
    }

    /// Calls `found` with ranges of the sorted order that cover all particles within `reach` of a place, one a row of boxes.
    #[inline(always)]
    pub fn each_range(&self, [x, y, z]: [f64; 3], reach: f64, mut found: impl FnMut(Range<usize>)) {
        let (first_y, last_y) = (self.along(1, y - reach), self.along(1, y + reach));
        let (first_z, last_z) = (self.along(2, z - reach), self.along(2, z + reach));
        for layer in first_z..=last_z {
            let off_z = self.distance_along(2, layer, z);
            let left = reach * reach - off_z * off_z;
            for row in first_y..=last_y {
                let off_y = self.distance_along(1, row, y);
                // Half of the chord that the row's nearest line cuts from the ball, with room for rounding.
                let half_squared = left - off_y * off_y;
                if half_squared < -1e-9 * reach * reach {
                    continue;
                }
                let half = half_squared.max(0.0).sqrt() + 1e-9 * reach;
                let line = (layer * self.count[1] + row) * self.count[0];
                let (first, last) = (self.along(0, x - half), self.along(0, x + half));
                found(self.start[line + first] as usize..self.start[line + last + 1] as usize);
            }
        }
    }

    /// Distance of a coordinate from the slab of boxes `cell`. The outermost slabs hold all that lies beyond, too.
    #[inline(always)]
    fn distance_along(&self, axis: usize, cell: usize, value: f64) -> f64 {
        let low = self.low[axis] + cell as f64 * self.size[axis];
        (low - value).max(value - (low + self.size[axis])).max(0.0)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.start.capacity() + self.cell.capacity() + self.order.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranges_cover_all_within_reach(
            places in prop::collection::vec((-5.0..5.0f64, -2.0..8.0f64, 0.0..6.0f64), 1..200),
            looks in prop::collection::vec((-7.0..7.0f64, -4.0..9.0f64, -1.0..7.0f64), 1..20),
            reach in 0.2..5.0f64,
        ) {
            let x: Vec<f64> = places.iter().map(|p| p.0).collect();
            let y: Vec<f64> = places.iter().map(|p| p.1).collect();
            let z: Vec<f64> = places.iter().map(|p| p.2).collect();
            let mut cells = Cells::default();
            let order = cells.sort([&x, &y, &z], reach).to_vec();
            let mut all = order.clone();
            all.sort_unstable();
            prop_assert!(all.iter().enumerate().all(|(k, &p)| k == p as usize));
            for look in looks {
                let mut found = Vec::new();
                cells.each_range(look.into(), reach, |range| found.extend_from_slice(&order[range]));
                for (j, other) in places.iter().enumerate() {
                    let squared = (look.0 - other.0).powi(2) + (look.1 - other.1).powi(2) + (look.2 - other.2).powi(2);
                    if squared < reach * reach {
                        prop_assert!(found.contains(&(j as u32)));
                    }
                }
            }
        }
    }
}
