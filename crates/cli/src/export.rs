//! `corpuscle export`.

use crate::args::ExportOptions;
use crate::output::print_json;
use crate::refusal::refuse;
use corpuscle_export::{Format, export as export_file};
use serde_json::json;
use std::path::Path;
use std::process::ExitCode;

/// Writes results of a run in other formats.
pub fn export(options: &ExportOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    // Before any work: what is refused writes nothing.
    options.files.iter().try_for_each(|file| check(file))?;
    let mut written = Vec::new();
    for file in &options.files {
        let format = export_file(&options.run, file)?;
        let bytes = std::fs::metadata(file)?.len();
        tell!("wrote {}: {format}, {:.1} MB", file.display(), bytes as f64 / 1e6);
        written.push(json!({ "file": file, "format": format.ending(), "bytes": bytes }));
    }
    if as_json {
        print_json(&written)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses a file whose ending says no format, or that exists.
fn check(file: &Path) -> anyhow::Result<()> {
    Format::of(file)?;
    if file.exists() {
        return Err(refuse(format!("{} exists and is not overwritten; name another file", file.display())));
    }
    Ok(())
}
