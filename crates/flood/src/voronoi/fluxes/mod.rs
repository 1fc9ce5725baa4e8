//! What passes a face, and how the ground pushes the water on both sides.

mod pass;
mod riemann;

pub(crate) use pass::{Inputs, OnFaces, fluxes_of_chunk};
use riemann::{Sides, hll};

use super::reconstruction::{AtFace, AtFaces};
use corpuscle_simd::{Lanes, Select, Simd, SimdBase};
use std::ops::{Add, Mul, Sub};

/// What a face does to the cells on both sides.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Flux {
    /// Volume from the first cell to the second, m3/s.
    pub volume: f64,
    /// Change of the momentum `[east, north]` of the first cell and of the second, over density, m4/s2. On a border the second is the momentum
    /// that goes with the volume.
    pub momentum: [[f64; 2]; 2],
}

/// What a border face does, per length and in its own directions: across and along it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Crossing {
    /// Volume out of the cell, m2/s.
    pub volume: f64,
    /// Momentum across and along the face that goes with it, over density, m3/s2.
    pub carried: [f64; 2],
    /// Thrust across the face, over density, m3/s2: the hydrostatic thrust, less the cell's own, whose sum round the cell is 0.
    pub thrust: f64,
}

impl Crossing {
    /// The flux through a face with the unit normal `[nx, ny]`, with the part `kept` of what goes out.
    #[inline(always)]
    pub fn through(self, length: f64, [nx, ny]: [f64; 2], kept: f64) -> Flux {
        let kept = if self.volume > 0.0 { kept * length } else { length };
        let [across, along] = self.carried.map(|value| value * kept);
        let carried = [across * nx - along * ny, across * ny + along * nx];
        let thrust = self.thrust * length;
        Flux { volume: self.volume * kept, momentum: [[-carried[0] - thrust * nx, -carried[1] - thrust * ny], carried] }
    }
}

/// What eight faces between cells do, per length and in their own directions.
#[derive(Clone, Copy)]
pub(crate) struct Crossings<S: Simd> {
    /// Volume from the first cells to the second, m2/s.
    pub volume: Lanes<S>,
    /// Momentum across and along the faces that goes with it, over density, m3/s2.
    pub carried: [Lanes<S>; 2],
    /// Thrust across the faces on the first cells and on the second, over density, m3/s2: the mean hydrostatic thrust, the ground's, and the cell's
    /// own, whose sum round the cell is 0.
    pub thrust: [Lanes<S>; 2],
}

/// What passes eight faces of unit length between two cells each, whose water has depth and level `own` (the second's as seen from the first).
///
/// The bed at the face is the higher of the two, but not above the lower level (Chen & Noelle 2017, equations 2.12 to 2.16); the ground's thrust
/// is the integral of g d dz along the straight line from the cell's value to the face's, so that nothing is left in a level lake, face by face.
#[inline(always)]
pub(crate) fn between<S: Simd>(simd: S, at: [AtFaces<S>; 2], own: [[Lanes<S>; 2]; 2], gravity: f64) -> Crossings<S> {
    let [a, b] = at;
    let (bed_a, bed_b) = (a.level - a.depth, b.level - b.depth);
    let face_bed = bed_a.max(bed_b).min(a.level.min(b.level));
    let depth_a = (a.level - face_bed).max(0.0).min(a.depth);
    let depth_b = (b.level - face_bed).max(0.0).min(b.depth);
    let (from, to) = (Sides { depth: depth_a, across: a.across }, Sides { depth: depth_b, across: b.across });
    let [volume, momentum] = hll(simd, from, to, gravity);
    let mean = (depth_a * depth_a + depth_b * depth_b) * (0.25 * gravity);
    let on_a = own_thrust([a.depth, a.level], own[0], depth_a, face_bed - bed_a) * (0.5 * gravity) + mean;
    let on_b = own_thrust([b.depth, b.level], own[1], depth_b, face_bed - bed_b) * (0.5 * gravity) + mean;
    let along = volume.simd_gt(Lanes::splat(simd, 0.0)).select(a.along, b.along);
    Crossings { volume, carried: [momentum - mean, volume * along], thrust: [on_a, on_b] }
}

/// Thrust of the ground between a cell's centroid and the face, and of the cell itself, over g/2: `at` are depth and level that the cell sees at the
/// face, `own` its own, `depth` the depth over the face's bed, which stands `step` m above the bed that the cell sees there.
#[inline(always)]
fn own_thrust<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>>(
    at: [T; 2],
    own: [T; 2],
    depth: T,
    step: T,
) -> T {
    (at[0] + depth) * step - at[0] * at[0] + (at[0] + own[0]) * (at[1] - own[1])
}

/// The same at a border, where the bed is that which the cell sees, with g/2.
#[inline]
pub(crate) fn own_thrust_at_border(at: &AtFace, own: [f64; 2], gravity: f64) -> f64 {
    0.5 * gravity * own_thrust([at.depth, at.level], own, at.depth, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_simd::{Level, dispatch};

    /// Wet on both sides, and with dry ground above the level on one.
    #[test]
    fn nothing_pushes_in_a_level_lake() {
        for (bed, own_bed) in [([1.0, 2.5], [0.3, 2.0]), ([1.0, 1.0], [1.0, 1.0]), ([0.0, 4.0], [1.0, 5.0])] {
            dispatch!(Level::new(), simd => {
                let lanes = |value: f64| Lanes::splat(simd, value);
                let zero = lanes(0.0);
                let at = bed.map(|bed: f64| {
                    let depth = (3.0 - bed).max(0.0);
                    AtFaces { depth: lanes(depth), level: lanes(bed + depth), across: zero, along: zero }
                });
                let own = own_bed.map(|bed: f64| [(3.0 - bed).max(0.0), bed.max(3.0)]);
                let found = between(simd, at, own.map(|own| own.map(lanes)), 9.81);
                assert_eq!(found.volume[0], 0.0);
                for (own, thrust) in own.iter().zip(found.thrust) {
                    let push = found.carried[0][0] + thrust[0];
                    assert!(own[0] == 0.0 || push.abs() < 1e-13, "{push}");
                }
            });
        }
    }
}
