//! The gas.

mod parameters;

use super::{COLLISIONS, ModelKind, Opened, Opening, Recorded};
use crate::Error;
use crate::parameters::Builder;
#[cfg(feature = "pictures")]
use crate::pictures::{DrawContext, PictureSettings, Scenery, Sketcher, Subject, gas::GasPicture};
use corpuscle_model::ModelError;
use corpuscle_output::GasReport;
use corpuscle_scene::{Gas, Scene, SceneKind, Units};

/// Memory for each ball, bytes: 340 measured where no frames are written, and room to write them.
const BYTES_PER_BALL: f64 = 500.0;

/// The model kind of gases.
pub(super) struct Kind;

/// The gas of a scene.
fn gas(scene: &Scene) -> Result<&Gas, ModelError> {
    scene.gas().ok_or_else(|| ModelError::Setup("it is not the scene of a gas".into()))
}

impl ModelKind for Kind {
    fn scene(&self) -> SceneKind {
        SceneKind::GAS
    }

    fn open(&self, opening: Opening<'_>) -> Result<Opened, Error> {
        let Opening { scene, folder, .. } = opening;
        Ok(Opened::plain(corpuscle_gas::open(gas(scene)?, scene.seed, scene.run.until_s, folder)?))
    }

    fn particles(&self) -> &'static str {
        "balls"
    }

    fn work(&self) -> &'static str {
        COLLISIONS
    }

    fn bytes_per_particle(&self, _scene: &Scene) -> f64 {
        BYTES_PER_BALL
    }

    fn has_si_units(&self, scene: &Scene) -> bool {
        scene.gas().is_none_or(|gas| gas.units == Units::Si)
    }

    fn first_gauges(&self) -> &'static [&'static str] {
        &["gas.temperature", "gas.pressure_walls"]
    }

    fn parameters(&self, builder: &mut Builder, scene: &Scene, _now: &Scene) {
        if let Some(gas) = scene.gas() {
            parameters::parameters(builder, gas);
        }
    }

    fn record_frame(&self, run: &Recorded<'_>) -> Result<(), Error> {
        Ok(GasReport::new(run.folder, run.scene, run.model)?.write_moment()?)
    }

    fn write_report(&self, run: &Recorded<'_>) -> Result<(), Error> {
        Ok(GasReport::new(run.folder, run.scene, run.model)?.write()?)
    }

    #[cfg(feature = "pictures")]
    fn sketcher(&self, scenery: &Scenery) -> Result<Box<dyn Sketcher>, Error> {
        Ok(Box::new(GasPicture::new(gas(scenery.scene())?.clone())))
    }

    #[cfg(feature = "pictures")]
    fn pictures(
        &self,
        _context: &DrawContext,
        scenery: &Scenery,
        _settings: &PictureSettings,
    ) -> Result<Box<dyn Subject>, Error> {
        Ok(Box::new(GasPicture::new(gas(scenery.scene())?.clone())))
    }
}
