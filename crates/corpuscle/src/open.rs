//! From a scene to a model.

use crate::ground::ground;
use crate::{Error, Simulation};
use corpuscle_flood::{FloodModel, default_spacing};
use corpuscle_model::ModelError;
#[cfg(feature = "gpu")]
use corpuscle_model::{CpuOnly, Model};
use corpuscle_output::compare_extent;
use corpuscle_scene::{Flood as FloodSettings, ModelScene, Scene, Scheme};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// The error of a model that runs on the CPU only, where a GPU was asked for.
#[cfg(feature = "gpu")]
fn refused(model: &dyn Model) -> Error {
    let why = model.cpu_only().map(|CpuOnly { what, remedy }| format!("{what}: {remedy}"));
    ModelError::Setup(why.unwrap_or_else(|| "this program was built without GPU support".into())).into()
}

impl Simulation {
    /// Makes a scene ready to run: reads its ground and sets up its model. Relative paths are taken from `folder`.
    ///
    /// # Errors
    /// Where the scene, its ground or a file that it names cannot be used.
    pub fn open(scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, corpuscle_flood::open)
    }

    /// As [`Simulation::open`], for a state that is restored, or frames that are read back: a flood does not arrange its water at
    /// the start, which takes minutes for millions of particles.
    ///
    /// # Errors
    /// As [`Simulation::open`].
    pub fn open_to_restore(scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, corpuscle_flood::open_to_restore)
    }

    /// Lets the GPU take the steps from here on, in single precision.
    ///
    /// # Errors
    /// Where there is no GPU, or it cannot compute this scene: nothing has changed then.
    #[cfg(feature = "gpu")]
    pub fn use_gpu(&mut self) -> Result<(), Error> {
        if self.model().cpu_only().is_some() {
            return Err(refused(self.model()));
        }
        self.use_this_gpu(corpuscle_gpu::Gpu::open()?)
    }

    /// [`Simulation::use_gpu`] with a GPU that is open.
    ///
    /// # Errors
    /// As [`Simulation::use_gpu`].
    #[cfg(feature = "gpu")]
    pub fn use_this_gpu(&mut self, gpu: corpuscle_gpu::Gpu) -> Result<(), Error> {
        match self.model_mut().on_gpu_mut() {
            Some(model) => Ok(model.use_gpu(gpu)?),
            None => Err(refused(self.model())),
        }
    }

    fn open_with(mut scene: Scene, folder: &Path, new_flood: NewFlood) -> Result<Self, Error> {
        scene.check()?;
        scene.resolve_paths(folder);
        scene.resolve_defaults();
        match &mut scene.model {
            ModelScene::Flood(written) => {
                let terrain = Arc::new(ground(&written.terrain, scene.seed, folder)?);
                check_observed_extent(&written.flood, &terrain)?;
                let mut notes = Vec::new();
                if written.flood.spacing_m.is_none() {
                    let chosen = default_spacing(&written.flood, &terrain, folder, scene.run.until_s)?;
                    written.flood.spacing_m = Some(chosen.spacing);
                    notes.push(chosen.to_string());
                }
                let flood = new_flood(&written.flood, scene.seed, folder, terrain.clone())?;
                written.flood = flood.settings().clone();
                check_inflow(&scene, &terrain, folder)?;
                Ok(Self::new(scene, Some(terrain), flood).with_notes(notes))
            }
            ModelScene::Gas(gas) => {
                let model = corpuscle_gas::open(gas, scene.seed, scene.run.until_s, folder)?;
                Ok(Self::new(scene, None, model))
            }
            ModelScene::Dew(dew) => {
                let model = corpuscle_dew::open(dew, scene.seed, folder)?;
                Ok(Self::new(scene, None, Box::new(model)))
            }
        }
    }
}

/// How a flood is made ready: its settings, seed, folder of relative paths, and ground.
type NewFlood = fn(&corpuscle_scene::Flood, u64, &Path, Arc<Terrain>) -> Result<Box<dyn FloodModel>, ModelError>;

/// More particles than this over a run are days of computation.
const MOST_TO_COME: f64 = 2e8;

/// A deeper layer over all the terrain, m, is more than any flood brings.
const MOST_LAYER: f64 = 1e5;

/// Water that the inflows of a scene bring in over the run, m3; relative paths are taken from `folder`.
fn volume_of_inflows(scene: &Scene, folder: &Path) -> Result<f64, Error> {
    let mut volume = 0.0;
    for inflow in scene.flood().iter().flat_map(|scene| &scene.flood.inflow) {
        volume += inflow.load_discharge(folder)?.integral(0.0, scene.run.until_s);
    }
    Ok(volume)
}

/// Refuses discharges that no machine could follow, most likely a slip of the unit.
fn check_inflow(scene: &Scene, terrain: &Terrain, folder: &Path) -> Result<(), Error> {
    let Some(flood) = scene.flood().map(|scene| &scene.flood) else { return Ok(()) };
    let volume = volume_of_inflows(scene, folder)?;
    if flood.scheme == Scheme::Voronoi {
        let [east, north] = terrain.bounds().size();
        let layer = volume / (east * north);
        if layer <= MOST_LAYER {
            return Ok(());
        }
        let what = format!(
            "the inflows ([[flood.inflow]]) would bring a layer of {layer:.1e} m over all the terrain, and at most {MOST_LAYER:.0e} m are \
             possible; check their discharges, which are in m3/s"
        );
        return Err(ModelError::Setup(what).into());
    }
    let (Some(spacing), Some(depth)) = (flood.spacing_m, flood.spacing_depth_m) else { return Ok(()) };
    let count = (volume / (spacing * spacing * depth)).floor();
    if count <= MOST_TO_COME {
        return Ok(());
    }
    let what = format!(
        "the inflows ([[flood.inflow]]) would bring in {count:.1e} particles over the run, and at most {MOST_TO_COME:.0e} \
         are possible; check their discharges, which are in m3/s, or take a larger flood.spacing_m"
    );
    Err(ModelError::Setup(what).into())
}

/// Finds out before the run, not at its end, that the observed extent cannot be used.
fn check_observed_extent(flood: &FloodSettings, terrain: &Terrain) -> Result<(), Error> {
    if let Some(observed) = &flood.observed_extent {
        let grid = terrain.map_grid();
        compare_extent(observed, terrain, &vec![f32::NAN; grid.columns * grid.rows])?;
    }
    Ok(())
}
