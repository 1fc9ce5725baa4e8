//! The report of the validation: results of cases with known answers, as one page of tables and charts.

use super::parts::{self, Table};
use crate::OutputError;
use crate::picture::{escape, number, plot};
use crate::whole::write_bytes;
use corpuscle_model::Chart;
use std::path::{Path, PathBuf};

/// Size of a chart, CSS pixels.
const CHART: [f64; 2] = [520.0, 300.0];

/// One measure of a case, against its bound.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidatedMeasure {
    /// What was measured, in words joined by `_`.
    pub name: String,
    /// What was found; none where the case was skipped.
    pub value: Option<f64>,
    /// Unit of value and bound; empty for a number.
    pub unit: String,
    /// How the value must stand to the bound: `<=`, `>=` or `==`.
    pub relation: String,
    /// The bound.
    pub bound: f64,
    /// Whether the bound was kept; none where it does not count.
    pub pass: Option<bool>,
    /// Why the bound does not count.
    pub reason: Option<String>,
}

/// A case that was run.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidatedCase {
    /// Name: `flood/voronoi/stoker`.
    pub name: &'static str,
    /// What it tests and where the answer comes from.
    pub about: &'static str,
    /// What was measured.
    pub measures: Vec<ValidatedMeasure>,
    /// Its charts.
    pub charts: Vec<Chart>,
}

/// The page, which grows with the cases that are run.
#[derive(Debug)]
pub struct ValidationReport {
    path: PathBuf,
    sections: String,
    /// Numbers of measures within their bounds, beyond them, and without verdict.
    counts: [usize; 3],
}

impl ValidationReport {
    /// Begins the page in a file, which is written at once, so that an error is found before anything is run.
    ///
    /// # Errors
    /// [`OutputError`] where the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let report = Self { path: path.into(), sections: String::new(), counts: [0; 3] };
        report.write()?;
        Ok(report)
    }

    /// Adds a case.
    pub fn add(&mut self, case: ValidatedCase) {
        for measure in &case.measures {
            self.counts[measure.pass.map_or(2, |pass| usize::from(!pass))] += 1;
        }
        self.sections += &section(&case);
    }

    /// Writes the page as it stands, whole or not at all.
    ///
    /// # Errors
    /// [`OutputError`] where the file cannot be written.
    pub fn write(&self) -> Result<(), OutputError> {
        let [kept, missed, rest] = self.counts;
        let about =
            format!("{kept} measures keep their bounds, {missed} do not, {rest} are only shown or were skipped.");
        let header = parts::header("Validation", "Corpuscle against known answers", &about);
        let version = env!("CARGO_PKG_VERSION");
        let footer = format!("<footer><p>Computed with Corpuscle {version}.</p></footer>\n");
        let content = [header, self.sections.clone(), footer].concat();
        write_bytes(&self.path, parts::document("Corpuscle – validation", "", &content).as_bytes())
    }
}

fn section(case: &ValidatedCase) -> String {
    let rows = case.measures.iter().map(row).collect();
    let table = parts::table(&Table { head: vec!["measure", "found", "bound", "kept"], rows });
    let charts: String =
        case.charts.iter().map(|chart| format!("<figure>{}</figure>\n", plot(chart, CHART).inline())).collect();
    let charts = if charts.is_empty() { charts } else { format!("<div class=\"pair\">\n{charts}</div>\n") };
    let (name, about) = (escape(case.name), escape(case.about));
    format!("<section>\n<h2>{name}</h2>\n<p>{about}</p>\n{table}{charts}</section>\n")
}

fn row(measure: &ValidatedMeasure) -> Vec<String> {
    let with_unit = |value: f64| format!("{} {}", number(value), measure.unit).trim_end().to_owned();
    let relation = match measure.relation.as_str() {
        "<=" => "at most",
        ">=" => "at least",
        _ => "equal to",
    };
    let kept = match (measure.pass, &measure.reason) {
        (Some(true), _) => "yes".into(),
        (Some(false), reason) => reason.as_ref().map_or("NO".into(), |reason| format!("NO: {reason}")),
        (None, reason) => reason.clone().unwrap_or_else(|| "shown".into()),
    };
    vec![
        measure.name.clone(),
        measure.value.map_or("–".into(), with_unit),
        format!("{relation} {}", with_unit(measure.bound)),
        kept,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::ChartSeries;

    fn measure(name: &str, value: Option<f64>, pass: Option<bool>) -> ValidatedMeasure {
        let (unit, relation) = ("m".into(), "<=".into());
        ValidatedMeasure { name: name.into(), value, unit, relation, bound: 0.5, pass, reason: None }
    }

    #[test]
    fn the_page_tells_what_kept_its_bound_and_draws_the_charts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("page.html");
        let mut report = ValidationReport::create(&path).unwrap();
        let series = ChartSeries { points: vec![[0.0, 0.0], [1.0, 2.0]], ..ChartSeries::default() };
        let chart = Chart { title: "Depth at G1".into(), series: vec![series], ..Chart::default() };
        let measures = vec![
            measure("depth", Some(0.25), Some(true)),
            measure("arrival", Some(0.75), Some(false)),
            measure("speed", None, None),
        ];
        report.add(ValidatedCase { name: "flood/a", about: "a < b", measures, charts: vec![chart] });
        report.write().unwrap();
        let page = std::fs::read_to_string(path).unwrap();
        let words = [
            "1 measures keep",
            "1 do not",
            "1 are only shown",
            "0.25 m",
            "at most 0.5 m",
            ">NO<",
            "Depth at G1",
            "a &lt; b",
        ];
        for word in words {
            assert!(page.contains(word), "{word} is missing");
        }
    }
}
