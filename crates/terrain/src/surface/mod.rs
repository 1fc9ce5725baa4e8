//! Smooth ground through heights on a regular grid.
//!
//! A bicubic Hermite surface: every node carries its height, its two slopes and its twist, and each patch between four
//! nodes is a cubic in both directions, so heights and slopes are continuous everywhere. Slopes and twists are limited
//! so that all sixteen Bezier points of a patch lie between the lowest and the highest of its four nodes (convex hull
//! property of Bernstein polynomials): the surface never over- or undershoots the data, makes no pits and no bumps of
//! its own, and is exact for a plane.

mod blocks;
mod mean;

use crate::Bounds;
use blocks::{Block, Heights, Node, Nodes, SIDE, STRIDE};
use corpuscle_simd::{LANES, Lanes, Simd, SimdBase, transposed};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// A smooth surface as the nodes of its bicubic Hermite patches, in single precision.
#[derive(Debug, Clone)]
pub struct GroundPatches {
    /// Height above the requested level, m, and its derivatives along y, along x and along both, m per cell; row by row from the
    /// south-west.
    pub nodes: Vec<[f32; 4]>,
    /// Nodes in a row, and rows.
    pub size: [usize; 2],
    /// Position of the first node in model coordinates, m.
    pub corner: [f64; 2],
    /// Nodes per metre along x and y.
    pub per_metre: [f64; 2],
}

/// Rounding of interpolated heights, as a part of them.
const ROUNDING: f64 = 1e-12;

/// Nodes of a formula's patches, along each side of a cell of its maps.
const NODES_A_CELL: f64 = 4.0;

/// Nodes along a side at most.
const MOST_NODES: f64 = 4096.0;

impl GroundPatches {
    /// Patches through a formula, which gives height and slope at a position, over `bounds`.
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

/// All of a surface but its heights.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SurfaceParts {
    /// Columns and rows of the heights.
    size: [usize; 2],
    /// True for heights in single precision.
    is_single: bool,
    corner: [f64; 2],
    per_metre: [f64; 2],
}

/// A smooth surface through heights on a regular grid.
#[derive(Debug)]
pub(crate) struct Surface {
    heights: Heights,
    /// Blocks of patches, row by row from the south-west, each made when it is first looked at.
    blocks: Vec<OnceLock<Block>>,
    /// Blocks in a row.
    blocks_in_row: usize,
    /// Patches in each direction.
    patches: [usize; 2],
    /// Position of the south-west node of the ring.
    corner: [f64; 2],
    /// Nodes per metre.
    per_metre: [f64; 2],
}

impl Surface {
    /// The surface through `heights`, `columns` by `rows`, row by row from the south-west, the first at `first`,
    /// neighbours `cell` apart. It reaches one cell beyond the outermost nodes, going on as it ends there.
    pub(crate) fn new(heights: Vec<f64>, [columns, rows]: [usize; 2], first: [f64; 2], cell: [f64; 2]) -> Self {
        assert!(columns > 0 && rows > 0 && heights.len() == columns * rows, "a surface needs all its heights");
        let corner = [first[0] - cell[0], first[1] - cell[1]];
        Self::through(Heights::new(heights, [columns, rows]), corner, [1.0 / cell[0], 1.0 / cell[1]])
    }

    fn through(heights: Heights, corner: [f64; 2], per_metre: [f64; 2]) -> Self {
        let patches = heights.size.map(|count| count + 1);
        let [blocks_in_row, rows_of_blocks] = patches.map(|count| count.div_ceil(SIDE));
        let blocks = (0..blocks_in_row * rows_of_blocks).map(|_| OnceLock::new()).collect();
        Self { heights, blocks, blocks_in_row, patches, corner, per_metre }
    }

    /// All of it but its heights.
    pub(crate) fn parts(&self) -> SurfaceParts {
        let (size, is_single) = (self.heights.size, self.heights.is_single());
        SurfaceParts { size, is_single, corner: self.corner, per_metre: self.per_metre }
    }

    /// The heights as the bytes of their numbers.
    pub(crate) fn height_bytes(&self) -> &[u8] {
        self.heights.bytes()
    }

    /// A surface of its parts and the bytes of its heights.
    pub(crate) fn of_parts(parts: SurfaceParts, heights: &[u8]) -> Result<Self, String> {
        let SurfaceParts { size, is_single, corner, per_metre } = parts;
        let heights = Heights::of_bytes(heights, size, is_single)
            .ok_or("a terrain with another number of heights than it says")?;
        Ok(Self::through(heights, corner, per_metre))
    }

    /// The block that holds a patch, and the index in it of the patch's south-west node.
    #[inline(always)]
    fn block(&self, column: usize, row: usize) -> (&Block, usize) {
        let index = row / SIDE * self.blocks_in_row + column / SIDE;
        let block = match self.blocks[index].get() {
            Some(block) => block,
            None => self.make_block(index),
        };
        (block, row % SIDE * STRIDE + column % SIDE)
    }

    /// Made by one thread: a parallel task that waited in here could be given another that needs the same block, and
    /// wait for itself.
    #[cold]
    #[inline(never)]
    fn make_block(&self, index: usize) -> &Block {
        self.blocks[index].get_or_init(|| Block::new(self.nodes_of_block(index)))
    }

    /// The nodes of a block, [`STRIDE`] in a row.
    fn nodes_of_block(&self, index: usize) -> Box<Nodes> {
        let first = [index % self.blocks_in_row * SIDE, index / self.blocks_in_row * SIDE];
        let count = [0, 1].map(|axis| (self.patches[axis] - first[axis]).min(SIDE) + 1);
        let mut nodes: Box<Nodes> = bytemuck::allocation::zeroed_box();
        for (row, line) in self.heights.nodes(first, count).chunks_exact(count[0]).enumerate() {
            nodes[row * STRIDE..][..count[0]].copy_from_slice(line);
        }
        nodes
    }

    /// The nodes for a device that has single precision only: heights above `level`. No block is kept for it.
    pub(crate) fn patches_above(&self, level: f64) -> GroundPatches {
        let above =
            |node: &Node| [node.height - level, node.slope_y, node.slope_x, node.twist].map(|value| value as f32);
        let size = self.patches.map(|count| count + 1);
        let mut nodes = vec![[0.0; 4]; size[0] * size[1]];
        // The last row of nodes belongs to the last row of blocks, and so do columns.
        nodes.par_chunks_mut(size[0] * SIDE).enumerate().for_each(|(chunk, nodes)| {
            let row_of_blocks = (chunk * SIDE).min(self.patches[1] - 1) / SIDE;
            let first_row = chunk * SIDE - row_of_blocks * SIDE;
            for column_of_blocks in 0..self.blocks_in_row {
                let made = self.nodes_of_block(row_of_blocks * self.blocks_in_row + column_of_blocks);
                let first = column_of_blocks * SIDE;
                let count = if column_of_blocks + 1 < self.blocks_in_row { SIDE } else { size[0] - first };
                for (row, line) in nodes.chunks_exact_mut(size[0]).enumerate() {
                    let own = &made[(first_row + row) * STRIDE..][..count];
                    line[first..first + count].iter_mut().zip(own).for_each(|(node, own)| *node = above(own));
                }
            }
        });
        GroundPatches { nodes, size, corner: self.corner, per_metre: self.per_metre }
    }

    /// Height and slope `[dz/dx, dz/dy]`; the nearest edge's outside the ring. Never panics.
    #[inline]
    pub(crate) fn height_and_slope(&self, x: f64, y: f64) -> (f64, [f64; 2]) {
        let ([column, row], position) = self.patch_at(x, y);
        let (block, south) = self.block(column, row);
        let (south, north) = (pair(&*block.nodes, south), pair(&*block.nodes, south + STRIDE));
        self.between(south, north, position)
    }

    /// The height that [`Self::height_and_slope`] gives, without making a block for it.
    pub(crate) fn height_once(&self, x: f64, y: f64) -> f64 {
        let ([column, row], position) = self.patch_at(x, y);
        if self.blocks[row / SIDE * self.blocks_in_row + column / SIDE].get().is_some() {
            return self.height_and_slope(x, y).0;
        }
        let nodes = self.heights.nodes([column, row], [2, 2]);
        self.between(pair(&nodes, 0), pair(&nodes, 2), position).0
    }

    /// The heights that [`Self::height_and_slope`] gives at all of `x`, of which each goes with all of `y`; both ascend. Row by row,
    /// a row for each `y`. No block is kept for it.
    pub(crate) fn heights_on(&self, x: &[f64], y: &[f64]) -> Vec<f32> {
        let mut heights = vec![0.0; x.len() * y.len()];
        let columns: Vec<(usize, f64)> = x.iter().map(|x| self.column_at(*x)).collect();
        let rows: Vec<(usize, f64)> = y.iter().map(|y| self.row_at(*y)).collect();
        let mut bands = Vec::new();
        let mut rest = &mut heights[..];
        for rows in rows.chunk_by(|a, b| a.0 / SIDE == b.0 / SIDE) {
            let (band, after) = rest.split_at_mut(rows.len() * x.len());
            bands.push((rows, band));
            rest = after;
        }
        bands.into_par_iter().for_each(|(rows, band)| self.fill_band(&columns, rows, band));
        heights
    }

    /// Heights at rows and columns of positions, all in one row of blocks.
    fn fill_band(&self, columns: &[(usize, f64)], rows: &[(usize, f64)], band: &mut [f32]) {
        let mut first = 0;
        for part in columns.chunk_by(|a, b| a.0 / SIDE == b.0 / SIDE) {
            let nodes = self.nodes_of_block(rows[0].0 / SIDE * self.blocks_in_row + part[0].0 / SIDE);
            for ((row, v), line) in rows.iter().zip(band.chunks_exact_mut(columns.len())) {
                for ((column, u), height) in part.iter().zip(&mut line[first..]) {
                    let south = row % SIDE * STRIDE + column % SIDE;
                    let (south, north) = (pair(&*nodes, south), pair(&*nodes, south + STRIDE));
                    *height = self.between(south, north, [*u, *v]).0 as f32;
                }
            }
            first += part.len();
        }
    }

    /// The height given at a node of the grid, counted from the south-west.
    pub(crate) fn height_of_node(&self, column: usize, row: usize) -> f64 {
        self.heights.at(column, row)
    }

    /// A height below which the surface nowhere is in a rectangle, m: that of its lowest node there, less rounding; none
    /// where there are more than `most` nodes.
    pub(crate) fn lowest_in(&self, from: [f64; 2], to: [f64; 2], most: usize) -> Option<f64> {
        let [first, last] = [from, to].map(|[x, y]| self.patch_at(x, y).0);
        let nodes = [0, 1].map(|axis| (last[axis] + 2).saturating_sub(first[axis]));
        if nodes[0] * nodes[1] > most {
            return None;
        }
        let mut lowest = f64::INFINITY;
        for row in first[1]..=last[1] + 1 {
            for column in first[0]..=last[0] + 1 {
                lowest = lowest.min(self.heights.with_ring([column, row]));
            }
        }
        Some(lowest - ROUNDING * lowest.abs().max(1.0))
    }

    /// Column and row of the patch that holds a position, and where in it.
    #[inline(always)]
    fn patch_at(&self, x: f64, y: f64) -> ([usize; 2], [f64; 2]) {
        let ((column, u), (row, v)) = (self.column_at(x), self.row_at(y));
        ([column, row], [u, v])
    }

    #[inline(always)]
    fn column_at(&self, x: f64) -> (usize, f64) {
        patch((x - self.corner[0]) * self.per_metre[0], self.patches[0])
    }

    #[inline(always)]
    fn row_at(&self, y: f64) -> (usize, f64) {
        patch((y - self.corner[1]) * self.per_metre[1], self.patches[1])
    }

    /// Height and slope in a patch from its south-west and south-east, north-west and north-east nodes.
    #[inline(always)]
    fn between(&self, south: (&Node, &Node), north: (&Node, &Node), [u, v]: [f64; 2]) -> (f64, [f64; 2]) {
        let (bu, du) = hermite(u);
        let (bv, dv) = hermite(v);
        // Along the two sides that run in x: height and y-slope, and their x-derivatives.
        let [south_height, south_slope] = along(&bu, south.0, south.1);
        let [north_height, north_slope] = along(&bu, north.0, north.1);
        let [south_dx, south_twist] = along(&du, south.0, south.1);
        let [north_dx, north_twist] = along(&du, north.0, north.1);
        let across = |w: &[f64; 4], p: f64, q: f64, dp: f64, dq: f64| w[0] * p + w[1] * q + w[2] * dp + w[3] * dq;
        let height = across(&bv, south_height, north_height, south_slope, north_slope);
        let slope_x = across(&bv, south_dx, north_dx, south_twist, north_twist);
        let slope_y = across(&dv, south_height, north_height, south_slope, north_slope);
        (height, [slope_x * self.per_metre[0], slope_y * self.per_metre[1]])
    }

    /// [`Self::height_and_slope`] at [`LANES`] positions at once, to the same bits: height, dz/dx, dz/dy.
    #[inline(always)]
    pub(crate) fn heights_and_slopes<S: Simd>(&self, simd: S, x: Lanes<S>, y: Lanes<S>) -> [Lanes<S>; 3] {
        let (columns, u) = patches(simd, (x - self.corner[0]) * self.per_metre[0], self.patches[0]);
        let (rows, v) = patches(simd, (y - self.corner[1]) * self.per_metre[1], self.patches[1]);
        let [south, north] = self.sides_of_patches(simd, columns, rows);
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

    /// [`sides_of`] patches anywhere.
    #[inline(always)]
    fn sides_of_patches<S: Simd>(
        &self,
        simd: S,
        columns: [usize; LANES],
        rows: [usize; LANES],
    ) -> [[Lanes<S>; LANES]; 2] {
        let mut south_west = [0; LANES];
        let nodes = std::array::from_fn(
            #[inline(always)]
            |lane| {
                let (block, index) = self.block(columns[lane], rows[lane]);
                south_west[lane] = index;
                &*block.nodes
            },
        );
        sides_of(simd, nodes, south_west)
    }
}

/// The two nodes on the south side of each patch, and on its north side: west's and east's height, y-slope, x-slope and
/// twist. Of each patch the nodes of its block and the index of its south-west node are given.
#[inline(always)]
fn sides_of<S: Simd>(simd: S, nodes: [&Nodes; LANES], south_west: [usize; LANES]) -> [[Lanes<S>; LANES]; 2] {
    [side_of(simd, nodes, south_west), side_of(simd, nodes, south_west.map(|node| node + STRIDE))]
}

/// Pairs of neighbouring nodes in a row, the first at `west` in its block.
#[inline(always)]
fn side_of<S: Simd>(simd: S, nodes: [&Nodes; LANES], west: [usize; LANES]) -> [Lanes<S>; LANES] {
    transposed(std::array::from_fn(
        #[inline(always)]
        |lane| {
            let numbers: &[f64] = bytemuck::must_cast_slice(nodes[lane]);
            Lanes::from_slice(simd, &numbers[4 * west[lane]..][..LANES])
        },
    ))
}

/// [`patch`] lane by lane.
#[inline(always)]
fn patches<S: Simd>(simd: S, position: Lanes<S>, patches: usize) -> ([usize; LANES], Lanes<S>) {
    let position = position.max(0.0).min(patches as f64);
    let values: [f64; LANES] = position.into();
    let index = values.map(|value| (value as usize).min(patches - 1));
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

/// The patch in which a grid coordinate lies and the position in it, 0 to 1; the outermost patches' outer sides beyond.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Heights of a function at the nodes of a grid whose first node is at `FIRST`.
    fn surface(columns: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> Surface {
        let heights: Vec<f64> = (0..columns * rows)
            .map(|i| height(FIRST[0] + CELL[0] * (i % columns) as f64, FIRST[1] + CELL[1] * (i / columns) as f64))
            .collect();
        Surface::new(heights, [columns, rows], FIRST, CELL)
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
    fn heights_on_a_grid_are_those_at_its_nodes_and_make_no_block() {
        let ground = surface(150, 90, |x, y| (0.3 * x).sin() * (0.2 * y).cos());
        let x: Vec<f64> = (0..211).map(|step| 95.0 + 1.5 * f64::from(step)).collect();
        let y: Vec<f64> = (0..97).map(|step| -40.0 + 5.1 * f64::from(step)).collect();
        let heights = ground.heights_on(&x, &y);
        assert!(ground.blocks.iter().all(|block| block.get().is_none()));
        for (index, height) in heights.iter().enumerate() {
            assert_eq!(*height, ground.height_and_slope(x[index % 211], y[index / 211]).0 as f32);
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

    #[test]
    fn one_look_keeps_nothing_and_gives_the_same() {
        let hills = |x: f64, y: f64| 5.0 * (0.3 * x).sin() + (0.2 * y).cos();
        let [surface, other] = [surface(150, 70, hills), surface(150, 70, hills)];
        for number in 0..500_u32 {
            let (x, y) = (90.0 + 0.63 * f64::from(number), -40.0 + 0.73 * f64::from(number * 7 % 500));
            assert_eq!(surface.height_once(x, y).to_bits(), other.height_and_slope(x, y).0.to_bits(), "{x} {y}");
        }
        assert!(surface.blocks.iter().all(|block| block.get().is_none()));
        assert!(other.blocks.iter().all(|block| block.get().is_some()));
    }

    #[test]
    fn nodes_for_a_device_are_those_of_the_blocks() {
        // One patch more than blocks, as many as blocks, and fewer than a block.
        for [columns, rows] in [[64, 127], [127, 63], [3, 2]] {
            let surface = surface(columns, rows, |x, y| (0.1 * x * y).sin());
            let GroundPatches { nodes, size, .. } = surface.patches_above(0.0);
            assert_eq!(size, [columns + 2, rows + 2]);
            let whole = surface.heights.nodes([0, 0], size);
            for (node, whole) in nodes.iter().zip(&whole) {
                let whole = [whole.height, whole.slope_y, whole.slope_x, whole.twist].map(|value| value as f32);
                assert_eq!(*node, whole);
            }
        }
    }

    proptest! {
        /// No point of a rectangle is below what is said to be lowest there.
        #[test]
        fn nothing_lies_below_the_lowest(
            heights in prop::collection::vec(-100.0..100.0_f64, 36),
            from in [-2.0..6.0_f64, -2.0..6.0_f64],
            size in [0.0..4.0_f64, 0.0..4.0_f64],
            part in [0.0..1.0_f64, 0.0..1.0_f64],
        ) {
            let surface = Surface::new(heights, [6, 6], [0.0, 0.0], [1.0, 1.0]);
            let at = |part: [f64; 2]| [0, 1].map(|axis| from[axis] + part[axis] * size[axis]);
            let [x, y] = at(part);
            let [from, to] = [at([0.0; 2]), at([1.0; 2])];
            prop_assert!(surface.height_and_slope(x, y).0 >= surface.lowest_in(from, to, 36).unwrap_or(f64::NEG_INFINITY));
            prop_assert!(surface.lowest_in(from, to, 49).is_some() && surface.lowest_in(from, to, 3).is_none());
        }

        /// Between four nodes the surface stays between the lowest and the highest of them, whatever the heights.
        #[test]
        fn never_over_or_undershoots(heights in prop::collection::vec(-100.0..100.0_f64, 36), u in 0.0..1.0_f64, v in 0.0..1.0_f64) {
            let surface = Surface::new(heights.clone(), [6, 6], [0.0, 0.0], [1.0, 1.0]);
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
            let surface = Surface::new(heights.clone(), [6, 6], [0.0, 0.0], [1.0, 1.0]);
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
