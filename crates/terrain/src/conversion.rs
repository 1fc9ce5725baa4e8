//! Positions and boxes from one reference system to another.

use crate::frame::convert;
use crate::{MapBox, ReferenceSystem};
use proj4rs::Proj;

/// Points on each side of a box that are converted to find the box round it in another system.
const SAMPLES_PER_EDGE: usize = 16;

/// From one reference system to another; `None` where they are the same.
#[derive(Debug)]
pub(crate) struct Conversion(Option<(Proj, Proj)>);

impl Conversion {
    /// The error says why the two do not convert.
    pub fn between(from: Option<&ReferenceSystem>, to: Option<&ReferenceSystem>) -> Result<Self, String> {
        if from == to {
            return Ok(Self(None));
        }
        let name = |system: Option<&ReferenceSystem>| system.map_or("none", |system| system.name.as_str()).to_owned();
        let projection = |system: Option<&ReferenceSystem>| system.and_then(ReferenceSystem::projection);
        match (projection(from), projection(to)) {
            (Some(from), Some(to)) => Ok(Self(Some((from, to)))),
            _ => Err(format!(
                "its reference system ({}) and that of the first file ({}) differ and cannot be converted; name the \
                 missing one with `crs`, or bring all to one with `gdalwarp -t_srs`",
                name(to),
                name(from)
            )),
        }
    }

    /// True where positions stay as they are.
    pub fn is_none(&self) -> bool {
        self.0.is_none()
    }

    /// The error says why the position has no counterpart.
    pub fn convert(&self, position: [f64; 2]) -> Result<[f64; 2], String> {
        match &self.0 {
            Some((from, to)) => convert(from, to, position),
            None => Ok(position),
        }
    }

    /// The box round what a box becomes.
    pub fn map_box(&self, part: &MapBox) -> Result<MapBox, String> {
        if self.is_none() {
            return Ok(*part);
        }
        let along = |a: f64, b: f64| {
            (0..=SAMPLES_PER_EDGE).map(move |step| a + (b - a) * step as f64 / SAMPLES_PER_EDGE as f64)
        };
        let level = along(part.west, part.east).flat_map(|x| [[x, part.south], [x, part.north]]);
        let upright = along(part.south, part.north).flat_map(|y| [[part.west, y], [part.east, y]]);
        let mut all: Option<MapBox> = None;
        for position in level.chain(upright) {
            let [x, y] =
                self.convert(position).map_err(|what| format!("its position {position:?} does not convert: {what}"))?;
            let point = MapBox { west: x, south: y, east: x, north: y };
            all = Some(all.map_or(point, |all| all.with(point)));
        }
        Ok(all.unwrap_or(*part))
    }
}
