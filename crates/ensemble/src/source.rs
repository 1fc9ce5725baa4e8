//! The scene of an ensemble as it was given: its text, and the changes that all members have.

use crate::EnsembleError;
use corpuscle::scene::{Scene, builtin};
use corpuscle::{Error, Simulation};
use std::fs;
use std::path::{Path, PathBuf};

/// A scene as text, with changes.
#[derive(Debug, Clone)]
pub struct Source {
    /// Name of the built-in scene, or path of the file.
    pub name: String,
    text: String,
    /// The folder that relative paths in the scene start from.
    pub folder: PathBuf,
    /// Changes that all members have: keys, and values as written in TOML.
    set: Vec<(String, String)>,
}

impl Source {
    /// Finds a built-in scene, or reads a file.
    ///
    /// # Errors
    /// [`EnsembleError::File`] for a file that cannot be read, [`EnsembleError::Scene`] where the scene is not as it must be.
    pub fn find(name: &str, set: Vec<(String, String)>) -> Result<Self, EnsembleError> {
        let source = match builtin(name) {
            Some(found) => Self { name: name.into(), text: found.text.into(), folder: PathBuf::from("."), set },
            None => {
                let path = Path::new(name);
                let text = fs::read_to_string(path).map_err(EnsembleError::file(path))?;
                let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                Self { name: name.into(), text, folder, set }
            }
        };
        source.scene(&[])?;
        Ok(source)
    }

    /// The scene with more changes.
    ///
    /// # Errors
    /// Where a key or a value is not as it must be.
    pub fn scene(&self, changes: &[(String, String)]) -> Result<Scene, Error> {
        Ok(Scene::parse(&self.text, &self.name, &[self.set.as_slice(), changes].concat())?)
    }

    /// The simulation of the scene with more changes.
    pub(crate) fn open(&self, changes: &[(String, String)]) -> Result<Simulation, Error> {
        Simulation::open(self.scene(changes)?, &self.folder)
    }

    /// The simulation of a scene whose water is not arranged: its terrain is that of a run.
    pub(crate) fn open_to_read(&self, changes: &[(String, String)]) -> Result<Simulation, Error> {
        Simulation::open_to_restore(self.scene(changes)?, &self.folder)
    }

    /// The whole scene as TOML, with its defaults; paths are absolute.
    pub(crate) fn toml(&self) -> Result<String, Error> {
        let mut scene = self.scene(&[])?;
        let folder = std::path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone());
        scene.resolve_paths(&folder);
        scene.resolve_defaults();
        Ok(scene.to_toml()?)
    }
}
