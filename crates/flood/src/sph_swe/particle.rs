//! One column of water.

use serde::{Deserialize, Serialize};

/// Speed of light in vacuum, m/s: water that is said to be faster comes of a computation that has broken down. Far below it no square,
/// momentum or energy overflows.
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// The rank of the speed among a particle's quantities.
const SPEED: usize = 3;

/// A particle: a column of water that moves with the flow, of a volume that never changes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Particle {
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Velocity, m/s.
    pub u: f64,
    /// Velocity, m/s.
    pub v: f64,
    /// Acceleration by pressure and ground (friction apart), m/s2.
    pub ax: f64,
    /// Acceleration by pressure and ground (friction apart), m/s2.
    pub ay: f64,
    /// Volume, m3.
    pub volume: f64,
    /// Smoothing length, m.
    pub h: f64,
    /// Smoothing length for the next step, m.
    pub next_h: f64,
    /// Depth of the water, m.
    pub depth: f64,
    /// Height of the ground, m.
    pub ground: f64,
    /// Slope of the ground `[east, north]`.
    pub ground_slope: [f64; 2],
    /// The side over which it has left (0 west, 1 east, 2 south, 3 north): then it is not of this water any more, and goes
    /// on for a while only so that the water before the edge meets water beyond it.
    pub outside: Option<u8>,
    /// Lasting identity.
    pub id: u64,
}

/// A value that no water has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Defect {
    /// The lower, the nearer to the cause.
    pub rank: usize,
    pub quantity: &'static str,
    pub value: f64,
}

impl Particle {
    /// A particle at rest at (x, y) whose depth is not known yet.
    pub fn new(id: u64, x: f64, y: f64, volume: f64, h: f64) -> Self {
        Self {
            x,
            y,
            u: 0.0,
            v: 0.0,
            ax: 0.0,
            ay: 0.0,
            volume,
            h,
            next_h: h,
            depth: 0.0,
            ground: 0.0,
            ground_slope: [0.0; 2],
            outside: None,
            id,
        }
    }

    /// Whether all its values are finite numbers, its volume is positive, and it is slower than light.
    #[inline]
    pub(crate) fn is_sound(&self) -> bool {
        let Self { x, y, u, v, ax, ay, volume, h, next_h, depth, ground, ground_slope, .. } = self;
        let [ground_x, ground_y] = ground_slope;
        let sum = x + y + u + v + ax + ay + volume + h + next_h + depth + ground;
        // A sum of finite numbers of this size is finite; one with a number that is not, is not.
        *volume > 0.0 && u * u + v * v < SPEED_OF_LIGHT * SPEED_OF_LIGHT && (sum + ground_x + ground_y).is_finite()
    }

    /// The first of its quantities that is no finite number, a volume that is not positive, or a speed above that of light, with its
    /// value; none where it is sound. Those of which the others are computed come first.
    pub(crate) fn defect(&self) -> Option<Defect> {
        let quantities = [
            ("volume", [if self.volume > 0.0 { 0.0 } else { f64::NAN }, self.volume]),
            ("position", [self.x, self.y]),
            ("velocity", [self.u, self.v]),
            ("speed", [if self.speed() < SPEED_OF_LIGHT { 0.0 } else { f64::NAN }, self.speed()]),
            ("height of the ground", [self.ground, 0.0]),
            ("slope of the ground", self.ground_slope),
            ("smoothing length", [self.h, self.next_h]),
            ("depth", [self.depth, 0.0]),
            ("acceleration", [self.ax, self.ay]),
        ];
        let is_bad = |values: &[f64; 2]| values.iter().any(|value| !value.is_finite());
        let rank = quantities.iter().position(|(_, values)| is_bad(values))?;
        let (quantity, values) = quantities[rank];
        let value = match rank {
            0 => self.volume,
            SPEED => self.speed(),
            _ if values[0].is_finite() => values[1],
            _ => values[0],
        };
        Some(Defect { rank, quantity, value })
    }

    /// Height of the water's surface, m.
    pub fn surface(&self) -> f64 {
        self.ground + self.depth
    }

    /// Area that the particle stands for, m2.
    pub fn area(&self) -> f64 {
        self.volume / self.depth
    }

    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        (self.u * self.u + self.v * self.v).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_that_is_not_a_number_is_found() {
        let sound = Particle { depth: 2.0, ..Particle::new(7, 1e6, -3e6, 1e-9, 5.0) };
        assert!(sound.is_sound() && sound.defect().is_none());
        let values: [fn(&mut Particle) -> &mut f64; 13] = [
            |p| &mut p.x,
            |p| &mut p.y,
            |p| &mut p.u,
            |p| &mut p.v,
            |p| &mut p.ax,
            |p| &mut p.ay,
            |p| &mut p.volume,
            |p| &mut p.h,
            |p| &mut p.next_h,
            |p| &mut p.depth,
            |p| &mut p.ground,
            |p| &mut p.ground_slope[0],
            |p| &mut p.ground_slope[1],
        ];
        for value in values {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut particle = sound;
                *value(&mut particle) = bad;
                let Defect { quantity, value, .. } = particle.defect().unwrap();
                assert!(!particle.is_sound() && value.to_bits() == bad.to_bits(), "{quantity}");
            }
        }
        for volume in [0.0, -1e-9] {
            let particle = Particle { volume, ..sound };
            assert!(!particle.is_sound());
            assert_eq!(particle.defect(), Some(Defect { rank: 0, quantity: "volume", value: volume }));
        }
        // Their squares are no numbers.
        let (fast, slow) = (Particle { v: -1e200, ..sound }, Particle { v: -1e8, ..sound });
        assert!(!fast.is_sound() && slow.is_sound() && slow.defect().is_none());
        assert_eq!(fast.defect().map(|defect| defect.quantity), Some("speed"));
    }
}
