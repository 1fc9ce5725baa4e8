//! The scenes that come with the program.

use crate::kinds;

/// A scene that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// Name: the model and a word, `flood/valley`.
    pub name: &'static str,
    /// The scene file, with comments.
    pub text: &'static str,
}

macro_rules! builtin_scenes {
    ($($name:literal),* $(,)?) => {
        &[$(Builtin { name: $name, text: include_str!(concat!("../scenes/", $name, ".toml")) }),*]
    };
}

/// Those of floods.
pub(crate) const FLOOD: &[Builtin] = builtin_scenes![
    "flood/valley",
    "flood/rough-terrain",
    "flood/cuboid",
    "flood/cylinder",
    "flood/cloudburst",
    "flood/dam-break",
    "flood/lake-at-rest",
    "flood/city",
    "flood/iowa-river",
    "flood/chishui",
];

/// Those of gases.
pub(crate) const GAS: &[Builtin] = builtin_scenes![
    "gas/maxwell",
    "gas/paper-2000",
    "gas/piston",
    "gas/mixing",
    "gas/brownian",
    "gas/free-expansion",
    "gas/granular",
    "gas/effusion",
    "gas/atmosphere",
    "gas/argon",
    "gas/million",
];

/// Those of dew.
pub(crate) const DEW: &[Builtin] =
    builtin_scenes!["dew/pane", "dew/lens", "dew/windscreen", "dew/breath", "dew/glassware", "dew/three-boundaries",];

/// All of them, by model.
pub fn scenes() -> impl Iterator<Item = Builtin> {
    kinds().into_iter().flat_map(|kind| kind.scenes).copied()
}

/// The scene called `name`.
pub fn builtin(name: &str) -> Option<Builtin> {
    scenes().find(|scene| scene.name == name)
}
