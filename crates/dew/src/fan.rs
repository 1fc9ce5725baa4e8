//! Fans: boxes in which air is driven to a velocity.

use serde::{Deserialize, Serialize};

/// How strongly a fan drives: air that crosses it at its speed loses all but exp(-this) of what it was slower by. Our choice: enough
/// that little is left, few enough that it is spread over the fan and sets no sound off.
const DRIVE_EXPONENT: f64 = 4.0;

/// A box in which air is driven to a velocity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fan {
    low: [f64; 3],
    high: [f64; 3],
    /// Unit vector along the velocity.
    direction: [f64; 3],
    /// m/s.
    speed: f64,
    /// 1/s.
    rate: f64,
}

impl Fan {
    /// A fan by its middle, the lengths of its sides, m, and its velocity, m/s; one of no velocity drives nothing.
    pub fn new(middle: [f64; 3], size: [f64; 3], velocity: [f64; 3]) -> Self {
        let speed = velocity.iter().map(|along| along * along).sum::<f64>().sqrt();
        let direction = velocity.map(|along| if speed > 0.0 { along / speed } else { 0.0 });
        // The longest distance through the box along the velocity.
        let depth = (0..3).map(|axis| size[axis] / direction[axis].abs().max(1e-9)).fold(f64::INFINITY, f64::min);
        Self {
            low: [0, 1, 2].map(|axis| middle[axis] - 0.5 * size[axis]),
            high: [0, 1, 2].map(|axis| middle[axis] + 0.5 * size[axis]),
            direction,
            speed,
            rate: DRIVE_EXPONENT * speed / depth,
        }
    }

    /// The same fan with another velocity along an axis, m/s.
    pub fn along(&self, axis: usize, velocity: f64) -> Self {
        let mut whole = self.direction.map(|part| self.speed * part);
        whole[axis] = velocity;
        let middle = [0, 1, 2].map(|axis| 0.5 * (self.low[axis] + self.high[axis]));
        let size = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        Self { low: self.low, high: self.high, ..Self::new(middle, size, whole) }
    }

    /// Its speed, m/s.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// The corners of its box, m.
    #[cfg(feature = "gpu")]
    pub(crate) fn corners(&self) -> [[f64; 3]; 2] {
        [self.low, self.high]
    }

    /// Unit vector along which it drives.
    #[cfg(feature = "gpu")]
    pub(crate) fn direction(&self) -> [f64; 3] {
        self.direction
    }

    /// How fast air takes its speed, 1/s.
    #[cfg(feature = "gpu")]
    pub(crate) fn rate(&self) -> f64 {
        self.rate
    }

    /// What it adds to the acceleration of air at a position that moves at a velocity, m/s2. It holds no air up that is faster.
    pub fn acceleration(&self, position: [f64; 3], velocity: [f64; 3]) -> [f64; 3] {
        if (0..3).any(|axis| position[axis] < self.low[axis] || position[axis] >= self.high[axis]) {
            return [0.0; 3];
        }
        let along: f64 = (0..3).map(|axis| velocity[axis] * self.direction[axis]).sum();
        let drive = self.rate * (self.speed - along).max(0.0);
        self.direction.map(|part| drive * part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_that_crosses_a_fan_takes_its_speed() {
        let fan = Fan::new([0.0; 3], [0.1, 1.0, 1.0], [2.0, 0.0, 0.0]);
        let ([mut x, mut u], step) = ([-0.05, 1.0], 1e-5);
        while x < 0.05 {
            u += step * fan.acceleration([x, 0.0, 0.0], [u, 0.0, 0.0])[0];
            x += step * u;
        }
        assert!((u - 2.0).abs() < 0.1 && u < 2.0, "{u} m/s");
        assert_eq!(fan.acceleration([0.0; 3], [3.0, 0.0, 0.0]), [0.0; 3]);
        assert_eq!(fan.acceleration([0.2, 0.0, 0.0], [0.0; 3]), [0.0; 3]);
    }
}
