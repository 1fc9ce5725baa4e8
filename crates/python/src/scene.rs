//! Scenes.

use crate::error::exception;
use corpuscle::Error;
use pyo3::prelude::*;
use std::path::PathBuf;

/// A checked scene, and the folder that its relative paths start from.
#[pyclass(frozen)]
pub struct Scene {
    pub(crate) scene: corpuscle::scene::Scene,
    pub(crate) folder: PathBuf,
}

#[pymethods]
impl Scene {
    /// Reads a scene from TOML text, called `name` in messages, with changes `(key, value as written in TOML)`.
    #[new]
    fn new(py: Python<'_>, text: &str, name: &str, folder: PathBuf, changes: Vec<(String, String)>) -> PyResult<Self> {
        let read = corpuscle::scene::Scene::parse(text, name, &changes);
        let scene = read.map_err(|error| exception(py, &Error::from(error)))?;
        Ok(Self { scene, folder })
    }

    /// The model: `gas`, `dew` or `flood`.
    #[getter]
    fn model(&self) -> &str {
        self.scene.model.name()
    }

    /// The title.
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// The end of the run, s.
    #[getter]
    fn until(&self) -> f64 {
        self.scene.run.until_s
    }

    /// The whole scene as TOML, with all defaults that do not depend on terrain; paths are absolute.
    #[getter]
    fn toml(&self, py: Python<'_>) -> PyResult<String> {
        let mut scene = self.scene.clone();
        scene.resolve_paths(&self.folder);
        scene.resolve_defaults();
        scene.to_toml().map_err(|error| exception(py, &Error::from(error)))
    }
}
