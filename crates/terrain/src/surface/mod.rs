//! Smooth ground through heights on a regular grid.
//!
//! A bicubic Hermite surface: every node carries its height, its two slopes and its twist, and each patch between four
//! nodes is a cubic in both directions, so heights and slopes are continuous everywhere. Slopes and twists are limited
//! so that all sixteen Bezier points of a patch lie between the lowest and the highest of its four nodes (convex hull
//! property of Bernstein polynomials): the surface never over- or undershoots the data, makes no pits and no bumps of
//! its own, and is exact for a plane.

mod mean;

use crate::Bounds;
use bytemuck::{Pod, Zeroable};
use corpuscle_simd::{LANES, Lanes, Simd, SimdBase, transposed};
use rayon::prelude::*;
use std::sync::OnceLock;

/// A slope is at most this many times the lesser of the two one-sided differences. 3 keeps an edge of a patch monotone
/// (Fritsch and Carlson 1980); half of that keeps the inner Bezier points in range as well, as they add two slopes.
const STEEPEST: f64 = 1.5;

/// What is known of the ground at one node, in units of cells: derivatives are differences per cell.
/// In this order two neighbouring numbers are treated equally, which the compiler turns into vector instructions.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct Node {
    height: f64,
    slope_y: f64,
    slope_x: f64,
    twist: f64,
}

/// A smooth surface as the nodes of its bicubic Hermite patches, in single precision.
#[derive(Debug, Clone)]
pub struct GroundPatches {
    /// Height above the requested level, m, and its derivatives along y, along x and along both, m per cell; row by row from the
    /// south-west.
    pub nodes: Vec<[f32; 4]>,
    /// Nodes in a row, and rows.
    pub size: [usize; 2],
    /// Place of the first node in model coordinates, m.
    pub corner: [f64; 2],
    /// Nodes per metre along x and y.
    pub per_metre: [f64; 2],
}

/// Nodes of a formula's patches, along each side of a cell of its maps.
const NODES_A_CELL: f64 = 4.0;

/// Nodes along a side at most.
const MOST_NODES: f64 = 4096.0;

impl GroundPatches {
    /// Patches through a formula, which gives height and slope at a place, over `bounds`.
    pub(crate) fn of_function(
        bounds: Bounds,
        cell: [f64; 2],
        level: f64,
        ground: &(impl Fn(f64, f64) -> (f64, [f64; 2]) + Sync),
    ) -> Self {
        let lengths = bounds.size();
        let patches =
            [0, 1].map(|axis| (NODES_A_CELL * lengths[axis] / cell[axis]).ceil().clamp(1.0, MOST_NODES - 1.0));
        let [dx, dy] = [0, 1].map(|axis| lengths[axis] / patches[axis]);
        let size = patches.map(|patches| patches as usize + 1);
        let node = |index: usize| {
            let (x, y) = (bounds.x_min + dx * (index % size[0]) as f64, bounds.y_min + dy * (index / size[0]) as f64);
            let (height, [east, north]) = ground(x, y);
            // The twist is the slope along y, followed along x.
            let [before, after] = [x - 1e-3 * dx, x + 1e-3 * dx].map(|x| x.clamp(bounds.x_min, bounds.x_max));
            let twist = (ground(after, y).1[1] - ground(before, y).1[1]) / (after - before);
            [height - level, north * dy, east * dx, twist * dx * dy].map(|value| value as f32)
        };
        let nodes = (0..size[0] * size[1]).into_par_iter().with_min_len(4096).map(node).collect();
        Self { nodes, size, corner: [bounds.x_min, bounds.y_min], per_metre: [1.0 / dx, 1.0 / dy] }
    }
}

/// A smooth surface through heights on a regular grid.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// Nodes of the grid and one ring round it, row by row from the south-west.
    nodes: Vec<Node>,
    /// Nodes in a row, ring included.
    stride: usize,
    /// Patches in each direction.
    patches: [usize; 2],
    /// Place of the south-west node of the ring.
    corner: [f64; 2],
    /// Nodes per metre.
    per_metre: [f64; 2],
    /// For each row of patches the running sums of their integrals, made when first needed.
    row_sums: Vec<OnceLock<Box<[f64]>>>,
}

impl Surface {
    /// The surface through `heights`, `columns` by `rows`, row by row from the south-west, the first at `first`,
    /// neighbours `cell` apart. It reaches one cell beyond the outermost nodes, going on as it ends there.
    pub(crate) fn new(heights: &[f64], [columns, rows]: [usize; 2], first: [f64; 2], cell: [f64; 2]) -> Self {
        assert!(columns > 0 && rows > 0 && heights.len() == columns * rows, "a surface needs all its heights");
        let padded = with_ring(heights, [columns, rows]);
        let stride = columns + 2;
        Self {
            nodes: nodes(&padded, stride, rows + 2),
            stride,
            patches: [columns + 1, rows + 1],
            corner: [first[0] - cell[0], first[1] - cell[1]],
            per_metre: [1.0 / cell[0], 1.0 / cell[1]],
            row_sums: vec![OnceLock::new(); rows + 1],
        }
    }

    /// The nodes for a device that has single precision only: heights above `level`.
    pub(crate) fn patches_above(&self, level: f64) -> GroundPatches {
        let above =
            |node: &Node| [node.height - level, node.slope_y, node.slope_x, node.twist].map(|value| value as f32);
        GroundPatches {
            nodes: self.nodes.par_iter().with_min_len(4096).map(above).collect(),
            size: [self.stride, self.patches[1] + 1],
            corner: self.corner,
            per_metre: self.per_metre,
        }
    }

    /// Height and slope `[dz/dx, dz/dy]`; the nearest edge's outside the ring. Never panics.
    #[inline]
    pub(crate) fn height_and_slope(&self, x: f64, y: f64) -> (f64, [f64; 2]) {
        let (column, u) = patch((x - self.corner[0]) * self.per_metre[0], self.patches[0]);
        let (row, v) = patch((y - self.corner[1]) * self.per_metre[1], self.patches[1]);
        let south = row * self.stride + column;
        let north = south + self.stride;
        let (south_west, south_east) = pair(&self.nodes, south);
        let (north_west, north_east) = pair(&self.nodes, north);
        let (bu, du) = hermite(u);
        let (bv, dv) = hermite(v);
        // Along the two sides that run in x: height and y-slope, and their x-derivatives.
        let [south_height, south_slope] = along(&bu, south_west, south_east);
        let [north_height, north_slope] = along(&bu, north_west, north_east);
        let [south_dx, south_twist] = along(&du, south_west, south_east);
        let [north_dx, north_twist] = along(&du, north_west, north_east);
        let across = |w: &[f64; 4], p: f64, q: f64, dp: f64, dq: f64| w[0] * p + w[1] * q + w[2] * dp + w[3] * dq;
        let height = across(&bv, south_height, north_height, south_slope, north_slope);
        let slope_x = across(&bv, south_dx, north_dx, south_twist, north_twist);
        let slope_y = across(&dv, south_height, north_height, south_slope, north_slope);
        (height, [slope_x * self.per_metre[0], slope_y * self.per_metre[1]])
    }

    /// [`Self::height_and_slope`] at [`LANES`] places at once, to the same bits: height, dz/dx, dz/dy.
    #[inline(always)]
    pub(crate) fn heights_and_slopes<S: Simd>(&self, simd: S, x: Lanes<S>, y: Lanes<S>) -> [Lanes<S>; 3] {
        let (columns, u) = patches(simd, (x - self.corner[0]) * self.per_metre[0], self.patches[0]);
        let (rows, v) = patches(simd, (y - self.corner[1]) * self.per_metre[1], self.patches[1]);
        // Two neighbours in a row make eight numbers: west's and east's height, y-slope, x-slope and twist.
        let numbers: &[f64] = bytemuck::must_cast_slice(&self.nodes);
        let pairs = |north: usize| {
            transposed(std::array::from_fn(
                #[inline(always)]
                |lane| {
                    let west = 4 * ((rows[lane] + north) * self.stride + columns[lane]);
                    Lanes::from_slice(simd, &numbers[west..west + LANES])
                },
            ))
        };
        let (south, north) = (pairs(0), pairs(1));
        let (bu, du) = hermite_lanes(u);
        let (bv, dv) = hermite_lanes(v);
        let [south_height, south_slope] = along_lanes(&bu, &south);
        let [north_height, north_slope] = along_lanes(&bu, &north);
        let [south_dx, south_twist] = along_lanes(&du, &south);
        let [north_dx, north_twist] = along_lanes(&du, &north);
        let height = weighted(&bv, [south_height, north_height, south_slope, north_slope]);
        let slope_x = weighted(&bv, [south_dx, north_dx, south_twist, north_twist]);
        let slope_y = weighted(&dv, [south_height, north_height, south_slope, north_slope]);
        [height, slope_x * self.per_metre[0], slope_y * self.per_metre[1]]
    }
}

/// [`patch`] lane by lane.
#[inline(always)]
fn patches<S: Simd>(simd: S, position: Lanes<S>, patches: usize) -> ([usize; LANES], Lanes<S>) {
    let position = position.max(0.0).min(patches as f64);
    let places: [f64; LANES] = position.into();
    let index = places.map(|place| (place as usize).min(patches - 1));
    (index, position - Lanes::from_fn(simd, |lane| index[lane] as f64))
}

/// [`hermite`] lane by lane.
#[inline(always)]
fn hermite_lanes<S: Simd>(t: Lanes<S>) -> ([Lanes<S>; 4], [Lanes<S>; 4]) {
    let s = 1.0 - t;
    let right = t * t * (3.0 - 2.0 * t);
    let rise = 6.0 * t * s;
    ([1.0 - right, right, t * s * s, -t * t * s], [-rise, rise, s * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)])
}

/// [`along`] lane by lane.
#[inline(always)]
fn along_lanes<S: Simd>(weights: &[Lanes<S>; 4], pair: &[Lanes<S>; LANES]) -> [Lanes<S>; 2] {
    let [west_height, west_slope_y, west_slope_x, west_twist, east_height, east_slope_y, east_slope_x, east_twist] =
        *pair;
    [
        weighted(weights, [west_height, east_height, west_slope_x, east_slope_x]),
        weighted(weights, [west_slope_y, east_slope_y, west_twist, east_twist]),
    ]
}

#[inline(always)]
fn weighted<S: Simd>(w: &[Lanes<S>; 4], [p, q, dp, dq]: [Lanes<S>; 4]) -> Lanes<S> {
    w[0] * p + w[1] * q + w[2] * dp + w[3] * dq
}

/// Two neighbours in a row.
#[inline]
fn pair(nodes: &[Node], index: usize) -> (&Node, &Node) {
    let pair = &nodes[index..index + 2];
    (&pair[0], &pair[1])
}

/// Height and y-slope between two neighbours in a row, with Hermite weights for the heights and the x-slopes.
#[inline]
fn along(weights: &[f64; 4], west: &Node, east: &Node) -> [f64; 2] {
    [
        weights[0] * west.height + weights[1] * east.height + weights[2] * west.slope_x + weights[3] * east.slope_x,
        weights[0] * west.slope_y + weights[1] * east.slope_y + weights[2] * west.twist + weights[3] * east.twist,
    ]
}

/// The patch in which a grid coordinate lies and the place in it, 0 to 1; the outermost patches' outer sides beyond.
#[inline]
fn patch(position: f64, patches: usize) -> (usize, f64) {
    let position = position.max(0.0).min(patches as f64);
    // Truncation is floor here, and not-a-number has become 0.
    let index = (position as usize).min(patches - 1);
    (index, position - index as f64)
}

/// Cubic Hermite weights at `t` of (left value, right value, left slope, right slope), and their derivatives.
#[inline]
fn hermite(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let right = t * t * (3.0 - 2.0 * t);
    let rise = 6.0 * t * s;
    ([1.0 - right, right, t * s * s, -t * t * s], [-rise, rise, s * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)])
}

/// The heights with one ring of cells round them in which the ground goes on as it ends: with the lesser of the last
/// two differences, so that a cliff at the edge does not dig a pit beyond it.
fn with_ring(heights: &[f64], [columns, rows]: [usize; 2]) -> Vec<f64> {
    let beyond = |line: &dyn Fn(usize) -> f64, length: usize| {
        let [last, before, third] = [0, 1.min(length - 1), 2.min(length - 1)].map(line);
        last + if length > 2 { lesser(last - before, before - third) } else { last - before }
    };
    let stride = columns + 2;
    let mut padded = vec![0.0; stride * (rows + 2)];
    for (row, line) in heights.chunks_exact(columns).enumerate() {
        let target = &mut padded[(row + 1) * stride..][..stride];
        target[1..=columns].copy_from_slice(line);
        target[0] = beyond(&|i| line[i], columns);
        target[stride - 1] = beyond(&|i| line[columns - 1 - i], columns);
    }
    for column in 0..stride {
        padded[column] = beyond(&|i| padded[(i + 1) * stride + column], rows);
        padded[(rows + 1) * stride + column] = beyond(&|i| padded[(rows - i) * stride + column], rows);
    }
    padded
}

/// The one nearer to 0 where both have the same sign, else 0.
fn lesser(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 { 0.0 } else { a.signum() * a.abs().min(b.abs()) }
}

/// The slope at a node, from the differences before and after it: the mean, limited.
fn limited(before: f64, after: f64) -> f64 {
    lesser(0.5 * (before + after), STEEPEST * lesser(before, after))
}

/// Heights, limited slopes and limited twists of all nodes.
fn nodes(heights: &[f64], stride: usize, rows: usize) -> Vec<Node> {
    // Beyond the grid's ends the ground goes on with the last difference.
    let difference = |index: usize, step: usize, position: usize, length: usize| {
        let after = (position + 1 < length).then(|| heights[index + step] - heights[index]);
        let before = (position > 0).then(|| heights[index] - heights[index - step]);
        (before.or(after).unwrap_or(0.0), after.or(before).unwrap_or(0.0))
    };
    let mut nodes: Vec<Node> = (0..heights.len())
        .into_par_iter()
        .with_min_len(4096)
        .map(|index| {
            let (west, east) = difference(index, 1, index % stride, stride);
            let (south, north) = difference(index, stride, index / stride, rows);
            Node { height: heights[index], slope_x: limited(west, east), slope_y: limited(south, north), twist: 0.0 }
        })
        .collect();
    let twists: Vec<f64> =
        (0..nodes.len()).into_par_iter().with_min_len(4096).map(|i| limited_twist(&nodes, i, stride, rows)).collect();
    for (node, twist) in nodes.iter_mut().zip(twists) {
        node.twist = twist;
    }
    nodes
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

    /// Heights of a function at the nodes of a grid whose first node is at `FIRST`.
    fn surface(columns: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> Surface {
        let heights: Vec<f64> = (0..columns * rows)
            .map(|i| height(FIRST[0] + CELL[0] * (i % columns) as f64, FIRST[1] + CELL[1] * (i / columns) as f64))
            .collect();
        Surface::new(&heights, [columns, rows], FIRST, CELL)
    }

    const FIRST: [f64; 2] = [100.0, -30.0];
    const CELL: [f64; 2] = [2.0, 5.0];

    #[test]
    fn a_plane_is_exact_up_to_a_cell_beyond_the_outermost_nodes() {
        let plane = |x: f64, y: f64| 3.0 + 0.25 * x - 0.5 * y;
        let surface = surface(4, 3, plane);
        for (x, y) in [(100.0, -30.0), (98.5, -34.0), (103.3, -27.1), (107.9, -15.1), (105.0, -20.0)] {
            let (height, [east, north]) = surface.height_and_slope(x, y);
            assert!((height - plane(x, y)).abs() < 1e-12, "{x} {y} {height}");
            assert!((east - 0.25).abs() < 1e-12 && (north + 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn smooth_ground_is_met_to_third_order() {
        let ground = |x: f64, y: f64| 0.01 * (x - 80.0) * (x - 80.0) + 0.02 * (x - 80.0) * (y + 60.0);
        let surface = surface(12, 9, ground);
        for (x, y) in [(108.7, -11.0), (110.9, -8.3), (112.0, -5.0)] {
            let (height, _) = surface.height_and_slope(x, y);
            assert!((height - ground(x, y)).abs() < 1e-10, "{x} {y}: {height} {}", ground(x, y));
        }
    }

    #[test]
    fn a_cliff_at_the_edge_digs_no_pit_beyond_it() {
        let surface = surface(5, 5, |x, _| if x > 101.0 { 200.0 } else { 10.0 });
        assert!(surface.height_and_slope(99.0, -20.0).0 >= 10.0 - 1e-12);
    }

    #[test]
    fn outside_and_nonsense_are_answered_with_numbers() {
        let surface = surface(3, 3, |x, y| x * y);
        for (x, y) in [(f64::NAN, 0.0), (f64::INFINITY, f64::NEG_INFINITY), (-1e300, 1e300)] {
            let (height, slope) = surface.height_and_slope(x, y);
            assert!(height.is_finite() && slope.iter().all(|s| s.is_finite()), "{x} {y}");
        }
    }

    proptest! {
        /// Between four nodes the surface stays between the lowest and the highest of them, whatever the heights.
        #[test]
        fn never_over_or_undershoots(heights in prop::collection::vec(-100.0..100.0_f64, 36), u in 0.0..1.0_f64, v in 0.0..1.0_f64) {
            let surface = Surface::new(&heights, [6, 6], [0.0, 0.0], [1.0, 1.0]);
            for row in 0..5 {
                for column in 0..5 {
                    let corners = [0, 1, 6, 7].map(|i| heights[row * 6 + column + i]);
                    let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
                    let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    let (height, _) = surface.height_and_slope(column as f64 + u, row as f64 + v);
                    prop_assert!((low - 1e-10..=high + 1e-10).contains(&height), "{height} of {corners:?}");
                }
            }
        }

        /// The slope is the derivative of the height, and both are continuous across the sides of patches.
        #[test]
        fn slope_is_the_derivative(heights in prop::collection::vec(-10.0..10.0_f64, 36), x in 0.1..4.9_f64, y in 0.1..4.9_f64) {
            let surface = Surface::new(&heights, [6, 6], [0.0, 0.0], [1.0, 1.0]);
            let step = 1e-6;
            let height = |x, y| surface.height_and_slope(x, y).0;
            let (_, [east, north]) = surface.height_and_slope(x, y);
            prop_assert!((east - (height(x + step, y) - height(x - step, y)) / (2.0 * step)).abs() < 1e-3);
            prop_assert!((north - (height(x, y + step) - height(x, y - step)) / (2.0 * step)).abs() < 1e-3);
            let side = x.round();
            let (before, after) = (surface.height_and_slope(side - 1e-9, y), surface.height_and_slope(side + 1e-9, y));
            prop_assert!((before.0 - after.0).abs() < 1e-6);
            prop_assert!((before.1[0] - after.1[0]).abs() < 1e-5 && (before.1[1] - after.1[1]).abs() < 1e-5);
        }
    }
}
