//! Water in the air: falls freely until it meets ground or water.

use super::particle::Particle;
use super::sampling::Sampler;
use serde::{Deserialize, Serialize};

/// A particle in the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Falling {
    pub particle: Particle,
    /// Height, m.
    pub z: f64,
    /// Upward velocity, m/s.
    pub w: f64,
}

impl Falling {
    /// Falls for `step` s.
    pub fn fall(&mut self, gravity: f64, step: f64) {
        self.z += step * (self.w - 0.5 * gravity * step);
        self.w -= gravity * step;
        self.particle.x += step * self.particle.u;
        self.particle.y += step * self.particle.v;
    }

    /// Whether it has met ground or water.
    pub fn has_landed(&self, water: &Sampler) -> bool {
        let Particle { x, y, .. } = self.particle;
        let ground = water.terrain.height(x, y);
        self.z <= ground || (water.may_be_wet(x, y) && self.z <= ground + water.at(x, y).depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falls_as_galilei_says() {
        let mut drop = Falling { particle: Particle::new(0, 0.0, 0.0, 1.0, 1.0), z: 30.0, w: 0.0 };
        for _ in 0..100 {
            drop.fall(9.81, 0.02);
        }
        assert!((drop.z - (30.0 - 0.5 * 9.81 * 4.0)).abs() < 1e-10);
    }
}
