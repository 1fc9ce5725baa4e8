//! `corpuscle render`.

use crate::args::RenderOptions;
use crate::output::print_json;
use anyhow::Context;
use corpuscle::film::{Film, Format};
use corpuscle::gpu::Image;
use corpuscle::model::{Container, Path};
use corpuscle::pictures::{Moment, PictureSettings, Pictures};
use corpuscle::record::{FrameFiles, followed_paths, write_picture};
use corpuscle::scene::{Run, Scene};
use corpuscle::{Simulation, film_rate};
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
    let container = simulation.model().container();
    if options.film {
        return film(options, as_json, &files, &mut pictures, &paths, container);
    }
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

/// A film that was made.
#[derive(Debug, Serialize)]
struct Made {
    film: PathBuf,
    pictures: usize,
    rate_per_s: f64,
    duration_s: f64,
}

/// Makes a film of all frames.
fn film(
    options: &RenderOptions,
    as_json: bool,
    files: &FrameFiles,
    pictures: &mut Pictures,
    paths: &[Path],
    container: Option<Container>,
) -> anyhow::Result<ExitCode> {
    let count = files.times().len();
    let to = options.film_to.clone().unwrap_or_else(|| options.run.join("film.mp4"));
    let rate = options.rate.unwrap_or_else(|| film_rate(count));
    let mut film = Film::create(&to, Format::of(&to), options.size, rate).map_err(corpuscle::Error::from)?;
    for index in 0..count {
        let frame = files.read(index).map_err(corpuscle::Error::from)?;
        let image = pictures.draw(&Moment { frame: &frame, paths, container })?;
        film.add(&image.rgba).map_err(corpuscle::Error::from)?;
        eprint!("\rpicture {} of {count}", index + 1);
    }
    eprintln!();
    film.finish().map_err(corpuscle::Error::from)?;
    eprintln!("{}", to.display());
    if as_json {
        let made = Made { film: to, pictures: count, rate_per_s: rate, duration_s: count as f64 / rate };
        print_json(&made).context("cannot write what was made")?;
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
