//! A particle of air.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

/// A particle of air of constant mass that moves with the flow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Particle {
    /// Position, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Acceleration, m/s2.
    pub acceleration: [f64; 3],
    /// How its position is evened out among its neighbours: times the square of the time step it is a displacement, m/s2.
    pub spreading: [f64; 3],
    /// Temperature, K.
    pub temperature: f64,
    /// Part of the mass that is vapour; where humidity diffuses to the letter of the patent, relative humidity.
    pub vapour: f64,
    /// Part of the mass that is fog, liquid that the air carries.
    pub fog: f64,
    /// Density, kg/m3.
    pub density: f64,
    /// Lasting identity.
    pub id: u64,
    /// Whether it is in the room.
    pub role: Role,
    /// For how long it has been of low utility, s.
    pub idle: f64,
}

/// Whether a particle is in the room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// In the room, and taking part in everything.
    Inside,
    /// Before an inlet, moving in: axis and side of the face.
    Coming(u8, u8),
    /// Beyond an outlet, moving away: axis and side of the face.
    Leaving(u8, u8),
    /// Beyond an open side, where it comes and goes as the air before it does: axis and side of the face.
    Outside(u8, u8),
    /// Beyond an edge of the room at an open side, where it stays: so that air before the edge has neighbours all round.
    Still,
    /// Has left by such an edge, and is about to be taken out.
    Gone,
    /// In the room, but of low utility: it only moves. The ledger has booked it as outflow.
    Idle,
}

impl Role {
    /// Whether the face that it names, if any, is one of a room.
    pub fn names_a_face(self) -> bool {
        match self {
            Self::Coming(axis, side) | Self::Leaving(axis, side) | Self::Outside(axis, side) => axis < 3 && side < 2,
            Self::Inside | Self::Still | Self::Gone | Self::Idle => true,
        }
    }
}

impl Particle {
    /// Air at rest, without fog.
    pub fn new(id: u64, position: [f64; 3], temperature: f64, vapour: f64) -> Self {
        Self {
            position,
            velocity: [0.0; 3],
            acceleration: [0.0; 3],
            spreading: [0.0; 3],
            temperature,
            vapour,
            fog: 0.0,
            density: 0.0,
            id,
            role: Role::Inside,
            idle: 0.0,
        }
    }

    /// Goes on beyond an outlet, along its axis at a velocity, m/s, but outwards and at a speed of at least `slowest`.
    pub fn leave(&mut self, axis: usize, side: usize, along: f64, slowest: f64) {
        let outward = [-1.0, 1.0][side];
        self.role = Role::Leaving(axis as u8, side as u8);
        self.velocity[axis] = outward * (outward * along).max(slowest);
    }

    /// Square of the speed, m2/s2.
    pub fn speed_squared(&self) -> f64 {
        self.velocity.iter().map(|along| along * along).sum()
    }

    /// Velocity, m/s, `ahead` s on for air in the room.
    pub fn velocity_ahead(&self, ahead: f64) -> [f64; 3] {
        let mut velocity = self.velocity;
        if self.role == Role::Inside {
            (0..3).for_each(|axis| velocity[axis] += ahead * self.acceleration[axis]);
        }
        velocity
    }
}

/// What is needed of a particle of another process before neighbours are searched.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct HaloParticle {
    /// Position, m.
    pub position: [f64; 3],
    /// Velocity as far ahead as that of the own air, m/s.
    pub velocity: [f64; 3],
    /// Temperature, K.
    pub temperature: f64,
    /// Part of the mass that is vapour.
    pub vapour: f64,
    /// Lasting identity.
    pub id: u64,
}

impl HaloParticle {
    /// A copy of a particle, whose velocity is taken `ahead` s on.
    pub fn new(particle: &Particle, ahead: f64) -> Self {
        let Particle { position, temperature, vapour, id, .. } = *particle;
        Self { position, velocity: particle.velocity_ahead(ahead), temperature, vapour, id }
    }
}
