//! The gas.

mod parameters;

use super::{COLLISIONS, ModelKind, Opened, Opening, Recorded};
use crate::Error;
use crate::memory::refuse_what_does_not_fit;
use crate::parameters::Builder;
#[cfg(feature = "pictures")]
use crate::pictures::{DrawContext, PictureSettings, Scenery, Sketcher, Subject, gas::GasPicture};
use corpuscle_model::ModelError;
use corpuscle_output::GasReport;
use corpuscle_scene::{Gas, Scene, SceneKind, Species, Units};
use std::f64::consts::PI;

/// Memory for each ball, bytes: 340 measured where no frames are written, and room to write them.
const BYTES_PER_BALL: f64 = 500.0;

/// The model kind of gases.
pub(super) struct Kind;

/// The gas of a scene.
fn gas(scene: &Scene) -> Result<&Gas, ModelError> {
    scene.gas().ok_or_else(|| ModelError::Setup("it is not the scene of a gas".into()))
}

/// About how many balls a gas has.
fn balls(gas: &Gas) -> f64 {
    let room: f64 = gas.size.iter().product();
    let of_species = |species: &Species| {
        let radius = species.radius;
        let ball = if gas.dimensions() == 2 { PI * radius * radius } else { 4.0 / 3.0 * PI * radius.powi(3) };
        species.count.map_or_else(|| species.packing.unwrap_or(0.0) * room / ball, |count| count as f64)
    };
    gas.species.iter().map(of_species).sum::<f64>() + gas.ball.len() as f64
}

impl ModelKind for Kind {
    fn scene(&self) -> SceneKind {
        SceneKind::GAS
    }

    fn open(&self, opening: Opening<'_>) -> Result<Opened, Error> {
        let Opening { scene, folder, .. } = opening;
        refuse_what_does_not_fit(balls(gas(scene)?) * BYTES_PER_BALL, "give fewer balls (gas.species)")?;
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
