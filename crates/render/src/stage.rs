//! The part of the world that is drawn, and the coordinates it is drawn in.

use glam::{DVec3, Vec3};

/// The part of the world that is drawn. Its own coordinates, which shaders use, are relative to its centre and so large that
/// its half diagonal is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Its smallest corner, m.
    pub from: DVec3,
    /// Its largest corner, m.
    pub to: DVec3,
}

impl Stage {
    /// The stage between two corners, m.
    pub fn new(from: [f64; 3], to: [f64; 3]) -> Self {
        Self { from: from.into(), to: to.into() }
    }

    /// The middle, m.
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.from + self.to)
    }

    /// Length of a stage unit, m: half the diagonal.
    pub fn unit(&self) -> f64 {
        let half = 0.5 * (self.to - self.from).length();
        if half.is_finite() && half > 0.0 { half } else { 1.0 }
    }

    /// A point of the world, m, in stage coordinates.
    pub fn position(&self, point: [f64; 3]) -> Vec3 {
        ((DVec3::from(point) - self.centre()) / self.unit()).as_vec3()
    }

    /// A length of the world, m, in stage units.
    pub fn length(&self, metres: f64) -> f32 {
        (metres / self.unit()) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_lie_at_distance_one() {
        let stage = Stage::new([1e6, 2e6, 100.0], [1e6 + 2000.0, 2e6 + 1000.0, 300.0]);
        for corner in [[1e6, 2e6, 100.0], [1e6 + 2000.0, 2e6 + 1000.0, 300.0], [1e6, 2e6 + 1000.0, 100.0]] {
            assert!((stage.position(corner).length() - 1.0).abs() < 1e-6);
        }
        assert_eq!(Stage::new([2.0; 3], [2.0; 3]).unit(), 1.0);
    }
}
