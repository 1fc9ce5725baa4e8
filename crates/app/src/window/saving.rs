//! Saving of stills, films and scenes.

use super::Window;
use crate::Source;
use crate::files;
use crate::physics::Command;
use std::path::PathBuf;

impl Window {
    /// Shows where a file was written, or the error.
    pub(super) fn wrote(&mut self, done: Result<PathBuf, String>) {
        match done {
            Ok(path) => self.notify(format!("Saved as {}", path.display())),
            Err(error) => self.fault = Some(format!("It could not be saved: {error}")),
        }
    }

    pub(super) fn save_scene(&mut self) {
        let Some(open) = &self.open else { return };
        let mut changes = open.parameters.changes().to_vec();
        let planned = open.scene.gas().and_then(|gas| gas.partition.as_ref()?.lifted_at_s);
        if let Some(time) = open.picture.view_state().lifted {
            let time = planned.map_or(time, |planned| planned.min(time));
            changes.push(("gas.partition.lifted_at_s".into(), format!("{time:?}")));
        }
        let changed = Source { changes, ..open.source.clone() }.scene();
        let text = changed.map_err(|error| error.to_string()).and_then(|mut scene| {
            scene.resolve_paths(&open.source.folder);
            scene.to_toml().map_err(|error| error.to_string())
        });
        let name = format!("{}-changed", open.source.name.trim_end_matches(".toml"));
        let done =
            text.and_then(|text| files::text(&self.folder, &name, "toml", &text).map_err(|error| error.to_string()));
        self.wrote(done);
    }

    /// Starts a film, or ends it.
    pub(super) fn film(&mut self) {
        let Some(open) = &mut self.open else { return };
        open.filming = !open.filming;
        self.physics.send(if open.filming {
            let path = files::free(&self.folder, &open.source.name, "mp4");
            self.physics.see(open.picture.view_state());
            Command::Film(path)
        } else {
            Command::EndFilm
        });
    }

    /// Handles the end of a film.
    pub(super) fn filmed(&mut self, film: Result<PathBuf, String>) {
        if let Some(open) = &mut self.open {
            open.filming = false;
        }
        self.wrote(film);
    }

    pub(super) fn save_still(&mut self) {
        let Some(open) = &self.open else { return };
        let Some(snapshot) = open.snapshot.clone() else { return };
        if open.picture.is_sketch() {
            self.fault = Some(
                "Stills are drawn by a graphics device, which there is not here: take a picture of the screen".into(),
            );
            return;
        }
        self.offscreen.still(open.picture.job(&snapshot), self.folder.clone(), open.source.name.clone());
        self.notify("The still is being drawn".into());
    }
}
