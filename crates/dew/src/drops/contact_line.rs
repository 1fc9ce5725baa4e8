//! The contact line of a drop: where it stays, how it holds a drop, and how it brakes one that slides.

use super::Cap;
use std::f64::consts::PI;

/// What holds a drop on an inclined solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Retention {
    /// Contact-angle hysteresis: the line recedes below one angle and advances above the other, both measured inside the drop, between 0 and pi. It holds
    /// up to 2 a gamma (cos receding - cos advancing), a the covered radius (Furmidge, Journal of Colloid Science 17, 1962, 309).
    Hysteresis {
        /// Angle at which the line recedes.
        receding: f64,
        /// Angle at which it advances.
        advancing: f64,
    },
    /// Friction up to this part of the force with which the air presses the drop on the solid (mu_f of patent CN106650064B). The contact angle is one.
    Friction(f64),
}

impl Retention {
    /// The angles between which the line stays, for drops of this contact angle.
    fn angles(self, contact_angle: f64) -> [f64; 2] {
        match self {
            Self::Hysteresis { receding, advancing } => [receding, advancing],
            Self::Friction(_) => [contact_angle; 2],
        }
    }
}

/// The shapes between which a contact line stays.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactLine {
    receding: Cap,
    advancing: Cap,
}

impl ContactLine {
    pub fn new(retention: Retention, contact_angle: f64) -> Self {
        let [receding, advancing] = retention.angles(contact_angle).map(Cap::new);
        Self { receding, advancing }
    }

    /// Covered radius of a drop that has this volume now and covered `radius` before, m.
    pub fn radius(&self, radius: f64, volume: f64) -> f64 {
        // Not by `clamp`: rounding may turn round angles that are all but the same.
        radius.max(self.advancing.covered_radius(volume)).min(self.receding.covered_radius(volume))
    }
}

/// The length at which the wedge of water at a contact line ends, that of molecules, m (de Gennes, Reviews of Modern Physics 57, 1985, 827).
const MOLECULE: f64 = 1e-9;

/// Force that brakes a sliding drop over its speed, N s/m: viscous stress in the wedge at its contact line, 2 sin^2 / (angle - sin cos) viscosity U ln(a / l) for
/// a length of line (Huh & Scriven, Journal of Colloid and Interface Science 35, 1971, 85; for small angles 3 / angle, de Gennes 1985), along the
/// way it slides and round a circle. So Kim, Lee & Kang (Journal of Colloid and Interface Science 247, 2002, 372) balance weight, retention and drag.
pub(super) fn drag(radius: f64, angle: f64, viscosity: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let wedge = 2.0 * sin * sin / (angle - sin * cos);
    PI * radius * viscosity * wedge * (radius / MOLECULE).ln().max(1.0)
}

/// Vapour that leaves a drop, over diffusivity, difference of density and covered radius (Hu & Larson, Journal of Physical Chemistry B 106, 2002, 1334,
/// fitted up to a right angle).
pub(super) fn evaporation(angle: f64) -> f64 {
    PI * (0.27 * angle * angle + 1.30)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_stays_between_its_angles() {
        let line = ContactLine::new(Retention::Hysteresis { receding: 1.0, advancing: 2.0 }, 1.5);
        let (low, high) = (Cap::new(2.0).covered_radius(1.0), Cap::new(1.0).covered_radius(1.0));
        assert!(low < high);
        assert_eq!(
            [0.0, low, 0.5 * (low + high), high, 9.0].map(|r| line.radius(r, 1.0)),
            [low, low, 0.5 * (low + high), high, high]
        );
        let one = ContactLine::new(Retention::Friction(1.0), 1.5);
        assert_eq!([0.0, 9.0].map(|r| one.radius(r, 1.0)), [Cap::new(1.5).covered_radius(1.0); 2]);
    }

    #[test]
    fn angles_that_are_all_but_the_same_are_no_trouble() {
        for step in 1..200 {
            let receding = f64::from(step) / 64.0;
            let line = ContactLine::new(Retention::Hysteresis { receding, advancing: receding.next_up() }, receding);
            let radius = line.radius(1.0, 1.0);
            assert!((radius / Cap::new(receding).covered_radius(1.0) - 1.0).abs() < 1e-12, "{receding}");
        }
    }

    #[test]
    fn flat_drops_are_braked_as_thin_wedges_are() {
        // 3 pi viscosity a ln(a / l) / angle.
        let thin = 3.0 * PI * 1e-3 * 1e-3 * 1e6_f64.ln() / 0.01;
        assert!((drag(1e-3, 0.01, 1e-3) / thin - 1.0).abs() < 1e-4);
    }

    #[test]
    fn drops_evaporate_as_disks_and_half_balls_do() {
        // 4 a and 2 pi a, exactly (Crank 1975; a ball's 4 pi a halved).
        assert!((evaporation(0.0) / 4.0 - 1.0).abs() < 0.03 && (evaporation(0.5 * PI) / (2.0 * PI) - 1.0).abs() < 0.03);
    }
}
