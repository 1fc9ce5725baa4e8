//! Dew.

mod parameters;

use super::{ModelKind, Opened, Opening, Recorded};
use crate::Error;
use crate::memory::refuse_what_does_not_fit;
use crate::parameters::Builder;
#[cfg(feature = "pictures")]
use crate::pictures::{
    DrawContext, PictureSettings, Scenery, Sketcher, Subject,
    dew::{DewPicture, DewSketch, shows_air},
};
use corpuscle_model::ModelError;
#[cfg(feature = "pictures")]
use corpuscle_model::SolidShape;
use corpuscle_output::DewReport;
use corpuscle_scene::{Dew, Scene, SceneKind};
#[cfg(feature = "pictures")]
use std::path::Path;

/// Memory for each particle, bytes, 1456 measured by the bench `dew/plate-100k`: air, its columns, lists and pairs with solids.
const BYTES_PER_AIR_PARTICLE: f64 = 1500.0;

/// The model kind of dew.
pub(super) struct Kind;

/// The air and solids of a scene.
fn dew(scene: &Scene) -> Result<&Dew, ModelError> {
    scene.dew().ok_or_else(|| ModelError::Setup("it is not the scene of dew".into()))
}

impl ModelKind for Kind {
    fn scene(&self) -> SceneKind {
        SceneKind::DEW
    }

    fn open(&self, opening: Opening<'_>) -> Result<Opened, Error> {
        let Opening { scene, folder, processes, .. } = opening;
        let settings = dew(scene)?;
        let parcels = settings.size_m.iter().product::<f64>() / settings.spacing_m.powi(3);
        refuse_what_does_not_fit(parcels * BYTES_PER_AIR_PARTICLE, "give a larger dew.spacing_m or a smaller box")?;
        Ok(Opened::plain(Box::new(corpuscle_dew::open_on(processes, dew(scene)?, scene.seed, folder)?)))
    }

    fn is_shared(&self) -> bool {
        true
    }

    fn bytes_per_particle(&self, _scene: &Scene) -> f64 {
        BYTES_PER_AIR_PARTICLE
    }

    fn first_gauges(&self) -> &'static [&'static str] {
        &["solids.covered_area"]
    }

    fn parameters(&self, builder: &mut Builder, scene: &Scene, _now: &Scene) {
        if let Some(dew) = scene.dew() {
            parameters::parameters(builder, dew);
        }
    }

    fn record_frame(&self, run: &Recorded<'_>) -> Result<(), Error> {
        Ok(DewReport::new(run.folder, run.scene, run.model)?.write_moment()?)
    }

    fn write_report(&self, run: &Recorded<'_>) -> Result<(), Error> {
        Ok(DewReport::new(run.folder, run.scene, run.model)?.write()?)
    }

    #[cfg(feature = "pictures")]
    fn shapes(&self, scene: &Scene, folder: &Path) -> Result<Vec<SolidShape>, Error> {
        Ok(corpuscle_dew::bodies::shapes(dew(scene)?, folder).map_err(ModelError::from)?)
    }

    #[cfg(feature = "pictures")]
    fn sketcher(&self, scenery: &Scenery) -> Result<Box<dyn Sketcher>, Error> {
        Ok(Box::new(DewSketch::new(dew(scenery.scene())?, scenery.surfaces())))
    }

    #[cfg(feature = "pictures")]
    fn pictures(
        &self,
        context: &DrawContext,
        scenery: &Scenery,
        _settings: &PictureSettings,
    ) -> Result<Box<dyn Subject>, Error> {
        Ok(Box::new(DewPicture::new(context, dew(scenery.scene())?, scenery.surfaces())))
    }

    #[cfg(feature = "pictures")]
    fn shows_particles(&self, scene: &Scene) -> bool {
        scene.dew().is_none_or(shows_air)
    }
}
