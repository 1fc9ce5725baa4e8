//! Search for drops near a position, small and large ones.

/// Drops (or patches) filed by position, each in cells as wide as it is or up to twice as wide: a level for each power of two of their
/// reach. A drop is searched in the cells of each level that it may reach from.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    smallest: f64,
    levels: u32,
    /// Where the drops of each bucket begin in `filed`; cells share buckets by a hash.
    starts: Vec<u32>,
    filed: Vec<u32>,
}

impl Grid {
    /// Files drops at these positions by their reach.
    pub fn new(positions: impl Iterator<Item = [f64; 3]>, reach: &[f64]) -> Self {
        let smallest = reach.iter().copied().fold(f64::INFINITY, f64::min);
        let buckets = (2 * reach.len()).next_power_of_two();
        let mut grid = Self { smallest, levels: 0, starts: vec![0; buckets + 1], filed: vec![0; reach.len()] };
        let buckets_of: Vec<usize> = positions
            .zip(reach)
            .map(|(position, &reach)| {
                let level = grid.level(reach);
                grid.levels = grid.levels.max(level + 1);
                grid.bucket(level, grid.cell(level, position))
            })
            .collect();
        buckets_of.iter().for_each(|&bucket| grid.starts[bucket + 1] += 1);
        for bucket in 0..buckets {
            grid.starts[bucket + 1] += grid.starts[bucket];
        }
        let mut next = grid.starts.clone();
        for (drop, &bucket) in buckets_of.iter().enumerate() {
            grid.filed[next[bucket] as usize] = drop as u32;
            next[bucket] += 1;
        }
        grid
    }

    /// The smallest reach of what is filed; infinite where nothing is.
    pub fn smallest(&self) -> f64 {
        self.smallest
    }

    /// The first level whose cells are wide enough for a drop of this reach.
    fn level(&self, reach: f64) -> u32 {
        (reach / self.smallest).log2().ceil().max(0.0) as u32
    }

    /// Side of a level's cells: twice the largest reach of its drops.
    fn side(&self, level: u32) -> f64 {
        2.0 * self.smallest * f64::from(level).exp2()
    }

    fn cell(&self, level: u32, position: [f64; 3]) -> [i64; 3] {
        let side = self.side(level);
        position.map(|x| (x / side).floor() as i64)
    }

    fn bucket(&self, level: u32, [x, y, z]: [i64; 3]) -> usize {
        // Large odd numbers without pattern, as usual for hashing cells (Teschner et al. 2003).
        let mixed = (x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791))
            .wrapping_add(i64::from(level).wrapping_mul(2_654_435_761));
        mixed as usize & (self.starts.len() - 2)
    }

    /// Calls `found` with drops of at least `from_reach`, among them all whose reach and `reach` together span the way from
    /// `position` to them. Some may be far, and some come twice.
    pub fn near(&self, position: [f64; 3], reach: f64, from_reach: f64, mut found: impl FnMut(usize)) {
        if self.filed.is_empty() {
            return;
        }
        for level in self.level(from_reach)..self.levels {
            let around = reach + 0.5 * self.side(level);
            let low = self.cell(level, position.map(|x| x - around));
            let high = self.cell(level, position.map(|x| x + around));
            let cells: f64 = (0..3).map(|axis| (high[axis] - low[axis] + 1) as f64).product();
            if cells > self.filed.len() as f64 {
                return (0..self.filed.len()).for_each(found);
            }
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    for x in low[0]..=high[0] {
                        let bucket = self.bucket(level, [x, y, z]);
                        let filed = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
                        self.filed[filed].iter().for_each(|&drop| found(drop as usize));
                    }
                }
            }
        }
    }
}
