//! Parts of the terrain with finer cells.

use super::Circle;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A part of the terrain over which the particles of scheme `voronoi` stand closer together. Give exactly one of `polygon`, `circle`, `file`, `line` and
/// `walls`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finer {
    /// Distance between particles there, m; the nearest half, quarter, eighth ... of `flood.spacing_m` is taken.
    pub spacing_m: f64,
    /// Its corners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[f64; 2]>>,
    /// A round part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<Circle>,
    /// A file with polygons: GeoJSON, shapefile, or CSV with a column each for x and y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Positions along a line, such as a river's or a dike's: the ground `within_m` of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Vec<[f64; 2]>>,
    /// The ground `within_m` of all obstacles.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub walls: bool,
    /// How far round it the cells are as fine, m. Farther out they become coarser step by step.
    #[serde(default)]
    pub within_m: f64,
}
