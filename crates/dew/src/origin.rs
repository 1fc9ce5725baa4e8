//! Particles of air from the host's numbers to the shaders' and back.

use crate::air::{Particle, Role};
use crate::room::Room;
use crate::shared::{self, COMING, FACE_BITS, IDLE, INSIDE, LEAVING, OUTSIDE, ROLE_MASK, STILL};
use corpuscle_gpu::{from_pair, to_pair};

/// Where the shaders count from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin {
    pub room: Room,
    /// Temperature, K, and part of the mass that is vapour.
    pub temperature: f64,
    pub vapour: f64,
}

impl Origin {
    /// The middle of the room.
    pub fn middle(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| 0.5 * (self.room.low[axis] + self.room.high[axis]))
    }

    /// A position from the middle of the room.
    pub fn relative(&self, position: [f64; 3]) -> [f32; 3] {
        let middle = self.middle();
        [0, 1, 2].map(|axis| (position[axis] - middle[axis]) as f32)
    }

    /// The same for a particle: rounding must not put it over a high face.
    fn relative_inside(&self, position: [f64; 3]) -> [f32; 3] {
        let (high, relative) = (self.relative(self.room.high), self.relative(position));
        [0, 1, 2].map(|axis| {
            let is_inside = position[axis] < self.room.high[axis];
            if is_inside { relative[axis].min(high[axis].next_down()) } else { relative[axis] }
        })
    }

    pub fn to_gpu(self, particle: &Particle) -> shared::Particle {
        let narrow = |vector: [f64; 3]| vector.map(|along| along as f32);
        shared::Particle {
            position: self.relative_inside(particle.position),
            density: particle.density as f32,
            velocity: narrow(particle.velocity),
            fog: particle.fog as f32,
            acceleration: narrow(particle.acceleration),
            spreading: narrow(particle.spreading),
            id: particle.id as u32,
            temperature: to_pair(particle.temperature - self.temperature),
            vapour: to_pair(particle.vapour - self.vapour),
            role: role(particle.role),
            idle: particle.idle as f32,
            ..shared::Particle::default()
        }
    }

    pub fn to_host(self, particle: &shared::Particle) -> Particle {
        let wide = |vector: [f32; 3]| vector.map(f64::from);
        let (position, middle) = (wide(particle.position), self.middle());
        Particle {
            position: [0, 1, 2].map(|axis| position[axis] + middle[axis]),
            velocity: wide(particle.velocity),
            acceleration: wide(particle.acceleration),
            spreading: wide(particle.spreading),
            temperature: from_pair(particle.temperature) + self.temperature,
            vapour: from_pair(particle.vapour) + self.vapour,
            fog: f64::from(particle.fog),
            density: f64::from(particle.density),
            id: u64::from(particle.id),
            role: role_of(particle.role),
            idle: f64::from(particle.idle),
        }
    }
}

/// As the shaders have roles. None that has gone is there at the end of a step.
fn role(role: Role) -> u32 {
    let of_face = |kind: u32, axis: u8, side: u8| kind | ((2 * u32::from(axis) + u32::from(side)) << FACE_BITS);
    match role {
        Role::Coming(axis, side) => of_face(COMING, axis, side),
        Role::Leaving(axis, side) => of_face(LEAVING, axis, side),
        Role::Outside(axis, side) => of_face(OUTSIDE, axis, side),
        Role::Still => STILL,
        Role::Idle => IDLE,
        Role::Inside | Role::Gone => INSIDE,
    }
}

fn role_of(role: u32) -> Role {
    let face = (role >> FACE_BITS) as u8;
    match role & ROLE_MASK {
        COMING => Role::Coming(face / 2, face % 2),
        LEAVING => Role::Leaving(face / 2, face % 2),
        OUTSIDE => Role::Outside(face / 2, face % 2),
        STILL => Role::Still,
        IDLE => Role::Idle,
        _ => Role::Inside,
    }
}
