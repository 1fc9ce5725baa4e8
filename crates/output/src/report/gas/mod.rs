//! The report of a gas.

mod charts;
mod facts;
mod page;
mod picture;

pub use picture::gas_key;

use super::{CHART, moments, title_or_folder};
use crate::picture::{Figure, plot, svg_to_png};
use crate::whole::write_bytes;
use crate::{GaugeTable, OutputError, Summary};
use corpuscle_model::{Chart, Model};
use corpuscle_scene::{Gas, Scene, read_text};
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

/// The run of a gas, for its report.
pub struct GasReport<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    gas: &'a Gas,
    model: &'a dyn Model,
}

/// The figures of the report.
struct Drawn {
    balls: Figure,
    charts: Vec<(String, Figure)>,
    /// Pictures of moments, as SVG files.
    moments: Vec<Vec<u8>>,
}

impl<'a> GasReport<'a> {
    /// The report of a run into `folder`. `scene` has its defaults resolved; `model` shows the time of the picture.
    ///
    /// # Errors
    /// [`OutputError::Content`] where the scene is not one of a gas.
    pub fn new(folder: &'a Path, scene: &'a Scene, model: &'a dyn Model) -> Result<Self, OutputError> {
        let no_gas = || OutputError::content(&folder.join("scene.toml"), "it is not the scene of a gas");
        Ok(Self { folder, scene, gas: scene.gas().ok_or_else(no_gas)?, model })
    }

    /// Draws the balls at the time shown, if this is one of the moments that the report will show:
    /// `pictures/frame_NNNNNN.svg`, with the number of the particle file.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be drawn.
    pub fn write_moment(&self) -> Result<(), OutputError> {
        let number = moments::frame_number(self.model.time(), self.scene.run.frame_period_s());
        if !moments::numbers(&self.scene.run).contains(&number) {
            return Ok(());
        }
        let caption = format!("t = {}", facts::time(self.gas, self.model.time()));
        let figure = picture::balls(self.gas, self.model).moment(&caption).map_err(|what| self.drawing(what))?;
        self.make_folder()?;
        write_bytes(&moments::path(self.folder, number), figure.standalone().as_bytes())
    }

    /// Writes `pictures/*.png`, `pictures/balls.svg` and `report.html`.
    ///
    /// # Errors
    /// [`OutputError::Read`], [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be drawn.
    pub fn write(&self) -> Result<(), OutputError> {
        let summary = Summary::read(self.folder)?;
        let scene_path = self.folder.join("scene.toml");
        let scene_text = read_text(&scene_path).map_err(OutputError::read(&scene_path))?;
        let gauges = GaugeTable::read(&self.folder.join("gauges.csv"))?;
        let mut charts = self.model.charts();
        charts.extend(charts::over_time(self.gas, &self.model.gauge_columns(), &gauges, &charts));
        let title = title_or_folder(self.scene, self.folder);
        let drawn = self.draw(&charts, &title)?;
        let content = page::content(self, &summary, &drawn, &title, &scene_text);
        write_bytes(&self.folder.join("report.html"), content.as_bytes())
    }

    fn draw(&self, charts: &[Chart], title: &str) -> Result<Drawn, OutputError> {
        self.make_folder()?;
        let balls = picture::balls(self.gas, self.model);
        let subtitle = format!("t = {}", facts::time(self.gas, self.model.time()));
        let file = balls.figure(Some([title, &subtitle])).map_err(|what| self.drawing(what))?;
        write_bytes(&self.picture_path("balls.svg"), file.with_margin(16.0).standalone().as_bytes())?;
        let on_page = balls.figure(None).map_err(|what| self.drawing(what))?;
        let charts: Vec<(String, Figure)> =
            charts.iter().map(|chart| (chart.name.clone(), plot(chart, CHART))).collect();
        let files = charts.iter().cloned().chain([("balls".to_owned(), file)]);
        let pngs = files.collect::<Vec<_>>().into_par_iter();
        let pngs = pngs.map(|(name, figure)| Ok((name, svg_to_png(&figure.with_margin(16.0))?)));
        for (name, png) in pngs.collect::<Result<Vec<_>, String>>().map_err(|what| self.drawing(what))? {
            write_bytes(&self.picture_path(&format!("{name}.png")), &png)?;
        }
        Ok(Drawn { balls: on_page, charts, moments: moments::read(self.folder, &self.scene.run) })
    }

    fn picture_path(&self, name: &str) -> PathBuf {
        self.folder.join("pictures").join(name)
    }

    fn make_folder(&self) -> Result<(), OutputError> {
        let pictures = self.folder.join("pictures");
        fs::create_dir_all(&pictures).map_err(OutputError::write(&pictures))
    }

    fn drawing(&self, what: String) -> OutputError {
        OutputError::content(&self.folder.join("pictures"), what)
    }
}
