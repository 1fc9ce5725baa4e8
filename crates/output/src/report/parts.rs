//! Parts of a report's page that are the same for every model.

use crate::picture::{FIGURE_CSS, Theme, escape, number};
use crate::{LedgerEntry, Status, Summary};
use std::fmt::Write;

const PAGE_CSS: &str = include_str!("page.css");

/// A key figure.
pub(super) struct KeyFigure {
    /// Its name.
    pub label: &'static str,
    /// The value with its unit.
    pub value: String,
    /// A remark below.
    pub remark: String,
}

/// A table: head and rows of cells.
pub(super) struct Table<H = &'static str> {
    pub head: Vec<H>,
    pub rows: Vec<Vec<String>>,
}

/// The page as one file: `before` stands before its content.
pub(super) fn document(title: &str, before: &str, content: &str) -> String {
    let title = escape(title);
    let (light, dark) = (Theme::Light.variables(), Theme::Dark.variables());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n\
         :root{{color-scheme:light dark;{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n\
         {PAGE_CSS}\n{FIGURE_CSS}</style>\n</head>\n<body>\n{before}<main>\n{content}</main>\n</body>\n</html>\n"
    )
}

/// The header: kind of report, title, description.
pub(super) fn header(kind: &str, title: &str, description: &str) -> String {
    let paragraphs = description.split("\n\n").map(str::trim).filter(|paragraph| !paragraph.is_empty());
    let paragraphs: String = paragraphs.map(|text| format!("<p class=\"lead\">{}</p>\n", escape(text))).collect();
    format!("<header>\n<p class=\"kind\">{kind}</p>\n<h1>{}</h1>\n{paragraphs}</header>\n", escape(title))
}

/// The key figures.
pub(super) fn key_figures(figures: &[KeyFigure]) -> String {
    let mut html = String::from("<dl class=\"figures\">\n");
    for figure in figures {
        let (value, remark) = (escape(&figure.value), escape(&figure.remark));
        let _ = writeln!(
            html,
            "<div><dt>{}</dt><dd class=\"value\">{value}</dd><dd class=\"remark\">{remark}</dd></div>",
            figure.label
        );
    }
    html + "</dl>\n"
}

/// The warnings of the run.
pub(super) fn warnings(summary: &Summary) -> String {
    let status = match summary.status {
        Status::Done => None,
        Status::Stopped => Some("The run was stopped before its end: the report covers the time until then."),
        Status::Failed => Some("The computation broke down before its end: the report covers the time until then."),
    };
    let warnings = summary.warnings.iter().map(String::as_str);
    let items: String = status.into_iter().chain(warnings).map(|text| format!("<li>{}</li>\n", escape(text))).collect();
    if items.is_empty() {
        return String::new();
    }
    format!("<aside class=\"warnings\">\n<h2>Warnings</h2>\n<ul>\n{items}</ul>\n</aside>\n")
}

/// How a run ended, in words.
pub(super) fn how_it_ended(summary: &Summary) -> &'static str {
    match summary.status {
        Status::Done => "complete",
        Status::Stopped => "stopped before its end",
        Status::Failed => "broke down before its end",
    }
}

/// The table of the balances.
pub(super) fn balance(summary: &Summary) -> String {
    if summary.ledger.is_empty() {
        return String::new();
    }
    let row = |(name, entry): (&String, &LedgerEntry)| {
        let values = [entry.initial, entry.inflow, entry.outflow, entry.end, entry.relative_error].map(number);
        std::iter::once(quantity(name, &summary.model)).chain(values).collect()
    };
    let ledger = Table {
        head: vec!["quantity", "at the start", "in", "out", "at the end", "relative error"],
        rows: summary.ledger.iter().map(row).collect(),
    };
    format!(
        "<section>\n<h2>Balance</h2>\n<p>What should be conserved. The relative error is (end − start − in + out) over \
         the larger of start + in and end + out.</p>\n{}</section>\n",
        table(&ledger)
    )
}

/// `water_m3` as `water, m³`.
fn quantity(name: &str, model: &str) -> String {
    match name.rsplit_once('_') {
        Some((quantity, "m3")) => format!("{quantity}, m³"),
        Some((quantity, unit @ ("J" | "kg"))) => format!("{quantity}, {unit}"),
        // A gas may have reduced units.
        None if name == "momentum" && model == "flood" => "momentum, kg m/s".into(),
        _ => name.replace('_', " "),
    }
}

/// The facts of the run, and the command that repeats it.
pub(super) fn run(facts: &[(&'static str, String)], folder: &str, scene: &str) -> String {
    let mut facts_html = String::new();
    for (name, value) in facts {
        let _ = writeln!(facts_html, "<tr><th scope=\"row\">{name}</th><td>{}</td></tr>", escape(value));
    }
    let command = format!("corpuscle run {}/scene.toml", shell_word(folder));
    format!(
        "<section>\n<h2>The run</h2>\n<table class=\"facts\">\n<tbody>\n{facts_html}</tbody>\n</table>\n\
         <h3>To run it again</h3>\n<p>The scene with all its defaults is kept with the results; from the folder above \
         them this computes the same again, to the bit:</p>\n<pre>{}</pre>\n<h3>Scene</h3>\n<pre>{}</pre>\n</section>\n",
        escape(&command),
        escape(scene.trim_end()),
    )
}

/// The footer: version, and the files in the folder.
pub(super) fn footer(summary: &Summary, simulated: &str, beside: &str) -> String {
    format!(
        "<footer><p>Simulated {} with Corpuscle {}. {beside}</p></footer>\n",
        escape(simulated),
        escape(&summary.version)
    )
}

/// A word quoted for a shell.
fn shell_word(word: &str) -> String {
    if word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./".contains(c)) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// A table whose first column has the row headers.
pub(super) fn table<H: AsRef<str>>(table: &Table<H>) -> String {
    let cell = |(index, text): (usize, &String)| match index {
        0 => format!("<th scope=\"row\">{}</th>", escape(text)),
        _ => format!("<td>{}</td>", escape(text)),
    };
    let head: String =
        table.head.iter().map(|text| format!("<th scope=\"col\">{}</th>", escape(text.as_ref()))).collect();
    let rows: String = table
        .rows
        .iter()
        .map(|row| format!("<tr>{}</tr>\n", row.iter().enumerate().map(cell).collect::<String>()))
        .collect();
    format!("<div class=\"wide\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n")
}
