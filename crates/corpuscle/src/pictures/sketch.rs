//! Pictures as discs, lines and a map, for a caller without a device that draws: it paints them itself.

use super::viewpoint::OwnView;
use super::{CameraOffset, Moment, Shown};
use corpuscle_gpu::Image;
use corpuscle_render::{Camera, Overlay, Stage};
use glam::DVec3;

/// A disc that faces the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its middle, m.
    pub position: [f64; 3],
    /// Its radius, m.
    pub radius: f64,
    /// Its colour.
    pub colour: [u8; 3],
    /// Whether it has a darker rim, as one of many things has; parts of one surface have none.
    pub has_rim: bool,
}

/// A square on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Its corners in order, m.
    pub corners: [[f64; 3]; 4],
    /// Its colour.
    pub colour: [u8; 3],
}

impl Patch {
    /// A square round a middle, m, across a normal, with half a side, m.
    pub(super) fn across(middle: [f64; 3], normal: [f64; 3], half_side: f64, colour: [u8; 3]) -> Self {
        let (middle, normal) = (DVec3::from(middle), DVec3::from(normal));
        let (one, other) = normal.any_orthonormal_pair();
        let corner = |[a, b]: [f64; 2]| (middle + half_side * (a * one + b * other)).into();
        Self { corners: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner), colour }
    }
}

/// A line through points, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The points.
    pub points: Vec<[f64; 3]>,
    /// Its colour.
    pub colour: [u8; 3],
}

/// A picture as discs and lines.
#[derive(Debug, Clone)]
pub struct Sketch {
    /// Camera, stage and overlay.
    pub shown: Shown,
    /// Surfaces behind the discs, in no order.
    pub patches: Vec<Patch>,
    /// Discs, in no order.
    pub discs: Vec<Disc>,
    /// Lines behind the discs.
    pub lines: Vec<Line>,
}

/// A picture of the ground, from above, behind all.
#[derive(Debug, Clone)]
pub struct GroundMap {
    /// The picture, north up.
    pub image: Image,
    /// South-western and north-eastern corner, m.
    pub corners: [[f64; 2]; 2],
}

/// How a sketch is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SketchView {
    /// How the user moved the camera.
    pub camera_offset: CameraOffset,
    /// Width of the picture over its height.
    pub aspect: f64,
}

impl SketchView {
    /// The camera above a stage, to scale.
    pub(super) fn plan(&self, stage: &Stage, margins: [f64; 4]) -> Camera {
        self.camera_offset.moved(Camera::plan(stage, self.aspect, margins))
    }

    /// The camera round a stage, or above it where the user wants that.
    pub(super) fn orbit(&self, stage: &Stage, own: &OwnView) -> Camera {
        if self.camera_offset.plan {
            return self.plan(stage, own.margins);
        }
        let camera = Camera::orbit(stage, own.direction, own.field_of_view, self.aspect, own.margin);
        self.camera_offset.moved(camera)
    }

    pub(super) fn shown(&self, stage: Stage, camera: Camera, overlay: Overlay) -> Shown {
        Shown { stage, camera, on_paper: true, finished: true, overlay }
    }
}

/// A model that can be sketched.
pub trait Sketcher: Send {
    /// The sketch of a moment.
    fn sketch(&mut self, seen: &SketchView, title: &str, moment: &Moment<'_>) -> Sketch;

    /// The ground behind it, which does not change.
    fn ground(&self) -> Option<GroundMap> {
        None
    }

    /// Draws no partition of a gas from a time on, s.
    fn lift_partition(&mut self, _time: f64) {}
}

/// Sketches of one scene.
pub struct Sketches {
    title: String,
    sketcher: Box<dyn Sketcher>,
}

impl Sketches {
    /// Sketches with a title, by a model's own drawing.
    pub(crate) fn new(title: String, sketcher: Box<dyn Sketcher>) -> Self {
        Self { title, sketcher }
    }

    /// The sketch of a moment.
    pub fn sketch(&mut self, seen: &SketchView, moment: &Moment<'_>) -> Sketch {
        self.sketcher.sketch(seen, &self.title, moment)
    }

    /// The ground behind it, if there is any; it does not change.
    pub fn ground(&self) -> Option<GroundMap> {
        self.sketcher.ground()
    }

    /// Draws no partition of a gas from a time on, s: the user lifted it.
    pub fn lift_partition(&mut self, time: f64) {
        self.sketcher.lift_partition(time);
    }
}
