//! What all exports read of a run: its scene and how far it has come.

use crate::ExportError;
use corpuscle_output::{FrameFiles, OutputError, Summary};
use corpuscle_scene::Scene;
use std::path::{Path, PathBuf};

/// A run's folder that is exported.
pub(crate) struct Run {
    /// The folder.
    pub(crate) folder: PathBuf,
    /// The scene as run.
    scene: Scene,
    /// The summary; none where the run has not ended.
    summary: Option<Summary>,
}

impl Run {
    /// Opens a run's folder.
    pub(crate) fn open(folder: &Path) -> Result<Self, ExportError> {
        let scene = folder.join("scene.toml");
        if !scene.is_file() {
            return Err(ExportError::NoRun { path: folder.to_owned() });
        }
        let ended = folder.join("summary.json").exists();
        let summary = ended.then(|| Summary::read(folder)).transpose()?;
        Ok(Self { folder: folder.to_owned(), scene: Scene::read(&scene, &[])?, summary })
    }

    /// Title of the scene, or the name of the folder.
    pub(crate) fn title(&self) -> String {
        match self.scene.title.trim() {
            "" => self.folder.file_name().map_or_else(|| "run".into(), |name| name.to_string_lossy().into_owned()),
            title => title.to_owned(),
        }
    }

    /// The program that ran it: `Corpuscle 0.1.0`.
    pub(crate) fn source(&self) -> String {
        let version = self.summary.as_ref().map_or(env!("CARGO_PKG_VERSION"), |summary| &summary.version);
        format!("Corpuscle {version}")
    }

    /// Time at its end, s; none where it has not ended.
    pub(crate) fn end(&self) -> Option<f64> {
        self.summary.as_ref().map(|summary| summary.simulated_time_s)
    }

    /// Its particle files.
    pub(crate) fn frames(&self) -> Result<FrameFiles, OutputError> {
        let run = &self.scene.run;
        // Of tables: a multiple of the period, or the end.
        FrameFiles::list(&self.folder, |index| (index as f64 * run.frame_period_s()).min(run.until_s))
    }
}
