//! Cells over the particles: counting sort, so that those of one cell and of one row of cells lie together.

use crate::counting::{self, range};
use rayon::prelude::*;
use std::ops::Range;

/// A grid of cells in `D` dimensions with the particles of each, as ranges of the sorted order. Rows of cells lie along x.
#[derive(Debug)]
pub struct Cells<const D: usize> {
    low: [f64; D],
    pub(crate) size: [f64; D],
    /// 1 / size: a product takes a fraction of a quotient's time.
    per_size: [f64; D],
    /// Number of the first cell along each axis, counted from `low`; a whole number.
    first: [f64; D],
    pub(crate) count: [usize; D],
    /// First particle of each cell, x fastest; one entry more than cells.
    pub(crate) start: Vec<u32>,
    /// Cell of each particle, in the order given to [`Cells::sort`].
    cell: Vec<u32>,
    order: Vec<u32>,
    /// Search radius from each cell, where that differs: see [`Cells::set_reach`].
    pub(crate) reach: Vec<f64>,
    /// The same from the particles of the cell's own row.
    pub(crate) along_rows: Vec<f64>,
}

/// Fewer particles or cells than this are not worth a thread of their own.
pub const FEWEST: usize = 2048;

impl<const D: usize> Default for Cells<D> {
    fn default() -> Self {
        Self {
            low: [0.0; D],
            size: [0.0; D],
            per_size: [0.0; D],
            first: [0.0; D],
            count: [0; D],
            start: Vec::new(),
            cell: Vec::new(),
            order: Vec::new(),
            reach: Vec::new(),
            along_rows: Vec::new(),
        }
    }
}

/// Cells in a reach along x: more fit the search closer, fewer are less to count.
const COLUMNS_IN_REACH: f64 = 4.0;

impl<const D: usize> Cells<D> {
    /// Sizes of cells that suit one reach of all particles, m: short along x, where rows of them are searched in one run.
    pub fn sizes_for(reach: f64) -> [f64; D] {
        std::array::from_fn(|axis| if axis == 0 { reach / COLUMNS_IN_REACH } else { reach })
    }

    /// Sorts positions into cells of about `size`, m (larger where there would be too many), and returns the order: entry k is the particle that
    /// comes k-th. Stable: particles of one cell keep their order.
    pub fn sort(&mut self, positions: [&[f64]; D], size: [f64; D]) -> &[u32] {
        self.lay_over(positions, size);
        self.sort_into_cells(positions)
    }

    /// The same with cells of just `size`, m, counted from `low`, m. Cells are made for `part`, m, only, by its lowest and highest corner; its outermost cells hold
    /// what lies beyond.
    pub fn sort_part(&mut self, positions: [&[f64]; D], size: [f64; D], low: [f64; D], part: [[f64; D]; 2]) -> &[u32] {
        (self.low, self.size, self.per_size) = (low, size, size.map(|size| 1.0 / size));
        let number = |axis: usize, end: usize| ((part[end][axis] - low[axis]) * self.per_size[axis]).floor();
        self.first = std::array::from_fn(|axis| number(axis, 0));
        // A negative number becomes 0.
        self.count = std::array::from_fn(|axis| (number(axis, 1) - self.first[axis]) as usize + 1);
        self.sort_into_cells(positions)
    }

    /// Sorts the particles of each cell by a key, those with the same key as they were, and returns the order.
    pub fn sort_each_cell_by(&mut self, key: impl Fn(u32) -> u64) -> &[u32] {
        for range in self.start.array_windows().map(|[from, to]| *from as usize..*to as usize) {
            self.order[range].sort_by_key(|particle| key(*particle));
        }
        &self.order
    }

    fn sort_into_cells(&mut self, positions: [&[f64]; D]) -> &[u32] {
        let mut cell = std::mem::take(&mut self.cell);
        let cell_of = |particle: usize| {
            let along = |axis: usize| self.along(axis, positions[axis][particle]);
            (0..D).rev().fold(0, |cell, axis| cell * self.count[axis] + along(axis)) as u32
        };
        (0..positions[0].len()).into_par_iter().with_min_len(FEWEST).map(cell_of).collect_into_vec(&mut cell);
        self.cell = cell;
        let cells = self.count.iter().product();
        counting::sort(&self.cell, cells, &mut self.start, &mut self.order);
        &self.order
    }

    fn lay_over(&mut self, positions: [&[f64]; D], mut size: [f64; D]) {
        let ranges = positions.map(range);
        let extent = ranges.map(|(low, high)| high - low);
        // Four a particle in the plane, 16 in space, and as many as 65,536 and 262,144 at any rate.
        let most = (4_usize.pow(D as u32 - 1) * positions[0].len()).max(4_usize.pow(D as u32 + 6)) as f64;
        let cells = |size: [f64; D]| (0..D).map(|axis| (extent[axis] / size[axis]).floor() + 1.0).product::<f64>();
        while cells(size) > most {
            size = size.map(|size| 1.5 * size);
        }
        self.low = ranges.map(|range| range.0);
        self.size = size;
        self.per_size = size.map(|size| 1.0 / size);
        self.first = [0.0; D];
        self.count = std::array::from_fn(|axis| (extent[axis] * self.per_size[axis]) as usize + 1);
    }

    #[inline(always)]
    pub(crate) fn along(&self, axis: usize, value: f64) -> usize {
        // A negative number becomes 0. Taking off whole numbers is exact, so cells do not depend on the part. To 32 bits a number is converted faster.
        (((value - self.low[axis]) * self.per_size[axis] - self.first[axis]) as u32 as usize).min(self.count[axis] - 1)
    }

    /// Ranges of the sorted order that cover all particles within `reach` of a position along each axis, one a row of cells.
    #[inline(always)]
    pub fn ranges(&self, position: [f64; D], reach: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        self.rows_round(position, reach).map(move |row| self.along_row(row, position[0], reach))
    }

    /// The same of those within `reach` of it in all, from fewer cells.
    #[inline(always)]
    pub fn ranges_within(&self, position: [f64; D], reach: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        let in_ball = move |row: [usize; D]| {
            // Half of the chord that the row's nearest line cuts from the circle or the ball, with room for rounding.
            let off = |axis: usize| self.distance_along(axis, row[axis], position[axis]);
            let off_squared = (1..D).rev().map(|axis| off(axis) * off(axis));
            let half_squared = off_squared.fold(reach * reach, |left, off_squared| left - off_squared);
            if half_squared < -1e-9 * reach * reach {
                return None;
            }
            Some(self.along_row(row, position[0], half_squared.max(0.0).sqrt() + 1e-9 * reach))
        };
        self.rows_round(position, reach).filter_map(in_ball)
    }

    /// Rows of cells that come within `reach` of a position along each axis but x.
    #[inline(always)]
    fn rows_round(&self, position: [f64; D], reach: f64) -> impl Iterator<Item = [usize; D]> {
        let first: [usize; D] = std::array::from_fn(|axis| self.along(axis, position[axis] - reach));
        let last: [usize; D] = std::array::from_fn(|axis| self.along(axis, position[axis] + reach));
        std::iter::successors(Some(first), move |row| following(*row, first, last))
    }

    /// Particles of a row's cells within `half` of `x`.
    #[inline(always)]
    fn along_row(&self, row: [usize; D], x: f64, half: f64) -> Range<usize> {
        let line = (1..D).rev().fold(0, |line, axis| line * self.count[axis] + row[axis]) * self.count[0];
        let (first, last) = (self.along(0, x - half), self.along(0, x + half));
        self.start[line + first] as usize..self.start[line + last + 1] as usize
    }

    /// Distance of a coordinate from the slab of cells `cell`. The outermost slabs hold all that lies beyond, too.
    #[inline(always)]
    fn distance_along(&self, axis: usize, cell: usize, value: f64) -> f64 {
        let low = self.low[axis] + (self.first[axis] + cell as f64) * self.size[axis];
        let below = if cell == 0 { 0.0 } else { low - value };
        let above = if cell + 1 == self.count[axis] { 0.0 } else { value - (low + self.size[axis]) };
        below.max(above).max(0.0)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.start.capacity() + self.cell.capacity() + self.order.capacity())
            + 8 * (self.reach.capacity() + self.along_rows.capacity())
    }
}

/// The next row of cells, y fastest; none after the last.
#[inline(always)]
fn following<const D: usize>(mut row: [usize; D], first: [usize; D], last: [usize; D]) -> Option<[usize; D]> {
    for axis in 1..D {
        if row[axis] < last[axis] {
            row[axis] += 1;
            return Some(row);
        }
        row[axis] = first[axis];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn covers_all_within_reach<const D: usize>(positions: &[[f64; 3]], looks: &[[f64; 3]], reach: f64, size: [f64; D]) {
        let along = |axis: usize| positions.iter().map(|position| position[axis]).collect::<Vec<f64>>();
        let columns: [Vec<f64>; D] = std::array::from_fn(along);
        let mut cells = Cells::<D>::default();
        let order = cells.sort(columns.each_ref().map(|column| &column[..]), size).to_vec();
        let mut all = order.clone();
        all.sort_unstable();
        assert!(all.iter().enumerate().all(|(k, &p)| k == p as usize));
        for look in looks {
            let position: [f64; D] = std::array::from_fn(|axis| look[axis]);
            let found = |ranges: &mut dyn Iterator<Item = Range<usize>>| {
                let found: Vec<u32> = ranges.flat_map(|range| order[range].to_vec()).collect();
                assert!(found.iter().collect::<std::collections::HashSet<_>>().len() == found.len());
                found
            };
            let in_box = found(&mut cells.ranges(position, reach));
            let in_ball = found(&mut cells.ranges_within(position, reach));
            assert!(in_ball.iter().all(|number| in_box.contains(number)));
            for (j, other) in positions.iter().enumerate() {
                let apart = |axis: usize| (position[axis] - other[axis]).abs();
                let squared: f64 = (0..D).map(|axis| apart(axis).powi(2)).sum();
                assert!(squared >= reach * reach || in_ball.contains(&(j as u32)), "{position:?} {other:?}");
                assert!(
                    (0..D).any(|axis| apart(axis) >= reach) || in_box.contains(&(j as u32)),
                    "{position:?} {other:?}"
                );
            }
        }
    }

    proptest! {
        /// In a part of the room, with its own particles in another order and some of those beyond it, neighbours are those in the whole and in the same order.
        #[test]
        fn neighbours_in_a_part_are_those_in_the_whole(
            positions in prop::collection::vec(prop::array::uniform3(0.0..8.0f64), 1..300),
            corners in prop::array::uniform3((0.0..8.0f64, 0.0..8.0f64)),
            low in prop::array::uniform3(-3.0..0.0f64),
            reach in 0.3..2.0f64,
        ) {
            let part = [corners.map(|(a, b)| a.min(b)), corners.map(|(a, b)| a.max(b))];
            let is_in = |position: &[f64; 3], more: f64| {
                (0..3).all(|axis| (part[0][axis] - more..=part[1][axis] + more).contains(&position[axis]))
            };
            let all: Vec<(u64, [f64; 3])> = (0..).zip(positions).collect();
            let near: Vec<_> = all.iter().rev().copied().filter(|(_, position)| is_in(position, 1.5 * reach)).collect();
            // Identities of the neighbours of each particle of the part, in order.
            let neighbours = |of: &[(u64, [f64; 3])], bounds: [[f64; 3]; 2]| {
                let column = |axis: usize| of.iter().map(|(_, position)| position[axis]).collect::<Vec<f64>>();
                let columns: [Vec<f64>; 3] = std::array::from_fn(column);
                let mut cells = Cells::<3>::default();
                cells.sort_part(columns.each_ref().map(|column| &column[..]), Cells::<3>::sizes_for(reach), low, bounds);
                let order = cells.sort_each_cell_by(|particle| of[particle as usize].0).to_vec();
                let mut found = std::collections::BTreeMap::new();
                for (id, position) in of.iter().filter(|(_, position)| is_in(position, 0.0)) {
                    let candidates = cells.ranges_within(*position, reach).flatten().map(|at| of[order[at] as usize]);
                    let squared = |other: [f64; 3]| (0..3).map(|axis| (other[axis] - position[axis]).powi(2)).sum::<f64>();
                    let within: Vec<u64> =
                        candidates.filter(|(_, other)| squared(*other) < reach * reach).map(|(id, _)| id).collect();
                    found.insert(*id, within);
                }
                found
            };
            let with_reach = [part[0].map(|at| (at - reach).max(-3.0)), part[1].map(|at| at + reach)];
            let lowest = std::array::from_fn(|axis| with_reach[0][axis].max(low[axis]));
            prop_assert_eq!(neighbours(&near, [lowest, with_reach[1]]), neighbours(&all, [low, [8.0; 3]]));
        }

        #[test]
        fn ranges_cover_all_within_reach(
            positions in prop::collection::vec(prop::array::uniform3(-5.0..8.0f64), 1..200),
            looks in prop::collection::vec(prop::array::uniform3(-7.0..9.0f64), 1..20),
            reach in 0.2..5.0f64,
            finer in 1.0..5.0f64,
        ) {
            covers_all_within_reach::<2>(&positions, &looks, reach, [reach / finer, reach]);
            covers_all_within_reach::<3>(&positions, &looks, reach, [reach / finer, reach, reach]);
        }
    }
}
