//! The report of a model without its own: gauges, charts, balances, and the command that repeats the run.

use super::parts::{self, KeyFigure, how_it_ended};
use super::{CHART, folder_name, title_or_folder};
use crate::picture::{Figure, number, plot, svg_to_png, time};
use crate::whole::write_bytes;
use crate::{GaugeTable, OutputError, Summary};
use corpuscle_model::{Chart, ChartAxis, ChartSeries, GaugeColumn, Model};
use corpuscle_scene::{Scene, read_text};
use std::fs;
use std::path::Path;

/// The run of any model, for its report.
pub struct PlainReport<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    model: &'a dyn Model,
    /// Empty in reduced units.
    time_unit: &'static str,
}

impl<'a> PlainReport<'a> {
    /// The report of a run into `folder`, whose model shows its end. The unit of time is empty in reduced units.
    pub fn new(folder: &'a Path, scene: &'a Scene, model: &'a dyn Model, time_unit: &'static str) -> Self {
        Self { folder, scene, model, time_unit }
    }

    fn time(&self, time: f64) -> String {
        format!("{} {}", number(time), self.time_unit).trim_end().to_owned()
    }

    /// Writes `pictures/*.png` and `report.html`.
    ///
    /// # Errors
    /// [`OutputError::Read`], [`OutputError::Write`]; [`OutputError::Content`] for a chart that cannot be drawn.
    pub fn write(&self) -> Result<(), OutputError> {
        let summary = Summary::read(self.folder)?;
        let scene_path = self.folder.join("scene.toml");
        let scene = read_text(&scene_path).map_err(OutputError::read(&scene_path))?;
        let table = GaugeTable::read(&self.folder.join("gauges.csv"))?;
        let mut charts = over_time(&self.model.gauge_columns(), &table, self.time_unit);
        charts.extend(self.model.charts());
        let charts: Vec<(String, Figure)> =
            charts.iter().map(|chart| (chart.name.clone(), plot(chart, CHART))).collect();
        let pictures = self.folder.join("pictures");
        fs::create_dir_all(&pictures).map_err(OutputError::write(&pictures))?;
        for (name, figure) in &charts {
            let drawing = |what: String| OutputError::content(&pictures, what);
            let png = svg_to_png(&figure.with_margin(16.0)).map_err(drawing)?;
            write_bytes(&pictures.join(format!("{name}.png")), &png)?;
        }
        write_bytes(&self.folder.join("report.html"), self.page(&summary, &charts, &scene).as_bytes())
    }

    fn page(&self, summary: &Summary, charts: &[(String, Figure)], scene: &str) -> String {
        let title = title_or_folder(self.scene, self.folder);
        let figures: String =
            charts.iter().map(|(_, chart)| format!("<figure>{}</figure>\n", chart.inline())).collect();
        let measured = match charts {
            [] => String::new(),
            _ => format!("<section>\n<h2>Measured</h2>\n<div class=\"pair\">\n{figures}</div>\n</section>\n"),
        };
        let beside = "Particles over time, gauges, charts as tables and pictures stand beside this page.";
        let sections = [
            parts::header(&format!("Report of a run of {}", summary.model), &title, &self.scene.description),
            parts::key_figures(&self.key_figures(summary)),
            parts::warnings(summary),
            measured,
            parts::balance(summary),
            parts::run(&self.run_facts(summary), &folder_name(self.folder), scene),
            parts::footer(summary, &self.time(summary.simulated_time_s), beside),
        ];
        parts::document(&format!("{title} – report"), "", &sections.concat())
    }

    /// The key figures.
    fn key_figures(&self, summary: &Summary) -> Vec<KeyFigure> {
        let figure = |label, value: String, remark: &str| KeyFigure { label, value, remark: remark.into() };
        let worst = summary.ledger.values().map(|entry| entry.relative_error.abs()).reduce(f64::max);
        let mut figures = vec![
            figure("Particles", whole(summary.particles as f64), "at the end"),
            figure("Simulated time", self.time(summary.simulated_time_s), how_it_ended(summary)),
            figure("Steps", whole(summary.steps as f64), ""),
        ];
        figures.extend(worst.map(|error| figure("Error of the balances", number(error), "the largest, relative")));
        figures
    }

    /// Names and values of the facts of the run.
    fn run_facts(&self, summary: &Summary) -> Vec<(&'static str, String)> {
        vec![
            ("Model", summary.model.clone()),
            ("Simulated time", format!("{} ({})", self.time(summary.simulated_time_s), how_it_ended(summary))),
            ("Particles", whole(summary.particles as f64)),
            ("Steps", whole(summary.steps as f64)),
            ("Computed in", format!("{} on the {}", time(summary.wall_time_s), summary.backend.to_uppercase())),
            ("Corpuscle", format!("version {}", summary.version)),
        ]
    }
}

fn whole(count: f64) -> String {
    number(count).replace(".0", "")
}

/// Gauges over time: a chart for each quantity, with a curve for each gauge. None of what never is a number.
fn over_time(columns: &[GaugeColumn], table: &GaugeTable, time_unit: &str) -> Vec<Chart> {
    let mut charts: Vec<Chart> = Vec::new();
    for column in columns {
        let Some(values) = table.column(&column.header()) else { continue };
        let points: Vec<_> = table.times.iter().zip(values).map(|(time, value)| [*time, value]).collect();
        if points.iter().all(|point| point[1].is_nan()) {
            continue;
        }
        let series = ChartSeries { name: column.gauge.clone(), points, ..ChartSeries::default() };
        let name = format!("{}_over_time", column.quantity);
        match charts.iter_mut().find(|chart| chart.name == name) {
            Some(chart) => chart.series.push(series),
            None => charts.push(chart(name, column, series, time_unit)),
        }
    }
    charts
}

fn chart(name: String, column: &GaugeColumn, series: ChartSeries, time_unit: &str) -> Chart {
    let words = column.quantity.replace('_', " ");
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    let unit = column.unit.replace("_per_", "/").replace('_', " ");
    Chart {
        name,
        title: first.to_uppercase() + rest,
        x: ChartAxis { label: "Time".into(), unit: time_unit.into(), logarithmic: false },
        y: ChartAxis { label: String::new(), unit, logarithmic: false },
        series: vec![series],
        note: String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauges_of_one_quantity_stand_in_one_chart() {
        let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
        let columns =
            [column("a", "spring_force", "N"), column("b", "spring_force", "N"), column("a", "speed", "m_per_s")];
        let table = GaugeTable {
            columns: columns.iter().map(GaugeColumn::header).collect(),
            times: vec![0.0, 1.0],
            rows: vec![vec![1.0, 2.0, f64::NAN], vec![3.0, f64::NAN, f64::NAN]],
        };
        let charts = over_time(&columns, &table, "s");
        let told: Vec<_> = charts.iter().map(|chart| (&*chart.name, &*chart.title, chart.series.len())).collect();
        assert_eq!(told, [("spring_force_over_time", "Spring force", 2)]);
        assert_eq!(charts[0].series[0].points, [[0.0, 1.0], [1.0, 3.0]]);
    }
}
