//! One column of water.

use serde::{Deserialize, Serialize};

/// A particle: a column of water that moves with the flow. Its volume is its own; rain and infiltration change it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Particle {
    /// Place, m.
    pub x: f64,
    /// Place, m.
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
    /// Volume by which it counts in the depth of the water round it, m3. That of a particle of its size as the scene asks for
    /// it; `volume / weight` makes the depth exact where its neighbours stand unevenly. Parts of a particle share both.
    pub weight: f64,
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
    /// Slope of the water's surface.
    pub surface_slope: [f64; 2],
    /// The side over which it has left (0 west, 1 east, 2 south, 3 north): then it is not of this water any more, and goes
    /// on for a while only so that the water before the edge meets water beyond it.
    pub outside: Option<u8>,
    /// Lasting identity.
    pub id: u64,
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
            weight: volume,
            h,
            next_h: h,
            depth: 0.0,
            ground: 0.0,
            ground_slope: [0.0; 2],
            surface_slope: [0.0; 2],
            outside: None,
            id,
        }
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
