//! Squares of the terrain, each with a level: how often the spacing is halved there for the water.

use super::grading::BAND;
use super::layout::Layout;

/// Side of a block, in spacings where cells are not finer. Bands round a block are narrower than this.
const SIDE: f64 = 4.0;

/// Levels of the blocks of a terrain.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Blocks {
    /// South-west corner of the terrain, m.
    low: [f64; 2],
    /// Size of a block, m.
    size: [f64; 2],
    /// Blocks along x and y.
    count: [usize; 2],
    /// The spacing where cells are not finer, m.
    spacing: f64,
    /// Row by row.
    levels: Vec<u8>,
}

impl Blocks {
    /// Blocks over all tiles of a layout, a whole number in each, with level 0.
    pub fn new(layout: &Layout) -> Self {
        let spacing = layout.spacing();
        let a_tile = layout.tile.map(|size| (size / (SIDE * spacing)).round().max(1.0));
        let size = [0, 1].map(|axis| layout.tile[axis] / a_tile[axis]);
        let count = [0, 1].map(|axis| layout.tiles[axis] * a_tile[axis] as usize);
        let low = [layout.bounds.x_min, layout.bounds.y_min];
        Self { low, size, count, spacing, levels: vec![0; count[0] * count[1]] }
    }

    /// The same blocks with levels given by number, 0 for the others; none where there is no such block.
    pub fn with(&self, levels: &[(u32, u8)]) -> Option<Self> {
        let mut blocks = self.cleared();
        for &(block, level) in levels {
            *blocks.levels.get_mut(block as usize)? = level;
        }
        Some(blocks)
    }

    /// The same blocks with level 0.
    pub fn cleared(&self) -> Self {
        Self { levels: vec![0; self.levels.len()], ..self.clone() }
    }

    /// The blocks whose level is not 0, by number, and their levels.
    pub fn finer(&self) -> Vec<(u32, u8)> {
        let all = self.levels.iter().enumerate().filter(|(_, level)| **level > 0);
        all.map(|(block, level)| (block as u32, *level)).collect()
    }

    /// The level of each block, row by row.
    pub fn levels(&self) -> &[u8] {
        &self.levels
    }

    /// The same, to be changed.
    pub fn levels_mut(&mut self) -> &mut [u8] {
        &mut self.levels
    }

    /// The highest level.
    pub fn finest(&self) -> u8 {
        self.levels.iter().copied().max().unwrap_or(0)
    }

    /// Blocks with level 1 where the levels of two differ, 0 elsewhere.
    pub fn difference(&self, other: &Self) -> Self {
        let level = |(block, level): (usize, &u8)| u8::from(other.levels.get(block).copied().unwrap_or(0) != *level);
        Self { levels: self.levels.iter().enumerate().map(level).collect(), ..self.clone() }
    }

    /// South-west and north-east corner of a block, m.
    pub fn corners(&self, block: usize) -> [[f64; 2]; 2] {
        let index = [block % self.count[0], block / self.count[0]];
        [0.0, 1.0].map(|next| [0, 1].map(|axis| self.low[axis] + (index[axis] as f64 + next) * self.size[axis]))
    }

    /// Middle of a block, m.
    pub fn middle(&self, block: usize) -> [f64; 2] {
        let [low, high] = self.corners(block);
        [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
    }

    /// Number of the block that holds a position; none outside.
    pub fn at(&self, at: [f64; 2]) -> Option<usize> {
        let position = [0, 1].map(|axis| (at[axis] - self.low[axis]) / self.size[axis]);
        let inside = (0..2).all(|axis| position[axis] >= 0.0 && position[axis] < self.count[axis] as f64);
        inside.then(|| position[1] as usize * self.count[0] + position[0] as usize)
    }

    /// Size of a block, m.
    pub fn size(&self) -> [f64; 2] {
        self.size
    }

    /// About how many points a block has where cells are not finer.
    pub fn points(&self) -> f64 {
        self.size[0] * self.size[1] / (self.spacing * self.spacing)
    }

    /// How far beyond a block cells may be finer for its sake, m.
    pub fn band(&self) -> f64 {
        0.5 * BAND * self.spacing
    }

    /// The highest level required within `reach` m of a position. Round a block it falls by one after each [`BAND`] spacings.
    pub fn level_within(&self, at: [f64; 2], reach: f64) -> u8 {
        if self.levels.is_empty() {
            return 0;
        }
        let far = reach + self.band();
        let span = |axis: usize| {
            let index = |x: f64| ((x - self.low[axis]) / self.size[axis]).floor();
            let last = self.count[axis] as f64 - 1.0;
            let (from, to) = (index(at[axis] - far).max(0.0), index(at[axis] + far).min(last));
            // No block where the position is farther outside than that.
            if from > to { 0..0 } else { from as usize..to as usize + 1 }
        };
        let mut highest = 0;
        for row in span(1) {
            for column in span(0) {
                let level = self.levels[row * self.count[0] + column];
                if level > highest {
                    let beyond = self.distance([column, row], at) - reach;
                    highest = highest.max(lowered(level, beyond, self.spacing));
                }
            }
        }
        highest
    }

    /// Distance of a position from a block, m; 0 inside.
    fn distance(&self, index: [usize; 2], at: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|axis| {
            let low = self.low[axis] + index[axis] as f64 * self.size[axis];
            (low - at[axis]).max(at[axis] - low - self.size[axis]).max(0.0)
        });
        x.hypot(y)
    }
}

/// The level `beyond` m outside a part with a level, where the spacing of level 0 is `spacing` m.
pub(crate) fn lowered(level: u8, beyond: f64, spacing: f64) -> u8 {
    if beyond <= 0.0 {
        return level;
    }
    let own = spacing / f64::from(1 << level);
    let steps = (1.0 + beyond / (BAND * own)).log2().ceil();
    level.saturating_sub(steps.min(255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;

    /// Where the level falls, and that no band is missed at the side of the blocks that are tested.
    #[test]
    fn levels_fall_by_one_at_a_time() {
        let bounds = Bounds { x_min: -3.0, x_max: 97.0, y_min: 5.0, y_max: 45.0 };
        let layout = Layout::new(bounds, [false; 2], 1.0, 1);
        let mut blocks = Blocks::new(&layout);
        let block = blocks.at([50.0, 25.0]).unwrap();
        blocks.levels_mut()[block] = 3;
        let [x, y] = blocks.middle(block);
        let side = x + 0.5 * blocks.size[0];
        let spacing = layout.spacing();
        for (away, level) in [(-0.1, 3), (0.1, 2), (0.9, 2), (1.1, 1), (2.9, 1), (3.1, 0), (40.0, 0)] {
            assert_eq!(blocks.level_within([side + away * spacing, y], 0.0), level, "{away}");
            assert_eq!(blocks.level_within([side + (away + 2.0) * spacing, y], 2.0 * spacing), level, "{away}");
        }
        assert_eq!(blocks.finer(), [(block as u32, 3)]);
        assert_eq!(blocks.cleared().with(&blocks.finer()), Some(blocks.clone()));
        assert_eq!(blocks.at([97.1, 20.0]), None);
        assert_eq!(blocks.with(&[(u32::MAX, 1)]), None);
    }
}
