//! A rectangle on the ground.

use serde::{Deserialize, Serialize};

/// A rectangle in model coordinates, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// West side.
    pub x_min: f64,
    /// East side.
    pub x_max: f64,
    /// South side.
    pub y_min: f64,
    /// North side.
    pub y_max: f64,
}

impl Bounds {
    /// True inside and on the sides.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        (self.x_min..=self.x_max).contains(&x) && (self.y_min..=self.y_max).contains(&y)
    }

    /// True where a disc of `radius` m round (x, y) is inside.
    pub fn holds_disc(&self, x: f64, y: f64, radius: f64) -> bool {
        self.x_min + radius < x && x < self.x_max - radius && self.y_min + radius < y && y < self.y_max - radius
    }

    /// Extent `[east, north]`, m.
    pub fn size(&self) -> [f64; 2] {
        [self.x_max - self.x_min, self.y_max - self.y_min]
    }

    /// The middle `[x, y]`.
    pub fn centre(&self) -> [f64; 2] {
        [0.5 * (self.x_min + self.x_max), 0.5 * (self.y_min + self.y_max)]
    }

    /// The point inside nearest to `(x, y)`; the south-west corner's coordinate for one that is not a number.
    pub(crate) fn nearest(&self, x: f64, y: f64) -> [f64; 2] {
        // `max` before `min`: not-a-number becomes the smallest coordinate.
        [x.max(self.x_min).min(self.x_max), y.max(self.y_min).min(self.y_max)]
    }
}

#[cfg(test)]
mod tests {
    use super::Bounds;

    const BOUNDS: Bounds = Bounds { x_min: -1.0, x_max: 3.0, y_min: 2.0, y_max: 4.0 };

    #[test]
    fn size_and_centre() {
        assert_eq!(BOUNDS.size(), [4.0, 2.0]);
        assert_eq!(BOUNDS.centre(), [1.0, 3.0]);
        assert!(BOUNDS.contains(-1.0, 4.0) && !BOUNDS.contains(-1.1, 3.0) && !BOUNDS.contains(f64::NAN, 3.0));
    }

    #[test]
    fn nearest_is_always_inside() {
        for (x, y) in [(0.0, 3.0), (-9.0, 9.0), (f64::INFINITY, f64::NEG_INFINITY), (f64::NAN, f64::NAN)] {
            let [nx, ny] = BOUNDS.nearest(x, y);
            assert!(BOUNDS.contains(nx, ny), "{x} {y}");
        }
    }
}
