//! The box that the air is in, and what its faces do.

use corpuscle_scene::Table;
use serde::{Deserialize, Serialize};

/// What happens at a face of the room.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Face {
    /// What leaves comes in at the opposite face, which must be periodic too.
    Periodic,
    /// A smooth wall that lets neither air nor heat nor vapour through.
    Wall,
    /// Air comes in.
    Inlet(Inflow),
    /// Air leaves.
    Outlet,
    /// Air leaves, and ambient air enters.
    Open,
}

impl Face {
    /// Whether air passes here.
    pub fn is_passed(&self) -> bool {
        matches!(self, Self::Inlet(_) | Self::Outlet | Self::Open)
    }
}

/// Air as it comes in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Inflow {
    /// Velocity, m/s; it leads into the room.
    pub velocity: [f64; 3],
    /// Temperature, K.
    pub temperature: f64,
    /// Part of the mass that is vapour.
    pub vapour: f64,
}

/// Air as it comes in over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct InflowOverTime {
    /// Temperature, K.
    pub temperature: Table,
    /// Part of the mass that is vapour.
    pub vapour: Table,
}

impl InflowOverTime {
    /// Temperature, K, and vapour, part of the mass, at a time.
    pub fn at(&self, time: f64) -> [f64; 2] {
        [self.temperature.at(time), self.vapour.at(time)]
    }
}

/// What comes in by each face where that changes with time, at low and high x, y and z.
pub(crate) type InflowsOverTime = [[Option<InflowOverTime>; 2]; 3];

/// A box with its six faces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Room {
    /// Corner at the smallest coordinates, m.
    pub low: [f64; 3],
    /// Corner at the largest coordinates, m.
    pub high: [f64; 3],
    /// The faces at low and high x, y and z.
    pub faces: [[Face; 2]; 3],
}

/// A ghost particle: what stands beyond faces for a particle in the room, or for a position there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GhostParticle {
    /// Where it stands, m.
    pub position: [f64; 3],
    /// The axes along which it is mirrored: what moves along them moves the other way.
    pub mirrored: [bool; 3],
    /// Whether it is mirrored at a face that air passes.
    pub beyond: bool,
}

/// Distance beyond each face, by axis and end, up to which ghost particles are required, m, where they are.
pub type Mirrors = [[Option<f64>; 2]; 3];

impl Room {
    /// Lengths of the sides, m.
    pub fn size(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.high[axis] - self.low[axis])
    }

    /// How many particles a spacing apart stand along each side.
    pub fn counts(&self, spacing: f64) -> [usize; 3] {
        self.size().map(|side| (side / spacing).round().max(1.0) as usize)
    }

    /// Distance of neighbouring particles along each side, m, nearest to `spacing`.
    pub fn apart(&self, spacing: f64) -> [f64; 3] {
        let (size, counts) = (self.size(), self.counts(spacing));
        [0, 1, 2].map(|axis| size[axis] / counts[axis] as f64)
    }

    /// How far a position is beyond a face, m; negative before it.
    pub fn depth_beyond(&self, position: [f64; 3], axis: usize, side: usize) -> f64 {
        [self.low[axis] - position[axis], position[axis] - self.high[axis]][side]
    }

    /// Whether air stands at a position at the start: in the room, beyond a face that air passes, and beyond two or more faces only where
    /// one of them is open.
    pub fn is_filled(&self, position: [f64; 3]) -> bool {
        let mut beyond = self.faces_before(position);
        let faces = || beyond.clone().map(|(axis, side)| &self.faces[axis][side]);
        faces().all(Face::is_passed) && (faces().any(|face| *face == Face::Open) || beyond.nth(1).is_none())
    }

    /// A position that is beyond faces for which `mirrors` has a reach, mirrored back.
    pub(crate) fn mirrored_back(&self, position: [f64; 3], mirrors: &Mirrors) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let (at, low, high) = (position[axis], self.low[axis], self.high[axis]);
            let [below, above] = mirrors[axis].map(|reach| reach.is_some());
            if at < low && below {
                2.0 * low - at
            } else if at >= high && above {
                2.0 * high - at
            } else {
                at
            }
        })
    }

    /// The faces that a position is beyond: axis and side.
    fn faces_before(&self, position: [f64; 3]) -> impl Iterator<Item = (usize, usize)> + Clone {
        let (low, high) = (self.low, self.high);
        (0..3)
            .flat_map(|axis| [(axis, 0), (axis, 1)])
            .filter(move |&(axis, side)| [position[axis] < low[axis], position[axis] >= high[axis]][side])
    }

    /// Whether a position is inside.
    pub fn contains(&self, position: [f64; 3]) -> bool {
        (0..3).all(|axis| self.low[axis] <= position[axis] && position[axis] < self.high[axis])
    }

    /// Calls `found` with every ghost particle of a position that is within `reach` of the room, beyond periodic faces and walls.
    pub fn ghost_particles(&self, position: [f64; 3], reach: f64, found: impl FnMut(GhostParticle)) {
        self.ghost_particles_beyond(position, &[[None; 2]; 3], reach, found);
    }

    /// The same, and mirror images within a reach of their own beyond those of the other faces, by axis and end, for which `mirrors` has one.
    pub fn ghost_particles_beyond(
        &self,
        position: [f64; 3],
        mirrors: &Mirrors,
        reach: f64,
        mut found: impl FnMut(GhostParticle),
    ) {
        let farthest = mirrors.iter().flatten().flatten().copied().fold(reach, f64::max);
        let near =
            |axis: usize| position[axis] - self.low[axis] < farthest || self.high[axis] - position[axis] < farthest;
        if !(0..3).any(near) {
            return;
        }
        // Along each axis the position itself comes first, then its ghost particles.
        let mut along = [[(0.0, false, false); 3]; 3];
        let mut count = [1; 3];
        for axis in 0..3 {
            let (low, high, at) = (self.low[axis], self.high[axis], position[axis]);
            along[axis][0] = (at, false, false);
            for side in 0..2 {
                let mirrored = |beyond: bool| (2.0 * [low, high][side] - at, true, beyond);
                let (ghost, reach) = match (self.faces[axis][side], mirrors[axis][side]) {
                    (Face::Periodic, _) => ((at + [low - high, high - low][side], false, false), reach),
                    (Face::Wall, _) => (mirrored(false), reach),
                    (Face::Inlet(_) | Face::Outlet | Face::Open, Some(reach)) => (mirrored(true), reach),
                    (Face::Inlet(_) | Face::Outlet | Face::Open, None) => continue,
                };
                if ghost.0 > low - reach && ghost.0 < high + reach {
                    along[axis][count[axis]] = ghost;
                    count[axis] += 1;
                }
            }
        }
        let mut itself = true;
        for &z in &along[2][..count[2]] {
            for &y in &along[1][..count[1]] {
                for &x in &along[0][..count[0]] {
                    if !std::mem::take(&mut itself) {
                        found(GhostParticle {
                            position: [x.0, y.0, z.0],
                            mirrored: [x.1, y.1, z.1],
                            beyond: x.2 || y.2 || z.2,
                        });
                    }
                }
            }
        }
    }

    /// Brings back what has crossed periodic faces and walls.
    pub fn keep(&self, position: &mut [f64; 3], velocity: &mut [f64; 3]) {
        for axis in 0..3 {
            let (low, high) = (self.low[axis], self.high[axis]);
            let side = usize::from(position[axis] >= high);
            if position[axis] >= low && side == 0 {
                continue;
            }
            match self.faces[axis][side] {
                Face::Periodic => {
                    let shifted = low + (position[axis] - low).rem_euclid(high - low);
                    position[axis] = if shifted < high { shifted } else { low };
                }
                Face::Wall => {
                    position[axis] = self.mirrored_inside(position[axis], axis, side);
                    velocity[axis] = -velocity[axis];
                }
                Face::Inlet(_) | Face::Outlet | Face::Open => {}
            }
        }
    }

    /// Brings back air of the room that was pushed out by an inlet: there it moves as what comes in.
    pub fn hold_at_inlets(&self, position: &mut [f64; 3], velocity: &mut [f64; 3]) {
        for axis in 0..3 {
            for side in 0..2 {
                if let Face::Inlet(inflow) = self.faces[axis][side]
                    && [position[axis] < self.low[axis], position[axis] >= self.high[axis]][side]
                {
                    position[axis] = self.mirrored_inside(position[axis], axis, side);
                    velocity[axis] = inflow.velocity[axis];
                }
            }
        }
    }

    /// A coordinate beyond a side, mirrored at it, but not beyond the opposite side.
    fn mirrored_inside(&self, at: f64, axis: usize, side: usize) -> f64 {
        let (low, high) = (self.low[axis], self.high[axis]);
        (2.0 * [low, high][side] - at).clamp(low, high.next_down())
    }

    /// Moves a particle that crossed the rim of a face to the opposite rim: air before an inlet is the same everywhere.
    pub fn wrap_along(&self, face: usize, position: &mut [f64; 3]) {
        for axis in (0..3).filter(|&axis| axis != face) {
            let (low, high) = (self.low[axis], self.high[axis]);
            if position[axis] < low || position[axis] >= high {
                let shifted = low + (position[axis] - low).rem_euclid(high - low);
                position[axis] = if shifted < high { shifted } else { low };
            }
        }
    }

    /// The first outlet to which a position in the room is nearer than `reach`: axis and side.
    pub fn outlet_near(&self, position: [f64; 3], reach: f64) -> Option<(usize, usize)> {
        (0..3).find_map(|axis| {
            let to = [position[axis] - self.low[axis], self.high[axis] - position[axis]];
            let side = (0..2).find(|&side| to[side] < reach && self.faces[axis][side] == Face::Outlet)?;
            Some((axis, side))
        })
    }

    /// Whether a position is beyond two faces or more, one of them open.
    pub fn is_beyond_edge(&self, position: [f64; 3]) -> bool {
        let mut beyond = self.faces_before(position);
        beyond.clone().any(|(axis, side)| self.faces[axis][side] == Face::Open) && beyond.nth(1).is_some()
    }

    /// The face that air passes beyond which a position lies, an open one before others: axis and side.
    pub fn beyond(&self, position: [f64; 3]) -> Option<(usize, usize)> {
        let passed = |&(axis, side): &(usize, usize)| self.faces[axis][side].is_passed();
        let open = |&(axis, side): &(usize, usize)| self.faces[axis][side] == Face::Open;
        let mut beyond = self.faces_before(position).filter(passed);
        beyond.clone().find(open).or_else(|| beyond.next())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room(faces: [[Face; 2]; 3]) -> Room {
        Room { low: [0.0; 3], high: [1.0, 2.0, 3.0], faces }
    }

    #[test]
    fn a_corner_has_seven_ghost_particles() {
        let walls = room([[Face::Wall; 2]; 3]);
        let mut ghosts = Vec::new();
        walls.ghost_particles([0.1, 0.1, 2.9], 0.2, |ghost| ghosts.push(ghost));
        assert_eq!(ghosts.len(), 7);
        assert!(ghosts.contains(&GhostParticle {
            position: [-0.1, -0.1, 0.1 + 3.0],
            mirrored: [true; 3],
            beyond: false
        }));
        let mut one = Vec::new();
        room([[Face::Periodic; 2]; 3]).ghost_particles([0.5, 1.9, 1.0], 0.2, |ghost| one.push(ghost.position));
        assert_eq!(one.len(), 1);
        assert!((one[0][1] + 0.1).abs() < 1e-12);
    }

    #[test]
    fn what_leaves_comes_back() {
        let mixed = room([[Face::Periodic; 2], [Face::Wall; 2], [Face::Outlet; 2]]);
        let (mut position, mut velocity) = ([-0.25, 2.5, 3.5], [1.0; 3]);
        mixed.keep(&mut position, &mut velocity);
        assert_eq!((position, velocity), ([0.75, 1.5, 3.5], [1.0, -1.0, 1.0]));
        assert_eq!(mixed.beyond(position), Some((2, 1)));
    }
}
