//! What lets water out, holds it, or leads it elsewhere.

use crate::Series;
use serde::{Deserialize, Serialize};

/// An outflow by a rating curve. Give exactly one of `at`, `line` and `polygon`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outflow {
    /// Name, for gauges and messages.
    pub name: String,
    /// Round a point `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// Along a line of points `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Vec<[f64; 2]>>,
    /// Within a polygon of corners `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[f64; 2]>>,
    /// Discharge, m3/s, over the level of the water there, m: rows of `[level, discharge]`, linear between them.
    pub rating: Vec<[f64; 2]>,
}

/// Water that is held at a level. Give exactly one of `line` and `polygon`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Name, for messages.
    pub name: String,
    /// Along a line of points `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Vec<[f64; 2]>>,
    /// Within a polygon of corners `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[f64; 2]>>,
    /// The level over time, m.
    pub level_m: Series,
}

/// A culvert, a weir, or what else leads water from one point to another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Name, for gauges and messages.
    pub name: String,
    /// One end `[x, y]`; flow from here to the other end counts as positive.
    pub from: [f64; 2],
    /// The other end `[x, y]`.
    pub to: [f64; 2],
    /// Whether water may also go from `to` to `from`.
    #[serde(default = "yes")]
    pub both_ways: bool,
    /// Law of the discharge.
    pub law: LinkLaw,
}

fn yes() -> bool {
    true
}

/// How much water a link leads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinkLaw {
    /// A pipe or box under a road or bank.
    Culvert(Culvert),
    /// A wall that water falls over.
    Weir(Weir),
    /// Discharge, m3/s, over the difference of the levels, m: rows of `[difference, discharge]`, linear between them.
    Rating(Vec<[f64; 2]>),
}

/// A culvert: round, by `diameter_m`, or a box, by `width_m` and `height_m`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Culvert {
    /// Inner diameter, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// Inner width, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Inner height, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Length, m. Left out: the distance between the ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Level of the floor at `from` and `to`, m. Left out: the ground there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor_m: Option<[f64; 2]>,
    /// Manning's n of the barrel, s/m^(1/3).
    #[serde(default = "concrete")]
    pub manning: f64,
    /// Share of the velocity head that is lost at the entrance.
    #[serde(default = "square_edge")]
    pub entrance_loss: f64,
    /// Barrels side by side.
    #[serde(default = "one")]
    pub barrels: usize,
}

/// Manning's n of concrete pipe (Schall et al. 2012, HDS-5, table B.1).
fn concrete() -> f64 {
    0.012
}

/// Entrance loss of a square edge in a headwall (HDS-5, table C.2).
fn square_edge() -> f64 {
    0.5
}

fn one() -> usize {
    1
}

/// A weir.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weir {
    /// Level of the crest, m.
    pub crest_m: f64,
    /// Length of the crest across the flow, m.
    pub width_m: f64,
    /// C in Q = C width head^(3/2), m^(1/2)/s.
    #[serde(default = "broad_crest")]
    pub coefficient: f64,
}

/// Critical flow over a broad crest: (2/3)^(3/2) g^(1/2).
fn broad_crest() -> f64 {
    1.705
}
