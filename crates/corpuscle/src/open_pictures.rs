//! Opening of pictures and sketches: by the model of their scene.

use crate::pictures::{DrawContext, Made, PictureSettings, Pictures, Scenery, Sketches};
use crate::{Error, Simulation, models};
use corpuscle_gpu::Gpu;
use corpuscle_render::RenderError;
use corpuscle_scene::Scene;
use std::path::Path;
use std::sync::Arc;

impl Pictures {
    /// Opens pictures of a scene: on the GPU that takes the steps, else on the best device.
    ///
    /// # Errors
    /// [`Error::Render`] where there is no device, or the pictures are larger than it can hold.
    pub fn open(simulation: &Simulation, settings: PictureSettings) -> Result<Self, Error> {
        let gpu = simulation.stepping_gpu().map_or_else(Gpu::open, Ok).map_err(RenderError::from)?;
        Self::open_on(&gpu, simulation, settings)
    }

    /// The same on a device that is open already.
    ///
    /// # Errors
    /// [`Error::Render`] where the pictures are larger than it can hold.
    pub fn open_on(gpu: &Gpu, simulation: &Simulation, settings: PictureSettings) -> Result<Self, Error> {
        Self::open_scenery(gpu, &Scenery::of(simulation), settings)
    }

    /// The same where the scene is computed elsewhere.
    ///
    /// # Errors
    /// [`Error::Render`] where the pictures are larger than the device can hold.
    pub fn open_scenery(gpu: &Gpu, scenery: &Scenery, settings: PictureSettings) -> Result<Self, Error> {
        let Scenery { scene, terrain, .. } = scenery;
        let context = DrawContext::new(gpu, &settings, terrain.as_deref())?;
        let subject = models::of(scene)?.pictures(&context, scenery, &settings)?;
        Ok(Self::new(context, scene.title.clone(), subject))
    }
}

impl Sketches {
    /// Sketches of a scene.
    ///
    /// # Errors
    /// Where a file that the scene names cannot be used.
    pub fn open(scenery: &Scenery) -> Result<Self, Error> {
        let sketcher = models::of(&scenery.scene)?.sketcher(scenery)?;
        Ok(Self::new(scenery.scene.title.clone(), sketcher))
    }
}

impl Scenery {
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
        let has_si_units = kind.has_si_units(&scene);
        Ok(Self { scene, terrain, surfaces, drawn, has_si_units })
    }

    /// The data of a scene in its current state.
    pub fn of(simulation: &Simulation) -> Self {
        let scene = simulation.scene();
        Self {
            scene: scene.clone(),
            terrain: simulation.terrain().cloned(),
            surfaces: simulation.model().surfaces(),
            drawn: None,
            has_si_units: models::of(scene).is_ok_and(|kind| kind.has_si_units(scene)),
        }
    }
}
