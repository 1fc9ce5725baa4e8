//! Splitting and merging of particles.

use serde::{Deserialize, Serialize};

/// The `[flood.refinement]` table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Refinement {
    /// How far apart particles of moving water stand at most, about, m: one that stands for twice the square of this is split in two. Left
    /// out: `flood.spacing_m`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing_m: Option<f64>,
    /// The smallest part into which a particle is split, over the water of a whole one.
    pub smallest: f64,
}

impl Default for Refinement {
    fn default() -> Self {
        Self { spacing_m: None, smallest: 1.0 / 64.0 }
    }
}
