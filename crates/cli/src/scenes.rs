//! `corpuscle scenes`.

use crate::args::ScenesOptions;
use crate::output::{print, print_json};
use crate::refusal::refuse;
use crate::scene_argument::not_found;
use anyhow::Context;
use corpuscle::scene::{self, Builtin, Scene, builtin};
use serde_json::json;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

/// Lists the built-in scenes, or shows or copies one.
pub fn scenes(options: &ScenesOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let Some(name) = &options.name else { return list(as_json) };
    let scene = builtin(name).ok_or_else(|| refuse(not_found(name)))?;
    match &options.copy {
        Some(file) => copy(scene, file, as_json)?,
        None if as_json => print_json(&json!({ "name": name, "text": scene.text }))?,
        None => print(scene.text)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn list(as_json: bool) -> anyhow::Result<ExitCode> {
    let mut rows = Vec::new();
    for scene in scene::scenes() {
        let read = Scene::parse(scene.text, scene.name, &[]).map_err(corpuscle::Error::from)?;
        rows.push((scene.name, read.title, read.description));
    }
    if as_json {
        let rows: Vec<_> = rows
            .iter()
            .map(|(name, title, description)| json!({ "name": name, "title": title, "description": description }))
            .collect();
        print_json(&rows)?;
    } else {
        let lines: Vec<_> = rows.iter().map(|(name, title, _)| format!("{name:22} {title}\n")).collect();
        print(&lines.concat())?;
    }
    Ok(ExitCode::SUCCESS)
}

fn copy(scene: Builtin, file: &Path, as_json: bool) -> anyhow::Result<()> {
    let mut out = File::create_new(file).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            refuse(format!("{} exists already and is not overwritten; name another file", file.display()))
        }
        _ => anyhow::Error::new(error).context(format!("cannot write {}", file.display())),
    })?;
    out.write_all(scene.text.as_bytes()).with_context(|| format!("cannot write {}", file.display()))?;
    tell!("{} copied to {}; run it with `corpuscle run {}`", scene.name, file.display(), file.display());
    if as_json { print_json(&json!({ "name": scene.name, "file": file })) } else { Ok(()) }
}
