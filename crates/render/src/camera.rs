//! Cameras.

use crate::Stage;
use glam::camera::rh::{proj::directx, view};
use glam::{DVec3, Mat4, Vec3};

/// Nearest distance that is drawn, in units of the stage.
const NEAR: f32 = 2e-3;
/// Half the depth that a lens without perspective covers, in units of the stage.
const DEPTH: f32 = 4.0;

/// A camera in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the camera, m.
    pub eye: DVec3,
    /// Target point, m.
    pub target: DVec3,
    /// Up vector; not along the line of sight.
    pub up: DVec3,
    /// Its projection.
    pub lens: Lens,
}

/// Projection of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// Perspective.
    Perspective {
        /// Vertical field of view, radians.
        field_of_view: f64,
    },
    /// Orthographic: lengths across the line of sight are to scale.
    Orthographic {
        /// Height of the world in the picture, m.
        height: f64,
    },
}

impl Camera {
    /// The stage seen from above, north up, to scale: as large as a picture of `aspect` (width over height) holds between its
    /// `margins` `[left, right, below, above]`, parts of the picture's height.
    pub fn plan(stage: &Stage, aspect: f64, margins: [f64; 4]) -> Self {
        Self::square(stage, aspect, margins, [DVec3::X, DVec3::Y])
    }

    /// The same from the south, where y is smallest, up being up.
    pub fn front(stage: &Stage, aspect: f64, margins: [f64; 4]) -> Self {
        Self::square(stage, aspect, margins, [DVec3::X, DVec3::Z])
    }

    /// The stage to scale, between margins, with these axes to the right and up.
    fn square(stage: &Stage, aspect: f64, [left, right, below, above]: [f64; 4], [across, up]: [DVec3; 2]) -> Self {
        let size = stage.to - stage.from;
        let height = (size.dot(up) / (1.0 - below - above)).max(size.dot(across) / (aspect - left - right));
        let target = stage.centre() + 0.5 * height * ((right - left) * across + (above - below) * up);
        let eye = target + across.cross(up) * stage.unit() * 2.0;
        Self { eye, target, up, lens: Lens::Orthographic { height } }
    }

    /// A camera with its target in the middle of the stage, from `azimuth` (radians, from east over north, where the camera stands)
    /// and `elevation` (radians above the horizon), so far away that all corners of the stage are in a picture of `aspect`
    /// but for a `margin` (part of the picture, 0 for none).
    pub fn orbit(stage: &Stage, [azimuth, elevation]: [f64; 2], field_of_view: f64, aspect: f64, margin: f64) -> Self {
        let away = DVec3::new(azimuth.cos() * elevation.cos(), azimuth.sin() * elevation.cos(), elevation.sin());
        let across = DVec3::new(-azimuth.sin(), azimuth.cos(), 0.0);
        let above = away.cross(across);
        let slope = (0.5 * field_of_view).tan() * (1.0 - 2.0 * margin);
        let reach = |corner: DVec3| {
            let offset = corner - stage.centre();
            let sideways = (offset.dot(above).abs() / slope).max(offset.dot(across).abs() / (slope * aspect));
            sideways + offset.dot(away)
        };
        let distance = stage.corners().into_iter().map(reach).fold(0.0, f64::max);
        Self {
            eye: stage.centre() + away * distance.max(1e-3 * stage.unit()),
            target: stage.centre(),
            up: DVec3::Z,
            lens: Lens::Perspective { field_of_view },
        }
    }

    /// The camera with another target, m, and the same direction.
    pub fn looking_at(self, target: DVec3) -> Self {
        Self { eye: self.eye + (target - self.target), target, ..self }
    }

    /// The camera so many times nearer to its target, or with a picture magnified so many times where it is orthographic.
    pub fn nearer(self, times: f64) -> Self {
        match self.lens {
            Lens::Perspective { .. } => Self { eye: self.target + (self.eye - self.target) / times, ..self },
            Lens::Orthographic { height } => Self { lens: Lens::Orthographic { height: height / times }, ..self },
        }
    }

    /// Position of a point, m, in a picture of `aspect`: fractions of its width from the left and of its height from above. None behind
    /// the eye.
    pub fn project(&self, stage: &Stage, aspect: f64, point: [f64; 3]) -> Option<[f64; 2]> {
        self.projection(stage, aspect).ball(point, 0.0).map(|ball| ball.at)
    }

    /// What projects many points of a picture of `aspect`.
    pub fn projection(&self, stage: &Stage, aspect: f64) -> Projection {
        let lens = self.clip_from_view(stage, aspect as f32);
        Projection { stage: *stage, scale: lens.y_axis.y, clip: lens * self.view_from_world(stage) }
    }

    /// From stage coordinates to those of the eye: x right, y up, looking along -z.
    pub(crate) fn view_from_world(&self, stage: &Stage) -> Mat4 {
        view::look_at_mat4(
            stage.position(self.eye.into()),
            stage.position(self.target.into()),
            self.up.as_vec3().normalize(),
        )
    }

    /// From the eye's coordinates to clip space; depth 1 is near, 0 far.
    pub(crate) fn clip_from_view(&self, stage: &Stage, aspect: f32) -> Mat4 {
        match self.lens {
            Lens::Perspective { field_of_view } => {
                directx::perspective_infinite_reverse(field_of_view as f32, aspect, NEAR)
            }
            Lens::Orthographic { height } => {
                let half = 0.5 * stage.length(height);
                let [near, far] = self.depths(stage);
                // Reversed depth: 1 is near.
                directx::orthographic(-half * aspect, half * aspect, -half, half, far, near)
            }
        }
    }

    /// Nearest and farthest distance from the eye that a lens without perspective shows.
    fn depths(&self, stage: &Stage) -> [f32; 2] {
        let distance = (stage.position(self.eye.into()) - stage.position(self.target.into())).length();
        [distance - DEPTH, distance + DEPTH]
    }

    /// The line of sight.
    pub(crate) fn forward(&self) -> Vec3 {
        (self.target - self.eye).normalize_or(DVec3::NEG_Z).as_vec3()
    }
}

/// Projects points into a picture.
#[derive(Debug, Clone, Copy)]
pub struct Projection {
    stage: Stage,
    clip: Mat4,
    /// Height of the picture over that of what is at distance 1, in half pictures.
    scale: f32,
}

/// A ball in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProjectedBall {
    /// Its middle: fractions of the picture's width from the left and of its height from above.
    pub at: [f64; 2],
    /// Its radius, fraction of the picture's height.
    pub radius: f64,
    /// Nearness: larger for what lies before other things.
    pub nearness: f64,
}

impl Projection {
    /// A ball with a radius, m, in the picture; none behind the eye.
    pub fn ball(&self, middle: [f64; 3], radius: f64) -> Option<ProjectedBall> {
        let at = self.clip * self.stage.position(middle).extend(1.0);
        (at.w > 0.0).then(|| ProjectedBall {
            at: [0.5 + 0.5 * f64::from(at.x / at.w), 0.5 - 0.5 * f64::from(at.y / at.w)],
            radius: 0.5 * f64::from(self.scale * self.stage.length(radius) / at.w),
            nearness: f64::from(at.z / at.w),
        })
    }
}

impl Stage {
    /// The eight corners, m.
    pub(crate) fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { self.from[axis] } else { self.to[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_has_all_corners_in_the_picture_and_one_at_its_edge() {
        let stage = Stage::new([-3.0, 10.0, 0.0], [5.0, 11.0, 2.0]);
        for (azimuth, elevation) in [(0.3, 0.4), (2.0, 1.2), (-1.0, 0.05)] {
            let camera = Camera::orbit(&stage, [azimuth, elevation], 0.7, 1.5, 0.0);
            let clip = camera.clip_from_view(&stage, 1.5) * camera.view_from_world(&stage);
            let reach = |corner: DVec3| {
                let at = clip.project_point3(stage.position(corner.into()));
                assert!(at.z > 0.0 && at.z < 1.0);
                at.x.abs().max(at.y.abs())
            };
            let farthest = stage.corners().into_iter().map(reach).fold(0.0, f32::max);
            assert!((farthest - 1.0).abs() < 1e-4, "{farthest}");
        }
    }

    #[test]
    fn a_camera_that_comes_nearer_shows_less_of_what_it_looks_at() {
        let stage = Stage::new([0.0; 3], [20.0, 10.0, 0.0]);
        let position = DVec3::new(15.0, 5.0, 0.0);
        for whole in [Camera::plan(&stage, 2.0, [0.0; 4]), Camera::orbit(&stage, [0.3, 0.9], 0.5, 2.0, 0.0)] {
            let near = whole.looking_at(position).nearer(4.0);
            let [x, y] = near.project(&stage, 2.0, position.into()).unwrap();
            assert!((x - 0.5).abs() < 1e-6 && (y - 0.5).abs() < 1e-6);
            let width = |camera: &Camera| {
                let ends = [-0.01, 0.01].map(|off| camera.project(&stage, 2.0, (camera.target + off).into()).unwrap());
                (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])
            };
            assert!((width(&near) / width(&whole) - 4.0).abs() < 0.05);
        }
    }

    #[test]
    fn a_plan_is_to_scale_with_north_up() {
        let stage = Stage::new([0.0; 3], [20.0, 10.0, 0.0]);
        let camera = Camera::plan(&stage, 2.0, [0.0; 4]);
        let clip = camera.clip_from_view(&stage, 2.0) * camera.view_from_world(&stage);
        let at = clip.project_point3(stage.position([20.0, 10.0, 0.0]));
        assert!((at.x - 1.0).abs() < 1e-5 && (at.y - 1.0).abs() < 1e-5, "{at}");
    }

    #[test]
    fn margins_of_a_plan_are_parts_of_the_pictures_height() {
        let stage = Stage::new([0.0; 3], [10.0, 10.0, 0.0]);
        let camera = Camera::plan(&stage, 2.0, [0.1, 0.3, 0.2, 0.05]);
        // Its height is what limits it: three quarters of the picture are the box's side.
        let corner = |position| camera.project(&stage, 2.0, position).unwrap();
        let ([left, bottom], [right, top]) = (corner([0.0; 3]), corner([10.0, 10.0, 0.0]));
        assert!((bottom - 0.8).abs() < 1e-5 && (top - 0.05).abs() < 1e-5, "{bottom} {top}");
        assert!((2.0 * (right - left) - 0.75).abs() < 1e-5);
        // What is left over is shared between the sides.
        assert!((2.0 * ((1.0 - right) - left) - 0.2).abs() < 1e-5);
    }
}
