//! Fans.

use serde::{Deserialize, Serialize};

/// A fan: a box in which the air is driven to a velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fan {
    /// Its middle, m.
    pub position_m: [f64; 3],
    /// Lengths of its sides, m.
    pub size_m: [f64; 3],
    /// The velocity to which it drives the air, m/s.
    pub velocity_m_per_s: [f64; 3],
}
