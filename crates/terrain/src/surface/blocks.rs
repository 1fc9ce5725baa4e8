//! Heights on a grid, and the nodes of the surface's patches, which follow from them block by block.

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use std::sync::OnceLock;

/// A slope is at most this many times the lesser of the two one-sided differences. 3 keeps an edge of a patch monotone
/// (Fritsch and Carlson 1980); half of that keeps the inner Bezier points in range as well, as they add two slopes.
const STEEPEST: f64 = 1.5;

/// Patches along each side of a block.
pub(super) const SIDE: usize = 64;

/// Nodes in a row of a block. Those on its sides stand in the neighbouring block too, so that a patch has all its
/// nodes in one block.
pub(super) const STRIDE: usize = SIDE + 1;

/// The nodes of a block; those beyond the surface's end are 0.
pub(super) type Nodes = [Node; STRIDE * STRIDE];

/// What is known of the ground at one node, in units of cells: derivatives are differences per cell.
/// In this order two neighbouring numbers are treated equally, which the compiler turns into vector instructions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Node {
    pub height: f64,
    pub slope_y: f64,
    pub slope_x: f64,
    pub twist: f64,
}

/// A square of patches.
#[derive(Debug)]
pub(super) struct Block {
    /// Row by row from the south-west, [`STRIDE`] in a row.
    pub nodes: Box<Nodes>,
    /// For each patch the sum of the integrals over those of its row up to and with it, [`SIDE`] in a row; made when
    /// first needed.
    pub row_sums: OnceLock<Box<[f64]>>,
}

impl Block {
    pub fn new(nodes: Box<Nodes>) -> Self {
        Self { nodes, row_sums: OnceLock::new() }
    }
}

/// Heights on a grid, row by row from the south-west.
#[derive(Debug)]
pub(super) struct Heights {
    values: Values,
    /// Columns and rows.
    pub size: [usize; 2],
}

/// Numbers in single precision where it holds each of them exactly, which takes half the memory.
#[derive(Debug)]
enum Values {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

impl Heights {
    pub fn new(heights: Vec<f64>, size: [usize; 2]) -> Self {
        let is_single = |height: &f64| f64::from(*height as f32) == *height;
        let values = if heights.par_iter().with_min_len(4096).all(is_single) {
            Values::Single(heights.par_iter().with_min_len(4096).map(|height| *height as f32).collect())
        } else {
            Values::Double(heights)
        };
        Self { values, size }
    }

    /// The heights as the bytes of their numbers, row by row from the south-west.
    pub fn bytes(&self) -> &[u8] {
        match &self.values {
            Values::Single(values) => bytemuck::cast_slice(values),
            Values::Double(values) => bytemuck::cast_slice(values),
        }
    }

    /// True where they are numbers in single precision.
    pub fn is_single(&self) -> bool {
        matches!(self.values, Values::Single(_))
    }

    /// The heights of [`Heights::bytes`]; none where these are not as many numbers as the grid has nodes.
    pub fn of_bytes(bytes: &[u8], size: [usize; 2], is_single: bool) -> Option<Self> {
        let width = if is_single { size_of::<f32>() } else { size_of::<f64>() };
        if size[0].checked_mul(size[1])?.checked_mul(width)? != bytes.len() || bytes.is_empty() {
            return None;
        }
        let values = if is_single {
            Values::Single(bytemuck::pod_collect_to_vec(bytes))
        } else {
            Values::Double(bytemuck::pod_collect_to_vec(bytes))
        };
        Some(Self { values, size })
    }

    /// The nodes of the grid with one ring of nodes round it, `count` columns and rows from `first` on, row by row.
    pub fn nodes(&self, first: [usize; 2], count: [usize; 2]) -> Vec<Node> {
        // Slopes and twists follow from the heights of the nodes round them: twists from the slopes across.
        let low = first.map(|index| index.saturating_sub(1));
        let high = [0, 1].map(|axis| (first[axis] + count[axis] + 1).min(self.size[axis] + 2));
        let (width, rows) = (high[0] - low[0], high[1] - low[1]);
        let mut heights = Vec::with_capacity(width * rows);
        for row in low[1]..high[1] {
            heights.extend((low[0]..high[0]).map(|column| self.with_ring([column, row])));
        }
        let slopes = with_slopes(&heights, width, rows);
        let mut nodes = Vec::with_capacity(count[0] * count[1]);
        for row in first[1] - low[1]..first[1] - low[1] + count[1] {
            let from = row * width + first[0] - low[0];
            nodes.extend(
                (from..from + count[0])
                    .map(|index| Node { twist: limited_twist(&slopes, index, width, rows), ..slopes[index] }),
            );
        }
        nodes
    }

    /// The height at a column and row.
    #[inline]
    pub fn at(&self, column: usize, row: usize) -> f64 {
        let index = row * self.size[0] + column;
        match &self.values {
            Values::Single(values) => f64::from(values[index]),
            Values::Double(values) => values[index],
        }
    }

    /// The height at a node of the grid with one ring of nodes round it, on which the ground goes on as it ends.
    #[inline]
    pub fn with_ring(&self, [column, row]: [usize; 2]) -> f64 {
        let rows = self.size[1];
        if row == 0 {
            beyond(|step| self.with_ends(column, step), rows)
        } else if row > rows {
            beyond(|step| self.with_ends(column, rows - 1 - step), rows)
        } else {
            self.with_ends(column, row - 1)
        }
    }

    /// The height in a row of the grid with one node more at both its ends.
    #[inline]
    fn with_ends(&self, column: usize, row: usize) -> f64 {
        let columns = self.size[0];
        if column == 0 {
            beyond(|step| self.at(step, row), columns)
        } else if column > columns {
            beyond(|step| self.at(columns - 1 - step, row), columns)
        } else {
            self.at(column - 1, row)
        }
    }
}

/// The height one node beyond the end of a line of `length`, whose heights `line` gives from the end on: with the lesser
/// of the last two differences, so that a cliff at the edge does not dig a pit beyond it.
fn beyond(line: impl Fn(usize) -> f64, length: usize) -> f64 {
    let [last, before, third] = [0, 1.min(length - 1), 2.min(length - 1)].map(line);
    last + if length > 2 { lesser(last - before, before - third) } else { last - before }
}

/// The one nearer to 0 where both have the same sign, else 0.
fn lesser(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 { 0.0 } else { a.signum() * a.abs().min(b.abs()) }
}

/// The slope at a node, from the differences before and after it: the mean, limited.
fn limited(before: f64, after: f64) -> f64 {
    lesser(0.5 * (before + after), STEEPEST * lesser(before, after))
}

/// Heights with limited slopes, without twists.
fn with_slopes(heights: &[f64], stride: usize, rows: usize) -> Vec<Node> {
    // Beyond the grid's ends the ground goes on with the last difference.
    let difference = |index: usize, step: usize, position: usize, length: usize| {
        let after = (position + 1 < length).then(|| heights[index + step] - heights[index]);
        let before = (position > 0).then(|| heights[index] - heights[index - step]);
        (before.or(after).unwrap_or(0.0), after.or(before).unwrap_or(0.0))
    };
    let node = |index: usize| {
        let (west, east) = difference(index, 1, index % stride, stride);
        let (south, north) = difference(index, stride, index / stride, rows);
        Node { height: heights[index], slope_x: limited(west, east), slope_y: limited(south, north), twist: 0.0 }
    };
    (0..heights.len()).map(node).collect()
}

/// The twist at a node: the central difference of the y-slopes along x, limited so that the inner Bezier point next to
/// this node in each of the four patches round it stays between the lowest and the highest corner of that patch.
fn limited_twist(nodes: &[Node], index: usize, stride: usize, rows: usize) -> f64 {
    let (column, row) = (index % stride, index / stride);
    if column == 0 || column + 1 == stride || row == 0 || row + 1 == rows {
        return 0.0;
    }
    let node = nodes[index];
    let along_x = nodes[index + 1].slope_y - nodes[index - 1].slope_y;
    let along_y = nodes[index + stride].slope_x - nodes[index - stride].slope_x;
    let mut twist = 0.25 * (along_x + along_y);
    for (sx, sy) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let beside = if sx > 0.0 { index + 1 } else { index - 1 };
        let shift = |i: usize| if sy > 0.0 { i + stride } else { i - stride };
        let corners = [index, beside, shift(index), shift(beside)].map(|i| nodes[i].height);
        let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Bezier point: height + sx slope_x / 3 + sy slope_y / 3 + sx sy twist / 9.
        let without = node.height + (sx * node.slope_x + sy * node.slope_y) / 3.0;
        let sign = sx * sy;
        let [least, most] = [(low - without) * 9.0, (high - without) * 9.0].map(|bound| bound * sign);
        // 0 always lies between the two, but for rounding: `STEEPEST` sees to it.
        twist = twist.max(least.min(most).min(0.0)).min(least.max(most).max(0.0));
    }
    twist
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nodes are the same whatever part of the grid is asked for.
        #[test]
        fn a_part_has_the_nodes_of_the_whole(
            noise in prop::collection::vec(-1.0..1.0_f64, 70),
            first in [0..11_usize, 0..8_usize],
            count in [1..12_usize, 1..9_usize],
        ) {
            // On a slope: where heights go up and down at each node, all slopes and twists are 0.
            let slope = |index: usize| {
                let [x, y] = [index % 10, index / 10].map(|node| node as f64);
                0.3 * x * x + 0.2 * x * y + 0.4 * y * y
            };
            let heights = noise.iter().enumerate().map(|(index, noise)| slope(index) + noise).collect();
            let grid = Heights::new(heights, [10, 7]);
            let whole = grid.nodes([0, 0], [12, 9]);
            let count = [count[0].min(12 - first[0]), count[1].min(9 - first[1])];
            let part = grid.nodes(first, count);
            for (index, node) in part.iter().enumerate() {
                let [column, row] = [first[0] + index % count[0], first[1] + index / count[0]];
                prop_assert_eq!(*node, whole[row * 12 + column]);
            }
        }
    }

    #[test]
    fn heights_are_kept_exactly_in_as_few_bytes_as_hold_them() {
        let single = Heights::new(vec![0.5, 1.25, -3.0, 0.0], [2, 2]);
        let double = Heights::new(vec![0.5, 1.25, -3.1, 0.0], [2, 2]);
        assert!(matches!(single.values, Values::Single(_)));
        assert!(matches!(double.values, Values::Double(_)));
        assert_eq!([single.at(0, 1), double.at(0, 1)], [-3.0, -3.1]);
    }
}
