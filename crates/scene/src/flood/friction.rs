//! Bed friction after other laws than Manning's.

use serde::{Deserialize, Serialize};

/// Friction after another law than Manning's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Friction {
    /// Chezy's coefficient C, m^(1/2)/s: the friction slope is u |u| / (C^2 d).
    Chezy(f64),
    /// The friction slope over the velocity, s/m.
    Linear(f64),
}
