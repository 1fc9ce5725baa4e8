//! What the water moves in.

use super::boundaries::EdgeRules;
use super::obstacles::Obstacles;
use corpuscle_terrain::Terrain;
use std::sync::Arc;

/// What the water moves in.
pub(crate) struct Surroundings {
    pub terrain: Arc<Terrain>,
    pub edges: EdgeRules,
    pub obstacles: Obstacles,
}
