//! The scenes that come with the program.

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

/// All of them; the first is what runs when no scene is named.
pub const BUILTIN: &[Builtin] = builtin_scenes![
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
    "dew/pane",
    "dew/lens",
    "dew/windscreen",
    "dew/glassware",
    "dew/three-boundaries",
];

/// The built-in scene called `name`.
pub fn builtin(name: &str) -> Option<Builtin> {
    BUILTIN.iter().copied().find(|scene| scene.name == name)
}
