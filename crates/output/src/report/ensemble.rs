//! The report of an ensemble: maps and curves of statistics, the plan, and members that failed.

use super::figures::{FIELDS, FieldKind, RELIEF, relief_definition};
use super::marks;
use super::parts::{self, Table};
use crate::OutputError;
use crate::picture::{
    Classes, Figure, Ground, Layer, MapFigure, MapMark, MarkKind, Ramp, Size, Window, data_url, escape, ground_image,
    legend, plot,
};
use crate::whole::write_bytes;
use corpuscle_model::Chart;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;

/// Size of a chart, CSS pixels.
const CHART: [f64; 2] = [482.0, 290.0];

/// The report of an ensemble.
#[derive(Debug)]
pub struct EnsembleReport<'a> {
    /// Title of the scene.
    pub title: String,
    /// How many members are finished and what was changed, in sentences.
    pub about: String,
    /// The scene and the terrain of the maps; none for a model without maps.
    pub ground: Option<(&'a Scene, &'a Terrain)>,
    /// Probabilities of a threshold.
    pub probabilities: Vec<EnsembleMap>,
    /// Statistics of maps, by the map's name; those that reports of runs show are shown.
    pub maps: Vec<(String, Vec<EnsembleMap>)>,
    /// Gauges over time.
    pub charts: Vec<Chart>,
    /// Tables: members that failed, last values of gauges, the plan.
    pub tables: Vec<EnsembleTable>,
    /// The scene without the members' changes.
    pub scene_text: String,
}

/// A statistic of a map.
#[derive(Debug, Clone)]
pub struct EnsembleMap {
    /// What it shows: `Percentile 95`.
    pub title: String,
    /// A value for each cell of the terrain's map grid; not-a-number where there is nothing to show.
    pub values: Vec<f32>,
}

/// A table of the report.
#[derive(Debug, Clone)]
pub struct EnsembleTable {
    /// Its heading.
    pub title: String,
    /// A sentence below the heading; empty for none.
    pub about: String,
    /// Headings of the columns.
    pub head: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl EnsembleReport<'_> {
    /// Writes the report as one page that needs nothing else.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::Content`] for a map that cannot be drawn.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let (relief, maps) = self.map_sections().map_err(|what| OutputError::content(path, what))?;
        let sections = [
            parts::header("Report of an ensemble", &self.title, &self.about),
            maps,
            self.gauges(),
            self.tables.iter().map(section).collect(),
            format!(
                "<section>\n<h2>Scene</h2>\n<p>Without the members' changes.</p>\n<pre>{}</pre>\n</section>\n",
                escape(self.scene_text.trim_end())
            ),
            format!(
                "<footer><p>Computed with Corpuscle {}. Maps and tables stand beside this page.</p></footer>\n",
                env!("CARGO_PKG_VERSION")
            ),
        ];
        let page = parts::document(&format!("{} – ensemble", self.title), &relief, &sections.concat());
        write_bytes(path, page.as_bytes())
    }

    /// What stands before the content, and the sections of the maps.
    fn map_sections(&self) -> Result<(String, String), String> {
        let Some((scene, terrain)) = self.ground else { return Ok(Default::default()) };
        let atlas = Atlas::of(scene, terrain, self.all_maps());
        let relief = relief_definition(&data_url(&ground_image(&atlas.ground)?));
        let classes = Classes::of_probability();
        let mut html = String::new();
        for map in &self.probabilities {
            let figure = atlas.draw(map, &classes, Size::Full)?;
            html += &format!(
                "<section>\n<h2>{}</h2>\n<p>Share of the finished members.</p>\n<figure>{}</figure>\n</section>\n",
                escape(&map.title),
                figure.inline()
            );
        }
        for kind in &FIELDS {
            if let Some((_, maps)) = self.maps.iter().find(|(name, _)| name == kind.name) {
                html += &atlas.section(kind, maps)?;
            }
        }
        Ok((relief, html))
    }

    fn all_maps(&self) -> impl Iterator<Item = &EnsembleMap> {
        self.probabilities.iter().chain(self.maps.iter().flat_map(|(_, maps)| maps))
    }

    fn gauges(&self) -> String {
        if self.charts.is_empty() {
            return String::new();
        }
        let charts: String =
            self.charts.iter().map(|chart| format!("<figure>{}</figure>\n", plot(chart, CHART).inline())).collect();
        format!(
            "<section>\n<h2>Gauges</h2>\n<p>Percentiles and mean over the finished members at each time.</p>\n<div class=\"pair\">\n{charts}</div>\n</section>\n"
        )
    }
}

fn section(table: &EnsembleTable) -> String {
    let about = if table.about.is_empty() { String::new() } else { format!("<p>{}</p>\n", escape(&table.about)) };
    let EnsembleTable { title, head, rows, .. } = table;
    let table = parts::table(&Table { head: head.clone(), rows: rows.clone() });
    format!("<section>\n<h2>{}</h2>\n{about}{table}</section>\n", escape(title))
}

/// The ground of the maps, and what is marked on it.
struct Atlas {
    ground: Ground,
    window: Window,
    columns: usize,
    marks: Vec<MapMark>,
}

impl Atlas {
    /// The ground round all that the maps show.
    fn of<'a>(scene: &Scene, terrain: &Terrain, maps: impl Iterator<Item = &'a EnsembleMap>) -> Self {
        let grid = terrain.map_grid();
        let marks = scene.flood().map_or_else(Vec::new, |scene| marks(&scene.flood, terrain));
        let has_value = |map: &'a EnsembleMap| map.values.iter().enumerate().filter(|(_, value)| !value.is_nan());
        let cells =
            maps.flat_map(has_value).map(|(cell, _)| [(cell % grid.columns) as f64, (cell / grid.columns) as f64]);
        let points = marks.iter().filter(|mark| mark.kind != MarkKind::Obstacle).flat_map(|mark| &mark.points);
        let points = points.map(|point| grid.georeference.position(*point));
        let window = Window::round([grid.columns, grid.rows], grid.cell_size(), cells.chain(points));
        Self { ground: Ground::of(terrain, &window), window, columns: grid.columns, marks }
    }

    fn draw(&self, map: &EnsembleMap, classes: &Classes, size: Size) -> Result<Figure, String> {
        let reduction = if size == Size::Thumb { 2 } else { 1 };
        let shown = self.window.crop(&map.values, self.columns);
        let url = data_url(&Layer::image(&self.ground, &shown, classes, reduction)?);
        let layer = Layer { url, classes: classes.clone() };
        let reference = format!("#{RELIEF}");
        let figure = MapFigure {
            ground: &self.ground,
            relief_url: &reference,
            layer: Some(&layer),
            marks: &self.marks,
            size,
            heading: None,
            title: &map.title,
        };
        Ok(figure.figure())
    }

    /// The statistics of one map side by side, in the same classes.
    fn section(&self, kind: &FieldKind, maps: &[EnsembleMap]) -> Result<String, String> {
        let values: Vec<f32> = maps.iter().flat_map(|map| map.values.iter().copied()).collect();
        let classes = Classes::of(kind.ramp, kind.legend, &values);
        let figures: Vec<Figure> =
            maps.iter().map(|map| self.draw(map, &classes, Size::Thumb)).collect::<Result<_, _>>()?;
        let figures: String = figures.iter().map(|figure| format!("<figure>{}</figure>\n", figure.inline())).collect();
        let dry = match kind.ramp {
            Ramp::Arrival => "A member that stays dry counts as an arrival that never comes.",
            _ => "A member that stays dry counts as 0.",
        };
        Ok(format!(
            "<section>\n<h2>{}</h2>\n<p>{} {dry}</p>\n<div class=\"strip\">\n{figures}</div>\n<figure style=\"max-width:440px\">{}</figure>\n</section>\n",
            kind.title,
            kind.about,
            legend(&classes).inline()
        ))
    }
}
