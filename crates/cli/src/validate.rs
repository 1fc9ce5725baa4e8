//! `corpuscle validate`.

use crate::args::{Backend, ValidateOptions};
use crate::output::{number, print, print_json};
use crate::select::select;
use corpuscle::gpu::Gpu;
use corpuscle_record::{ValidatedCase, ValidatedMeasure, ValidationReport};
use corpuscle_validate::{Options, Row, cases};
use std::process::ExitCode;

/// Runs cases and prints their rows as they come.
pub fn validate(options: &ValidateOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let data = std::env::var_os("CORPUSCLE_DATA").filter(|path| !path.is_empty()).map(Into::into);
    let mut with = Options::new(data, std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_some_and(|value| value == "1"));
    if options.backend == Backend::Gpu {
        with.gpu = Some(Gpu::open().map_err(corpuscle::Error::from)?);
    }
    let mut report = options.report.as_deref().map(ValidationReport::create).transpose()?;
    let mut rows = Vec::new();
    for case in select(cases(), |case| case.name, &options.cases)? {
        if options.fast && case.slow {
            continue;
        }
        if with.gpu.is_some() && case.name.starts_with("gas/") {
            eprintln!("{} left out: it computes on the CPU only", case.name);
            continue;
        }
        let first = rows.len();
        for row in case.rows(&with) {
            let line = line(&row);
            if as_json {
                eprint!("{line}");
            } else {
                print(&line)?;
            }
            rows.push(row);
        }
        if let Some(report) = &mut report {
            let measures = rows[first..].iter().map(measure).collect();
            report.add(ValidatedCase { name: case.name, about: case.about, measures, charts: with.take_charts() });
            report.write()?;
        }
    }
    if as_json {
        print_json(&rows)?;
    }
    let count = |verdict: Option<bool>| rows.iter().filter(|row| row.pass == verdict).count();
    let failed = count(Some(false));
    let skipped = rows.iter().filter(|row| row.pass.is_none() && row.value.is_none()).count();
    eprintln!("{} passed, {failed} failed, {skipped} skipped", count(Some(true)));
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A row as the report has it.
fn measure(row: &Row) -> ValidatedMeasure {
    ValidatedMeasure {
        name: row.measure.clone(),
        value: row.value,
        unit: row.unit.clone(),
        relation: row.relation.clone(),
        bound: row.bound,
        pass: row.pass,
        reason: row.reason.clone(),
    }
}

/// A row as people read it: verdict, case, measure, value and bound.
fn line(row: &Row) -> String {
    let verdict = match row.pass {
        Some(true) => "pass",
        Some(false) => "FAIL",
        None if row.value.is_some() => "note",
        None => "skip",
    };
    let value = row.value.map_or("-".into(), number);
    let reason = row.reason.as_deref().map(|reason| format!("  ({reason})")).unwrap_or_default();
    let Row { case, measure, relation, unit, .. } = row;
    let bound = format!("{relation} {} {unit}", number(row.bound));
    format!("{verdict}  {case:24} {measure:28} {value:>11} {}{reason}\n", bound.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_holds_all_of_a_row() {
        let mut row = Row {
            case: "flood/stoker".into(),
            measure: "relative_l1_error_1m".into(),
            value: Some(0.0015),
            unit: "m/s".into(),
            relation: "<=".into(),
            bound: 0.0032,
            pass: Some(true),
            reason: None,
        };
        let text = line(&row);
        let words = ["pass", "flood/stoker", "relative_l1_error_1m", "0.0015", "<= 0.0032 m/s"];
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
        (row.pass, row.reason) = (None, Some("a peer's".into()));
        assert!(line(&row).starts_with("note") && line(&row).contains("0.0015"));
        (row.value, row.reason) = (None, Some("no data".into()));
        assert!(line(&row).starts_with("skip") && line(&row).contains("(no data)"));
    }
}
