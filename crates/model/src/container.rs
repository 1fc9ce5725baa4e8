//! The box round the particles.

use serde::{Deserialize, Serialize};

/// The box that holds the particles, as it stands at the time shown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Container {
    /// Corner at the smallest coordinates, m; the third 0 in two dimensions.
    pub from: [f64; 3],
    /// Corner at the largest coordinates, m; the third 0 in two dimensions.
    pub to: [f64; 3],
}
