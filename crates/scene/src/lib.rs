//! Scene files: what a user asks for, typed, in SI units and checked.

mod flood;
mod terrain;

pub use flood::*;
pub use terrain::*;

use serde::{Deserialize, Serialize};

/// A scene: everything that a run depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line: what is seen here.
    #[serde(default)]
    pub title: String,
    /// A few sentences for the gallery and the report.
    #[serde(default)]
    pub description: String,
    /// Seed of everything random.
    #[serde(default = "default_seed")]
    pub seed: u64,
    /// How long to run and how often to look.
    pub run: Run,
    /// The ground.
    pub terrain: Terrain,
    /// The flood model.
    pub flood: Flood,
}

fn default_seed() -> u64 {
    1
}

/// How long to run and how often to look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// End of the run, s.
    pub until_s: f64,
    /// Time between particle frames and depth maps, s. Left out: a twentieth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame_every_s: Option<f64>,
    /// Time between gauge rows, s. Left out: a two-hundredth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauge_every_s: Option<f64>,
    /// Time between checkpoints, s of wall-clock time.
    #[serde(default = "default_checkpoint")]
    pub checkpoint_every_wall_s: f64,
}

fn default_checkpoint() -> f64 {
    60.0
}
