//! `corpuscle`: run, check and validate scenes from the command line.
//!
//! Exit status: 0 done, 1 the run was interrupted, a run or a validation failed, 2 the input was refused.

mod args;
mod bench;
mod check;
mod interrupt;
mod look;
mod output;
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
#[cfg(feature = "window")]
mod view;

use anyhow::Context;
use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match dispatch(&arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {}", refusal::in_words(&error));
            if refusal::is_refusal(&error) { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

fn dispatch(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("cannot start the threads")?;
    }
    match &arguments.command {
        Command::Run(options) => run::run(options, arguments.json),
        Command::Render(options) => render::render(options, arguments.json),
        #[cfg(feature = "window")]
        Command::View(options) => view::view(options),
        Command::Scenes(options) => scenes::scenes(options, arguments.json),
        Command::Check(options) => check::check(options, arguments.json),
        Command::Validate(options) => validate::validate(options, arguments.json),
        Command::Bench(options) => bench::bench(options, arguments.json),
        Command::Terrain(command) => terrain::terrain(command, arguments.json),
    }
}
