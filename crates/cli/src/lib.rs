//! The command line of `corpuscle`: runs, checks, draws and validates scenes.
//!
//! Exit status: 0 done, 1 the run was interrupted, a run or a validation failed, 2 the input was refused.

#![deny(clippy::print_stderr, clippy::print_stdout)]

/// Writes a line to standard error. Where that cannot be written, as to a full disk, nobody can be told, and the work goes on.
macro_rules! tell {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($text)*);
    }};
}

mod args;
mod bench;
mod check;
mod ensemble;
mod export;
mod interrupt;
mod output;
mod picture_options;
mod processes;
mod progress;
mod refusal;
mod render;
mod run;
mod scene_argument;
mod scenes;
mod select;
mod suggestion;
mod terrain;
mod validate;
mod window_program;

pub use args::{Backend, ViewOptions};
pub use refusal::refuse;
pub use scene_argument::{Named, read as read_scene};
pub use window_program::start_window_program;

use anyhow::Context;
use args::{Arguments, Command};
use clap::Parser;
use std::ffi::OsString;
use std::process::ExitCode;

/// Parses the arguments of the process, runs their command and returns the exit status; `view` opens the window.
///
/// An error is written to standard error, in one line.
pub fn run_command_line(view: fn(&ViewOptions) -> anyhow::Result<ExitCode>) -> ExitCode {
    run_arguments(&Arguments::parse(), view)
}

/// As [`run_command_line`], for arguments that are not those of the process; the first is the program's name. Where they cannot be parsed
/// the process ends, as there.
pub fn run_command_line_on(
    arguments: impl IntoIterator<Item = OsString>,
    view: fn(&ViewOptions) -> anyhow::Result<ExitCode>,
) -> ExitCode {
    run_arguments(&Arguments::parse_from(arguments), view)
}

fn run_arguments(arguments: &Arguments, view: fn(&ViewOptions) -> anyhow::Result<ExitCode>) -> ExitCode {
    match dispatch(arguments, view) {
        Ok(code) => code,
        Err(error) => {
            tell!("error: {}", refusal::in_words(&error));
            if refusal::is_refusal(&error) { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

fn dispatch(arguments: &Arguments, view: fn(&ViewOptions) -> anyhow::Result<ExitCode>) -> anyhow::Result<ExitCode> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("cannot start the threads")?;
    }
    match &arguments.command {
        Command::Run(options) => run::run(options, arguments.json),
        Command::Render(options) => render::render(options, arguments.json),
        Command::Export(options) => export::export(options, arguments.json),
        Command::View(options) => view(options),
        Command::Scenes(options) => scenes::scenes(options, arguments.json),
        Command::Check(options) => check::check(options, arguments.json),
        Command::Validate(options) => validate::validate(options, arguments.json),
        Command::Bench(options) => bench::bench(options, arguments.json),
        Command::Ensemble(options) => ensemble::ensemble(options, arguments),
        Command::Terrain(command) => terrain::terrain(command, arguments.json),
    }
}
