//! The shape of a drop: a cap of a sphere.

use std::f64::consts::PI;

/// Caps of one contact angle. Small drops are caps: below the capillary length, 2.7 mm for water, surface tension outdoes
/// gravity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    sin: f64,
    cos: f64,
}

impl Cap {
    /// Caps that meet the solid at this angle, measured inside the drop, between 0 and pi.
    pub fn new(contact_angle: f64) -> Self {
        Self { sin: contact_angle.sin(), cos: contact_angle.cos() }
    }

    /// Radius of the sphere whose cap has this volume: V = pi/3 R^3 (2 + cos)(1 - cos)^2.
    pub fn sphere_radius(&self, volume: f64) -> f64 {
        let part = (2.0 + self.cos) * (1.0 - self.cos).powi(2);
        (3.0 * volume / (PI * part)).cbrt()
    }

    /// Radius of the disk of solid that is covered.
    pub fn covered_radius(&self, volume: f64) -> f64 {
        self.sphere_radius(volume) * self.sin
    }

    /// Volume of the drop that covers a disk of this radius.
    pub fn volume(&self, covered_radius: f64) -> f64 {
        let radius = covered_radius / self.sin;
        PI / 3.0 * radius.powi(3) * (2.0 + self.cos) * (1.0 - self.cos).powi(2)
    }
}

/// Height of a cap of this volume over the disk that it covers: the root of V = pi/6 h (3 a^2 + h^2) (Cardano).
pub fn height(covered_radius: f64, volume: f64) -> f64 {
    let (half, square) = (3.0 * volume / PI, covered_radius * covered_radius);
    let large = (half + half.hypot(square * covered_radius)).cbrt();
    large - square / large
}

/// Contact angle of such a cap.
pub fn angle(covered_radius: f64, volume: f64) -> f64 {
    2.0 * height(covered_radius, volume).atan2(covered_radius)
}

/// How far such a cap reaches sideways: where it overhangs, farther than it covers.
pub fn reach(covered_radius: f64, volume: f64) -> f64 {
    let height = height(covered_radius, volume);
    if height > covered_radius { 0.5 * (covered_radius * covered_radius / height + height) } else { covered_radius }
}

#[cfg(test)]
mod tests {
    use super::{Cap, angle, height, reach};
    use std::f64::consts::PI;

    #[test]
    fn right_angles_make_half_balls_and_flat_ones_thin_caps() {
        let half = Cap::new(0.5 * PI);
        let volume = 2.0 / 3.0 * PI * 8.0;
        assert!((half.covered_radius(volume) - 2.0).abs() < 1e-12 && (height(2.0, volume) - 2.0).abs() < 1e-12);
        // A thin cap is a paraboloid: V = pi a^2 h / 2, h = a tan(angle / 2).
        let flat = Cap::new(0.01);
        let volume = 0.5 * PI * 0.005;
        assert!((flat.covered_radius(volume) - 1.0).abs() < 1e-4 && (height(1.0, volume) / 0.005 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn volume_and_radius_are_inverse_and_round_drops_overhang() {
        for degrees in [10.0_f64, 60.0, 90.0, 120.0, 170.0] {
            let cap = Cap::new(degrees.to_radians());
            let volume = cap.volume(0.7);
            assert!((cap.covered_radius(volume) - 0.7).abs() < 1e-12);
            assert!((angle(0.7, volume).to_degrees() - degrees).abs() < 1e-6, "{degrees}");
            assert_eq!(reach(0.7, volume) > 0.7 + 1e-9, degrees > 90.0, "{degrees}");
        }
    }
}
