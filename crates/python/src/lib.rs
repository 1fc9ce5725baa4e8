//! The native part of the Python package `corpuscle`: scenes, simulations and the command line. The classes that a user sees are in
//! `python/corpuscle`, which dresses arrays as tables and maps.

#![warn(missing_docs)]

mod arrays;
mod error;
mod raster;
mod scene;
mod simulation;
mod watch;

use pyo3::prelude::*;
use std::ffi::OsString;
use std::process::ExitCode;

/// Scenes, simulations and the command line, in arrays and plain values.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{builtin_scenes, raster::write_raster, run_command_line, scene::Scene, simulation::Simulation};
}

/// Names and texts of the built-in scenes.
#[pyfunction]
fn builtin_scenes() -> Vec<(&'static str, &'static str)> {
    corpuscle::scene::scenes().map(|scene| (scene.name, scene.text)).collect()
}

/// Runs the command line on arguments, the first of which is the program's name; returns the exit status.
#[pyfunction]
fn run_command_line(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    let status = py.detach(|| corpuscle_cli::run_command_line_on(arguments, corpuscle_cli::start_window_program));
    (0..=u8::MAX).find(|code| ExitCode::from(*code) == status).unwrap_or(1)
}
