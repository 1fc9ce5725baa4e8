//! The targets, one for each reader.

mod checkpoint;
mod frame;
mod http;
mod mesh;
mod polygon;
mod raster;
mod scene;
mod table;
mod written;

use crate::Target;
use crate::drive::scratch;
use std::cell::OnceCell;
use std::path::{Path, PathBuf};

/// All targets.
pub fn targets() -> Vec<Target> {
    [
        scene::TARGETS,
        raster::TARGETS,
        polygon::TARGETS,
        table::TARGETS,
        mesh::TARGETS,
        frame::TARGETS,
        checkpoint::TARGETS,
        http::TARGETS,
    ]
    .concat()
}

/// No inputs beside the files.
fn none() -> Vec<Vec<u8>> {
    Vec::new()
}

thread_local! {
    static FOLDER: OnceCell<tempfile::TempDir> = const { OnceCell::new() };
}

/// The path of a file in this thread's own folder.
fn path_of(name: &str) -> PathBuf {
    FOLDER.with(|folder| folder.get_or_init(|| scratch().expect("a folder for temporary files")).path().join(name))
}

/// Has a file with these bytes read. Its name may have a folder.
fn on_file<T>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    let path = path_of(name);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).expect("a temporary folder can be made");
    }
    std::fs::write(&path, bytes).expect("a temporary file can be written");
    read(&path)
}
