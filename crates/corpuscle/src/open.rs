//! Opening of scenes.

use crate::models::{self, Opened, Opening};
use crate::{Error, Simulation};
use corpuscle_model::ModelError;
#[cfg(feature = "gpu")]
use corpuscle_model::{CpuOnly, Model};
use corpuscle_processes::Processes;
use corpuscle_scene::Scene;
use std::path::Path;

/// The error of a model that runs on the CPU only, where a GPU was requested.
#[cfg(feature = "gpu")]
fn refused(model: &dyn Model) -> Error {
    let why = model.cpu_only().map(|CpuOnly { what, remedy }| format!("{what}: {remedy}"));
    ModelError::Setup(why.unwrap_or_else(|| "this program was built without GPU support".into())).into()
}

impl Simulation {
    /// Opens a scene: reads its terrain and sets up its model. Relative paths are taken from `folder`.
    ///
    /// # Errors
    /// Where the scene, its terrain or a file that it names cannot be used.
    pub fn open(scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, &Processes::alone(), false)
    }

    /// As [`Simulation::open`], with the scene distributed over processes, which all call this. The first then runs it; the others
    /// [follow](Simulation::follow).
    ///
    /// # Errors
    /// As [`Simulation::open`]; and where the model, or what the scene has, is computed by one process only.
    pub fn open_on(processes: &Processes, scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, processes, false)
    }

    /// As [`Simulation::open_to_restore`], with the scene distributed over processes.
    ///
    /// # Errors
    /// As [`Simulation::open_on`].
    pub fn open_to_restore_on(processes: &Processes, scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, processes, true)
    }

    /// Takes part in the run of the first of the processes with which it was opened, until that ends; for a process that is not the first.
    pub fn follow(&mut self, processes: &Processes) {
        processes.follow(self.model_mut());
    }

    /// As [`Simulation::open`], for a state that is restored, or frames that are read back: a flood does not arrange its water at
    /// the start, which takes minutes for millions of particles.
    ///
    /// # Errors
    /// As [`Simulation::open`].
    pub fn open_to_restore(scene: Scene, folder: &Path) -> Result<Self, Error> {
        Self::open_with(scene, folder, &Processes::alone(), true)
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

    fn open_with(mut scene: Scene, folder: &Path, processes: &Processes, is_restored: bool) -> Result<Self, Error> {
        scene.check()?;
        scene.resolve_paths(folder);
        scene.resolve_defaults();
        let opening = Opening { scene: &mut scene, folder, processes, is_restored };
        let kind = models::of(opening.scene)?;
        if processes.link().is_some() && !kind.is_shared() {
            let what =
                "several processes compute dew, and floods by scheme voronoi, only: start the run without `mpirun`";
            return Err(ModelError::Setup(what.into()).into());
        }
        let Opened { model, terrain, notes } = kind.open(opening)?;
        let notes = [scene.notes.clone(), notes].concat();
        Ok(Self::new(scene, terrain, model).with_notes(notes))
    }
}
