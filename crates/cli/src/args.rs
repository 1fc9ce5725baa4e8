//! The command line's words.

use clap::{Args, Parser, Subcommand, ValueEnum};
use corpuscle::record::FrameFormat;
use std::path::PathBuf;

/// Particle physics from a scene file: flood valleys, look at the result in QGIS and ParaView.
#[derive(Debug, Parser)]
#[command(name = "corpuscle", version, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Write the result as JSON to standard output
    #[arg(long, global = true)]
    pub json: bool,
    /// Number of threads; results are the same for any [default: one for each core]
    #[arg(long, global = true, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
}

fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("must be a whole number from 1 to 1024".into()),
    }
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene into a new folder
    Run(RunOptions),
    /// List the built-in scenes, show one, or copy one to edit
    Scenes(ScenesOptions),
    /// Say what would be run: sizes, memory, time step, warnings
    Check(CheckOptions),
    /// Run cases with known answers
    Validate(ValidateOptions),
    /// Measure rates on this machine
    Bench(BenchOptions),
}

#[derive(Debug, Args)]
pub struct SceneOptions {
    /// A built-in scene (`corpuscle scenes` lists them) or a TOML file [default: flood/valley]
    #[arg(value_name = "SCENE")]
    pub scene: Option<String>,
    /// Change a value of the scene, as in `--set flood.scheme=paper`; rows of lists are counted from 0
    #[arg(long, value_name = "PATH=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
    /// End of the run, s: short for `--set run.until_s=T`
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub until: Option<String>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.trim().is_empty() => Ok((path.trim().to_owned(), value.trim().to_owned())),
        _ => Err("must be PATH=VALUE, as in run.until_s=60".into()),
    }
}

impl SceneOptions {
    /// What is to be changed in the scene.
    pub fn overrides(&self) -> Vec<(String, String)> {
        let until = self.until.iter().map(|until| ("run.until_s".to_owned(), until.clone()));
        self.set.iter().cloned().chain(until).collect()
    }
}

#[derive(Debug, Args)]
pub struct RunOptions {
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Folder to write, new or empty [default: the next free one in runs/]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
    /// How particles are written [default: vtp]
    #[arg(long, value_enum)]
    pub frames: Option<Frames>,
    /// Go on with an interrupted run in its folder
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "set", "until", "output", "frames"])]
    pub resume: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// A GPU if there is one, else the CPU
    Auto,
    /// The CPU, all cores
    Cpu,
    /// A GPU
    Gpu,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Frames {
    /// VTK files and a collection, for ParaView
    Vtp,
    /// Tables, one row for each particle
    Csv,
    /// No particle files
    None,
}

impl From<Frames> for FrameFormat {
    fn from(frames: Frames) -> Self {
        match frames {
            Frames::Vtp => Self::Vtp,
            Frames::Csv => Self::Csv,
            Frames::None => Self::None,
        }
    }
}

#[derive(Debug, Args)]
pub struct ScenesOptions {
    /// The built-in scene to show or copy
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Copy it to this file; one that exists is left alone
    #[arg(long, value_name = "FILE", requires = "name")]
    pub copy: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct CheckOptions {
    #[command(flatten)]
    pub scene: SceneOptions,
}

#[derive(Debug, Args)]
pub struct ValidateOptions {
    /// Cases by name (`flood/stoker`) or beginning (`flood`) [default: all]
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// Leave out the cases that take more than some seconds
    #[arg(long)]
    pub fast: bool,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
}

#[derive(Debug, Args)]
pub struct BenchOptions {
    /// Benches by name or beginning [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Less time for each: a quick look, with more scatter
    #[arg(long)]
    pub quick: bool,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
}
