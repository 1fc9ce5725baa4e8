//! Scenes in messages: as the text of a scene file.

use corpuscle::scene::Scene;
use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serializer};

pub(super) fn serialize<S: Serializer>(scene: &Scene, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&scene.to_toml().map_err(S::Error::custom)?)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Box<Scene>, D::Error> {
    let text = String::deserialize(deserializer)?;
    Scene::parse(&text, "scene", &[]).map(Box::new).map_err(D::Error::custom)
}
