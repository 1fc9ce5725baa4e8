//! Cells that follow the water.

use serde::{Deserialize, Serialize};

/// The `[flood.adaptive]` table: the cells of scheme `voronoi` become finer, and coarser again, while the flood runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// Smallest distance between particles, m; the nearest half, quarter, eighth ... of `flood.spacing_m` is taken.
    pub finest_m: f64,
    /// Cells are finer where the ground rises over a cell by more than this many times the depth of the water.
    #[serde(default = "rise_over_depth")]
    pub rise_over_depth: f64,
    /// Whether they are finest too where water ends at dry ground, however level.
    #[serde(default)]
    pub fronts: bool,
    /// Time steps between two checks of the resolution.
    #[serde(default = "every_steps")]
    pub every_steps: u32,
}

fn rise_over_depth() -> f64 {
    0.5
}

fn every_steps() -> u32 {
    10
}

impl Default for Adaptive {
    fn default() -> Self {
        Self { finest_m: 1.0, rise_over_depth: rise_over_depth(), fronts: false, every_steps: every_steps() }
    }
}
