//! Viewpoints of pictures, as the user gives them.

use super::DrawContext;
use corpuscle_render::{Camera, CameraPath, Stage};
use corpuscle_terrain::Terrain;
use glam::DVec3;

/// A viewpoint of a picture. Values that are not given are the model's defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewpoint {
    /// True for a plan from above, to scale, north up; false for perspective.
    pub plan: bool,
    /// Direction of the camera as seen from the centre of the picture: bearing, clockwise from north (the second axis), and height above
    /// the horizon, degrees.
    pub from_deg: Option<[f64; 2]>,
    /// Position in the centre of the picture, in the scene's own coordinates.
    pub centre: Option<[f64; 2]>,
    /// Magnification over the view of the whole scene.
    pub zoom: f64,
}

impl Default for Viewpoint {
    fn default() -> Self {
        Self { plan: false, from_deg: None, centre: None, zoom: 1.0 }
    }
}

/// A viewpoint at a time, its centre in world coordinates.
pub(super) struct Station {
    time: f64,
    viewpoint: Viewpoint,
    /// Position in the centre of the picture, m; by default the centre of the stage, or its height.
    target: Option<([f64; 2], Option<f64>)>,
}

impl Station {
    /// A station for a flood, whose scene has its own coordinates, with heights exaggerated by `heights`.
    pub(super) fn on_ground((time, viewpoint): (f64, Viewpoint), ground: &Terrain, heights: f64) -> Self {
        let target = viewpoint.centre.map(|own| {
            let [x, y] = ground.to_model(own);
            ([x, y], Some(heights * ground.height(x, y)))
        });
        Self { time, viewpoint, target }
    }

    /// A station for any other model.
    pub(super) fn plain((time, viewpoint): (f64, Viewpoint)) -> Self {
        Self { time, viewpoint, target: viewpoint.centre.map(|at| (at, None)) }
    }
}

/// The default view of a model.
pub(super) struct OwnView {
    /// Azimuth (from east over north) and elevation of the camera, radians.
    pub direction: [f64; 2],
    /// Field of view, radians.
    pub field_of_view: f64,
    /// Margin round the stage, fraction of the picture.
    pub margin: f64,
    /// Margins in a plan: left, right, below and above, fractions of the picture's height.
    pub margins: [f64; 4],
}

impl DrawContext {
    /// The camera at a time.
    pub(super) fn camera(&self, stage: &Stage, own: &OwnView, time: f64) -> Camera {
        let stations = self.stations.iter().map(|station| (station.time, self.seen_from(stage, own, station)));
        let still = || self.seen_from(stage, own, &Station::plain((0.0, Viewpoint::default())));
        self.camera_offset.moved(CameraPath::through(stations.collect()).map_or_else(still, |path| path.at(time)))
    }

    /// The camera at a time; from above where all lies in one plane.
    pub(super) fn seen(&self, stage: &Stage, own: &OwnView, time: f64, is_flat: bool) -> Camera {
        match is_flat {
            true => self.camera_offset.moved(Camera::plan(stage, self.aspect(), own.margins)),
            false => self.camera(stage, own, time),
        }
    }

    /// True where the whole stage is always in the picture, so that axes along its edges are visible.
    pub(super) fn shows_all(&self) -> bool {
        let whole = |station: &Station| station.viewpoint.zoom <= 1.0 && station.target.is_none();
        self.camera_offset.zoom <= 1.5 && self.stations.iter().all(whole)
    }

    fn seen_from(&self, stage: &Stage, own: &OwnView, station: &Station) -> Camera {
        let viewpoint = &station.viewpoint;
        let direction = match viewpoint.from_deg {
            Some([bearing, height]) => [(90.0 - bearing).to_radians(), height.to_radians()],
            None => own.direction,
        };
        let whole = match viewpoint.plan || self.camera_offset.plan {
            true => Camera::plan(stage, self.aspect(), own.margins),
            false => Camera::orbit(stage, direction, own.field_of_view, self.aspect(), own.margin),
        };
        let target = |([x, y], z): ([f64; 2], Option<f64>)| DVec3::new(x, y, z.unwrap_or(stage.centre().z));
        station.target.map_or(whole, |at| whole.looking_at(target(at))).nearer(viewpoint.zoom)
    }
}
