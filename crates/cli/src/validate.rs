//! `corpuscle validate`.

use crate::args::{Backend, ValidateOptions};
use crate::output::{number, print, print_json};
use crate::select::select;
use corpuscle::gpu::Gpu;
use corpuscle::model::Chart;
use corpuscle_output::{ValidatedCase, ValidatedMeasure, ValidationReport};
use corpuscle_validate::{Case, Options, Row, cases};
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Runs cases and prints their rows in the order of the cases.
pub fn validate(options: &ValidateOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let data = std::env::var_os("CORPUSCLE_DATA").filter(|path| !path.is_empty()).map(Into::into);
    let mut with = Options::new(data, std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_some_and(|value| value == "1"));
    if options.backend == Backend::Gpu {
        with.gpu = Some(Gpu::open().map_err(corpuscle::Error::from)?);
    }
    let mut report = options.report.as_deref().map(ValidationReport::create).transpose()?;
    let cases = cases();
    let mut chosen = select(&cases, |case| case.name, &options.cases)?;
    chosen.retain(|case| !options.fast || !case.slow);
    if with.gpu.is_some() {
        for case in chosen.extract_if(.., |case| case.name.starts_with("gas/")) {
            tell!("{} left out: it computes on the CPU only", case.name);
        }
    }
    let mut rows = Vec::new();
    each(&chosen, &with, |case, Done { rows: of_case, charts, .. }| {
        let first = rows.len();
        for row in of_case {
            let line = line(&row);
            if as_json {
                tell!("{}", line.trim_end_matches('\n'));
            } else {
                print(&line)?;
            }
            rows.push(row);
        }
        if let Some(report) = &mut report {
            let measures = rows[first..].iter().map(measure).collect();
            report.add(ValidatedCase { name: case.name, about: case.about, measures, charts });
            report.write()?;
        }
        Ok(())
    })?;
    if as_json {
        print_json(&rows)?;
    }
    let count = |verdict: Option<bool>| rows.iter().filter(|row| row.pass == verdict).count();
    let failed = count(Some(false));
    let skipped = rows.iter().filter(|row| row.pass.is_none() && row.value.is_none()).count();
    tell!("{} passed, {failed} failed, {skipped} skipped", count(Some(true)));
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The results of a case.
struct Done {
    rows: Vec<Row>,
    charts: Vec<Chart>,
    took: Duration,
}

/// Runs cases in parallel and takes their results in order: most are so small that two of them on a thread each are done sooner than
/// one after the other on both. A GPU takes one after the other.
fn each(
    cases: &[&Case],
    with: &Options,
    mut take: impl FnMut(&Case, Done) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let threads = rayon::current_num_threads();
    let beside = if with.gpu.is_some() { 1 } else { ((threads as f64).sqrt().ceil() as usize).min(cases.len()).max(1) };
    let next = AtomicUsize::new(0);
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        for _ in 0..beside {
            let pool = rayon::ThreadPoolBuilder::new().num_threads((threads / beside).max(1)).build()?;
            let (sender, with, next) = (sender.clone(), with.clone(), &next);
            let work = move || {
                while let Some((index, case)) = next_of(cases, next) {
                    let start = Instant::now();
                    let rows = case.rows(&with);
                    let done = Done { rows, charts: with.take_charts(), took: start.elapsed() };
                    if sender.send((index, done)).is_err() {
                        break;
                    }
                }
            };
            scope.spawn(move || pool.install(work));
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut taken = 0;
        for (ended, (index, done)) in receiver.into_iter().enumerate() {
            let (name, seconds) = (cases[index].name, done.took.as_secs_f64());
            tell!("{name} took {seconds:.1} s ({} of {} cases)", ended + 1, cases.len());
            waiting.insert(index, done);
            while let Some(done) = waiting.remove(&taken) {
                take(cases[taken], done)?;
                taken += 1;
            }
        }
        Ok(())
    })
}

/// The next case that has not begun.
fn next_of<'a>(cases: &[&'a Case], next: &AtomicUsize) -> Option<(usize, &'a Case)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    cases.get(index).map(|case| (index, *case))
}

/// A row in the form of the report.
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

/// A row as text: verdict, case, measure, value and bound.
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
