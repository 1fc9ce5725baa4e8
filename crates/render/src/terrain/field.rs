//! Heights on a grid.

/// Heights of the ground at the nodes of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    /// The south-western node, m.
    pub origin: [f64; 2],
    /// Distance of nodes `[eastwards, northwards]`, m.
    pub cell: [f64; 2],
    /// Nodes `[eastwards, northwards]`, at least 2 each.
    pub nodes: [usize; 2],
    /// Heights, m, row by row from the south, each from the west; not-a-number where there is none.
    pub heights: Vec<f32>,
}

impl HeightField {
    /// Heights that a function gives at nodes from the south-western to the north-eastern corner, m.
    pub fn sampled(
        [west, south]: [f64; 2],
        [east, north]: [f64; 2],
        nodes: [usize; 2],
        height: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let nodes = nodes.map(|count| count.max(2));
        let cell = [(east - west) / (nodes[0] - 1) as f64, (north - south) / (nodes[1] - 1) as f64];
        let place = |index: usize| [index % nodes[0], index / nodes[0]];
        let heights = (0..nodes[0] * nodes[1])
            .map(place)
            .map(|[column, row]| height(west + column as f64 * cell[0], south + row as f64 * cell[1]) as f32);
        Self { origin: [west, south], cell, nodes, heights: heights.collect() }
    }

    /// Lowest and highest height, m.
    pub fn range(&self) -> [f64; 2] {
        let finite = || self.heights.iter().copied().filter(|height| height.is_finite());
        let [low, high] = [finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max)];
        if low <= high { [f64::from(low), f64::from(high)] } else { [0.0, 0.0] }
    }

    /// Nodes as a texture's size.
    pub(super) fn size(&self) -> [u32; 2] {
        self.nodes.map(|count| count as u32)
    }

    /// Rise `[eastwards, northwards]` at a node, m per m, by central differences; level beside a node without height.
    pub(super) fn slope(&self, index: usize) -> [f32; 2] {
        let [columns, rows] = self.nodes;
        let (column, row) = (index % columns, index / columns);
        let difference = |before: usize, after: usize, length: f64| {
            let steps = if before == index || after == index { 1.0 } else { 2.0 };
            let slope = f64::from(self.heights[after] - self.heights[before]) / (steps * length);
            if slope.is_finite() { slope as f32 } else { 0.0 }
        };
        let west = if column > 0 { index - 1 } else { index };
        let east = if column + 1 < columns { index + 1 } else { index };
        let south = if row > 0 { index - columns } else { index };
        let north = if row + 1 < rows { index + columns } else { index };
        [difference(west, east, self.cell[0]), difference(south, north, self.cell[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_of_a_plane_are_the_planes() {
        let field = HeightField::sampled([1e6, 5.0], [1e6 + 40.0, 25.0], [5, 3], |x, y| 0.5 * (x - 1e6) - 0.25 * y);
        for index in 0..15 {
            let [east, north] = field.slope(index);
            assert!((east - 0.5).abs() < 1e-5 && (north + 0.25).abs() < 1e-5, "{index}: {east} {north}");
        }
        assert_eq!(field.range(), [-6.25, 18.75]);
    }
}
