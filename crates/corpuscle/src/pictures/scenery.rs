//! What pictures need of a scene.

use super::flood::drawn_ground;
use crate::{Error, Simulation, models};
use corpuscle_model::Surface;
use corpuscle_render::HeightField;
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
    /// The heights of the ground as drawn, where they have been found already.
    drawn: Option<HeightField>,
}

/// What was made of a scene elsewhere, and need not be made again.
#[derive(Debug, Default)]
pub struct Made {
    /// The terrain, if there is one that can be sent.
    pub terrain: Option<Terrain>,
    /// The heights of the ground as drawn ([`Scenery::drawn_heights`]).
    pub drawn: Option<HeightField>,
    /// The surfaces of the model, in any case.
    pub surfaces: Vec<Surface>,
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

    /// Finds the heights of the ground as drawn, which takes long for a large terrain; none where there is none.
    pub fn drawn_heights(&self) -> Option<HeightField> {
        self.terrain().map(|terrain| self.drawn.clone().unwrap_or_else(|| drawn_ground(terrain)))
    }

    /// The data of a scene that was opened elsewhere, with what was made of it there. Terrain that is not given and shapes of solids are
    /// made again, from the scene as run.
    ///
    /// # Errors
    /// Where terrain or a solid cannot be made.
    pub fn of_scene(scene: Scene, made: Made) -> Result<Self, Error> {
        let Made { terrain, drawn, mut surfaces } = made;
        let (kind, folder) = (models::of(&scene)?, Path::new(""));
        let terrain = match terrain {
            Some(terrain) => Some(Arc::new(terrain)),
            None => kind.terrain(&scene, folder)?,
        };
        for (surface, shape) in surfaces.iter_mut().zip(kind.shapes(&scene, folder)?) {
            surface.shape = shape;
        }
        Ok(Self { scene, terrain, surfaces, drawn })
    }

    /// The data of a scene in its current state.
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            scene: simulation.scene().clone(),
            terrain: simulation.terrain().cloned(),
            surfaces: simulation.model().surfaces(),
            drawn: None,
        }
    }
}
