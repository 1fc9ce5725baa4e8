//! What momentum and energy have moved, summed over the balls.

use serde::{Deserialize, Serialize};

/// Pairs of axes: momentum along one, moved along the other.
const SHEARS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Helfand's moments (Phys. Rev. 119, 1960, 1): sums over the balls of momentum times position and of energy times position, as they
/// change. Balls carry both in flight, and in a collision both jump from centre to centre (Alder, Gass & Wainwright, J. Chem. Phys.
/// 53, 1970, 3813). In a box that repeats they go on growing, as if it had no end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Moments {
    /// Momentum along x moved along y; in three dimensions x along z and y along z, too.
    pub momentum: [f64; 3],
    /// Kinetic energy moved along each axis.
    pub energy: [f64; 3],
}

impl Moments {
    /// Number of moments of momentum in two or three dimensions.
    pub const fn shears(dimensions: usize) -> usize {
        dimensions * (dimensions - 1) / 2
    }

    /// A ball flies for a time.
    #[inline(always)]
    pub fn fly<const D: usize>(&mut self, mass: f64, velocity: &[f64; D], time: f64) {
        let mut energy = 0.0;
        for v in velocity {
            energy += 0.5 * mass * v * v;
        }
        for axis in 0..D {
            self.energy[axis] += energy * velocity[axis] * time;
        }
        for (moment, (a, b)) in self.momentum.iter_mut().zip(SHEARS).take(Self::shears(D)) {
            *moment += mass * velocity[a] * velocity[b] * time;
        }
    }

    /// A ball is given the momentum `impulse` times `apart` and the energy `gain` by one that is `apart` from it.
    #[inline(always)]
    pub fn collide<const D: usize>(&mut self, apart: &[f64; D], impulse: f64, gain: f64) {
        for axis in 0..D {
            self.energy[axis] -= gain * apart[axis];
        }
        for (moment, (a, b)) in self.momentum.iter_mut().zip(SHEARS).take(Self::shears(D)) {
            *moment -= impulse * apart[a] * apart[b];
        }
    }
}
