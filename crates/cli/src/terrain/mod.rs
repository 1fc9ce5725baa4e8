//! `corpuscle terrain`.

mod clip;
mod fetch;
mod info;

pub use fetch::fetch_for;

use crate::args::TerrainCommand;
use crate::refusal::refuse;
use corpuscle::terrain::{Raster, write_raster};
use std::path::Path;
use std::process::ExitCode;

/// The value of cells without data in files that are written.
const NO_DATA: f32 = -9999.0;

/// Runs one of the commands.
pub fn terrain(command: &TerrainCommand, as_json: bool) -> anyhow::Result<ExitCode> {
    match command {
        TerrainCommand::Fetch(options) => fetch::fetch(options, as_json)?,
        TerrainCommand::Info(options) => info::info(options, as_json)?,
        TerrainCommand::Clip(options) => clip::clip(options, as_json)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses a file that exists, before any other work.
fn check_is_new(path: &Path) -> anyhow::Result<()> {
    if path.exists() {
        return Err(refuse(format!("{} exists and is not overwritten; name another file with -o", path.display())));
    }
    Ok(())
}

/// Writes a raster and prints its warnings.
fn write(path: &Path, raster: &Raster) -> anyhow::Result<()> {
    write_raster(path, raster, NO_DATA).map_err(corpuscle::Error::from)?;
    for warning in &raster.warnings {
        tell!("note: {warning}");
    }
    tell!("wrote {}: {} x {} cells", path.display(), raster.columns, raster.rows);
    Ok(())
}
