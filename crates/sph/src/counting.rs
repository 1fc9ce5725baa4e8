//! What cells in the plane and in space share: sorting by counting, and the range of coordinates.

use crate::FEWEST;
use rayon::prelude::*;

/// Sorts particles by their cell: `start` becomes the first particle of each cell, one entry more than cells, and `order` the
/// particles in sorted order. Stable: particles of one cell keep their order.
pub(crate) fn sort(cell_of: &[u32], cells: usize, start: &mut Vec<u32>, order: &mut Vec<u32>) {
    start.clear();
    start.resize(cells + 1, 0);
    for &cell in cell_of {
        start[cell as usize + 1] += 1;
    }
    for cell in 0..cells {
        start[cell + 1] += start[cell];
    }
    order.resize(cell_of.len(), 0);
    for (particle, &cell) in cell_of.iter().enumerate() {
        let slot = &mut start[cell as usize];
        order[*slot as usize] = particle as u32;
        *slot += 1;
    }
    // Each start has moved to its cell's end, which is the next cell's start.
    start.copy_within(0..cells, 1);
    start[0] = 0;
}

/// The smallest and the largest of some coordinates; 0 and 0 of none.
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    if values.is_empty() {
        return (0.0, 0.0);
    }
    let none = || (f64::INFINITY, f64::NEG_INFINITY);
    let ranges = values.par_iter().with_min_len(FEWEST).map(|&value| (value, value));
    ranges.reduce(none, |(low, high), (lower, higher)| (low.min(lower), high.max(higher)))
}
