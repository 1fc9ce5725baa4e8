//! `corpuscle render`.

use crate::args::RenderOptions;
use crate::output::print_json;
use crate::picture_options::picture_settings;
use anyhow::Context;
use corpuscle::Simulation;
use corpuscle::gpu::Image;
use corpuscle::output::{FrameFiles, WallPlaces, followed_paths, put_into_report, write_picture};
use corpuscle::pictures::{Moment, Pictures};
use corpuscle::scene::{Run, Scene};
use corpuscle::video::{Film, Format};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Pictures where no times are named.
const STILLS: usize = 6;

/// A picture that was drawn.
#[derive(Debug, Serialize)]
struct Drawn {
    time_s: f64,
    file: PathBuf,
}

/// A film that was written.
#[derive(Debug, Serialize)]
struct Filmed {
    file: PathBuf,
    pictures: usize,
    duration_s: f64,
}

/// Draws pictures of a finished run into its folder.
pub fn render(options: &RenderOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let path = options.run.join("scene.toml");
    let scene = Scene::read(&path, &[]).map_err(corpuscle::Error::from)?;
    let files = FrameFiles::list(&options.run, |index| time_of(&scene.run, index)).map_err(corpuscle::Error::from)?;
    let paths = followed_paths(&options.run).map_err(corpuscle::Error::from)?;
    let simulation = Simulation::open_to_restore(scene, &options.run)?;
    let settings = picture_settings(options.size, options.samples, &options.picture)?;
    let mut pictures = Pictures::open(&simulation, settings)?;
    tell!("drawing on {}", pictures.device());
    let walls = WallPlaces::read(&options.run).map_err(corpuscle::Error::from)?;
    let at_start = simulation.model().container();
    let mut draw = |index: usize| -> Result<(f64, Image), corpuscle::Error> {
        let frame = files.read(index)?;
        let container = at_start.map(|container| walls.container(container, frame.time));
        let image = pictures.draw(&Moment { frame: &frame, on_device: None, paths: &paths, container })?;
        Ok((frame.time, image))
    };
    if options.film {
        return film(options, files.times().len(), draw, as_json);
    }
    let mut drawn = Vec::new();
    for index in chosen(options, &files) {
        let (time_s, Image { width, height, rgba }) = draw(index)?;
        let file = options.run.join("pictures").join(format!("picture_{index:06}.png"));
        write_picture(&file, [width, height], &rgba).map_err(corpuscle::Error::from)?;
        tell!("{}", file.display());
        drawn.push(Drawn { time_s, file });
    }
    show_in_report(&options.run)?;
    if as_json {
        print_json(&drawn).context("cannot write the list of pictures")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Puts what was drawn into the run's report, where it has one.
fn show_in_report(run: &Path) -> anyhow::Result<()> {
    if put_into_report(run).map_err(corpuscle::Error::from)? {
        tell!("{} was updated", run.join("report.html").display());
    }
    Ok(())
}

/// Writes a film of all frames.
fn film(
    options: &RenderOptions,
    frames: usize,
    mut draw: impl FnMut(usize) -> Result<(f64, Image), corpuscle::Error>,
    as_json: bool,
) -> anyhow::Result<ExitCode> {
    let file = options.film_to.clone().unwrap_or_else(|| options.run.join("film.mp4"));
    let mut film =
        Film::create(&file, Format::of(&file), options.size, options.rate).map_err(corpuscle::Error::from)?;
    for index in 0..frames {
        let (_, image) = draw(index)?;
        film.add(&image.rgba).map_err(corpuscle::Error::from)?;
        tell!("picture {} of {frames}", index + 1);
    }
    let pictures = film.pictures();
    film.finish().map_err(corpuscle::Error::from)?;
    if options.film_to.is_none() {
        show_in_report(&options.run)?;
    }
    let duration_s = pictures as f64 / options.rate;
    tell!("{}: {pictures} pictures, {duration_s} s", file.display());
    if as_json {
        print_json(&Filmed { file, pictures, duration_s }).context("cannot write the description of the film")?;
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
