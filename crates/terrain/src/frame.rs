//! From a terrain's own coordinates to model metres and back.

use crate::system::{ReferenceSystem, WGS_84};
use crate::{Georeference, TerrainError};
use proj4rs::Proj;
use proj4rs::transform::transform;

/// How a terrain's own coordinates, model metres, and longitude and latitude on WGS 84 hang together.
#[derive(Debug)]
pub(crate) struct Frame {
    kind: Kind,
    /// The own system, where it is known.
    own: Option<Proj>,
    wgs_84: Proj,
}

#[derive(Debug)]
enum Kind {
    /// Model coordinates are own coordinates times this.
    Scaled(f64),
    /// Own coordinates are degrees; the model's come from this projection.
    Projected(Box<Proj>),
}

impl Frame {
    /// Model coordinates are own coordinates in metres; no position on Earth.
    pub(crate) fn plain() -> Self {
        Self { kind: Kind::Scaled(1.0), own: None, wgs_84: wgs_84() }
    }

    /// Model coordinates are the system's own in metres, or for a geographic one metres of a projection that is true
    /// to scale at `centre`.
    pub(crate) fn of(system: &ReferenceSystem, centre: [f64; 2]) -> Result<Self, String> {
        let kind = if system.geographic {
            Kind::Projected(Box::new(system.local_projection(centre)?))
        } else {
            Kind::Scaled(system.metres_per_unit)
        };
        Ok(Self { kind, own: system.projection(), wgs_84: wgs_84() })
    }

    /// The frame of a grid of so many columns and rows, centred on it.
    pub(crate) fn of_grid(georeference: &Georeference, size: [usize; 2]) -> Result<Self, String> {
        let Some(system) = &georeference.system else { return Ok(Self::plain()) };
        let centre = georeference.point(size.map(|count| 0.5 * count as f64 - 0.5));
        if system.geographic && !(centre[0].abs() <= 360.0 && centre[1].abs() <= 89.0) {
            return Err(format!(
                "its middle {centre:?} is no longitude and latitude in degrees, which its reference system {} wants",
                system.name
            ));
        }
        Self::of(system, centre)
    }

    /// Model metres over the own coordinates' unit, where the two differ by nothing else.
    pub(crate) fn metres_per_unit(&self) -> Option<f64> {
        match self.kind {
            Kind::Scaled(metres) => Some(metres),
            Kind::Projected(_) => None,
        }
    }

    /// Not-a-number where the projection does not reach.
    pub(crate) fn to_model(&self, position: [f64; 2]) -> [f64; 2] {
        match (&self.kind, &self.own) {
            (Kind::Scaled(metres), _) => position.map(|value| value * metres),
            (Kind::Projected(local), Some(own)) => convert(own, local, position).unwrap_or([f64::NAN; 2]),
            (Kind::Projected(_), None) => [f64::NAN; 2],
        }
    }

    /// Not-a-number where the projection does not reach.
    pub(crate) fn to_own(&self, model: [f64; 2]) -> [f64; 2] {
        match (&self.kind, &self.own) {
            (Kind::Scaled(metres), _) => model.map(|value| value / metres),
            (Kind::Projected(local), Some(own)) => convert(local, own, model).unwrap_or([f64::NAN; 2]),
            (Kind::Projected(_), None) => [f64::NAN; 2],
        }
    }

    pub(crate) fn lon_lat_to_model(&self, lon_lat: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        let own = self.own.as_ref().ok_or(TerrainError::NoReferenceSystem)?;
        let position =
            convert(&self.wgs_84, own, lon_lat).map_err(|what| TerrainError::Position { position: lon_lat, what })?;
        Ok(self.to_model(position))
    }

    pub(crate) fn model_to_lon_lat(&self, model: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        let own = self.own.as_ref().ok_or(TerrainError::NoReferenceSystem)?;
        convert(own, &self.wgs_84, self.to_own(model)).map_err(|what| TerrainError::Position { position: model, what })
    }

    /// Metres on the ground in one metre of model coordinates northwards at a position, where the Earth is known.
    pub(crate) fn scale(&self, [x, y]: [f64; 2]) -> Option<f64> {
        const STEP: f64 = 100.0;
        let here = self.model_to_lon_lat([x, y]).ok()?;
        let there = self.model_to_lon_lat([x, y + STEP]).ok()?;
        let system = ReferenceSystem::parse(WGS_84).ok()?;
        let [east, north] = convert(&self.wgs_84, &system.local_projection(here).ok()?, there).ok()?;
        Some(east.hypot(north) / STEP)
    }

    /// From own coordinates to those of another system.
    pub(crate) fn own_to(&self, other: &Proj, position: [f64; 2]) -> Option<[f64; 2]> {
        convert(self.own.as_ref()?, other, position).ok()
    }

    /// True where own coordinates can be converted to other systems.
    pub(crate) fn is_known(&self) -> bool {
        self.own.is_some()
    }
}

fn wgs_84() -> Proj {
    Proj::from_proj_string(WGS_84).expect("a definition that the projection library's own examples use")
}

/// From one system to another; geographic coordinates are degrees (the library's are radians).
pub(crate) fn convert(from: &Proj, to: &Proj, position: [f64; 2]) -> Result<[f64; 2], String> {
    let [x, y] = if from.is_latlong() { position.map(f64::to_radians) } else { position };
    let mut point = (x, y, 0.0);
    transform(from, to, &mut point).map_err(|error| error.to_string())?;
    let position = [point.0, point.1];
    if !position.iter().all(|value| value.is_finite()) {
        return Err("it lies beyond what the projection can show".into());
    }
    Ok(if to.is_latlong() { position.map(f64::to_degrees) } else { position })
}
