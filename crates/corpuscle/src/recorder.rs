//! A run's folder as a sink.

use crate::models::{self, Recorded};
use crate::{Error, Simulation, Sink};
use corpuscle_model::Model;
use corpuscle_output::{Clock, FrameFormat, MAP_OVER_TIME, RunFolder, Status, Summary};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// The sink that writes a run into its folder and, at the end, its report.
pub struct Recorder {
    folder: RunFolder,
    terrain: Option<Arc<Terrain>>,
    scene: Scene,
}

impl Recorder {
    /// Starts the folder of a run.
    ///
    /// # Errors
    /// [`corpuscle_output::OutputError`] where the folder holds anything or cannot be written.
    pub fn create(path: &Path, simulation: &Simulation, frames: FrameFormat) -> Result<Self, Error> {
        let scene_text = simulation.scene().to_toml()?;
        let folder = RunFolder::create(path, &scene_text, &simulation.model().gauge_columns(), frames)?;
        let mut recorder = Self::new(folder, simulation);
        simulation.notes().iter().try_for_each(|note| recorder.folder.log(&format!("note: {note}")))?;
        Ok(recorder)
    }

    /// Resumes an interrupted run from its folder: opens its scene and restores its checkpoint.
    ///
    /// # Errors
    /// Where the folder holds no run, no checkpoint or one that does not fit.
    pub fn resume(path: &Path) -> Result<(Simulation, Self), Error> {
        Self::resume_with(path, |scene| Simulation::open_to_restore(scene, path))
    }

    /// [`Recorder::resume`] with a caller's own model: `open` opens the scene.
    ///
    /// # Errors
    /// As [`Recorder::resume`].
    pub fn resume_with(
        path: &Path,
        open: impl FnOnce(Scene) -> Result<Simulation, Error>,
    ) -> Result<(Simulation, Self), Error> {
        let mut simulation = open(Scene::read(&path.join("scene.toml"), &[])?)?;
        let (folder, clock, state) = RunFolder::resume(path)?;
        simulation.restore(clock, &state)?;
        let recorder = Self::new(folder, &simulation);
        Ok((simulation, recorder))
    }

    fn new(folder: RunFolder, simulation: &Simulation) -> Self {
        Self { folder, terrain: simulation.terrain().cloned(), scene: simulation.scene().clone() }
    }

    fn recorded<'a>(&'a self, model: &'a dyn Model) -> Recorded<'a> {
        Recorded { folder: self.folder.path(), scene: &self.scene, terrain: self.terrain.as_deref(), model }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// True where there is a checkpoint to resume from.
    pub fn can_resume(&self) -> bool {
        self.folder.has_checkpoint()
    }
}

impl Sink for Recorder {
    fn gauges(&mut self, time: f64, row: &[f64]) -> Result<(), Error> {
        Ok(self.folder.append_gauges(time, row)?)
    }

    fn frame(&mut self, model: &dyn Model) -> Result<(), Error> {
        if self.folder.frame_format() != FrameFormat::None {
            self.folder.write_frame(&model.frame(), model.container().as_ref())?;
        }
        if let Some(terrain) = &self.terrain {
            let (folder, mut written) = (&mut self.folder, Ok(()));
            model.each_map(&|name| name == MAP_OVER_TIME, &mut |map| {
                written = folder.write_snapshot(model.time(), &[map], terrain);
            });
            written?;
        }
        models::of(&self.scene)?.record_frame(&self.recorded(model))
    }

    fn checkpoint(&mut self, model: &dyn Model, clock: Clock) -> Result<(), Error> {
        Ok(self.folder.write_checkpoint(clock, &model.save())?)
    }

    fn finish(&mut self, model: &dyn Model, summary: &mut Summary) -> Result<(), Error> {
        let kind = models::of(&self.scene)?;
        if let Some(terrain) = &self.terrain {
            let (folder, mut written) = (&self.folder, Ok(()));
            model.each_map(&|name| name != MAP_OVER_TIME, &mut |map| {
                if written.is_ok() {
                    written = folder.write_final_maps(&[map], terrain);
                }
            });
            written?;
        }
        kind.complete(&self.recorded(model), summary)?;
        for warning in &summary.warnings {
            self.folder.log(&format!("warning: {warning}"))?;
        }
        self.folder.finish(summary)?;
        self.folder.write_charts(&model.charts(), &model.paths())?;
        self.folder.write_surfaces(&model.surfaces())?;
        if summary.status == Status::Stopped {
            return Ok(());
        }
        kind.write_report(&self.recorded(model))
    }
}
