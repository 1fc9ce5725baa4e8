//! The report of dew: amounts of water, sizes of drops and times of wetting.

mod air;
mod charts;
mod facts;
mod picture;

use super::{CHART, folder_name, moments, parts, title_or_folder};
use crate::picture::{Figure, plot, svg_to_png, svg_url};
use crate::whole::write_bytes;
use crate::{GaugeTable, OutputError, Summary};
use corpuscle_model::Model;
use corpuscle_scene::{Dew, Scene, read_text};
use std::fs;
use std::path::Path;

/// The run of dew, for its report.
pub struct DewReport<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    dew: &'a Dew,
    model: &'a dyn Model,
}

/// Figures with the names of their files.
type Figures = Vec<(String, Figure)>;

/// The figures of the report.
struct Drawn {
    drops: Option<Figure>,
    air: Option<Figure>,
    maps: Figures,
    charts: Figures,
    /// Pictures of moments, as SVG files.
    moments: Vec<Vec<u8>>,
}

impl<'a> DewReport<'a> {
    /// The report of a run into `folder`. `model` shows the time of the picture.
    ///
    /// # Errors
    /// [`OutputError::Content`] where the scene is not one of dew.
    pub fn new(folder: &'a Path, scene: &'a Scene, model: &'a dyn Model) -> Result<Self, OutputError> {
        let no_dew = || OutputError::content(&folder.join("scene.toml"), "it is not the scene of dew");
        Ok(Self { folder, scene, dew: scene.dew().ok_or_else(no_dew)?, model })
    }

    /// Draws the solids and drops at the time shown, if this is one of the moments that the report will show:
    /// `pictures/frame_NNNNNN.svg`, with the number of the particle file.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be drawn.
    pub fn write_moment(&self) -> Result<(), OutputError> {
        let number = moments::frame_number(self.model.time(), self.scene.run.frame_period_s());
        if !moments::numbers(&self.scene.run).contains(&number) {
            return Ok(());
        }
        let caption = format!("t = {}", facts::time(self.model.time()));
        let figure = picture::moment(self.model, &caption).map_err(|what| self.drawing(what))?;
        let Some(figure) = figure else { return Ok(()) };
        self.make_folder()?;
        write_bytes(&moments::path(self.folder, number), figure.standalone().as_bytes())
    }

    /// Writes `pictures/*.png` and `report.html`.
    ///
    /// # Errors
    /// [`OutputError::Read`], [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be drawn.
    pub fn write(&self) -> Result<(), OutputError> {
        let summary = Summary::read(self.folder)?;
        let scene_path = self.folder.join("scene.toml");
        let scene = read_text(&scene_path).map_err(OutputError::read(&scene_path))?;
        let table = GaugeTable::read(&self.folder.join("gauges.csv"))?;
        let drawn = self.draw(&table)?;
        let page = self.page(&summary, &table, &drawn, &scene);
        write_bytes(&self.folder.join("report.html"), page.as_bytes())
    }

    fn draw(&self, table: &GaugeTable) -> Result<Drawn, OutputError> {
        self.make_folder()?;
        let mut charts = charts::over_time(table, self.dew);
        charts.extend(self.model.charts());
        let drawn = Drawn {
            drops: picture::drops(self.model).map_err(|what| self.drawing(what))?,
            air: air::slice(self.dew, self.model).map_err(|what| self.drawing(what))?,
            maps: picture::maps(self.model).map_err(|what| self.drawing(what))?,
            charts: charts.iter().map(|chart| (chart.name.clone(), plot(chart, CHART))).collect(),
            moments: moments::read(self.folder, &self.scene.run),
        };
        let drops = drawn.drops.iter().map(|figure| ("drops", figure));
        let drops = drops.chain(drawn.air.iter().map(|figure| ("air", figure)));
        let others = drawn.maps.iter().chain(&drawn.charts).map(|(name, figure)| (name.as_str(), figure));
        for (name, figure) in drops.chain(others) {
            let png = svg_to_png(&figure.with_margin(16.0)).map_err(|what| self.drawing(what))?;
            write_bytes(&self.folder.join("pictures").join(format!("{name}.png")), &png)?;
        }
        Ok(drawn)
    }

    fn make_folder(&self) -> Result<(), OutputError> {
        let pictures = self.folder.join("pictures");
        fs::create_dir_all(&pictures).map_err(OutputError::write(&pictures))
    }

    fn drawing(&self, what: String) -> OutputError {
        OutputError::content(&self.folder.join("pictures"), what)
    }

    fn page(&self, summary: &Summary, table: &GaugeTable, drawn: &Drawn, scene: &str) -> String {
        let title = title_or_folder(self.scene, self.folder);
        let beside = "Particles and drops over time, gauges, maps of the solids for ParaView and pictures stand beside this page.";
        let sections = [
            parts::header("Condensation report", &title, &self.scene.description),
            parts::key_figures(&facts::key_figures(table, summary, self.dew)),
            parts::warnings(summary),
            self.drops(drawn),
            self.air(drawn),
            pairs("Where it is wet", &drawn.maps),
            pairs("Measured", &drawn.charts),
            parts::balance(summary),
            parts::run(&facts::run_facts(self.dew, summary), &folder_name(self.folder), scene),
            parts::footer(summary, &facts::time(summary.simulated_time_s), beside),
        ];
        parts::document(&format!("{title} – condensation report"), "", &sections.concat())
    }

    fn air(&self, drawn: &Drawn) -> String {
        let Some(air) = &drawn.air else { return String::new() };
        let time = facts::time(self.model.time());
        format!(
            "<section>\n<h2>The air at t = {time}</h2>\n<p>A slice through the middle of the box.</p>\n<figure>{}</figure>\n</section>\n",
            air.inline()
        )
    }

    fn drops(&self, drawn: &Drawn) -> String {
        let Some(drops) = &drawn.drops else { return String::new() };
        let image =
            |svg: &Vec<u8>| format!("<figure><img alt=\"The solids at a moment\" src=\"{}\"></figure>\n", svg_url(svg));
        let moments: String = drawn.moments.iter().map(image).collect();
        let moments = if drawn.moments.len() > 1 {
            format!("<h3>From the start to the end</h3>\n<div class=\"strip\">\n{moments}</div>\n")
        } else {
            String::new()
        };
        let time = facts::time(self.model.time());
        format!(
            "<section>\n<h2>The drops at t = {time}</h2>\n<figure>{}</figure>\n{moments}</section>\n",
            drops.inline()
        )
    }
}

/// Figures, two in a row; nothing where there are none.
fn pairs(heading: &str, figures: &Figures) -> String {
    if figures.is_empty() {
        return String::new();
    }
    let inline: String = figures.iter().map(|(_, figure)| format!("<figure>{}</figure>\n", figure.inline())).collect();
    format!("<section>\n<h2>{heading}</h2>\n<div class=\"pair\">\n{inline}</div>\n</section>\n")
}
