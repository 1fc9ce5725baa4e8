//! The report as one HTML page that needs nothing else.

use super::figures::{FieldFigure, Figures};
use super::parts::{self, Table, table};
use super::{Report, facts, gauges};
use crate::picture::{area, escape, number, time};
use std::fmt::Write;

/// The page.
pub(super) fn html(report: &Report, figures: &Figures) -> String {
    let title = report.title();
    let sections = [
        parts::header("Flood simulation report", &title, &report.scene.description),
        parts::key_figures(&facts::key_figures(report)),
        parts::warnings(&report.summary),
        maximum(report, figures),
        other_maps(report, figures),
        snapshots(figures),
        hydrographs(report, figures),
        charts(figures),
        parts::balance(&report.summary),
        comparison(report),
        parts::run(&facts::run_facts(report), &report.folder_name(), &report.scene_text),
        parts::footer(
            &report.summary,
            &time(report.summary.simulated_time_s),
            "Maps, particles and gauges stand beside this page.",
        ),
    ];
    parts::document(&format!("{title} – flood report"), &figures.relief_definition(), &sections.concat())
}

fn maximum(report: &Report, figures: &Figures) -> String {
    figures.fields.first().map_or_else(String::new, |first| {
        format!(
            "<section>\n<h2>{}</h2>\n<p>{}</p>\n<figure>{}</figure>\n{}</section>\n",
            first.kind.title,
            first.kind.about,
            first.on_page.inline(),
            class_areas(report, first)
        )
    })
}

fn other_maps(report: &Report, figures: &Figures) -> String {
    let maps = figures.fields.iter().skip(1).map(|field| {
        let areas = if field.kind.areas { class_areas(report, field) } else { String::new() };
        format!(
            "<div>\n<h3>{}</h3>\n<p>{}</p>\n<figure>{}</figure>\n{areas}</div>\n",
            field.kind.title,
            field.kind.about,
            field.on_page.inline()
        )
    });
    match maps.collect::<String>() {
        none if none.is_empty() => none,
        maps => {
            format!("<section>\n<h2>Arrival, speed and hazard</h2>\n<div class=\"pair\">\n{maps}</div>\n</section>\n")
        }
    }
}

/// Bars of the area in each class.
fn class_areas(report: &Report, field: &FieldFigure) -> String {
    let areas = facts::areas_by_class(report, field);
    let total: f64 = areas.iter().map(|(_, _, area)| area).sum();
    if total == 0.0 {
        return "<p class=\"none\">Nothing became wet.</p>\n".into();
    }
    let largest = areas.iter().map(|(_, _, area)| *area).fold(0.0, f64::max);
    let mut html = format!(
        "<table class=\"areas\">\n<caption>Area by class: {}</caption>\n<tbody>\n",
        escape(&field.classes.title)
    );
    for (name, [r, g, b], size) in areas {
        let (width, part) = (100.0 * size / largest, 100.0 * size / total);
        let bar = format!("<span style=\"width:{width:.1}%;background:rgb({r},{g},{b})\"></span>");
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{}</th><td class=\"bar\">{}</td><td>{}</td><td>{part:.1} %</td></tr>",
            escape(&name),
            if size > 0.0 { bar.as_str() } else { "" },
            area(size)
        );
    }
    html + "</tbody>\n</table>\n"
}

fn snapshots(figures: &Figures) -> String {
    if figures.snapshots.is_empty() {
        return String::new();
    }
    let maps: String = figures.snapshots.iter().map(|map| format!("<figure>{}</figure>\n", map.inline())).collect();
    format!(
        "<section>\n<h2>Depth over time</h2>\n<p>Time after the start; colours as in the map of the maximum \
         depth.</p>\n<div class=\"strip\">\n{maps}</div>\n</section>\n"
    )
}

fn hydrographs(report: &Report, figures: &Figures) -> String {
    let peaks = facts::gauge_peaks(report);
    if peaks.rows.is_empty() {
        return String::new();
    }
    let charts: String =
        figures.hydrographs.iter().map(|chart| format!("<figure>{}</figure>\n", chart.inline())).collect();
    let left_out = match peaks.rows.len() - figures.hydrographs.len() {
        0 => "",
        _ if figures.hydrographs.len() == gauges::MOST_GAUGES => {
            "<p>More gauges are in the table and in gauges.csv.</p>\n"
        }
        _ => "<p>Gauges that stay dry have no chart.</p>\n",
    };
    format!(
        "<section>\n<h2>Hydrographs at the gauges</h2>\n{left_out}<div class=\"strip\">\n{charts}</div>\n{}</section>\n",
        table(&peaks)
    )
}

fn charts(figures: &Figures) -> String {
    if figures.charts.is_empty() {
        return String::new();
    }
    let charts = figures.charts.iter().map(|(_, chart)| format!("<figure>{}</figure>\n", chart.inline()));
    format!("<section>\n<h2>Discharge and storage</h2>\n{}</section>\n", charts.collect::<String>())
}

fn comparison(report: &Report) -> String {
    let Some(scores) = &report.summary.extent else { return String::new() };
    let rows = [
        ("Hit rate", number(scores.hit_rate), "part of the observed area that is computed wet"),
        ("False alarm ratio", number(scores.false_alarm_ratio), "part of the computed area that was not observed"),
        ("Critical success index", number(scores.critical_success_index), "common area over the area wet in either"),
        ("Area computed", area(scores.simulated_area_m2), ""),
        ("Area observed", area(scores.observed_area_m2), "within the terrain"),
    ];
    let rows = rows.map(|(name, value, about)| vec![name.to_owned(), value, about.to_owned()]).to_vec();
    let scores = table(&Table { head: vec!["score", "value", "meaning"], rows });
    format!("<section>\n<h2>Against the observed extent</h2>\n{scores}</section>\n")
}
