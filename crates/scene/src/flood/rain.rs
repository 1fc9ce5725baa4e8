//! Rain, what soaks into the ground, and what kinds of ground there are.

use crate::Series;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The `[flood.rain]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rain {
    /// Intensity over time, mm/h.
    pub intensity_mm_per_h: Series,
    /// A raster of factors by which the intensity is multiplied; of intensities in mm/h where the intensity is 1. No rain falls
    /// where it has no data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raster: Option<PathBuf>,
}

/// How fast water soaks into the ground, where there is enough of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Infiltration {
    /// Always as fast.
    Constant(ConstantInfiltration),
    /// After Horton.
    Horton(Horton),
    /// After Green and Ampt.
    GreenAmpt(GreenAmpt),
}

/// Infiltration at one rate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantInfiltration {
    /// The rate, mm/h.
    pub rate_mm_per_h: f64,
}

/// Infiltration that falls from a first to a last rate as the ground fills: last + (first - last) exp(-decay t).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Horton {
    /// The rate into dry ground, mm/h.
    pub first_mm_per_h: f64,
    /// The rate in the end, mm/h.
    pub last_mm_per_h: f64,
    /// How fast it falls, 1/h.
    pub decay_per_h: f64,
}

/// Infiltration behind a sharp front: conductivity (1 + suction deficit / water that has soaked in).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GreenAmpt {
    /// Hydraulic conductivity of the wet ground, mm/h.
    pub conductivity_mm_per_h: f64,
    /// Suction head at the front, m.
    pub suction_m: f64,
    /// Water that the dry ground takes up, as a share of its volume.
    pub deficit: f64,
}

/// The `[flood.land_use]` table: kinds of ground by a raster of whole numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LandUse {
    /// The raster.
    pub raster: PathBuf,
    /// What its numbers stand for; numbers that are not here are ground as in the rest of the scene.
    pub class: Vec<LandClass>,
}

/// One kind of ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LandClass {
    /// Its number in the raster.
    pub code: i64,
    /// What it is, for the reader.
    #[serde(default)]
    pub name: String,
    /// Manning's n, s/m^(1/3). Left out: as in the rest of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manning: Option<f64>,
    /// How water soaks in. Left out: as in the rest of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub infiltration: Option<Infiltration>,
}
