//! `corpuscle view`: opens the window on what the command line names.

use anyhow::Context;
use corpuscle::scene::builtin;
use corpuscle_app::{Measurement, Source, Start, physics, view as open_window};
use corpuscle_cli::{Backend, ViewOptions, read_scene, refuse};
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// Opens the window and, where it measures, prints what it measured.
///
/// # Errors
/// Where the scene cannot be opened, or the window.
pub fn view(options: &ViewOptions) -> anyhow::Result<ExitCode> {
    let start = match &options.what {
        None => Start::Welcome,
        Some(name) => start(name, &options.set)?,
    };
    let measured = open_window(start, backend(options.backend), options.measure)?;
    if let Some(Measurement { pictures_per_s, slowest_s, particles, pace }) = measured {
        println!(
            "{pictures_per_s:.1} pictures/s, the slowest took {slowest_s:.3} s; {particles} particles, \
             {pace:.4} simulated seconds in a second"
        );
    }
    Ok(ExitCode::SUCCESS)
}

fn backend(of: Backend) -> physics::Backend {
    match of {
        Backend::Auto => physics::Backend::Auto,
        Backend::Cpu => physics::Backend::Cpu,
        Backend::Gpu => physics::Backend::Gpu,
    }
}

/// What the window begins with.
fn start(name: &str, set: &[(String, String)]) -> anyhow::Result<Start> {
    let path = Path::new(name);
    if builtin(name).is_none() && path.is_dir() {
        if !path.join("scene.toml").exists() {
            return Err(refuse(format!("{name} is a folder without a scene.toml: it holds no run")));
        }
        if !set.is_empty() {
            return Err(refuse(format!("{name} is a finished run: --set would change nothing; open its scene.toml")));
        }
        return Ok(Start::Run(path.to_owned()));
    }
    // Refuses what cannot be opened before there is a window.
    let named = read_scene(Some(name), set)?;
    let text = match builtin(name) {
        Some(scene) => scene.text.to_owned(),
        None => fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?,
    };
    Ok(Start::Scene(Source { name: name.to_owned(), text, folder: named.folder, changes: set.to_vec() }))
}
