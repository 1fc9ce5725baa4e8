//! The scene argument of a command: a built-in scene or a file.

use crate::refusal::refuse;
use crate::suggestion::suggest_scene;
use corpuscle::scene::{Scene, builtin, scenes};
use std::path::{Path, PathBuf};

/// The scene that the command line names.
pub struct Named {
    /// The scene.
    pub scene: Scene,
    /// The folder that its relative paths start from.
    pub folder: PathBuf,
    /// Its short name, for the run's folder: `valley`.
    pub short_name: String,
}

/// The scene that runs when none is named.
const DEFAULT: &str = "flood/valley";

/// Endings of terrain files; `.gz` may follow.
const TERRAIN_ENDINGS: [&str; 4] = ["tif", "tiff", "asc", "agr"];

/// Finds and reads the scene called `name`: a built-in one, or a file.
pub fn read(name: Option<&str>, overrides: &[(String, String)]) -> anyhow::Result<Named> {
    let name = name.unwrap_or(DEFAULT);
    if let Some(found) = builtin(name) {
        let scene = Scene::parse(found.text, name, overrides).map_err(corpuscle::Error::from)?;
        let short_name = name.rsplit('/').next().unwrap_or(name).to_owned();
        return Ok(Named { scene, folder: PathBuf::from("."), short_name });
    }
    let path = Path::new(name);
    if is_terrain(path) && path.exists() {
        return Err(refuse(suggest_scene(path)?));
    }
    if path.is_dir() {
        return Err(refuse(format!("{name} is a folder; name a scene file in it, as in {name}/scene.toml")));
    }
    if !path.exists() {
        return Err(refuse(not_found(name)));
    }
    let scene = Scene::read(path, overrides).map_err(corpuscle::Error::from)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let short_name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Named { scene, folder, short_name })
}

fn is_terrain(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    TERRAIN_ENDINGS.iter().any(|ending| name.ends_with(&format!(".{ending}")))
}

/// The error message for a name that is neither a built-in scene nor a file.
pub fn not_found(name: &str) -> String {
    let nearest = scenes()
        .map(|scene| (strsim::jaro_winkler(name, scene.name), scene.name))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let names: Vec<_> = scenes().map(|scene| scene.name).collect();
    let meant = nearest.map(|(_, name)| format!("; did you mean {name}?")).unwrap_or_default();
    format!("there is no file and no built-in scene `{name}`{meant} (built in: {})", names.join(", "))
}
