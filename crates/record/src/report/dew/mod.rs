//! The report of dew: how much water is where, in what drops, and since when.

mod charts;
mod facts;
mod picture;

use super::{folder_name, parts, title_or_folder};
use crate::picture::{Figure, plot, svg_to_png};
use crate::whole::write_bytes;
use crate::{GaugeTable, RecordError, Summary};
use corpuscle_model::Model;
use corpuscle_scene::{Dew, Scene};
use std::fs;
use std::path::Path;

/// Width and height of a chart, CSS pixels.
const CHART: [f64; 2] = [482.0, 310.0];

/// The run of dew, for its report.
pub struct DewReport<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    dew: &'a Dew,
    model: &'a dyn Model,
}

impl<'a> DewReport<'a> {
    /// The report of a run into `folder`. `model` shows the time of the picture.
    ///
    /// # Errors
    /// [`RecordError::Content`] where the scene is not one of dew.
    pub fn new(folder: &'a Path, scene: &'a Scene, model: &'a dyn Model) -> Result<Self, RecordError> {
        let no_dew = || RecordError::content(&folder.join("scene.toml"), "it is not the scene of dew");
        Ok(Self { folder, scene, dew: scene.dew().ok_or_else(no_dew)?, model })
    }

    /// Writes `pictures/*.png` and `report.html`.
    ///
    /// # Errors
    /// [`RecordError::Read`], [`RecordError::Write`]; [`RecordError::Content`] for a picture that cannot be drawn.
    pub fn write(&self) -> Result<(), RecordError> {
        let summary = Summary::read(self.folder)?;
        let scene_path = self.folder.join("scene.toml");
        let scene = fs::read_to_string(&scene_path).map_err(RecordError::read(&scene_path))?;
        let table = GaugeTable::read(&self.folder.join("gauges.csv"))?;
        let pictures = self.folder.join("pictures");
        fs::create_dir_all(&pictures).map_err(RecordError::write(&pictures))?;
        let drawing = |what: String| RecordError::content(&pictures, what);
        let mut figures: Vec<(String, Figure)> =
            charts::over_time(&table, self.dew).iter().map(|chart| (chart.name.clone(), plot(chart, CHART))).collect();
        if let Some(drops) = picture::drops(self.dew, self.model) {
            figures.insert(0, ("drops".into(), drops.figure(None).map_err(drawing)?));
        }
        for (name, figure) in &figures {
            let png = svg_to_png(&figure.with_margin(16.0)).map_err(drawing)?;
            write_bytes(&pictures.join(format!("{name}.png")), &png)?;
        }
        let page = self.page(&summary, &table, &figures, &scene);
        write_bytes(&self.folder.join("report.html"), page.as_bytes())
    }

    fn page(&self, summary: &Summary, table: &GaugeTable, figures: &[(String, Figure)], scene: &str) -> String {
        let title = title_or_folder(self.scene, self.folder);
        let (charts, drops): (Vec<_>, Vec<_>) = figures.iter().partition(|(name, _)| name != "drops");
        let inline = |figures: &[&(String, Figure)]| -> String {
            figures.iter().map(|(_, figure)| format!("<figure>{}</figure>\n", figure.inline())).collect()
        };
        let drops = if drops.is_empty() {
            String::new()
        } else {
            let time = facts::time(self.model.time());
            format!("<section>\n<h2>The drops at t = {time}, to scale</h2>\n{}</section>\n", inline(&drops))
        };
        let charts =
            format!("<section>\n<h2>Measured</h2>\n<div class=\"pair\">\n{}</div>\n</section>\n", inline(&charts));
        let beside = "Particles and drops over time, gauges and pictures stand beside this page.";
        let sections = [
            parts::header("Condensation report", &title, &self.scene.description),
            parts::key_figures(&facts::key_figures(table, summary)),
            parts::warnings(summary),
            drops,
            charts,
            parts::balance(summary),
            parts::run(&facts::run_facts(self.dew, summary), &folder_name(self.folder), scene),
            parts::footer(summary, &facts::time(summary.simulated_time_s), beside),
        ];
        parts::document(&format!("{title} – condensation report"), "", &sections.concat())
    }
}
