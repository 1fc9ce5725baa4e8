//! The water at the sides of the terrain: what is beyond a face there is a state of water, by the characteristics that reach the face.

mod open;
mod state;
#[cfg(feature = "gpu")]
mod upload;

pub(crate) use open::Boundaries;
#[cfg(feature = "gpu")]
pub(crate) use open::{CROSSINGS, FEWEST_CROSSINGS, LAG};
pub(crate) use state::state;

use super::fluxes::{Crossing, own_thrust_at_border};
use super::reconstruction::AtFace;
use corpuscle_scene::Table;

/// What a side of the terrain, or a part of one, does.
#[derive(Debug, Clone)]
pub(crate) enum Boundary {
    /// A wall without friction.
    Wall,
    /// Joined to the opposite side.
    Periodic,
    /// Water leaves, and none comes in.
    Open,
    /// The level over time, m.
    Level(Table),
    /// Discharge inwards over time, m3/s, shared out by conveyance.
    Discharge(Table),
    /// A wave comes in: level over time, m, velocity inwards over time, m/s, at least one of them; and the level at rest, m.
    Wave { level: Option<Table>, velocity: Option<Table>, rest: f64 },
    /// A moving wall: its displacement inwards over time, m.
    Paddle(Table),
    /// Water leaves at the depth of normal flow: the root of the slope.
    NormalDepth(f64),
    /// Discharge outwards, m3/s, by the level before the side, m.
    Rating(Table),
}

impl Boundary {
    /// Whether the image of the water behind it counts in slopes.
    pub fn mirrors(&self) -> bool {
        matches!(self, Self::Wall)
    }

    /// Whether water may come in over it onto dry ground.
    pub fn brings(&self) -> bool {
        matches!(self, Self::Level(_) | Self::Discharge(_) | Self::Wave { .. })
    }
}

/// What a boundary face does in a stage of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Now {
    Wall,
    /// Water leaves, and none comes in. The level beyond, m, where there was water at the start; the bed or less elsewhere.
    Open(f64),
    /// Level, m, and velocity outwards, m/s, of the water beyond, and the ground under the face, m, over which it comes in where it is faster than waves.
    Beyond(f64, f64, f64),
    /// Discharge inwards, m2/s; negative outwards.
    Discharge(f64),
    /// A wall with this velocity inwards, m/s.
    Moving(f64),
    /// Velocity of normal flow over the depth to 2/3, m^(1/3)/s.
    Normal(f64),
}

/// Depth, m, and velocity outwards, m/s, of the water at a boundary face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AtBoundary {
    pub depth: f64,
    pub across: f64,
}

/// What passes a border face of unit length; `own` are depth and level of the cell.
#[inline]
pub(crate) fn through(now: Now, at: AtFace, own: [f64; 2], gravity: f64) -> Crossing {
    let pushed = own_thrust_at_border(&at, own, gravity);
    if let Now::Wall = now {
        return Crossing { thrust: thrust_on_wall(&at, gravity) + pushed, ..Crossing::default() };
    }
    let AtBoundary { depth, across } = state(now, &at, gravity);
    let along = if across > 0.0 { at.along } else { 0.0 };
    let volume = match now {
        // The hydrograph's, to the last bit.
        Now::Discharge(discharge) if discharge >= 0.0 => -discharge,
        _ => depth * across,
    };
    let carried = [volume * across, volume * along];
    Crossing { volume, carried, thrust: 0.5 * gravity * depth * depth + pushed }
}

/// Thrust on a wall over density, m3/s2: the flux of Harten, Lax & van Leer between the water and its mirror image, whose wave speeds are
/// u - c and, from the two-rarefaction state, c + u/2 (Toro 2001, equation 10.18).
fn thrust_on_wall(at: &AtFace, gravity: f64) -> f64 {
    let AtFace { depth, across, .. } = *at;
    let celerity = (gravity * depth).sqrt();
    let fastest = (celerity - across).max(celerity + 0.5 * across);
    depth * across * (across + fastest) + 0.5 * gravity * depth * depth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn still_water_stays_still_at_every_boundary() {
        let at = AtFace { depth: 2.0, level: 3.0, across: 0.0, along: 0.4 };
        for now in [Now::Wall, Now::Open(3.0), Now::Beyond(3.0, 0.0, 0.9), Now::Discharge(0.0), Now::Moving(0.0)] {
            let flux = through(now, at, [2.0, 3.0], 9.81);
            assert!(
                flux.volume.abs() < 1e-14 && flux.carried[0].abs() < 1e-14 && flux.thrust.abs() < 1e-13,
                "{now:?} {flux:?}"
            );
        }
    }
}
