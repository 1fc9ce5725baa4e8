//! The source of the window: a scene as written, or a finished run.

use corpuscle::scene::{Builtin, Scene, SceneError};
use std::path::PathBuf;

/// What the window opens first.
#[derive(Debug, Clone)]
pub enum Start {
    /// The first page.
    Welcome,
    /// A scene.
    Scene(Source),
    /// The folder of a finished run.
    Run(PathBuf),
}

/// A scene as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// Its name: `gas/maxwell`, or its file.
    pub name: String,
    /// Its text.
    pub text: String,
    /// The folder that its relative paths start from.
    pub folder: PathBuf,
    /// Its changes: paths of values, and the values.
    pub changes: Vec<(String, String)>,
}

impl Source {
    /// The scene with its changes.
    ///
    /// # Errors
    /// Where the text or a change is refused.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let written = Scene::parse(&self.text, &self.name, &[])?;
        if self.changes.is_empty() {
            return Ok(written);
        }
        // Defaults are written out, so that every value can be set by its path.
        let mut whole = written;
        whole.resolve_defaults();
        Scene::parse(&whole.to_toml()?, &self.name, &self.changes)
    }
}

impl From<Builtin> for Source {
    fn from(scene: Builtin) -> Self {
        Self { name: scene.name.into(), text: scene.text.into(), folder: PathBuf::from("."), changes: Vec::new() }
    }
}
