//! Scene files: the settings of a run, typed and checked; in SI units, but for a gas in reduced ones.
//!
//! [`Scene::read`] takes a TOML file, [`Scene::parse`] its text; [`builtin`] holds the scenes that come with the program.
//! A [`Scene`] that was read is checked: numbers are finite and in range, names unique, exactly one kind given where
//! one is meant. Files named in it are opened by whoever uses them.

pub mod dew;

mod builtin;
mod check;
mod document;
mod error;
mod expression;
mod files;
mod flood;
mod gas;
mod kernel;
mod link;
mod memory;
mod model;
mod nesting;
mod old_names;
mod parse;
mod resolve;
mod series;
mod terrain;
mod units;
mod write;
mod written;

pub use builtin::{Builtin, builtin, scenes};
pub use check::{Check, Checked, is_name};
pub use dew::Dew;
pub use error::{Location, Problem, SceneError};
pub use expression::{Expression, ExpressionError};
pub use files::{open_file, read_bytes, read_text};
pub use flood::*;
pub use gas::*;
pub use kernel::KernelName;
pub use link::SceneLink;
pub use memory::{hold_in_memory, in_memory, keep_in_memory, without_disk};
pub use model::{ModelScene, ModelTables, ReadError, SceneKind, Tables, kinds, register};
pub use nesting::{TOO_DEEP, too_deep};
pub use series::{Series, Table};
pub use terrain::*;
pub use units::us_name;

use serde::{Deserialize, Serialize};

/// A scene: everything that a run depends on.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Title, one line.
    pub title: String,
    /// A few sentences for the gallery and the report.
    pub description: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Duration of the run and its output intervals.
    pub run: Run,
    /// What is moved.
    pub model: ModelTables,
    /// Notes to the user on how it was written, in sentences: of keys read by an old name. They are not part of the scene: neither written out nor compared.
    pub notes: Vec<String>,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        let Self { title, description, seed, run, model, notes: _ } = self;
        *title == other.title
            && *description == other.description
            && *seed == other.seed
            && *run == other.run
            && *model == other.model
    }
}

/// Duration of the run and its output intervals. For a gas in reduced units read its unit of time for s.
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

impl Run {
    /// Time between frames, s: as given, or a twentieth of the run.
    pub fn frame_period_s(&self) -> f64 {
        self.frame_every_s.unwrap_or(self.until_s / 20.0)
    }

    /// Time between gauge rows, s: as given, or a two-hundredth of the run.
    pub fn gauge_period_s(&self) -> f64 {
        self.gauge_every_s.unwrap_or(self.until_s / 200.0)
    }
}
