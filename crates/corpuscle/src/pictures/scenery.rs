//! What pictures need of a scene.

use super::flood::drawn_ground;
use corpuscle_model::Surface;
use corpuscle_render::HeightField;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::sync::Arc;

/// The data that pictures need of an open scene. With it they can be opened in another thread than the one that computes.
#[derive(Debug, Clone)]
pub struct Scenery {
    pub(crate) scene: Scene,
    pub(crate) terrain: Option<Arc<Terrain>>,
    pub(crate) surfaces: Vec<Surface>,
    /// The heights of the ground as drawn, where they have been found already.
    pub(crate) drawn: Option<HeightField>,
    /// False where numbers are shown without units.
    pub(crate) has_si_units: bool,
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
}
