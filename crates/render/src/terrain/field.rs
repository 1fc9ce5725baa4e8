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
        let node = |index: usize| [index % nodes[0], index / nodes[0]];
        let heights = (0..nodes[0] * nodes[1])
            .map(node)
            .map(|[column, row]| height(west + column as f64 * cell[0], south + row as f64 * cell[1]) as f32);
        Self { origin: [west, south], cell, nodes, heights: heights.collect() }
    }

    /// Lowest and highest height, m.
    pub fn range(&self) -> [f64; 2] {
        let finite = || self.heights.iter().copied().filter(|height| height.is_finite());
        let [low, high] = [finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max)];
        if low <= high { [f64::from(low), f64::from(high)] } else { [0.0, 0.0] }
    }

    /// Rise `[eastwards, northwards]` of the quad round a position, m per m; of the nearest for positions outside, and level where there
    /// is no ground.
    pub fn slope_at(&self, position: [f64; 2]) -> [f64; 2] {
        let quad = [0, 1].map(|k| {
            let at = (position[k] - self.origin[k]) / self.cell[k];
            (at.max(0.0) as usize).min(self.nodes[k] - 2)
        });
        let node =
            |east: usize, north: usize| f64::from(self.heights[(quad[1] + north) * self.nodes[0] + quad[0] + east]);
        let east = 0.5 * (node(1, 0) - node(0, 0) + node(1, 1) - node(0, 1)) / self.cell[0];
        let north = 0.5 * (node(0, 1) - node(0, 0) + node(1, 1) - node(1, 0)) / self.cell[1];
        [east, north].map(|slope| if slope.is_finite() { slope } else { 0.0 })
    }

    /// Where a node is, m.
    pub fn position(&self, index: usize) -> [f64; 2] {
        let at = [index % self.nodes[0], index / self.nodes[0]];
        [0, 1].map(|k| self.origin[k] + self.cell[k] * at[k] as f64)
    }

    /// True for a quad, by its south-western node, that has heights at all four corners.
    fn has_ground(&self, [column, row]: [usize; 2]) -> bool {
        let first = row * self.nodes[0] + column;
        [first, first + 1, first + self.nodes[0], first + self.nodes[0] + 1]
            .iter()
            .all(|index| self.heights[*index].is_finite())
    }

    /// Edges of quads with ground, beyond which there is none.
    pub(super) fn edges(&self) -> Vec<Edge> {
        let [columns, rows] = self.nodes;
        let ground =
            |column: usize, row: usize| column + 1 < columns && row + 1 < rows && self.has_ground([column, row]);
        let mut edges = Vec::new();
        for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
            if !ground(column, row) {
                continue;
            }
            let south_west = row * columns + column;
            let north_west = south_west + columns;
            let sides = [
                (row == 0 || !ground(column, row - 1), [south_west, south_west + 1], [0.0, -1.0]),
                (!ground(column, row + 1), [north_west, north_west + 1], [0.0, 1.0]),
                (column == 0 || !ground(column - 1, row), [south_west, north_west], [-1.0, 0.0]),
                (!ground(column + 1, row), [south_west + 1, north_west + 1], [1.0, 0.0]),
            ];
            edges.extend(sides.into_iter().filter(|side| side.0).map(|(_, nodes, outwards)| Edge { nodes, outwards }));
        }
        edges
    }

    /// Heights with those of the nearest nodes, by steps along rows and columns, where there are none.
    pub(super) fn filled(&self) -> Vec<f32> {
        let mut heights = self.heights.clone();
        let mut front: Vec<usize> = (0..heights.len()).filter(|index| heights[*index].is_finite()).collect();
        if front.len() == heights.len() {
            return heights;
        }
        let mut next = Vec::new();
        while !front.is_empty() {
            for index in front.drain(..) {
                for near in self.neighbours(index) {
                    if !heights[near].is_finite() {
                        heights[near] = heights[index];
                        next.push(near);
                    }
                }
            }
            std::mem::swap(&mut front, &mut next);
        }
        heights
    }

    /// Nodes beside a node: west, east, south, north.
    fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.nodes;
        let (column, row) = (index % columns, index / columns);
        [
            (column > 0, index.wrapping_sub(1)),
            (column + 1 < columns, index + 1),
            (row > 0, index.wrapping_sub(columns)),
            (row + 1 < rows, index + columns),
        ]
        .into_iter()
        .filter_map(|(is_there, near)| is_there.then_some(near))
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

/// An edge at which the ground ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub nodes: [usize; 2],
    /// The direction away from the ground.
    pub outwards: [f32; 2],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_ends_at_its_border_and_round_what_is_missing() {
        let whole = HeightField::sampled([0.0; 2], [4.0, 3.0], [5, 4], |x, y| x + 10.0 * y);
        assert_eq!(whole.edges().len(), 14);
        assert_eq!(whole.filled(), whole.heights);
        let mut holed = whole.clone();
        holed.heights[6] = f32::NAN;
        // The four quads round it go, two sides of the border with each of three of them; two sides of four quads come.
        assert_eq!(holed.edges().len(), 14);
        assert!(holed.edges().iter().all(|edge| !edge.nodes.contains(&6)));
        assert!(holed.filled().iter().all(|height| height.is_finite()));
        let none = HeightField { heights: vec![f32::NAN; 20], ..whole };
        assert_eq!((none.edges().len(), none.filled().len()), (0, 20));
    }

    #[test]
    fn slopes_of_a_plane_are_the_planes() {
        let field = HeightField::sampled([1e6, 5.0], [1e6 + 40.0, 25.0], [5, 3], |x, y| 0.5 * (x - 1e6) - 0.25 * y);
        for index in 0..15 {
            let [east, north] = field.slope(index);
            assert!((east - 0.5).abs() < 1e-5 && (north + 0.25).abs() < 1e-5, "{index}: {east} {north}");
        }
        assert_eq!(field.range(), [-6.25, 18.75]);
        for position in [[1e6 + 3.0, 7.0], [1e6 + 40.0, 25.0], [0.0, 1e9]] {
            let [east, north] = field.slope_at(position);
            assert!((east - 0.5).abs() < 1e-5 && (north + 0.25).abs() < 1e-5, "{position:?}: {east} {north}");
        }
    }
}
