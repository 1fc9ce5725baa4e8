//! The sides of the box.

use crate::{Axis, Series};
use serde::{Deserialize, Serialize};

/// The sides of the box, each at the smallest or largest coordinate along an axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Faces {
    /// At x = 0.
    pub x_min: Face,
    /// At the first number of `size_m`.
    pub x_max: Face,
    /// At y = 0.
    pub y_min: Face,
    /// At the second number of `size_m`.
    pub y_max: Face,
    /// At z = 0.
    pub z_min: Face,
    /// At the third number of `size_m`.
    pub z_max: Face,
}

impl Faces {
    /// The faces at the smallest and the largest coordinate along an axis.
    pub fn along(&self, axis: Axis) -> [&Face; 2] {
        match axis {
            Axis::X => [&self.x_min, &self.x_max],
            Axis::Y => [&self.y_min, &self.y_max],
            Axis::Z => [&self.z_min, &self.z_max],
        }
    }
}

/// What one side of the box is.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Face {
    /// Nothing passes: no air, heat or vapour.
    #[default]
    Wall,
    /// What leaves here comes in at the opposite side (which must be periodic too).
    Periodic,
    /// Air leaves here; where it comes in it is that of the start.
    Open,
    /// Air leaves here, and none comes in.
    Outflow,
    /// Air comes in.
    Inflow(AirInflow),
}

/// Air that comes in. What is left out is as in the air at the start; give at most one measure of humidity. All but the velocity may change with time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirInflow {
    /// Its velocity, m/s; into the box.
    pub velocity_m_per_s: [f64; 3],
    /// Its temperature, °C, over time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature_c: Option<Series>,
    /// Vapour pressure over that of saturation, from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_humidity: Option<Series>,
    /// Temperature at which it would be saturated, °C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dew_point_c: Option<Series>,
    /// Mass of vapour over that of dry air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mixing_ratio: Option<Series>,
}

impl AirInflow {
    /// The files of what changes with time.
    pub(crate) fn paths(&mut self) -> impl Iterator<Item = &mut std::path::PathBuf> {
        let all = [&mut self.temperature_c, &mut self.relative_humidity, &mut self.dew_point_c, &mut self.mixing_ratio];
        all.into_iter().flatten().filter_map(|series| match series {
            Series::File { csv, .. } => Some(csv),
            _ => None,
        })
    }
}
