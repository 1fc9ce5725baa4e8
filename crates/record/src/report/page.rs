//! The report as one HTML page that needs nothing else.

use super::facts::{self, Table};
use super::figures::{FieldFigure, Figures};
use super::{Report, gauges};
use crate::Status;
use crate::picture::{FIGURE_CSS, Theme, area, escape, number, time};
use std::fmt::Write;

const PAGE_CSS: &str = include_str!("page.css");

/// The page.
pub(super) fn html(report: &Report, figures: &Figures) -> String {
    let title = escape(&report.title());
    let (light, dark) = (Theme::Light.variables(), Theme::Dark.variables());
    let sections = [
        header(report),
        key_figures(report),
        warnings(report),
        maximum(report, figures),
        other_maps(report, figures),
        snapshots(figures),
        hydrographs(report, figures),
        charts(figures),
        balance(report),
        comparison(report),
        run(report),
    ];
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{title} – flood report</title>\n<style>\n\
         :root{{color-scheme:light dark;{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n\
         {PAGE_CSS}\n{FIGURE_CSS}</style>\n</head>\n<body>\n{}<main>\n{}</main>\n</body>\n</html>\n",
        figures.relief_definition(),
        sections.concat()
    )
}

fn header(report: &Report) -> String {
    let description = paragraphs(&report.scene.description);
    format!(
        "<header>\n<p class=\"kind\">Flood simulation report</p>\n<h1>{}</h1>\n{description}</header>\n",
        escape(&report.title())
    )
}

fn paragraphs(text: &str) -> String {
    let paragraphs = text.split("\n\n").map(str::trim).filter(|paragraph| !paragraph.is_empty());
    paragraphs.map(|paragraph| format!("<p class=\"lead\">{}</p>\n", escape(paragraph))).collect()
}

fn key_figures(report: &Report) -> String {
    let mut html = String::from("<dl class=\"figures\">\n");
    for figure in facts::key_figures(report) {
        let (value, remark) = (escape(&figure.value), escape(&figure.remark));
        let _ = writeln!(
            html,
            "<div><dt>{}</dt><dd class=\"value\">{value}</dd><dd class=\"remark\">{remark}</dd></div>",
            figure.label
        );
    }
    html + "</dl>\n"
}

fn warnings(report: &Report) -> String {
    let status = match report.summary.status {
        Status::Done => None,
        Status::Stopped => Some("The run was stopped before its end: this is how far it came."),
        Status::Failed => Some("The computation broke down before its end: this is what came before."),
    };
    let warnings = report.summary.warnings.iter().map(String::as_str);
    let items: String = status.into_iter().chain(warnings).map(|text| format!("<li>{}</li>\n", escape(text))).collect();
    if items.is_empty() {
        return String::new();
    }
    format!("<aside class=\"warnings\">\n<h2>To be known</h2>\n<ul>\n{items}</ul>\n</aside>\n")
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
        return "<p class=\"none\">No place became wet.</p>\n".into();
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

fn balance(report: &Report) -> String {
    let ledger = facts::ledger(report);
    if ledger.rows.is_empty() {
        return String::new();
    }
    format!(
        "<section>\n<h2>Balance</h2>\n<p>What should be conserved. The relative error is (end − start − in + out) over \
         the larger of start + in and end + out.</p>\n{}</section>\n",
        table(&ledger)
    )
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

fn run(report: &Report) -> String {
    let mut facts_html = String::new();
    for (name, value) in facts::run_facts(report) {
        let _ = writeln!(facts_html, "<tr><th scope=\"row\">{name}</th><td>{}</td></tr>", escape(&value));
    }
    let command = format!("corpuscle run {}/scene.toml", shell_word(&report.folder_name()));
    format!(
        "<section>\n<h2>The run</h2>\n<table class=\"facts\">\n<tbody>\n{facts_html}</tbody>\n</table>\n\
         <h3>To run it again</h3>\n<p>The scene with all its defaults is kept with the results; from the folder above \
         them this computes the same again, to the bit:</p>\n<pre>{}</pre>\n<h3>Scene</h3>\n<pre>{}</pre>\n\
         </section>\n<footer><p>Simulated {} with Corpuscle {}. Maps, particles and gauges stand beside this page.</p></footer>\n",
        escape(&command),
        escape(report.scene_text.trim_end()),
        escape(&time(report.summary.simulated_time_s)),
        escape(&report.summary.version)
    )
}

/// A word as a shell takes it.
fn shell_word(word: &str) -> String {
    if word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./".contains(c)) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

fn table(table: &Table) -> String {
    let cell = |(index, text): (usize, &String)| match index {
        0 => format!("<th scope=\"row\">{}</th>", escape(text)),
        _ => format!("<td>{}</td>", escape(text)),
    };
    let head: String = table.head.iter().map(|text| format!("<th scope=\"col\">{text}</th>")).collect();
    let rows: String = table
        .rows
        .iter()
        .map(|row| format!("<tr>{}</tr>\n", row.iter().enumerate().map(cell).collect::<String>()))
        .collect();
    format!("<div class=\"wide\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n")
}
