//! The report of a gas as one HTML page that needs nothing else.

use super::{Drawn, GasReport, facts};
use crate::Summary;
use crate::picture::{Figure, svg_url};
use crate::report::parts;

/// The page.
pub(super) fn content(report: &GasReport<'_>, summary: &Summary, drawn: &Drawn, title: &str, scene: &str) -> String {
    let folder = super::super::folder_name(report.folder);
    let beside = "Balls over time, gauges, charts as tables and pictures stand beside this page.";
    let sections = [
        parts::header("Gas simulation report", title, &report.scene.description),
        parts::key_figures(&facts::key_figures(report, summary)),
        parts::warnings(summary),
        balls(report, drawn),
        charts(&drawn.charts),
        parts::balance(summary),
        parts::run(&facts::run_facts(report.gas, summary), &folder, scene),
        parts::footer(summary, &facts::time(report.gas, summary.simulated_time_s), beside),
    ];
    parts::document(&format!("{title} – gas report"), "", &sections.concat())
}

fn balls(report: &GasReport<'_>, drawn: &Drawn) -> String {
    let time = facts::time(report.gas, report.model.time());
    let image =
        |svg: &Vec<u8>| format!("<figure><img alt=\"The balls at a moment\" src=\"{}\"></figure>\n", svg_url(svg));
    let moments: String = drawn.moments.iter().map(image).collect();
    let moments = if drawn.moments.len() > 1 {
        format!("<h3>From the start to the end</h3>\n<div class=\"strip\">\n{moments}</div>\n")
    } else {
        String::new()
    };
    format!(
        "<section>\n<h2>The balls at t = {time}</h2>\n<figure>{}</figure>\n{moments}</section>\n",
        drawn.balls.inline()
    )
}

fn charts(charts: &[(String, Figure)]) -> String {
    if charts.is_empty() {
        return String::new();
    }
    let figures: String = charts.iter().map(|(_, chart)| format!("<figure>{}</figure>\n", chart.inline())).collect();
    format!("<section>\n<h2>Measured</h2>\n<div class=\"pair\">\n{figures}</div>\n</section>\n")
}
