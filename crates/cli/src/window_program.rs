//! `corpuscle view`: starts the window program.
//!
//! The window's libraries are a third of the whole build, so they are left out of the program that runs scenes.

use crate::args::ViewOptions;
use crate::refusal::refuse;
use anyhow::{Context, bail};
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Name of the package of the window program, and of its file without the ending.
const NAME: &str = "corpuscle-window";

/// Starts the window program on the arguments of this process and waits until it ends.
///
/// It lies in the folder of this program. Under `cargo run` it is built first.
///
/// # Errors
///
/// The program is missing, cannot be built or cannot be started.
pub fn start_window_program(_: &ViewOptions) -> anyhow::Result<ExitCode> {
    let own = env::current_exe().context("cannot find the path of this program")?;
    let window = own.with_file_name(format!("{NAME}{}", env::consts::EXE_SUFFIX));
    match cargo() {
        Some(cargo) => build(&cargo, &own)?,
        None if window.exists() => {}
        None => {
            return Err(refuse(format!(
                "the window is a program of its own, {NAME}, and {} does not exist: \
                 `cargo install --locked --path crates/window` installs it",
                window.display()
            )));
        }
    }
    let status = Command::new(&window).args(env::args_os().skip(1)).status();
    let status = status.with_context(|| format!("cannot start {}", window.display()))?;
    // Ended by a signal, it has no code.
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

/// The cargo that runs this program, if one does.
fn cargo() -> Option<PathBuf> {
    env::var_os("CARGO_MANIFEST_DIR")?;
    env::var_os("CARGO").map(PathBuf::from)
}

/// Builds the window program into the folder of this one, with the same profile.
fn build(cargo: &Path, own: &Path) -> anyhow::Result<()> {
    let folder = own.parent().and_then(Path::file_name).unwrap_or_default();
    let profile = if folder == "debug" { "dev".as_ref() } else { folder };
    let status = Command::new(cargo).args(["build", "--quiet", "--package", NAME, "--profile"]).arg(profile).status();
    if !status.with_context(|| format!("cannot start {}", cargo.display()))?.success() {
        bail!("{NAME} was not built");
    }
    Ok(())
}
