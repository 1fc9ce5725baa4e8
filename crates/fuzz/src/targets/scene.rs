//! Scene files and expressions.

use super::none;
use crate::Target;
use corpuscle_scene::{Expression, Scene, SceneLink, builtin, scenes};

pub(super) const TARGETS: &[Target] = &[
    Target { name: "scene", about: "scene files", corpus: "scene", read: scene, more: all_builtin },
    Target { name: "link", about: "links of the window in a browser", corpus: "link", read: link, more: none },
    Target {
        name: "expression",
        about: "expressions of the position in scene files",
        corpus: "expression",
        read: expression,
        more: none,
    },
];

fn all_builtin() -> Vec<Vec<u8>> {
    scenes().map(|scene| scene.text.as_bytes().to_vec()).collect()
}

/// A scene that is read is the same after it was written and read again.
fn scene(bytes: &[u8]) -> Result<String, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
    let scene = Scene::parse(text, "scene.toml", &[]).map_err(|error| error.to_string())?;
    let written = scene.to_toml().map_err(|error| error.to_string())?;
    let again = Scene::parse(&written, "written.toml", &[]);
    assert!(
        again.as_ref().is_ok_and(|again| again.to_toml().is_ok_and(|twice| twice == written)),
        "a scene is another one when written and read again"
    );
    Ok("a scene".into())
}

/// A link that is read is the same after it was written and read again; its changes make a scene, or are refused.
fn link(bytes: &[u8]) -> Result<String, String> {
    let text = String::from_utf8_lossy(bytes);
    let Some(link) = SceneLink::read(&text)? else { return Ok("no scene".into()) };
    let written = SceneLink::write(&link.name, &link.changes);
    let again = written.as_deref().map(SceneLink::read);
    assert!(
        matches!(&again, Some(Ok(Some(again))) if *again == link),
        "a link is another one when written and read again"
    );
    let scene = builtin(&link.name).ok_or("a link to no scene")?;
    Scene::parse(scene.text, &link.name, &link.changes).map(|_| "a scene".into()).map_err(|error| error.to_string())
}

fn expression(bytes: &[u8]) -> Result<String, String> {
    let text = String::from_utf8_lossy(bytes);
    let expression = Expression::parse(&text).map_err(|error| error.to_string())?;
    let value = expression.at(1.5, -2.5);
    Ok(if value.is_finite() { "a number" } else { "none" }.into())
}
