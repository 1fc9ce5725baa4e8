//! From values of cells to values at faces, to second order.
//!
//! Slopes are least-squares fits to the neighbours; at each face they are limited on their own (MC, van Leer 1977) by the difference to
//! the neighbour there. Level and depth are reconstructed, the bed is what lies between them (Audusse et al. 2004, section 3).

use super::mesh::{Face, Link, Mesh};
use super::water::{DEPTH, EAST, LEVEL, NORTH, Slopes, Water, slope};
use corpuscle_lanes::{Lanes, Select, Simd, SimdBase, SimdFrom};

/// A neighbour whose bed stands above the level here counts the less, the thinner its water: in full from this part of the depth here on.
const FILM: f64 = 4.0;

/// Water at a face as one side sees it: depth and level, m, velocity across and along the face, m/s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct AtFace {
    pub depth: f64,
    pub level: f64,
    pub across: f64,
    pub along: f64,
}

/// Differences of depth and level from `here` to a neighbour whose bed and level stand `lift` higher. Films on ground above the level here do not
/// raise or lower its slope.
#[inline]
fn differences(here: &Water, there: &Water, lift: f64) -> [f64; 2] {
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
        let [depth, level] = differences(here, there, lift_seen(mesh, link, cell));
        let wet = f64::from(u8::from(there.depth > 0.0));
        let velocity = [0, 1].map(|axis| wet * (there.velocity[axis] - here.velocity[axis]));
        let difference = [depth, level, velocity[0], velocity[1]];
        for (slopes, gradient) in slopes.iter_mut().zip(link.gradient) {
            (0..4).for_each(|quantity| slopes[quantity] += f64::from(gradient) * difference[quantity]);
        }
    }
    std::array::from_fn(|k| slopes[k / 4][k % 4] as f32)
}

/// By how much the neighbour behind a link stands higher than its bed says, m.
#[inline]
fn lift_seen(mesh: &Mesh, link: &Link, cell: usize) -> f64 {
    if mesh.lift.is_empty() {
        return 0.0;
    }
    let lift = mesh.lift[link.face as usize];
    if mesh.faces[link.face as usize].cells[0] == cell as u32 { lift } else { -lift }
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

/// Keeps the change of the depth to the depth itself. On rough ground what is too much is taken off the level too: otherwise waves on a lake
/// grow there.
#[inline]
fn bound_depth(here: &Water, lift: f64, face: &mut AtFace) {
    let change = face.depth - here.depth;
    if change.abs() > here.depth {
        let kept = here.depth.copysign(change);
        let rise = face.level - (here.level + lift);
        let of_bed = rise - change;
        let share = rise * rise / (rise * rise + of_bed * of_bed + 1e-300);
        face.level -= share * (change - kept);
        face.depth = here.depth + kept;
    }
    face.depth = face.depth.max(0.0);
}

/// The water at a face between two cells as each sees it, at the level of the first cell, with the unit normal `normal`. Both sides and their
/// four quantities are worked out in eight lanes.
#[inline(always)]
pub(crate) fn at_face<S: Simd>(
    simd: S,
    [here, there]: [&Water; 2],
    slopes: [&Slopes; 2],
    lift: f64,
    face: &Face,
    [nx, ny]: [f64; 2],
) -> [AtFace; 2] {
    let both = if here.depth > 0.0 && there.depth > 0.0 { 1.0 } else { 0.0 };
    let east = both * (there.velocity[0] - here.velocity[0]);
    let north = both * (there.velocity[1] - here.velocity[1]);
    let [depth, level] = if here.depth > 0.0 { differences(here, there, lift) } else { [0.0; 2] };
    let [depth_back, level_back] = if there.depth > 0.0 { differences(there, here, -lift) } else { [0.0; 2] };
    let difference = Lanes::simd_from(simd, [depth, level, east, north, depth_back, level_back, -east, -north]);
    let of_axis = |axis: usize| -> Lanes<S> {
        let lanes: [f64; 8] = std::array::from_fn(|k| f64::from(slopes[k / 4][4 * axis + k % 4]));
        Lanes::simd_from(simd, lanes)
    };
    let (along_x, along_y) = (of_axis(0), of_axis(1));
    let sign = Lanes::simd_from(simd, [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]);
    let [between, offset] = [face.between, face.offset].map(|[x, y]| [f64::from(x), f64::from(y)]);
    let whole = (along_x * between[0] + along_y * between[1]) * sign;
    let along = along_x * offset[0] + along_y * offset[1];
    let change: [f64; 8] = changes(simd, difference, whole, along).into();
    let side = |own: &Water, lift: f64, change: &[f64]| {
        let mut at = AtFace { depth: own.depth, level: own.level + lift, ..AtFace::default() };
        if own.depth > 0.0 {
            at.depth += change[DEPTH];
            at.level += change[LEVEL];
            bound_depth(own, lift, &mut at);
        }
        let velocity = [own.velocity[0] + both * change[EAST], own.velocity[1] + both * change[NORTH]];
        at.across = velocity[0] * nx + velocity[1] * ny;
        at.along = velocity[1] * nx - velocity[0] * ny;
        at
    };
    [side(here, 0.0, &change[..4]), side(there, lift, &change[4..])]
}

/// The water at a wall as its cell sees it: level and depth are the cell's, the velocity goes towards that of its mirror image.
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

/// The water at a side of the terrain as its cell sees it: the cell's own. Slopes are not followed there: with next to nothing beyond to hold it, a lake
/// at an open side grows waves from rounding then (seen: 0.2 m/s within 20 s).
#[inline(always)]
pub(crate) fn at_side(here: &Water, [nx, ny]: [f64; 2]) -> AtFace {
    let [u, v] = here.velocity;
    AtFace { depth: here.depth, level: here.level, across: u * nx + v * ny, along: v * nx - u * ny }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_lanes::{Level, dispatch};

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
