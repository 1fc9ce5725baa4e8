//! Mean height of the surface over a polygon, by Green's theorem.
//!
//! The integral of the height h over a polygon is the line integral of -F dx along its sides, counter-clockwise, where
//! dF/dy = h. In a patch F is the integral of h upwards from the patch's south side. So F jumps where a side of the
//! polygon passes from a row of patches to the next, by the integral G of h over the patch's height, and each passage
//! at x adds the integral of G from a fixed column of patches to x: whole patches, of which a row's running sums are
//! kept, and a part of one. The cost goes with the number of patches that the sides pass through, not with those
//! inside.
//!
//! Along a straight part of a side within one patch F is a polynomial of degree 7 (3 along x, 4 along y), which four
//! Gauss-Legendre points integrate exactly.

use super::blocks::{Node, Nodes, SIDE, STRIDE};
use super::{Surface, along_lanes, hermite, hermite_lanes, patch, sides_of, weighted};
use crate::Bounds;
use crate::outline::Outline;
use corpuscle_simd::{LANES, Lanes, LanesExt, Level, Simd, SimdBase, dispatch};
use std::ops::Range;

/// Points, as shares of the length, and weights of the four-point Gauss-Legendre rule (Abramowitz and Stegun, Handbook
/// of Mathematical Functions, table 25.4).
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Weight of the first slope in the integral of a Hermite cubic over the whole patch; that of the second is its
/// negative, and the values' are halves.
const END_SLOPE: f64 = 1.0 / 12.0;

/// Whole patches in a row up to which they are added one by one: fewer look-ups in memory than with running sums.
const SHORT_RUN: usize = 4;

/// Below this length in patches the quotient of integral and area loses more to rounding than it is worth.
const MIN_LENGTH: f64 = 1e-5;

/// The same for area over length, in patches.
const MIN_WIDTH: f64 = 1e-8;

impl Surface {
    /// Mean height over a convex polygon, m; outside `bounds` the ground goes on with the height of the nearest point
    /// inside. `None` for a polygon so small or thin that a quotient of integral and area is inexact.
    pub(crate) fn mean_over(&self, outline: &Outline, bounds: Bounds) -> Option<f64> {
        let region = Region::around(self, outline, bounds);
        let (integral, area) = region.integral_and_area(outline);
        let length = region.extent();
        (length >= MIN_LENGTH && area.abs() >= MIN_WIDTH * length).then(|| region.level + integral / area)
    }

    /// Lowest and highest node of the patches that the polygon's bounding rectangle touches, m.
    pub(crate) fn node_range_around(&self, outline: &Outline, bounds: Bounds) -> [f64; 2] {
        Region::around(self, outline, bounds).node_range()
    }

    /// Sum of the integrals of neighbouring whole patches in a row, in m times the area of a patch.
    fn sum_of_row(&self, row: usize, columns: Range<usize>) -> f64 {
        let mut sum = 0.0;
        let mut from = columns.start;
        while from < columns.end {
            let to = columns.end.min((from / SIDE + 1) * SIDE);
            let sums = self.running_sums(from, row);
            let before = if from.is_multiple_of(SIDE) { 0.0 } else { sums[from % SIDE - 1] };
            sum += sums[(to - 1) % SIDE] - before;
            from = to;
        }
        sum
    }

    /// Of the block that holds a patch, for each patch of its row the sum of the integrals up to and with it. Sums begin
    /// anew in each block, so that rounding does not grow with the length of a row.
    fn running_sums(&self, column: usize, row: usize) -> &[f64] {
        let block = self.block(column, row).0;
        let sums = block.row_sums.get_or_init(|| {
            let mut sum = 0.0;
            let mut with = |patch: usize| {
                let node = patch / SIDE * STRIDE + patch % SIDE;
                let before = if patch.is_multiple_of(SIDE) { 0.0 } else { sum };
                sum = before + whole_patch(line(&*block.nodes, node, 0.0), line(&*block.nodes, node + 1, 0.0));
                sum
            };
            (0..SIDE * SIDE).map(&mut with).collect()
        });
        &sums[row % SIDE * SIDE..][..SIDE]
    }

    /// Integral of the height above `level` over the height of a patch, on the line on its west side or, with `east` = 1,
    /// on its east side, and its derivative along x. Along x the integral is the Hermite cubic through these.
    #[inline]
    fn line(&self, row: usize, column: usize, east: usize, level: f64) -> [f64; 2] {
        let (block, south_west) = self.block(column, row);
        line(&*block.nodes, south_west + east, level)
    }

    /// Position in patches from the south-west node of the ring.
    #[inline(always)]
    fn position(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.corner[0]) * self.per_metre[0], (y - self.corner[1]) * self.per_metre[1]]
    }
}

/// [`Surface::line`] north of a node of a block.
#[inline(always)]
fn line(nodes: &[Node], south: usize, level: f64) -> [f64; 2] {
    let (south, north) = (&nodes[south], &nodes[south + STRIDE]);
    [
        0.5 * (south.height + north.height) - level + END_SLOPE * (south.slope_y - north.slope_y),
        0.5 * (south.slope_x + north.slope_x) + END_SLOPE * (south.twist - north.twist),
    ]
}

/// Integral over a whole patch from [`Surface::line`] west and east of it.
fn whole_patch([west, west_slope]: [f64; 2], [east, east_slope]: [f64; 2]) -> f64 {
    0.5 * (west + east) + END_SLOPE * (west_slope - east_slope)
}

/// The integrals of the weights of [`hermite`] from 0 to `t`.
#[inline(always)]
fn hermite_integrals(t: f64) -> [f64; 4] {
    let square = t * t;
    let cube = square * t;
    let right = cube * (1.0 - 0.5 * t);
    [t - right, right, square * (0.5 - t * (2.0 / 3.0 - 0.25 * t)), cube * (0.25 * t - 1.0 / 3.0)]
}

/// [`hermite_integrals`] lane by lane.
#[inline(always)]
fn hermite_integral_lanes<S: Simd>(t: Lanes<S>) -> [Lanes<S>; 4] {
    let square = t * t;
    let cube = square * t;
    let right = cube * (1.0 - 0.5 * t);
    [t - right, right, square * (0.5 - t * (2.0 / 3.0 - 0.25 * t)), cube * (0.25 * t - 1.0 / 3.0)]
}

/// The patches round a polygon. Lengths are in patches, from the south-west corner of the first patch that the
/// polygon's bounding rectangle touches: small numbers, which rounding hurts little.
struct Region<'a> {
    surface: &'a Surface,
    /// Column and row of the first patch.
    first: [usize; 2],
    /// Position of the first patch from the surface's corner.
    shift: [f64; 2],
    /// South-west and north-east corner of the bounds, outside which the height is that of the nearest point inside.
    low: [f64; 2],
    high: [f64; 2],
    /// South-west and north-east corner of the polygon's bounding rectangle, which may reach outside the bounds.
    least: [f64; 2],
    most: [f64; 2],
    /// Last patch of the surface.
    last: [usize; 2],
    /// Column of patches from which integrals along x are counted: in the middle, so that little is added only to be
    /// taken off again.
    middle: usize,
    /// Height from which all heights are counted, m: the rounding then goes with the differences in height.
    level: f64,
    /// The nodes of the block that holds all the patches, and the index of the first patch's south-west node, where there
    /// is such a block: it is looked up once.
    block: Option<(&'a Nodes, usize)>,
}

impl<'a> Region<'a> {
    fn around(surface: &'a Surface, outline: &Outline, bounds: Bounds) -> Self {
        let patches = surface.patches.map(|count| count as f64);
        let inside = |corner: [f64; 2]| {
            let corner = surface.position(corner);
            [0, 1].map(|axis| corner[axis].max(0.0).min(patches[axis]))
        };
        let [low, high] = [inside([bounds.x_min, bounds.y_min]), inside([bounds.x_max, bounds.y_max])];
        let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in outline.corners() {
            let corner = surface.position(corner);
            for axis in 0..2 {
                least[axis] = least[axis].min(corner[axis]);
                most[axis] = most[axis].max(corner[axis]);
            }
        }
        let first = [0, 1].map(|axis| patch(least[axis].max(low[axis]).min(high[axis]), surface.patches[axis]).0);
        let shift = first.map(|index| index as f64);
        let shifted = |position: [f64; 2]| [0, 1].map(|axis| position[axis] - shift[axis]);
        let middle = 0;
        let (block, south_west) = surface.block(first[0], first[1]);
        let level = block.nodes[south_west].height;
        let last = [0, 1].map(|axis| surface.patches[axis] - 1 - first[axis]);
        let (low, high, least, most) = (shifted(low), shifted(high), shifted(least), shifted(most));
        let block = Some((&*block.nodes, south_west));
        let mut region = Self { surface, first, shift, low, high, least, most, last, middle, level, block };
        let centre = [0, 1].map(|axis| 0.5 * (region.least[axis] + region.most[axis]));
        region.middle = region.patch_at(centre)[0];
        let farthest = region.patch_at(region.most);
        if (0..2).any(|axis| first[axis] % SIDE + farthest[axis] >= SIDE) {
            region.block = None;
        }
        region
    }

    /// Largest side of the bounding rectangle.
    fn extent(&self) -> f64 {
        (self.most[0] - self.least[0]).max(self.most[1] - self.least[1])
    }

    /// Lowest and highest node of the patches that the bounding rectangle touches, m.
    fn node_range(&self) -> [f64; 2] {
        let [from, to] = [self.least, self.most].map(|corner| self.patch_at(corner));
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for row in self.first[1] + from[1]..=self.first[1] + to[1] {
            for column in self.first[0] + from[0]..=self.first[0] + to[0] {
                let (block, south_west) = self.surface.block(column, row);
                for node in [south_west, south_west + 1, south_west + STRIDE, south_west + STRIDE + 1] {
                    let height = block.nodes[node].height;
                    range = [range[0].min(height), range[1].max(height)];
                }
            }
        }
        range
    }

    /// The position inside the bounds nearest to one.
    #[inline(always)]
    fn nearest(&self, position: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| position[axis].max(self.low[axis]).min(self.high[axis]))
    }

    /// Column and row of the patch that holds the point inside the bounds nearest to a position.
    #[inline]
    fn patch_at(&self, position: [f64; 2]) -> [usize; 2] {
        let position = self.nearest(position);
        [0, 1].map(|axis| (position[axis] as usize).min(self.last[axis]))
    }

    /// Integral of the height above the level over the polygon, and its area; both negative where the corners go
    /// clockwise.
    fn integral_and_area(&self, outline: &Outline) -> (f64, f64) {
        let within = |axis: usize| self.low[axis] <= self.least[axis] && self.most[axis] <= self.high[axis];
        if within(0) && within(1) {
            dispatch!(Level::new(), simd => self.round_outline::<_, true>(simd, outline))
        } else {
            dispatch!(Level::new(), simd => self.round_outline::<_, false>(simd, outline))
        }
    }

    /// [`Self::integral_and_area`]; `INSIDE` is true for polygons inside the bounds.
    #[inline(always)]
    fn round_outline<S: Simd, const INSIDE: bool>(&self, simd: S, outline: &Outline) -> (f64, f64) {
        let position = |corner: [f64; 2]| {
            let position = self.surface.position(corner);
            [0, 1].map(|axis| position[axis] - self.shift[axis])
        };
        let Some(mut from) = outline.corners().next_back().map(position) else { return (0.0, 0.0) };
        let origin = from;
        let mut parts = Parts::<S, INSIDE>::new(simd);
        let mut twice_area = 0.0;
        for corner in outline.corners() {
            let to = position(corner);
            let [a, b] = [from, to].map(|corner| [corner[0] - origin[0], corner[1] - origin[1]]);
            twice_area += a[0] * b[1] - a[1] * b[0];
            let mut start = from;
            for cut in self.cuts::<INSIDE>(from, to) {
                let end = if cut == 1.0 { to } else { [0, 1].map(|axis| from[axis] + cut * (to[axis] - from[axis])) };
                self.along_side(&mut parts, start, end);
                start = end;
            }
            from = to;
        }
        (parts.finish(self), 0.5 * twice_area)
    }

    /// Shares of a side at which it crosses the lines through the sides of the bounds, and its end.
    #[inline(always)]
    fn cuts<const INSIDE: bool>(&self, from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = f64> {
        let mut cuts = [1.0; 5];
        if !INSIDE {
            let share = |axis: usize, line: f64| {
                let share = (line - from[axis]) / (to[axis] - from[axis]);
                // Not-a-number, where the side lies on the line, becomes 0.
                if share > 0.0 { share.min(1.0) } else { 0.0 }
            };
            cuts = [share(0, self.low[0]), share(0, self.high[0]), share(1, self.low[1]), share(1, self.high[1]), 1.0];
            cuts.sort_by(f64::total_cmp);
        }
        cuts.into_iter().skip(if INSIDE { 4 } else { 0 })
    }

    /// Adds to `parts` the parts of a straight side that lie in one patch each, and the jumps of F from row to row. The
    /// side crosses no line through a side of the bounds.
    #[inline(always)]
    fn along_side<S: Simd, const INSIDE: bool>(&self, parts: &mut Parts<S, INSIDE>, from: [f64; 2], to: [f64; 2]) {
        let [mut column, mut row] = self.patch_at(from);
        let [last_column, last_row] = self.patch_at(to);
        let [east, north] = [last_column > column, last_row > row];
        let length = [to[0] - from[0], to[1] - from[1]];
        let per_length = length.map(|length| 1.0 / length);
        let mut start = from;
        loop {
            let at_last = [column == last_column, row == last_row];
            let [line_x, line_y] = [(column + usize::from(east)) as f64, (row + usize::from(north)) as f64];
            // Used only where a line is still to be crossed, so that the length is not 0.
            let share = [(line_x - from[0]) * per_length[0], (line_y - from[1]) * per_length[1]];
            let along_x = !at_last[0] && (at_last[1] || share[0] <= share[1]);
            let end = match at_last {
                [true, true] => to,
                _ if along_x => [line_x, from[1] + share[0] * length[1]],
                _ => [from[0] + share[1] * length[0], line_y],
            };
            parts.add(self, [column, row], start, end);
            if at_last == [true, true] {
                return;
            } else if along_x {
                column = if east { column + 1 } else { column - 1 };
            } else {
                parts.jumps += if north { self.up_to(row, end[0]) } else { -self.up_to(row - 1, end[0]) };
                row = if north { row + 1 } else { row - 1 };
            }
            start = end;
        }
    }

    /// Integral along x, from the middle column to `x`, of the integrals over the height of a row of patches.
    fn up_to(&self, row: usize, x: f64) -> f64 {
        let inside = x.max(self.low[0]).min(self.high[0]);
        let column = (inside as usize).min(self.last[0]);
        let (low, high) = (self.middle.min(column), self.middle.max(column));
        let run = Run { region: self, row, first: low };
        let whole = if column == high { run.whole_patches(0..high - low) } else { -run.whole_patches(0..high - low) };
        let (west, east) = (run.line(column - low, 0), run.line(column - low, 1));
        let part = inside - column as f64;
        let mut integral = along(&hermite_integrals(part), west, east);
        if x != inside {
            integral += (x - inside) * along(&hermite(part).0, west, east);
        }
        whole + integral
    }
}

/// Neighbouring patches in a row.
struct Run<'a> {
    region: &'a Region<'a>,
    row: usize,
    /// Column of the patch from which the others are counted.
    first: usize,
}

impl Run<'_> {
    /// [`Surface::line`] of a patch.
    #[inline(always)]
    fn line(&self, patch: usize, east: usize) -> [f64; 2] {
        let Region { surface, first, level, block, .. } = *self.region;
        let column = self.first + patch;
        match block {
            Some((nodes, south_west)) => line(nodes, south_west + self.row * STRIDE + column + east, level),
            None => surface.line(first[1] + self.row, first[0] + column, east, level),
        }
    }

    /// Sum of the integrals of whole patches.
    #[inline(always)]
    fn whole_patches(&self, patches: Range<usize>) -> f64 {
        let count = patches.len();
        if count > SHORT_RUN {
            let Region { surface, first, level, .. } = *self.region;
            let west = first[0] + self.first;
            let sum = surface.sum_of_row(first[1] + self.row, west + patches.start..west + patches.end);
            return sum - level * count as f64;
        }
        // On lines between two patches the slopes cancel.
        let between: f64 = (patches.start + 1..patches.end).map(|patch| self.line(patch, 0)[0]).sum();
        if count > 0 { between + whole_patch(self.line(patches.start, 0), self.line(patches.end - 1, 1)) } else { 0.0 }
    }
}

/// A Hermite cubic from weights and [`Surface::line`] west and east of a patch.
#[inline]
fn along(weights: &[f64; 4], west: [f64; 2], east: [f64; 2]) -> f64 {
    weights[0] * west[0] + weights[1] * east[0] + weights[2] * west[1] + weights[3] * east[1]
}

/// Straight parts of a polygon's sides, each in one patch or beyond it outside the bounds, integrated along [`LANES`]
/// at a time. `INSIDE` is true where all are inside the bounds.
struct Parts<S: Simd, const INSIDE: bool> {
    simd: S,
    /// Line integral of -F dx along the parts done so far, lane by lane.
    sum: Lanes<S>,
    /// Sum of the jumps of F.
    jumps: f64,
    /// Number of parts still to be integrated along; for each the patch, the start and the length along x and y.
    count: usize,
    column: [usize; LANES],
    row: [usize; LANES],
    from: [[f64; LANES]; 2],
    length: [[f64; LANES]; 2],
}

impl<S: Simd, const INSIDE: bool> Parts<S, INSIDE> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let (sum, index, point) = (Lanes::splat(simd, 0.0), [0; LANES], [[0.0; LANES]; 2]);
        Self { simd, sum, jumps: 0.0, count: 0, column: index, row: index, from: point, length: point }
    }

    #[inline(always)]
    fn add(&mut self, region: &Region, [column, row]: [usize; 2], from: [f64; 2], to: [f64; 2]) {
        // Along y there is nothing to integrate.
        if from[0] == to[0] {
            return;
        }
        if self.count == LANES {
            self.integrate_pending(region);
        }
        let lane = self.count;
        (self.column[lane], self.row[lane]) = (column, row);
        for axis in 0..2 {
            self.from[axis][lane] = from[axis];
            self.length[axis][lane] = to[axis] - from[axis];
        }
        self.count += 1;
    }

    /// Integrates along the parts added since the last time.
    #[inline(always)]
    fn integrate_pending(&mut self, region: &Region) {
        let simd = self.simd;
        let [south, north] = self.nodes(region);
        let [x, y] = [Lanes::from_slice(simd, &self.from[0]), Lanes::from_slice(simd, &self.from[1])];
        let length = [Lanes::from_slice(simd, &self.length[0]), Lanes::from_slice(simd, &self.length[1])];
        let column = Lanes::from_slice(simd, &self.column.map(|column| column as f64));
        let row = Lanes::from_slice(simd, &self.row.map(|row| row as f64));
        let mut sum = Lanes::splat(simd, 0.0);
        for (share, weight) in GAUSS {
            let position = [x + share * length[0], y + share * length[1]];
            let [mut x, mut y] = position;
            if !INSIDE {
                x = x.max(region.low[0]).min(region.high[0]);
                y = y.max(region.low[1]).min(region.high[1]);
            }
            let along_x = hermite_lanes(x - column).0;
            let [south_height, south_slope] = along_lanes(&along_x, &south);
            let [north_height, north_slope] = along_lanes(&along_x, &north);
            let along_y = [south_height, north_height, south_slope, north_slope];
            let mut integral = weighted(&hermite_integral_lanes(y - row), along_y);
            if !INSIDE {
                integral += (position[1] - y) * weighted(&hermite_lanes(y - row).0, along_y);
            }
            sum += weight * integral;
        }
        self.sum -= length[0] * sum;
        self.count = 0;
        self.length = [[0.0; LANES]; 2];
    }

    /// The two nodes on the south side of the patch of each part, and on its north side: west's and east's height above
    /// the level and derivatives.
    #[inline(always)]
    fn nodes(&self, region: &Region) -> [[Lanes<S>; LANES]; 2] {
        let [mut south, mut north] = if let Some((nodes, first)) = region.block {
            let mut south_west = self.column;
            for (node, row) in south_west.iter_mut().zip(self.row) {
                *node += first + row * STRIDE;
            }
            sides_of(self.simd, [nodes; LANES], south_west)
        } else {
            let columns = self.column.map(|column| region.first[0] + column);
            let rows = self.row.map(|row| region.first[1] + row);
            region.surface.sides_of_patches(self.simd, columns, rows)
        };
        (south[0], south[4]) = (south[0] - region.level, south[4] - region.level);
        (north[0], north[4]) = (north[0] - region.level, north[4] - region.level);
        [south, north]
    }

    /// All line integrals with the jumps of F.
    #[inline(always)]
    fn finish(mut self, region: &Region) -> f64 {
        self.integrate_pending(region);
        self.sum.sum() + self.jumps
    }
}
