//! Inputs to begin with.

use crate::Target;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of valid inputs, one below it for each target.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")
}

/// The folder of inputs that made a reader fail, one below it for each target.
pub fn found_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("found")
}

/// The valid inputs of a target, by name: its files, and what it makes itself.
pub fn of(target: &Target) -> Vec<(String, Vec<u8>)> {
    let mut inputs = files(&folder().join(target.corpus));
    inputs.extend((target.more)().into_iter().enumerate().map(|(number, bytes)| (format!("made {number}"), bytes)));
    inputs
}

/// Inputs that made this target fail once.
pub fn found(target: &Target) -> Vec<(String, Vec<u8>)> {
    files(&found_folder().join(target.name))
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.flatten().map(|entry| entry.path());
    let mut files: Vec<_> = paths
        .filter_map(|path| Some((path.file_name()?.to_string_lossy().into_owned(), fs::read(&path).ok()?)))
        .collect();
    files.sort();
    files
}
