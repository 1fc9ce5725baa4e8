//! What pictures need of a scene.

use crate::{Error, Simulation, models};
use corpuscle_model::Surface;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
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

    /// The data of a scene that was opened elsewhere, with the surfaces of its model there: terrain and shapes of solids are made again,
    /// from the scene as run.
    ///
    /// # Errors
    /// Where terrain or a solid cannot be made.
    pub fn of_scene(scene: Scene, mut surfaces: Vec<Surface>) -> Result<Self, Error> {
        let (kind, folder) = (models::of(&scene)?, Path::new(""));
        let terrain = kind.terrain(&scene, folder)?;
        for (surface, shape) in surfaces.iter_mut().zip(kind.shapes(&scene, folder)?) {
            surface.shape = shape;
        }
        Ok(Self { scene, terrain, surfaces })
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
