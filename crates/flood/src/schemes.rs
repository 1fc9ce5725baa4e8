//! Floods of both schemes.

use crate::sampling::Sample;
use crate::{LiveChange, SphSweFlood, VoronoiFlood, limits};
use corpuscle_model::{Model, ModelError};
use corpuscle_processes::Processes;
use corpuscle_scene::{Flood, Scheme};
use corpuscle_terrain::Terrain;
use std::any::Any;
use std::path::Path;
use std::sync::Arc;

/// A flood of any scheme.
pub trait FloodModel: Model {
    /// The `[flood]` of the scene with every default that depends on ground and water filled in.
    fn settings(&self) -> &Flood;

    /// The water at a position in model coordinates, m, at the time shown.
    fn sample(&self, x: f64, y: f64) -> Sample;

    /// About how many particles inflows, rain and held levels bring, or wet, from `from` to `until`, s.
    fn particles_to_come(&self, from: f64, until: f64) -> f64;

    /// Places a gauge at a point in model coordinates, m: depth, level and velocity are measured there from now on, in columns after all
    /// others.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where another gauge has the name, or the position lies outside the terrain.
    fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), ModelError>;

    /// Changes the flood from the end of the last step on.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it has nothing of the kind, or the number is out of range: nothing has changed then.
    /// [`ModelError::Device`] where a GPU takes the steps and cannot go on with the change.
    fn change(&mut self, change: LiveChange) -> Result<(), ModelError>;
}

/// Sets a flood up as the `[flood]` of a scene says, its defaults resolved, with the scene's seed. `folder` is what relative paths refer to.
///
/// # Errors
/// [`ModelError::Setup`] where something cannot be opened or lies outside the terrain.
pub fn open(
    processes: &Processes,
    settings: &Flood,
    seed: u64,
    folder: &Path,
    terrain: Arc<Terrain>,
) -> Result<Box<dyn FloodModel>, ModelError> {
    Ok(match settings.scheme {
        Scheme::Voronoi => {
            limits::check_cells(settings, &terrain)?;
            // A file may be missing for one process only.
            processes.agree(limits::check_depths(settings, &terrain, folder), ModelError::Setup)?;
            Box::new(VoronoiFlood::new_on(processes, settings, seed, folder, terrain)?)
        }
        Scheme::SphSwe => {
            refuse_several(processes)?;
            Box::new(SphSweFlood::new(settings, seed, folder, terrain)?)
        }
    })
}

/// As [`open`], but without the water at the start, which may take a while to arrange: for a state that is restored.
///
/// # Errors
/// As [`open`].
pub fn open_to_restore(
    processes: &Processes,
    settings: &Flood,
    seed: u64,
    folder: &Path,
    terrain: Arc<Terrain>,
) -> Result<Box<dyn FloodModel>, ModelError> {
    Ok(match settings.scheme {
        Scheme::Voronoi => {
            limits::check_cells(settings, &terrain)?;
            Box::new(VoronoiFlood::to_restore_on(processes, settings, seed, folder, terrain)?)
        }
        Scheme::SphSwe => {
            refuse_several(processes)?;
            Box::new(SphSweFlood::to_restore(settings, seed, folder, terrain)?)
        }
    })
}

/// Refuses several processes for scheme sph-swe.
fn refuse_several(processes: &Processes) -> Result<(), ModelError> {
    if processes.link().is_none() {
        return Ok(());
    }
    let what = "flood.scheme = \"sph-swe\" is computed by one process only: start the run without `mpirun`";
    Err(ModelError::Setup(what.into()))
}

/// A model that is a flood, as one.
pub fn as_flood(model: &dyn Any) -> Option<&dyn FloodModel> {
    let kernels = model.downcast_ref::<SphSweFlood>().map(|flood| flood as &dyn FloodModel);
    kernels.or_else(|| model.downcast_ref::<VoronoiFlood>().map(|flood| flood as &dyn FloodModel))
}

/// A model that is a flood, as one.
pub fn as_flood_mut(model: &mut dyn Any) -> Option<&mut dyn FloodModel> {
    if model.is::<SphSweFlood>() {
        return model.downcast_mut::<SphSweFlood>().map(|flood| flood as &mut dyn FloodModel);
    }
    model.downcast_mut::<VoronoiFlood>().map(|flood| flood as &mut dyn FloodModel)
}

impl FloodModel for SphSweFlood {
    fn settings(&self) -> &Flood {
        Self::settings(self)
    }

    fn sample(&self, x: f64, y: f64) -> Sample {
        Self::sample(self, x, y)
    }

    fn particles_to_come(&self, from: f64, until: f64) -> f64 {
        Self::particles_to_come(self, from, until)
    }

    fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), ModelError> {
        Self::place_gauge(self, name, at)
    }

    fn change(&mut self, change: LiveChange) -> Result<(), ModelError> {
        self.change_live(change)
    }
}

impl FloodModel for VoronoiFlood {
    fn settings(&self) -> &Flood {
        Self::settings(self)
    }

    fn sample(&self, x: f64, y: f64) -> Sample {
        Self::sample(self, x, y)
    }

    fn particles_to_come(&self, from: f64, until: f64) -> f64 {
        Self::particles_to_come(self, from, until)
    }

    fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), ModelError> {
        Self::place_gauge(self, name, at)
    }

    fn change(&mut self, change: LiveChange) -> Result<(), ModelError> {
        Self::change(self, change)
    }
}
