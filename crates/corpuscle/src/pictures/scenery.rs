//! What pictures need of a scene.

use crate::Simulation;
use corpuscle_model::Surface;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::sync::Arc;

/// The data that pictures need of an open scene. With it they can be opened in another thread than the one that computes.
#[derive(Debug, Clone)]
pub struct Scenery {
    pub(super) scene: Scene,
    pub(super) terrain: Option<Arc<Terrain>>,
    surfaces: Vec<Surface>,
}

impl Scenery {
    /// The scene as run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The terrain, if there is one.
    pub fn terrain(&self) -> Option<&Terrain> {
        self.terrain.as_deref()
    }

    /// The terrain, if there is one, to be kept.
    pub fn shared_terrain(&self) -> Option<Arc<Terrain>> {
        self.terrain.clone()
    }

    /// The surfaces of solids.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The data of a scene in its current state.
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            scene: simulation.scene().clone(),
            terrain: simulation.terrain().cloned(),
            surfaces: simulation.model().surfaces(),
        }
    }
}
