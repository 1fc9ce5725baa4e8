//! Which model a scene is for.

use crate::{Dew, Flood, Gas, Scene, Terrain};

/// What a scene says about what is moved: that of one model.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelScene {
    /// Shallow water: the tables `[terrain]` and `[flood]`.
    Flood(Box<FloodScene>),
    /// Colliding balls: the table `[gas]`.
    Gas(Box<Gas>),
    /// Humid air and cold solids: the table `[dew]`.
    Dew(Box<Dew>),
}

/// A flood and the ground that it runs over.
#[derive(Debug, Clone, PartialEq)]
pub struct FloodScene {
    /// The ground.
    pub terrain: Terrain,
    /// The flood model.
    pub flood: Flood,
}

impl Scene {
    /// The flood and its ground, where the scene is one of a flood.
    pub fn flood(&self) -> Option<&FloodScene> {
        match &self.model {
            ModelScene::Flood(flood) => Some(flood),
            ModelScene::Gas(_) | ModelScene::Dew(_) => None,
        }
    }

    /// The gas, where the scene is one of a gas.
    pub fn gas(&self) -> Option<&Gas> {
        match &self.model {
            ModelScene::Gas(gas) => Some(gas),
            ModelScene::Flood(_) | ModelScene::Dew(_) => None,
        }
    }

    /// The air and its solids, where the scene is one of dew.
    pub fn dew(&self) -> Option<&Dew> {
        match &self.model {
            ModelScene::Dew(dew) => Some(dew),
            ModelScene::Flood(_) | ModelScene::Gas(_) => None,
        }
    }
}
