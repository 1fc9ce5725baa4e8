//! Cells in which balls are searched.
//!
//! Two balls are compared when their cells touch. Balls much larger than most lie in coarser levels, each with cells twice as
//! wide as the level below; a ball is a member of every level above its own by its position. A cell's number is a sum of one
//! entry from a table for each axis, laid out so that cells near each other in space are near each other in memory: blocks
//! of 64 cells, interleaved within. A border of empty cells surrounds walls; across periodic sides the tables wrap round.

use crate::memory;
use crate::world::NONE;

/// Number of cells along a side of a block, as a power of two, in two and three dimensions.
const fn block_bits(dimensions: usize) -> u32 {
    if dimensions == 2 { 3 } else { 2 }
}

/// Most cells along one axis: cell coordinates are 16 bits wide.
const MOST_CELLS: usize = 60_000;

/// All levels.
#[derive(Debug)]
pub(crate) struct Grid<const D: usize> {
    /// Where the first cell begins.
    pub low: [f64; D],
    pub periodic: [bool; D],
    pub levels: Vec<Level<D>>,
    /// First ball in each cell.
    pub heads: Vec<u32>,
}

/// Cells of one size.
#[derive(Debug)]
pub(crate) struct Level<const D: usize> {
    /// Sides of a cell.
    pub size: [f64; D],
    /// Cells along each axis, without the border.
    pub count: [u16; D],
    /// What each coordinate, border included, adds to a cell's number.
    pub table: [Vec<u32>; D],
}

impl<const D: usize> Grid<D> {
    /// A grid over a box whose finest cells have sides of at least `finest`, with levels up to balls of diameter `largest`.
    /// `None` where a periodic side is shorter than three of the largest balls.
    pub fn new(
        low: [f64; D],
        length: [f64; D],
        periodic: [bool; D],
        finest: f64,
        largest: f64,
        most_cells: usize,
    ) -> Option<Self> {
        // More levels than these would be needed by no more than a handful of balls.
        let mut finest = finest.max(largest / MOST_CELLS as f64);
        if (0..D).any(|axis| periodic[axis] && length[axis] < 3.0 * largest) {
            return None;
        }
        loop {
            let mut top = 0;
            while finest * f64::from(1_u32 << top) < largest {
                top += 1;
            }
            let across = |axis: usize| {
                let coarse = (length[axis] / (finest * f64::from(1_u32 << top))).floor();
                // Of three cells each is next to the other two on one side only: no two balls are tested twice.
                let least = if periodic[axis] { 3.0 } else { 1.0 };
                (coarse.max(least) * f64::from(1_u32 << top)) as usize
            };
            let counts: [usize; D] = std::array::from_fn(across);
            let cells: f64 = counts.iter().map(|&count| count as f64).product();
            if cells > most_cells as f64 || counts.iter().any(|&count| count > MOST_CELLS) {
                finest *= 1.25;
                continue;
            }
            let mut total = 0;
            let levels = (0..=top)
                .map(|level| Level::new(length, periodic, counts.map(|count| count >> level), &mut total))
                .collect();
            return Some(Grid { low, periodic, levels, heads: memory::filled(total as usize, NONE) });
        }
    }

    /// The level for a ball of this diameter.
    pub fn level_of(&self, diameter: f64) -> u8 {
        let fits = |level: &Level<D>| level.size.iter().all(|&size| size >= diameter);
        self.levels.iter().position(fits).unwrap_or(self.levels.len() - 1) as u8
    }

    /// The cell of a position in a level; positions outside belong to the outermost cells.
    pub fn cell_of(&self, level: u8, position: &[f64; D]) -> [u16; D] {
        let level = &self.levels[level as usize];
        std::array::from_fn(|axis| {
            let cell = ((position[axis] - self.low[axis]) / level.size[axis]).floor();
            cell.clamp(0.0, f64::from(level.count[axis] - 1)) as u16 + 1
        })
    }

    /// Number of a ball's own cell.
    #[inline(always)]
    pub fn index(&self, level: u8, cell: &[u16; D]) -> usize {
        let level = &self.levels[level as usize];
        (0..D).map(|axis| level.table[axis][cell[axis] as usize]).sum::<u32>() as usize
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.heads.capacity() * 4
    }
}

impl<const D: usize> Level<D> {
    fn new(length: [f64; D], periodic: [bool; D], count: [usize; D], total: &mut u32) -> Self {
        let bits = block_bits(D);
        let side = 1_usize << bits;
        let mut stride = 1_u32 << (bits * D as u32);
        let table = std::array::from_fn(|axis| {
            let number = |cell: usize| {
                let inside =
                    (0..bits).map(|bit| ((cell >> bit & 1) as u32) << (bit * D as u32 + axis as u32)).sum::<u32>();
                inside + (cell >> bits) as u32 * stride
            };
            let mut table: Vec<u32> = (0..count[axis] + 2).map(number).collect();
            if periodic[axis] {
                table[0] = table[count[axis]];
                table[count[axis] + 1] = table[1];
            }
            stride *= (count[axis] + 2).div_ceil(side) as u32;
            table
        });
        let mut level = Level {
            size: std::array::from_fn(|axis| length[axis] / count[axis] as f64),
            count: count.map(|count| count as u16),
            table,
        };
        level.table[0].iter_mut().for_each(|entry| *entry += *total);
        *total += stride;
        level
    }

    /// True where the ball's cell touches a side of the box across which the box repeats.
    #[inline(always)]
    pub fn at_seam(&self, periodic: &[bool; D], cell: &[u16; D]) -> bool {
        (0..D).any(|axis| periodic[axis] & ((cell[axis] == 1) | (cell[axis] == self.count[axis])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_of_every_level_has_its_own_number() {
        let grid = Grid::<3>::new([0.0; 3], [13.0, 12.0, 7.0], [true, false, false], 1.0, 3.0, 1_000_000).unwrap();
        assert_eq!(grid.levels.len(), 3);
        let mut seen = std::collections::HashSet::new();
        for (number, level) in grid.levels.iter().enumerate() {
            for x in 1..=level.count[0] {
                for y in 1..=level.count[1] {
                    for z in 1..=level.count[2] {
                        let index = grid.index(number as u8, &[x, y, z]);
                        assert!(index < grid.heads.len() && seen.insert(index));
                    }
                }
            }
            assert_eq!(level.table[0][0], level.table[0][level.count[0] as usize]);
        }
    }

    #[test]
    fn a_short_periodic_side_has_no_grid() {
        assert!(Grid::<2>::new([0.0; 2], [2.9, 10.0], [true; 2], 1.0, 1.0, 1000).is_none());
        assert!(Grid::<2>::new([0.0; 2], [3.0, 10.0], [true; 2], 1.0, 1.0, 1000).is_some());
    }
}
