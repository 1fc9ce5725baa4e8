//! The water at a position.

use serde::{Deserialize, Serialize};

/// The water at a position.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Depth, m; 0 where it is dry.
    pub depth: f64,
    /// Velocity `[east, north]`, m/s.
    pub velocity: [f64; 2],
}

impl Sample {
    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        self.velocity[0].hypot(self.velocity[1])
    }
}
