//! Buildings and walls.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A rigid obstacle that water flows around. Give exactly one of `polygon`, `circle`, `line` and `file`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Its name.
    pub name: String,
    /// Its corners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[f64; 2]>>,
    /// A round one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<Circle>,
    /// Positions along a wall of no thickness (scheme voronoi).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Vec<[f64; 2]>>,
    /// A file with polygons: GeoJSON, shapefile, or CSV with a column each for x and y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// How high it stands above the ground, m. Water flows over a line that is lower than its level; over others it does not, and water that comes
    /// higher is reported. Left out: high enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Level of the crest of a line, m, over which water flows as over a weir.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crest_m: Option<f64>,
}

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Circle {
    /// Its middle.
    pub centre: [f64; 2],
    /// Its radius, m.
    pub radius_m: f64,
}
