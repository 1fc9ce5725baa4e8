//! Coordinate reference systems.

use crate::TerrainError;
use geotiff_reader::geokeys::{self, GeoKeyDirectory, GeoKeyValue};
use proj4rs::Proj;
use serde::{Deserialize, Serialize};

/// PROJ definition of longitude and latitude on WGS 84 (EPSG:4326).
pub(crate) const WGS_84: &str = "+proj=longlat +datum=WGS84 +no_defs";

/// GeoTIFF codes of the model types (GeoTIFF 1.1, 7.2).
const PROJECTED: u16 = 1;
const GEOGRAPHIC: u16 = 2;
const GEOCENTRIC: u16 = 3;
/// GeoTIFF code of a system given by its parameters instead of by a code.
const USER_DEFINED: u16 = 32767;

/// A coordinate reference system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReferenceSystem {
    /// What it is called: `EPSG:27700`, a PROJ string, or the file's own words.
    pub name: String,
    /// True for longitude and latitude in degrees.
    pub geographic: bool,
    /// Metres in one unit of easting and northing; 1 for a geographic one.
    pub metres_per_unit: f64,
    /// EPSG code, if it has one.
    pub epsg: Option<u16>,
    /// PROJ definition, if it is known.
    definition: Option<String>,
}

impl ReferenceSystem {
    /// The system of an EPSG code. One that is not in the tables has no definition; its name still goes to results.
    pub(crate) fn from_epsg(code: u16, geographic: bool, metres_per_unit: f64) -> Self {
        let name = format!("EPSG:{code}");
        let Some((definition, projection)) = epsg_definition(code) else {
            return Self { name, geographic, metres_per_unit, epsg: Some(code), definition: None };
        };
        Self {
            name,
            geographic: projection.is_latlong(),
            metres_per_unit: metres_per_unit_of(&projection),
            epsg: Some(code),
            definition: Some(definition),
        }
    }

    /// The system that a scene names: `EPSG:27700` or a PROJ string.
    pub(crate) fn parse(crs: &str) -> Result<Self, TerrainError> {
        let refuse = |what: String| TerrainError::ReferenceSystem { crs: crs.into(), what };
        let text = crs.trim();
        if let Some((authority, code)) = text.split_once(':')
            && authority.eq_ignore_ascii_case("EPSG")
        {
            let code = code.trim().parse().map_err(|_| refuse(format!("`{code}` is not a code from 1 to 65535")))?;
            return Ok(Self::from_epsg(code, false, 1.0));
        }
        if !text.starts_with('+') {
            return Err(refuse("it begins neither with EPSG: nor with +".into()));
        }
        let projection = Proj::from_proj_string(text).map_err(|error| refuse(error.to_string()))?;
        Ok(Self {
            name: text.into(),
            geographic: projection.is_latlong(),
            metres_per_unit: metres_per_unit_of(&projection),
            epsg: None,
            definition: Some(text.into()),
        })
    }

    /// The system that a GeoTIFF names, if any; the error says which kind cannot be used.
    pub(crate) fn from_keys(keys: &GeoKeyDirectory) -> Result<Option<Self>, String> {
        let code = |key| keys.get_short(key).filter(|code| !matches!(*code, 0 | USER_DEFINED));
        let words = |key: u16, else_: &str| keys.get_ascii(key).unwrap_or(else_).trim().to_string();
        let projected = code(geokeys::PROJECTED_CRS_TYPE);
        let geodetic = code(geokeys::GEODETIC_CRS_TYPE);
        match (keys.get_short(geokeys::GT_MODEL_TYPE), projected, geodetic) {
            (Some(GEOCENTRIC), ..) => Err("its coordinates are geocentric (x, y, z from the centre of the Earth); \
                                           project it to a map with `gdalwarp -t_srs`"
                .into()),
            (Some(GEOGRAPHIC), _, Some(code)) | (None, None, Some(code)) => Ok(Some(Self::from_epsg(code, true, 1.0))),
            (Some(GEOGRAPHIC), _, None) => Ok(Some(Self {
                name: words(geokeys::GEODETIC_CITATION, "longitude and latitude"),
                geographic: true,
                metres_per_unit: 1.0,
                epsg: None,
                definition: None,
            })),
            (Some(PROJECTED) | None, Some(code), _) => Ok(Some(Self::from_epsg(code, false, linear_unit(keys)))),
            (Some(PROJECTED), None, _) => Ok(Some(Self {
                name: words(geokeys::PROJ_CITATION, &words(geokeys::GT_CITATION, "a projection without a code")),
                geographic: false,
                metres_per_unit: linear_unit(keys),
                epsg: None,
                definition: None,
            })),
            _ => Ok(None),
        }
    }

    /// The system as well-known text (WKT 1), with feature `well-known-text`, if it has an EPSG code that is in the tables.
    #[cfg(feature = "well-known-text")]
    pub fn well_known_text(&self) -> Option<&'static str> {
        Some(crs_definitions::from_code(self.epsg?)?.wkt)
    }

    /// Adds the system to GeoTIFF keys; a PROJ string cannot be said there.
    pub(crate) fn write_keys(&self, keys: &mut GeoKeyDirectory) {
        let Some(code) = self.epsg else { return };
        let (model, key) = if self.geographic {
            (GEOGRAPHIC, geokeys::GEODETIC_CRS_TYPE)
        } else {
            (PROJECTED, geokeys::PROJECTED_CRS_TYPE)
        };
        keys.set(geokeys::GT_MODEL_TYPE, GeoKeyValue::Short(model));
        keys.set(key, GeoKeyValue::Short(code));
    }

    /// The projection, if the definition is known. A geographic one of unknown datum is taken for WGS 84.
    pub(crate) fn projection(&self) -> Option<Proj> {
        let definition = self.definition.as_deref().or(self.geographic.then_some(WGS_84))?;
        Proj::from_proj_string(definition).ok()
    }

    /// A warning about results in this system.
    pub(crate) fn warning(&self) -> Option<String> {
        let name = &self.name;
        match (&self.definition, self.geographic) {
            (Some(_), _) if self.epsg.is_none() => Some(format!(
                "The reference system is given as a PROJ string, which a GeoTIFF cannot name: the maps carry none. It is \
                 {name}."
            )),
            (Some(_), _) => None,
            (None, true) => Some(format!("The reference system {name} is not known; it is taken for WGS 84.")),
            (None, false) => Some(format!(
                "The reference system {name} is not known: its name goes on to the maps, but longitude and latitude are \
                 not to be had, and its unit is taken to be {} m.",
                self.metres_per_unit
            )),
        }
    }

    /// A transverse Mercator projection in metres on this geographic system's own ellipsoid, true to scale at, and
    /// with its origin at, the given longitude and latitude, degrees.
    pub(crate) fn local_projection(&self, [longitude, latitude]: [f64; 2]) -> Result<Proj, String> {
        let shape = ["+datum=", "+ellps=", "+towgs84=", "+a=", "+b=", "+rf=", "+R=", "+pm=", "+nadgrids="];
        let kept: Vec<&str> = self
            .definition
            .as_deref()
            .unwrap_or(WGS_84)
            .split_whitespace()
            .filter(|word| shape.iter().any(|start| word.starts_with(start)))
            .collect();
        let definition = format!(
            "+proj=tmerc +lat_0={latitude} +lon_0={longitude} +k=1 +x_0=0 +y_0=0 {} +units=m +no_defs",
            kept.join(" ")
        );
        Proj::from_proj_string(&definition).map_err(|error| error.to_string())
    }
}

/// Definition of an EPSG code that can be computed with. Shift grids are files that are not at hand: a definition that
/// requires one is used without (an error of metres at most).
fn epsg_definition(code: u16) -> Option<(String, Proj)> {
    let text = crs_definitions::from_code(code)?.proj4;
    let without_grids: Vec<&str> = text.split_whitespace().filter(|word| !word.starts_with("+nadgrids=")).collect();
    [text.to_string(), without_grids.join(" ")]
        .into_iter()
        .find_map(|text| Proj::from_proj_string(&text).ok().map(|projection| (text, projection)))
}

fn metres_per_unit_of(projection: &Proj) -> f64 {
    if projection.is_latlong() { 1.0 } else { projection.to_meter() }
}

/// Metres in the unit of length that GeoTIFF keys name for easting and northing.
fn linear_unit(keys: &GeoKeyDirectory) -> f64 {
    keys.get_short(geokeys::PROJ_LINEAR_UNITS).and_then(metres_in).unwrap_or(1.0)
}

/// Metres in the unit of the heights that GeoTIFF keys name; metres unless they say otherwise.
pub(crate) fn height_unit(keys: &GeoKeyDirectory) -> f64 {
    // NAVD88 in US survey feet and in feet.
    let by_system = match keys.get_short(geokeys::VERTICAL_CS_TYPE) {
        Some(6360) => metres_in(9003),
        Some(8228) => metres_in(9002),
        _ => None,
    };
    keys.get_short(geokeys::VERTICAL_UNITS).and_then(metres_in).or(by_system).unwrap_or(1.0)
}

/// Metres in an EPSG unit of length.
fn metres_in(code: u16) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        9036 => Some(1000.0),
        _ => None,
    }
}
