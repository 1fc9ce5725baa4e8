//! The user's changes of the camera.

use corpuscle_render::{Camera, Lens};
use glam::DVec3;

/// Highest and lowest elevation of the camera, radians.
const MAX_ELEVATION: f64 = 1.54;
const MIN_ELEVATION: f64 = -0.35;

/// The user's changes of a camera, relative to the model's default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraOffset {
    /// True for a plan from above, to scale, north up.
    pub plan: bool,
    /// Rotation of the camera round its target: azimuth (from east over north) and elevation, radians.
    pub turn: [f64; 2],
    /// Shift of the target, m.
    pub shift: [f64; 3],
    /// Magnification.
    pub zoom: f64,
}

impl Default for CameraOffset {
    fn default() -> Self {
        Self { plan: false, turn: [0.0; 2], shift: [0.0; 3], zoom: 1.0 }
    }
}

impl CameraOffset {
    /// A camera with these changes.
    pub(super) fn moved(&self, camera: Camera) -> Camera {
        let camera = if matches!(camera.lens, Lens::Perspective { .. }) { self.turned(camera) } else { camera };
        camera.looking_at(camera.target + DVec3::from(self.shift)).nearer(self.zoom)
    }

    fn turned(&self, camera: Camera) -> Camera {
        let away = camera.eye - camera.target;
        let distance = away.length();
        let azimuth = away.y.atan2(away.x) + self.turn[0];
        let height = ((away.z / distance).asin() + self.turn[1]).clamp(MIN_ELEVATION, MAX_ELEVATION);
        let direction = DVec3::new(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin());
        Camera { eye: camera.target + distance * direction, ..camera }
    }

    /// Adds a rotation by these angles, radians, within the range of elevations; `own_height` is the default elevation.
    pub fn turn_by(&mut self, own_height: f64, [azimuth, height]: [f64; 2]) {
        self.turn[0] += azimuth;
        self.turn[1] = (self.turn[1] + height).clamp(MIN_ELEVATION - own_height, MAX_ELEVATION - own_height);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_render::Stage;

    #[test]
    fn an_offset_turns_shifts_and_comes_nearer() {
        let stage = Stage::new([0.0; 3], [4.0, 4.0, 2.0]);
        let camera = Camera::orbit(&stage, [0.3, 0.4], 0.5, 1.5, 0.1);
        let far = (camera.eye - camera.target).length();
        let offset = CameraOffset { turn: [1.0, 0.2], shift: [1.0, 0.0, 0.0], zoom: 2.0, plan: false };
        let moved = offset.moved(camera);
        let away = moved.eye - moved.target;
        assert!((away.length() - 0.5 * far).abs() < 1e-9);
        assert!((away.y.atan2(away.x) - 1.3).abs() < 1e-9 && ((away.z / away.length()).asin() - 0.6).abs() < 1e-9);
        assert_eq!(moved.target, camera.target + DVec3::X);
        assert!(CameraOffset::default().moved(camera).eye.distance(camera.eye) < 1e-9);
        // Never over the top.
        let over = CameraOffset { turn: [0.0, 9.0], ..CameraOffset::default() }.moved(camera);
        assert!(over.eye.z < over.target.z + far && over.eye.is_finite());
    }
}
