//! From values of cells to values at faces, to second order.
//!
//! Slopes are least-squares fits to the neighbours; at each face they are limited on their own (MC, van Leer 1977) by the difference to
//! the neighbour there. Level and depth are reconstructed, the bed is what lies between them (Audusse et al. 2004, section 3).

use super::mesh::{Face, Link, Mesh};
use super::water::{DEPTH, EAST, LEVEL, NORTH, Slopes, THIN, Water, slope};
use corpuscle_simd::{Lanes, Select, Simd, SimdBase, SimdFrom};

/// A neighbour whose bed stands above the level here counts the less, the thinner its water: in full from this part of the depth here on.
pub(crate) const FILM: f64 = 4.0;

/// Water at a face, reconstructed from one side: depth and level, m, velocity across and along the face, m/s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct AtFace {
    pub depth: f64,
    pub level: f64,
    pub across: f64,
    pub along: f64,
}

/// Differences of depth and level from `here` to a neighbour whose bed and level stand `lift` higher. Films on ground above the level here do not
/// raise or lower its slope.
#[inline(always)]
pub(crate) fn differences(here: &Water, there: &Water, lift: f64) -> [f64; 2] {
    let depth = there.depth - here.depth;
    let level = there.level + lift - here.level;
    if level > there.depth {
        let share = FILM * there.depth / here.depth;
        if share < 1.0 {
            return [share * share * depth, share * share * level];
        }
    }
    [depth, level]
}

/// Slopes of a wet cell, where `water` gives the water of each.
#[inline(always)]
pub(crate) fn slopes(mesh: &Mesh, water: &impl Fn(usize) -> Water, cell: usize) -> Slopes {
    let here = &water(cell);
    let mut slopes = [[0.0_f64; 4]; 2];
    for link in mesh.links_of(cell) {
        let Some(other) = link.cell() else {
            let velocity = mirrored(mesh, link, here.velocity);
            for (slopes, gradient) in slopes.iter_mut().zip(link.gradient) {
                (0..2).for_each(|axis| slopes[EAST + axis] += f64::from(gradient) * velocity[axis]);
            }
            continue;
        };
        let there = &water(other);
        let [depth, level] = differences(here, there, mesh.lift_seen(link, cell));
        // Next to no water has no velocity that counts.
        let share = (there.depth / THIN).min(1.0);
        let velocity = [0, 1].map(|axis| share * (there.velocity[axis] - here.velocity[axis]));
        let difference = [depth, level, velocity[0], velocity[1]];
        for (slopes, gradient) in slopes.iter_mut().zip(link.gradient) {
            (0..4).for_each(|quantity| slopes[quantity] += f64::from(gradient) * difference[quantity]);
        }
    }
    std::array::from_fn(|k| slopes[k / 4][k % 4] as f32)
}

/// Difference of the velocity to that of the mirror image behind a wall, m/s.
fn mirrored(mesh: &Mesh, link: &Link, velocity: [f64; 2]) -> [f64; 2] {
    if link.gradient == [0.0; 2] {
        return [0.0; 2];
    }
    let normal = mesh.faces[link.face as usize].normal;
    let across = velocity[0] * normal[0] + velocity[1] * normal[1];
    let squared = normal[0] * normal[0] + normal[1] * normal[1];
    normal.map(|n| -2.0 * across * n / squared)
}

/// Changes from the centroids to the middle of the face, lane by lane: half the limited difference, and along the face by the slope as far as that
/// was kept. `whole` is the difference by the slope, `along` the change by it from the middle between the centroids to that of the face.
#[inline(always)]
fn changes<S: Simd>(simd: S, difference: Lanes<S>, whole: Lanes<S>, along: Lanes<S>) -> Lanes<S> {
    let limited = limit(simd, whole * 2.0 - difference, difference);
    let zero = Lanes::splat(simd, 0.0);
    let none = whole.abs().simd_lt(Lanes::splat(simd, 1e-300));
    let kept = (limited / none.select(Lanes::splat(simd, 1.0), whole)).max(0.0).min(1.0);
    limited * 0.5 + none.select(zero, kept) * along
}

/// Monotonised central limiter of two differences (van Leer 1977, equation 66).
#[inline(always)]
fn limit<S: Simd>(simd: S, a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    let zero = Lanes::splat(simd, 0.0);
    let least = ((a + b).abs() * 0.5).min(a.abs() * 2.0).min(b.abs() * 2.0);
    let signed = a.simd_lt(zero).select(-least, least);
    (a * b).simd_gt(zero).select(signed, zero)
}

/// Eight faces between cells, a lane each, and the cells on both sides. The second is relative to the first.
pub(crate) struct Faces<S: Simd> {
    /// Depth and level, m, and velocity east- and northwards, m/s, of the cells.
    pub water: [[Lanes<S>; 4]; 2],
    /// Their slopes along x and along y.
    pub slopes: [[[Lanes<S>; 4]; 2]; 2],
    /// Difference of depth and level from each cell to the other (see [`differences`]), m.
    pub differences: [[Lanes<S>; 2]; 2],
    /// Unit normal from the first cell to the second.
    pub normal: [Lanes<S>; 2],
    /// From the first cell's centroid to the second's, m.
    pub between: [Lanes<S>; 2],
    /// From the middle between the two centroids to the middle of the face, m.
    pub offset: [Lanes<S>; 2],
}

/// Water at eight faces, reconstructed from one side: see [`AtFace`].
#[derive(Clone, Copy)]
pub(crate) struct AtFaces<S: Simd> {
    pub depth: Lanes<S>,
    pub level: Lanes<S>,
    pub across: Lanes<S>,
    pub along: Lanes<S>,
}

impl<S: Simd> Faces<S> {
    /// The water at the faces, reconstructed from each side.
    #[inline(always)]
    pub fn at(&self, simd: S) -> [AtFaces<S>; 2] {
        let thick = |side: usize| (self.water[side][DEPTH] * (1.0 / THIN)).min(1.0);
        let thick = [thick(0), thick(1)];
        let both = thick[0].min(thick[1]);
        [self.seen_from(simd, 0, thick[0], both), self.seen_from(simd, 1, thick[1], both)]
    }

    /// Reconstruction from one side. Next to no water has neither slopes nor a velocity that count: `thick` is 1 where it has more, `both` where both have, and less
    /// elsewhere.
    #[inline(always)]
    fn seen_from(&self, simd: S, side: usize, thick: Lanes<S>, both: Lanes<S>) -> AtFaces<S> {
        let (own, other, differences) = (&self.water[side], &self.water[1 - side], &self.differences[side]);
        let deeper = thick * self.change(simd, side, DEPTH, differences[DEPTH]);
        let higher = thick * self.change(simd, side, LEVEL, differences[LEVEL]);
        let [depth, level] = bounded(own, deeper, higher);
        let u = own[EAST] + both * self.change(simd, side, EAST, both * (other[EAST] - own[EAST]));
        let v = own[NORTH] + both * self.change(simd, side, NORTH, both * (other[NORTH] - own[NORTH]));
        let [nx, ny] = self.normal;
        AtFaces { depth, level, across: u * nx + v * ny, along: v * nx - u * ny }
    }

    /// Change of a quantity from the centroid of one side to the faces.
    #[inline(always)]
    fn change(&self, simd: S, side: usize, quantity: usize, difference: Lanes<S>) -> Lanes<S> {
        let (x, y) = (self.slopes[side][0][quantity], self.slopes[side][1][quantity]);
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let whole = (x * self.between[0] + y * self.between[1]) * sign;
        changes(simd, difference, whole, x * self.offset[0] + y * self.offset[1])
    }
}

/// Keeps the change of the depth to the depth itself. On rough ground what is too much is taken off the level too: otherwise waves on a lake
/// grow there.
#[inline(always)]
fn bounded<S: Simd>(own: &[Lanes<S>; 4], deeper: Lanes<S>, higher: Lanes<S>) -> [Lanes<S>; 2] {
    let kept = deeper.max(-own[DEPTH]).min(own[DEPTH]);
    let of_bed = higher - deeper;
    let share = higher * higher / (higher * higher + of_bed * of_bed + 1e-300);
    [(own[DEPTH] + kept).max(0.0), own[LEVEL] + (higher - share * (deeper - kept))]
}

/// The water at a wall, reconstructed from its cell: level and depth are the cell's, the velocity tends to that of its mirror image.
#[inline(always)]
pub(crate) fn at_wall<S: Simd>(simd: S, here: &Water, slopes: &Slopes, face: &Face, [nx, ny]: [f64; 2]) -> AtFace {
    let across = here.velocity[0] * nx + here.velocity[1] * ny;
    let [between, offset] = [face.between, face.offset].map(|[x, y]| [f64::from(x), f64::from(y)]);
    let mut lanes = [[0.0; 8]; 3];
    for (axis, normal) in [nx, ny].into_iter().enumerate() {
        let [x, y] = slope(slopes, EAST + axis);
        lanes[0][axis] = -2.0 * across * normal;
        lanes[1][axis] = x * between[0] + y * between[1];
        lanes[2][axis] = x * offset[0] + y * offset[1];
    }
    let [difference, whole, along] = lanes.map(|lanes| Lanes::simd_from(simd, lanes));
    let change: [f64; 8] = changes(simd, difference, whole, along).into();
    let velocity = [here.velocity[0] + change[0], here.velocity[1] + change[1]];
    AtFace {
        depth: here.depth,
        level: here.level,
        across: velocity[0] * nx + velocity[1] * ny,
        along: velocity[1] * nx - velocity[0] * ny,
    }
}

/// The water at a side of the terrain: the cell's own. Slopes are not followed there: with next to nothing beyond to hold it, a lake
/// at an open side grows waves from rounding then (seen: 0.2 m/s within 20 s).
#[inline(always)]
pub(crate) fn at_side(here: &Water, [nx, ny]: [f64; 2]) -> AtFace {
    let [u, v] = here.velocity;
    AtFace { depth: here.depth, level: here.level, across: u * nx + v * ny, along: v * nx - u * ny }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_simd::{Level, dispatch};

    #[test]
    fn the_limiter_keeps_smooth_differences_and_none_at_extrema() {
        dispatch!(Level::new(), simd => {
            let a = Lanes::simd_from(simd, [1.0, 0.1, -1.0, 1.0, 0.0, 3.0, -2.0, 1.0]);
            let b = Lanes::simd_from(simd, [1.2, 1.0, -5.0, -1.0, 1.0, 3.0, -2.0, 0.0]);
            let limited: [f64; 8] = limit(simd, a, b).into();
            assert_eq!(limited, [1.1, 0.2, -2.0, 0.0, 0.0, 3.0, -2.0, 0.0]);
        });
    }
}
