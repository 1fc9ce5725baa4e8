//! `corpuscle render`.

use crate::args::RenderOptions;
use crate::output::print_json;
use anyhow::Context;
use corpuscle::Simulation;
use corpuscle::gpu::Image;
use corpuscle::pictures::{Moment, PictureSettings, Pictures};
use corpuscle::record::{FrameFiles, followed_paths, write_picture};
use corpuscle::scene::{Run, Scene};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Pictures where no times are named.
const STILLS: usize = 6;

/// A picture that was drawn.
#[derive(Debug, Serialize)]
struct Drawn {
    time_s: f64,
    file: PathBuf,
}

/// Draws pictures of a finished run into its folder.
pub fn render(options: &RenderOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let path = options.run.join("scene.toml");
    let scene = Scene::read(&path, &[]).map_err(corpuscle::Error::from)?;
    let files = FrameFiles::list(&options.run, |index| time_of(&scene.run, index)).map_err(corpuscle::Error::from)?;
    let paths = followed_paths(&options.run).map_err(corpuscle::Error::from)?;
    let simulation = Simulation::open(scene, &options.run)?;
    let settings = PictureSettings { size: options.size, samples: options.samples };
    let mut pictures = Pictures::open(&simulation, settings)?;
    eprintln!("drawing on {}", pictures.device());
    let model = simulation.model();
    let container = model.container();
    let mut drawn = Vec::new();
    for index in chosen(options, &files) {
        let frame = files.read(index).map_err(corpuscle::Error::from)?;
        let moment = Moment { frame: &frame, paths: &paths, container };
        let Image { width, height, rgba } = pictures.draw(&moment)?;
        let file = options.run.join("pictures").join(format!("picture_{index:06}.png"));
        write_picture(&file, [width, height], &rgba).map_err(corpuscle::Error::from)?;
        eprintln!("{}", file.display());
        drawn.push(Drawn { time_s: frame.time, file });
    }
    if as_json {
        print_json(&drawn).context("cannot write the list of pictures")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Time of a frame: a multiple of the period, or the end.
fn time_of(run: &Run, index: usize) -> f64 {
    (index as f64 * run.frame_period_s()).min(run.until_s)
}

/// Numbers of the frames to draw.
fn chosen(options: &RenderOptions, files: &FrameFiles) -> Vec<usize> {
    let last = files.times().len() - 1;
    let mut numbers: Vec<usize> = match (options.all, options.at.as_slice()) {
        (true, _) => (0..=last).collect(),
        (false, []) => (0..STILLS).map(|still| (still * last + (STILLS - 1) / 2) / (STILLS - 1)).collect(),
        (false, times) => times.iter().map(|time| files.nearest(*time)).collect(),
    };
    numbers.dedup();
    numbers
}
