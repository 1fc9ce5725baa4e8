//! `corpuscle ensemble`.

use crate::args::{Arguments, EnsembleOptions};
use crate::interrupt::stop_on_interrupt;
use crate::output::{duration, print_json};
use crate::progress::{MemberBar, while_shown};
use crate::refusal::refuse;
use crate::terrain::fetch_for;
use corpuscle_ensemble::{Folder, PlanFile, Workers, Written, run, write_results};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    folder: &'a Path,
    members: usize,
    finished: usize,
    failed: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    report: Option<&'a Path>,
}

/// Runs the members of a plan that are missing and writes the results, or runs the named members alone.
pub fn ensemble(options: &EnsembleOptions, arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let stop = stop_on_interrupt()?;
    let file = PlanFile::read(&options.plan)?;
    fetch_for(&file.source.scene(&[])?, &stop)?;
    let members = members(options, file.plan.rows.len())?;
    let path = options.output.clone().unwrap_or_else(|| default_folder(&options.plan));
    let folder = Folder::prepare(&path, &file.source, &file.plan, &file.statistics)?;
    tell!("{} members in {}", file.plan.rows.len(), path.display());
    run_members(&folder, &file, &members, workers(options, arguments, members.len()), &stop)?;
    if stop.load(Ordering::Relaxed) {
        tell!("interrupted; the same command goes on with the members that are missing");
        return Ok(ExitCode::FAILURE);
    }
    let written = match options.member.as_slice() {
        [] => {
            Some(while_shown("computing the statistics", || write_results(&folder, &file.source, &file.statistics))??)
        }
        _ => None,
    };
    finish(&folder, &members, written.as_ref(), arguments.json)
}

/// The members that this call runs.
fn members(options: &EnsembleOptions, planned: usize) -> anyhow::Result<Vec<usize>> {
    if let Some(beyond) = options.member.iter().find(|member| **member >= planned) {
        return Err(refuse(format!("the plan has no member {beyond}: they are numbered from 0 to {}", planned - 1)));
    }
    Ok(if options.member.is_empty() { (0..planned).collect() } else { options.member.clone() })
}

fn default_folder(plan: &Path) -> PathBuf {
    Path::new("runs").join(plan.file_stem().unwrap_or(plan.as_os_str()))
}

fn workers(options: &EnsembleOptions, arguments: &Arguments, members: usize) -> Workers {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.unwrap_or_else(cores);
    match options.at_once {
        Some(members) => Workers { members, threads: (threads / members).max(1) },
        None => Workers::share(threads, members),
    }
}

fn run_members(
    folder: &Folder,
    file: &PlanFile,
    members: &[usize],
    workers: Workers,
    stop: &AtomicBool,
) -> anyhow::Result<()> {
    let (bar, start) = (MemberBar::new()?, Instant::now());
    let ended = run(folder, &file.source, members, workers, stop, &mut |progress| bar.show(progress, start.elapsed()));
    bar.clear();
    ended?;
    tell!("members ran for {}", duration(start.elapsed().as_secs_f64()));
    Ok(())
}

/// Tells how it ended. Exit status 1 where a member failed.
fn finish(folder: &Folder, members: &[usize], written: Option<&Written>, as_json: bool) -> anyhow::Result<ExitCode> {
    let (mut finished, mut failed) = (0, 0);
    for &number in members {
        let Some(record) = folder.record(number)? else { continue };
        finished += usize::from(record.is_finished());
        if let Some(failure) = &record.error {
            failed += 1;
            tell!("member {number} failed: {}", failure.message);
        }
    }
    tell!("{finished} of {} members are finished, {failed} failed", members.len());
    if let Some(Written { folder, report, maps }) = written {
        let maps = if *maps == 0 { String::new() } else { format!(" and {maps} maps") };
        tell!("tables{maps} in {}, report in {}", folder.display(), report.display());
    }
    if as_json {
        let report = written.map(|written| written.report.as_path());
        print_json(&Report { folder: folder.path(), members: members.len(), finished, failed, report })?;
    }
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
