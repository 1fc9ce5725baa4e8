//! `corpuscle render`.

use crate::args::{FigureOptions, OverlayKind, RenderOptions};
use crate::output::print_json;
use crate::picture_options::picture_settings;
use crate::refusal::refuse;
use anyhow::{Context, Result};
use corpuscle::Simulation;
use corpuscle::gpu::Image;
use corpuscle::model::{Container, GaugeColumn, Path as Trajectory};
use corpuscle::output::{FrameFiles, GaugeTable, WallPositions, followed_paths, gauge_chart, put_into_report};
use corpuscle::output::{write_drawing, write_picture};
use corpuscle::pictures::{Moment, PictureSettings, Pictures, Sheet};
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
pub fn render(options: &RenderOptions, as_json: bool) -> Result<ExitCode> {
    refuse_film_of(options)?;
    let mut drawing = Drawing::open(options)?;
    tell!("drawing on {}", drawing.runs[0].pictures.device());
    if options.is_film() {
        return film(options, &mut drawing, as_json);
    }
    let mut drawn = Vec::new();
    for index in chosen(options, &drawing.runs[0].files) {
        let (time_s, sheet) = drawing.draw(index)?;
        let file = write_sheet(options, index, &sheet)?;
        tell!("{}", file.display());
        drawn.push(Drawn { time_s, file });
    }
    show_in_report(&options.run)?;
    if as_json {
        print_json(&drawn).context("cannot write the list of pictures")?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses what a film cannot show.
fn refuse_film_of(options: &RenderOptions) -> Result<()> {
    if options.is_film() && options.figure.overlay == OverlayKind::Vector {
        return Err(refuse("a film has no vectors: --overlay drawn or none"));
    }
    let is_folder = options.film_to.as_deref().is_some_and(|file| Format::of(file) == Format::Png);
    if options.is_film() && options.figure.transparent && !is_folder {
        return Err(refuse("a film file has no transparent pixels: --film-to FOLDER writes its pictures as PNG files"));
    }
    Ok(())
}

/// The runs that are drawn side by side.
struct Drawing {
    runs: Vec<DrawnRun>,
    overlay: OverlayKind,
    /// Width and height of the whole, pixels.
    size: [u32; 2],
}

impl Drawing {
    fn open(options: &RenderOptions) -> Result<Self> {
        let figure = &options.figure;
        let folders: Vec<&Path> = std::iter::once(&*options.run).chain(figure.beside.as_deref()).collect();
        let count = folders.len() as u32;
        let size = [options.size[0] / count, options.size[1]];
        let settings = PictureSettings {
            transparent: figure.transparent,
            north: figure.north,
            ..picture_settings(size, options.samples, &options.picture)?
        };
        let captions = figure.caption.iter().cloned().chain(std::iter::repeat(String::new()));
        let open = |(folder, caption)| DrawnRun::open(folder, PictureSettings { caption, ..settings.clone() }, figure);
        let runs = folders.into_iter().zip(captions).map(open).collect::<Result<_>>()?;
        Ok(Self { runs, overlay: figure.overlay, size: [count * size[0], size[1]] })
    }

    /// Draws a frame of the first run, with those of the others nearest in time; returns its time, s.
    fn draw(&mut self, index: usize) -> Result<(f64, Sheet)> {
        let mut sheet = Sheet::default();
        let time = self.runs[0].files.times().nth(index).unwrap_or_default();
        for (number, run) in self.runs.iter_mut().enumerate() {
            let index = if number == 0 { index } else { run.files.nearest(time) };
            run.draw(index, self.overlay, &mut sheet)?;
        }
        Ok((time, sheet))
    }
}

/// A run that is drawn.
struct DrawnRun {
    files: FrameFiles,
    paths: Vec<Trajectory>,
    walls: WallPositions,
    container: Option<Container>,
    pictures: Pictures,
    inset: Option<(GaugeColumn, GaugeTable)>,
    has_si_units: bool,
}

impl DrawnRun {
    fn open(folder: &Path, settings: PictureSettings, options: &FigureOptions) -> Result<Self> {
        let scene = Scene::read(&folder.join("scene.toml"), &[]).map_err(corpuscle::Error::from)?;
        if settings.north && scene.model.name() != "flood" {
            return Err(refuse("--north: only floods have a north; leave it out for this run"));
        }
        let files = FrameFiles::list(folder, |index| time_of(&scene.run, index)).map_err(corpuscle::Error::from)?;
        let paths = followed_paths(folder).map_err(corpuscle::Error::from)?;
        let has_si_units = corpuscle::models::of(&scene).is_ok_and(|kind| kind.has_si_units(&scene));
        let simulation = Simulation::open_to_restore(scene, folder)?;
        let pictures = Pictures::open(&simulation, settings)?;
        let walls = WallPositions::read(folder).map_err(corpuscle::Error::from)?;
        let inset = match &options.inset {
            Some(name) => Some(gauge(name, simulation.model().gauge_columns(), folder)?),
            None => None,
        };
        Ok(Self { files, paths, walls, container: simulation.model().container(), pictures, inset, has_si_units })
    }

    /// Draws a frame beside what is on a sheet.
    fn draw(&mut self, index: usize, overlay: OverlayKind, sheet: &mut Sheet) -> Result<()> {
        let frame = self.files.read(index).map_err(corpuscle::Error::from)?;
        let container = self.container.map(|container| self.walls.container(container, frame.time));
        let moment = Moment { frame: &frame, on_device: None, paths: &self.paths, container };
        let inset =
            self.inset.as_ref().and_then(|(column, table)| gauge_chart(column, table, frame.time, self.has_si_units));
        self.pictures.set_inset(inset);
        match overlay {
            OverlayKind::Drawn => sheet.add(self.pictures.draw(&moment)?, None),
            OverlayKind::Vector => {
                let (image, overlay) = self.pictures.draw_apart(&moment)?;
                sheet.add(image, Some(overlay));
            }
            OverlayKind::None => sheet.add(self.pictures.draw_apart(&moment)?.0, None),
        }
        Ok(())
    }
}

/// The gauge of a name, a column or a gauge of which it is the first, with the table of the run's gauges.
fn gauge(name: &str, columns: Vec<GaugeColumn>, folder: &Path) -> Result<(GaugeColumn, GaugeTable)> {
    let table = GaugeTable::read(&folder.join("gauges.csv")).map_err(corpuscle::Error::from)?;
    let found = columns.iter().find(|column| column.header() == name);
    let found = found.or_else(|| columns.iter().find(|column| column.gauge == name)).cloned();
    match found {
        Some(column) => Ok((column, table)),
        None => {
            let headers: Vec<String> = columns.iter().map(GaugeColumn::header).collect();
            Err(refuse(format!("--inset {name}: {} has no such gauge, only {}", folder.display(), headers.join(", "))))
        }
    }
}

/// Writes a picture into the run's folder; returns its file.
fn write_sheet(options: &RenderOptions, index: usize, sheet: &Sheet) -> Result<PathBuf> {
    let file = |ending: &str| options.run.join("pictures").join(format!("picture_{index:06}.{ending}"));
    let Image { width, height, rgba } = sheet.image();
    write_picture(&file("png"), [width, height], &rgba).map_err(corpuscle::Error::from)?;
    if options.figure.overlay != OverlayKind::Vector {
        return Ok(file("png"));
    }
    write_drawing(&file("svg"), &sheet.svg()?).map_err(corpuscle::Error::from)?;
    Ok(file("svg"))
}

/// Puts what was drawn into the run's report, where it has one.
fn show_in_report(run: &Path) -> Result<()> {
    if put_into_report(run).map_err(corpuscle::Error::from)? {
        tell!("{} was updated", run.join("report.html").display());
    }
    Ok(())
}

/// Writes a film of all frames.
fn film(options: &RenderOptions, drawing: &mut Drawing, as_json: bool) -> Result<ExitCode> {
    let file = options.film_to.clone().unwrap_or_else(|| options.run.join("film.mp4"));
    let frames = drawing.runs[0].files.times().len();
    let film = Film::create(&file, Format::of(&file), drawing.size, options.rate);
    let mut film = film.map_err(corpuscle::Error::from)?;
    for index in 0..frames {
        let (_, sheet) = drawing.draw(index)?;
        film.add(&sheet.image().rgba).map_err(corpuscle::Error::from)?;
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
