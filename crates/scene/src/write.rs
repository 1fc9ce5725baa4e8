//! From a scene to text.

use crate::{Scene, SceneError};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

impl Scene {
    /// The scene as TOML with everything written out; reading it again gives an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Unwritable`] where a path is not Unicode or the seed is beyond TOML's integers.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        toml::to_string(self).map_err(|error| SceneError::Unwritable(error.to_string()))
    }
}

impl Serialize for Scene {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("title", &self.title)?;
        map.serialize_entry("description", &self.description)?;
        map.serialize_entry("seed", &self.seed)?;
        map.serialize_entry("run", &self.run)?;
        for (name, table) in self.model.written() {
            map.serialize_entry(name, table)?;
        }
        map.end()
    }
}
