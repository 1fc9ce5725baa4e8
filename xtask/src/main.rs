//! Tasks of the project: `cargo xtask site` makes the site.

mod site;

use clap::Parser;
use std::path::PathBuf;

/// Tasks of the project.
#[derive(Parser)]
enum Task {
    /// Makes the site: start page, guide, and the window as a page. Any static host serves it.
    Site {
        /// The folder that it is written to; what was there before is replaced.
        #[arg(short, long, default_value = "target/site")]
        out: PathBuf,
    },
}

fn main() -> anyhow::Result<()> {
    match Task::parse() {
        Task::Site { out } => site::make(&out),
    }
}
