//! From where a picture is taken, as a user says it.

use super::Studio;
use corpuscle_render::{Camera, CameraPath, Stage};
use corpuscle_terrain::Terrain;
use glam::DVec3;

/// From where a picture is taken. What is not said is the model's own choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewpoint {
    /// True for straight from above and to scale, north up; false for an eye that stands somewhere.
    pub plan: bool,
    /// Where the eye stands as seen from the middle of the picture: bearing, clockwise from north (the second axis), and height above
    /// the horizon, degrees.
    pub from_deg: Option<[f64; 2]>,
    /// The place in the middle of the picture, in the scene's own coordinates.
    pub centre: Option<[f64; 2]>,
    /// How many times nearer than where all is seen.
    pub zoom: f64,
}

impl Default for Viewpoint {
    fn default() -> Self {
        Self { plan: false, from_deg: None, centre: None, zoom: 1.0 }
    }
}

/// A viewpoint at a time, its place that of the world.
pub(super) struct Station {
    time: f64,
    viewpoint: Viewpoint,
    /// What is in the middle of the picture, m; the middle of the stage, or its height, where none is said.
    target: Option<([f64; 2], Option<f64>)>,
}

impl Station {
    /// Of a flood, whose scene has coordinates of its own, with heights drawn so many times higher than they are.
    pub(super) fn on_ground((time, viewpoint): (f64, Viewpoint), ground: &Terrain, heights: f64) -> Self {
        let target = viewpoint.centre.map(|own| {
            let [x, y] = ground.to_model(own);
            ([x, y], Some(heights * ground.height(x, y)))
        });
        Self { time, viewpoint, target }
    }

    /// Of any other model.
    pub(super) fn plain((time, viewpoint): (f64, Viewpoint)) -> Self {
        Self { time, viewpoint, target: viewpoint.centre.map(|at| (at, None)) }
    }
}

/// From where a model is seen if nobody says otherwise.
pub(super) struct OwnView {
    /// Azimuth (from east over north) and height of the eye, radians.
    pub direction: [f64; 2],
    /// Angle of the lens, radians.
    pub field_of_view: f64,
    /// Room round what is seen, part of the picture.
    pub margin: f64,
    /// The same in a plan: left, right, below and above, parts of the picture's height.
    pub margins: [f64; 4],
}

impl Studio {
    /// The camera of a time.
    pub(super) fn camera(&self, stage: &Stage, own: &OwnView, time: f64) -> Camera {
        let stations = self.stations.iter().map(|station| (station.time, self.seen_from(stage, own, station)));
        let still = || self.seen_from(stage, own, &Station::plain((0.0, Viewpoint::default())));
        self.camera_offset.moved(CameraPath::through(stations.collect()).map_or_else(still, |path| path.at(time)))
    }

    /// The camera of a time; straight from above where all lies in one plane.
    pub(super) fn seen(&self, stage: &Stage, own: &OwnView, time: f64, is_flat: bool) -> Camera {
        match is_flat {
            true => self.camera_offset.moved(Camera::plan(stage, self.aspect(), own.margins)),
            false => self.camera(stage, own, time),
        }
    }

    /// True where the whole stage is in the picture whatever the time, so that axes along its edges are.
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
