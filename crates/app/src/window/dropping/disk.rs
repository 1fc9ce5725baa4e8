//! Dropped files on the disk.

use super::{Pending, Window};
use crate::{Source, Start, dropped};
use egui::{Context, DroppedFileHandle, Ui};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;

/// Files chosen by a button, of which there is none here.
#[derive(Default)]
pub(in crate::window) struct ChosenFiles {}

impl ChosenFiles {
    /// None.
    pub fn take(&self) -> Vec<DroppedFileHandle> {
        Vec::new()
    }
}

impl Window {
    /// Shows no button: files are dropped, or named on the command line.
    pub(in crate::window) fn open_button(&self, _: &mut Ui) {}

    /// What is said while a file hovers over the window.
    pub(super) const DROP_HINT: &str =
        "Drop terrain to flood it: a GeoTIFF or an ESRI ASCII grid.\nA scene file or the folder of a run is opened.";

    /// Opens the first of the dropped files.
    pub(super) fn take_files(&mut self, context: &Context, files: &[DroppedFileHandle]) {
        if let Some(file) = files.first() {
            self.open_dropped(context, file.path().to_owned());
        }
    }

    /// Frees nothing: files are on the disk.
    pub(in crate::window) fn free_dropped(&self, _: &Source) {}

    /// Opens a file or a folder in a thread of its own: large terrain takes a while to read.
    pub fn open_dropped(&mut self, context: &Context, path: PathBuf) {
        self.fault = None;
        let (sender, receiver) = channel();
        let context = context.clone();
        let read = move || {
            // The receiver is gone when the window closes.
            let _ = sender.send(open(&path));
            context.request_repaint();
        };
        match std::thread::Builder::new().name("dropped".into()).spawn(read) {
            Ok(_) => self.pending = Some(Pending::Dropped(receiver)),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }
}

/// The scene or run of a dropped file or folder. Returns when it has been read.
///
/// # Errors
/// A text that says what is wrong with it.
fn open(path: &Path) -> Result<Start, String> {
    if path.is_dir() {
        return Ok(Start::Run(path.to_owned()));
    }
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ending == "toml" {
        let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        return Ok(scene(path, text));
    }
    dropped::flood(path).map(Start::Scene)
}

/// The scene of a dropped file with its text.
fn scene(path: &Path, text: String) -> Start {
    let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
    Start::Scene(Source { name: path.display().to_string(), text, folder, changes: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_terrain_is_refused_and_scenes_and_runs_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(open(folder.path()), Ok(Start::Run(_))));
        let file = folder.path().join("notes.txt");
        fs::write(&file, "no terrain").unwrap();
        assert!(open(&file).unwrap_err().contains("notes.txt"));
        assert!(open(&folder.path().join("none.tif")).unwrap_err().contains("none.tif"));
        let scene = folder.path().join("own.TOML");
        fs::write(&scene, corpuscle::scene::builtin("flood/valley").unwrap().text).unwrap();
        let Ok(Start::Scene(source)) = open(&scene) else { panic!("no scene") };
        assert!(source.scene().is_ok() && source.folder == folder.path());
    }
}
