//! `corpuscle run`.

use crate::args::{Backend, RunOptions};
use crate::interrupt::stop_on_interrupt;
use crate::output::{duration, number, print_json, rate};
use crate::picture_options::picture_settings;
use crate::processes::{follow, processes, read, read_of_run};
use crate::progress::{Bar, while_shown};
use anyhow::anyhow;
use corpuscle::model::ModelError;
use corpuscle::output::{FrameFormat, Status, Summary, next_run_folder, put_into_report};
use corpuscle::processes::Processes;
use corpuscle::{Choice, Filming, Recorder, Simulation, Sink};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Runs a scene, or resumes an interrupted run.
pub fn run(options: &RunOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let processes = processes()?;
    if !processes.is_first() {
        return Ok(follow(&processes, options));
    }
    let stop = stop_on_interrupt()?;
    let (mut simulation, mut recorder) = match &options.resume {
        Some(folder) => resume(&processes, folder, options.backend)?,
        None => start(&processes, options, &stop)?,
    };
    if processes.count() > 1 {
        tell!("computing on {} processes", processes.count());
    }
    for note in simulation.notes() {
        tell!("note: {note}");
    }
    for warning in simulation.warnings() {
        tell!("warning: {warning}");
    }
    tell!("writing {}", recorder.path().display());
    let mut filming = filming(options, &simulation, recorder.path())?;
    let bar = Bar::new()?;
    let mut sinks: Vec<&mut dyn Sink> = vec![&mut recorder];
    sinks.extend(filming.iter_mut().map(|filming| filming as &mut dyn Sink));
    let ended = simulation.run(&mut sinks, &stop, &mut |progress| bar.show(progress));
    bar.clear();
    let summary = ended.map_err(|error| run_error(&error, &simulation, &recorder))?;
    if filming.is_some() {
        put_into_report(recorder.path()).map_err(corpuscle::Error::from)?;
    }
    let has_frames = options.frames.is_none_or(|frames| FrameFormat::from(frames) != FrameFormat::None);
    print_summary(&summary, recorder.path(), has_frames);
    if as_json {
        print_json(&summary)?;
    }
    Ok(if summary.status == Status::Done { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Opens the film of `--film`. Where there is no GPU to draw it, a warning is printed and the run goes on without a film.
fn filming(options: &RunOptions, simulation: &Simulation, folder: &Path) -> anyhow::Result<Option<Filming>> {
    if !options.film {
        return Ok(None);
    }
    let settings = picture_settings(options.film_size, 1, &options.picture)?;
    match Filming::open(simulation, &folder.join("film.mp4"), settings, options.film_length) {
        Ok(filming) => {
            tell!("filming on {}", filming.device());
            Ok(Some(filming))
        }
        Err(error @ corpuscle::Error::Render(_)) if !error.is_refusal() => {
            tell!("warning: no film: {error}");
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

fn resume(processes: &Processes, folder: &Path, backend: Backend) -> anyhow::Result<(Simulation, Recorder)> {
    if processes.count() > 1 {
        read_of_run(processes, folder)?;
    }
    let open = |scene| Simulation::open_to_restore_on(processes, scene, folder);
    let (mut simulation, recorder) = Recorder::resume_with(folder, open)?;
    match backend {
        // So that an interruption does not change the backend, and with it the last digits.
        Backend::Auto if processes.count() > 1 => {}
        Backend::Auto => tell!("resuming on the CPU; `--backend gpu` resumes on a GPU"),
        _ => compute_on(backend, &mut simulation)?,
    }
    Ok((simulation, recorder))
}

/// Selects the backend of the steps.
fn compute_on(backend: Backend, simulation: &mut Simulation) -> Result<(), corpuscle::Error> {
    match backend {
        Backend::Auto => {
            let Choice { is_gpu, why } = simulation.use_best();
            let reason = if why.is_empty() { String::new() } else { format!(": {why}") };
            tell!("computing on the {}{reason}", if is_gpu { "GPU" } else { "CPU" });
            Ok(())
        }
        Backend::Cpu => Ok(()),
        Backend::Gpu => simulation.use_gpu(),
    }
}

fn start(
    processes: &Processes,
    options: &RunOptions,
    stop: &Arc<AtomicBool>,
) -> anyhow::Result<(Simulation, Recorder)> {
    let named = read(processes, options, stop)?;
    let open = || Simulation::open_on(processes, named.scene, &named.folder);
    let mut simulation = while_shown("setting up the scene", open)??;
    // Before the folder is made: a refused scene leaves none behind.
    if processes.count() == 1 || options.backend == Backend::Gpu {
        compute_on(options.backend, &mut simulation)?;
    }
    let folder = match &options.output {
        Some(folder) => folder.clone(),
        None => next_run_folder(Path::new("runs"), &named.short_name).map_err(corpuscle::Error::from)?,
    };
    let frames = options.frames.map(FrameFormat::from).unwrap_or_default();
    let recorder = Recorder::create(&folder, &simulation, frames)?;
    Ok((simulation, recorder))
}

/// The error of a run that broke down. Whatever the reason, the input had been accepted: exit status 1.
fn run_error(error: &corpuscle::Error, simulation: &Simulation, recorder: &Recorder) -> anyhow::Error {
    let (time, folder) = (number(simulation.model().time()), recorder.path().display());
    let ended = format!("the run ended at t = {time}");
    match error {
        corpuscle::Error::Model(ModelError::Device(error)) if recorder.can_resume() => {
            anyhow!("{ended}: {error}; resume on the CPU with `corpuscle run --resume {folder} --backend cpu`")
        }
        corpuscle::Error::Output(error) if recorder.can_resume() => {
            anyhow!("{ended}: {error}; then resume with `corpuscle run --resume {folder}`")
        }
        error => anyhow!("{ended}; what was written up to there stays readable in {folder}: {error}"),
    }
}

/// The work done and its rate, as text.
fn work(summary: &Summary) -> String {
    match (summary.collisions, summary.collisions_per_s, summary.particle_steps_per_s) {
        (Some(collisions), Some(per_second), _) => {
            format!("{collisions} collisions, {}", rate(per_second, "collisions"))
        }
        (_, _, Some(per_second)) => format!("{} steps, {}", summary.steps, rate(per_second, "particle-steps")),
        _ => format!("{} steps", summary.steps),
    }
}

/// Prints the summary of a run and, where there are frames to draw, the command for pictures.
fn print_summary(summary: &Summary, folder: &Path, has_frames: bool) {
    let folder = folder.display();
    if summary.status == Status::Stopped {
        let time = number(summary.simulated_time_s);
        tell!("interrupted at t = {time}; resume with\n    corpuscle run --resume {folder}");
        return;
    }
    tell!(
        "done in {}: t = {}, {} particles, {}",
        duration(summary.wall_time_s),
        number(summary.simulated_time_s),
        summary.particles,
        work(summary)
    );
    for (quantity, entry) in &summary.ledger {
        let [initial, inflow, outflow, end] = [entry.initial, entry.inflow, entry.outflow, entry.end].map(number);
        let error = number(entry.relative_error);
        tell!("{quantity}: {initial} at the start, {inflow} in, {outflow} out, {end} now; relative error {error}");
    }
    tell!("results in {folder}");
    if has_frames {
        // Not checked here whether there is a GPU: `render` says what to install.
        tell!("pictures with `corpuscle render {folder}`, on any GPU or software Vulkan (mesa-vulkan-drivers)");
    }
}
