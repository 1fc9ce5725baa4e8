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
        let mut whole = Scene::parse(&self.text, &self.name, &[])?;
        // As `--set` on the command line: defaults that depend on a changed value follow it.
        if let Ok(changed) = Scene::parse(&self.text, &self.name, &self.changes) {
            return Ok(changed);
        }
        // A part of a default, such as one number of a list, has a path only where defaults are written out.
        whole.resolve_defaults();
        Scene::parse(&whole.to_toml()?, &self.name, &self.changes)
    }
}

impl From<Builtin> for Source {
    fn from(scene: Builtin) -> Self {
        Self { name: scene.name.into(), text: scene.text.into(), folder: PathBuf::from("."), changes: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle::scene::builtin;

    fn changed(path: &str, value: &str) -> Scene {
        let changes = vec![(path.into(), value.into())];
        let mut scene = Source { changes, ..builtin("gas/effusion").unwrap().into() }.scene().unwrap();
        scene.resolve_defaults();
        scene
    }

    #[test]
    fn defaults_follow_changes() {
        let scene = changed("run.until_s", "3");
        assert_eq!(scene.run.gauge_every_s, Some(3.0 / 200.0));
        assert_eq!(scene.gas().unwrap().measure.from_s, Some(0.1 * 3.0));
        // One number of a default.
        assert_eq!(changed("gas.gravity.1", "-2.0").gas().unwrap().gravity, Some(vec![0.0, -2.0]));
    }
}
