//! Trajectories of single particles.

use serde::{Deserialize, Serialize};

/// The trajectory of one particle as a polyline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Path {
    /// Name for legends: `ball 0`.
    pub name: String,
    /// Time at each point, s.
    pub times: Vec<f64>,
    /// The points, m; one for each time. Not-a-number separates two pieces, as where a periodic side is crossed.
    pub points: Vec<[f64; 3]>,
}
