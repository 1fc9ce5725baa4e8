//! What passes a face, and how the ground pushes the water on both sides.

mod riemann;

pub(crate) use riemann::{Side, hll};

use super::reconstruction::AtFace;

/// What a face does, per length and in its own directions: across and along it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Crossing {
    /// Volume from the first cell to the second, m2/s.
    pub volume: f64,
    /// Momentum across and along the face that goes with it, over density, m3/s2.
    pub carried: [f64; 2],
    /// Thrust across the face on the first cell and on the second, over density, m3/s2: the mean hydrostatic thrust, the ground's, and the
    /// cell's own, which comes to nothing round the cell.
    pub thrust: [f64; 2],
}

/// What a face does.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Flux {
    /// Volume from the first cell to the second, m3/s.
    pub volume: f64,
    /// Momentum `[east, north]` that goes with it, over density, m4/s2.
    pub carried: [f64; 2],
    /// Thrust across the face on the first cell and on the second, over density and length, m3/s2.
    pub thrust: [f64; 2],
}

impl Crossing {
    /// The flux through a face with the unit normal `[nx, ny]`.
    #[inline(always)]
    pub fn through(self, length: f64, [nx, ny]: [f64; 2]) -> Flux {
        let [across, along] = self.carried.map(|value| value * length);
        let carried = [across * nx - along * ny, across * ny + along * nx];
        Flux { volume: self.volume * length, carried, thrust: self.thrust }
    }
}

/// The flux through a face of unit length between two cells, whose water has depth and level `own` (the second's as seen from the first).
///
/// The bed at the face is the higher of the two, but not above the lower level (Chen & Noelle 2017, equations 2.12 to 2.16); the ground's thrust
/// is the integral of g d dz along the straight line from the cell's value to the face's, so that nothing is left in a level lake, face by face.
#[inline(always)]
pub(crate) fn between(at: [AtFace; 2], own: [[f64; 2]; 2], gravity: f64) -> Crossing {
    let bed = at.map(|side| side.level - side.depth);
    let face_bed = bed[0].max(bed[1]).min(at[0].level.min(at[1].level));
    let sides = at.map(|side| Side { depth: (side.level - face_bed).max(0.0).min(side.depth), across: side.across });
    let thrust = [0, 1].map(|k| own_thrust(&at[k], own[k], sides[k].depth, face_bed - bed[k], gravity));
    let [volume, momentum] = hll(sides[0], sides[1], gravity);
    let [a, b] = sides.map(|side| side.depth);
    let mean = 0.25 * gravity * (a * a + b * b);
    let along = if volume > 0.0 { at[0].along } else { at[1].along };
    Crossing { volume, carried: [momentum - mean, volume * along], thrust: thrust.map(|thrust| thrust + mean) }
}

/// Thrust of the ground between a cell's centroid and the face, and of the cell itself: `own` are its depth and level, `depth` the depth over the
/// face's bed, which stands `step` m above the bed that the cell sees there.
#[inline(always)]
pub(crate) fn own_thrust(at: &AtFace, own: [f64; 2], depth: f64, step: f64, gravity: f64) -> f64 {
    0.5 * gravity * ((at.depth + depth) * step - at.depth * at.depth + (at.depth + own[0]) * (at.level - own[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(level: f64, bed: f64) -> AtFace {
        let depth = (level - bed).max(0.0);
        AtFace { depth, level: bed + depth, ..AtFace::default() }
    }

    /// Wet on both sides, and with dry ground above the level on one.
    #[test]
    fn nothing_pushes_in_a_level_lake() {
        for (bed, own_bed) in [([1.0, 2.5], [0.3, 2.0]), ([1.0, 1.0], [1.0, 1.0]), ([0.0, 4.0], [1.0, 5.0])] {
            let at = bed.map(|bed| at(3.0, bed));
            let own = own_bed.map(|bed: f64| [(3.0 - bed).max(0.0), bed.max(3.0)]);
            let flux = between(at, own, 9.81);
            assert_eq!(flux.volume, 0.0);
            for (own, thrust) in own.iter().zip(flux.thrust) {
                let push = flux.carried[0] + thrust;
                assert!(own[0] == 0.0 || push.abs() < 1e-13, "{push}");
            }
        }
    }
}
