//! A scene as its file writes it: the tables of one model, side by side with what all scenes have.

use crate::{Dew, Flood, FloodScene, Gas, ModelScene, Problem, Run, Scene, Terrain};
use serde::{Deserialize, Serialize};

/// The keys of a scene file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Written {
    #[serde(default)]
    title: String,
    #[serde(default)]
    description: String,
    #[serde(default = "default_seed")]
    seed: u64,
    run: Run,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    terrain: Option<Terrain>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    flood: Option<Flood>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gas: Option<Gas>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dew: Option<Dew>,
}

fn default_seed() -> u64 {
    1
}

impl Written {
    /// The scene, where the tables are those of one model.
    pub(crate) fn into_scene(self) -> Result<Scene, Box<Problem>> {
        let Self { title, description, seed, run, terrain, flood, gas, dew } = self;
        let other = if gas.is_some() { "gas" } else { "dew" };
        let model = match (terrain, flood, gas, dew) {
            (Some(terrain), Some(flood), None, None) => ModelScene::Flood(Box::new(FloodScene { terrain, flood })),
            (None, None, Some(gas), None) => ModelScene::Gas(Box::new(gas)),
            (None, None, None, Some(dew)) => ModelScene::Dew(Box::new(dew)),
            (None, Some(_), None, None) => return Err(missing("terrain", GROUND)),
            (Some(_), None, None, None) => return Err(missing("flood", WATER)),
            (None, None, None, None) => return Err(Problem::new("", NO_MODEL)),
            (_, _, Some(_), Some(_)) => return Err(Problem::new("dew", two_models("dew", "gas"))),
            (Some(_), _, _, _) => return Err(Problem::new("terrain", no_ground(other))),
            (None, Some(_), _, _) => return Err(Problem::new("flood", two_models("flood", other))),
        };
        Ok(Scene { title, description, seed, run, model })
    }
}

const GROUND: &str = "give the ground, as in [terrain.file] with path = \"dem.tif\", or one of [terrain.tiles], \
                      [terrain.fetch], [terrain.valley], [terrain.rough-hills], [terrain.plane], [terrain.bump], [terrain.bowl]";
const WATER: &str = "give a table [flood] with spacing_m and the water of the scene";
const NO_MODEL: &str =
    "the scene has no model: give a table [flood] and the ground, [terrain], or a table [gas], or a table [dew]";

fn no_ground(model: &str) -> String {
    format!(": only a flood has ground; take out [terrain], or [{model}]")
}

fn two_models(one: &str, other: &str) -> String {
    format!(": a scene has one model; take out [{one}], or [{other}]")
}

fn missing(key: &str, give: &str) -> Box<Problem> {
    Problem::new(key, format!(" is missing: {give}"))
}

impl From<Scene> for Written {
    fn from(Scene { title, description, seed, run, model }: Scene) -> Self {
        let (terrain, flood, gas, dew) = match model {
            ModelScene::Flood(scene) => (Some(scene.terrain), Some(scene.flood), None, None),
            ModelScene::Gas(gas) => (None, None, Some(*gas), None),
            ModelScene::Dew(dew) => (None, None, None, Some(*dew)),
        };
        Self { title, description, seed, run, terrain, flood, gas, dew }
    }
}
