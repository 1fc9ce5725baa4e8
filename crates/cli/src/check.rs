//! `corpuscle check`.

use crate::args::CheckOptions;
use crate::interrupt::stop_on_interrupt;
use crate::output::{duration, number, print, print_json};
use crate::progress::while_shown;
use crate::refusal::in_words;
use crate::scene_argument;
use crate::terrain::fetch_for;
use corpuscle::Simulation;
use corpuscle::model::Model;
use corpuscle::models;
use corpuscle::terrain::Terrain;
use serde::Serialize;
use serde_json::{Value, json};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Wall-clock time of the trial run that measures time step and rate.
const PROBE: Duration = Duration::from_secs(2);

/// Steps of each particle (in a gas, collisions for each ball) after which the trial run may end.
const PROBE_STEPS: u64 = 50;

/// The first part of the run that is tried; it is doubled until there are enough steps.
const SHORTEST_PROBE: f64 = 1e-3;

/// Parts of a run for which the particles to come are estimated.
const ESTIMATE_PARTS: usize = 20;

/// Memory for each cell of the terrain, bytes, measured: heights, and the maps of maxima and times.
const BYTES_PER_CELL: f64 = 55.0;

/// The result of the check.
#[derive(Debug, Serialize)]
struct Report {
    ok: bool,
    title: String,
    model: &'static str,
    /// None for a model without one.
    terrain: Option<Ground>,
    particles_at_start: usize,
    /// Name of the particles, in the plural.
    #[serde(skip)]
    called: &'static str,
    particles_to_come: usize,
    memory_bytes: f64,
    /// At the start; none where nothing moves yet.
    time_step_s: Option<f64>,
    /// On this machine; none where nothing moves yet and nothing comes.
    estimated_wall_time_s: Option<f64>,
    until_s: f64,
    frames: u64,
    gauge_rows: u64,
    gauges: Vec<String>,
    notes: Vec<String>,
    warnings: Vec<String>,
}

/// Size of the terrain.
#[derive(Debug, Serialize)]
struct Ground {
    columns: usize,
    rows: usize,
    cell_m: [f64; 2],
    size_m: [f64; 2],
}

impl Ground {
    fn of(terrain: &Terrain) -> Self {
        let grid = terrain.map_grid();
        Self { columns: grid.columns, rows: grid.rows, cell_m: grid.cell_size(), size_m: terrain.bounds().size() }
    }
}

/// Checks a scene and prints the result, without writing anything.
pub fn check(options: &CheckOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    match report(options) {
        Ok(report) if as_json => print_json(&report)?,
        Ok(report) => print(&text(&report))?,
        Err(error) => {
            if as_json {
                print_json(&fault(&error))?;
            }
            return Err(error);
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// An error as JSON: the message and, where it is in the scene's text, file, line and column, or the option that it is in.
fn fault(error: &anyhow::Error) -> Value {
    let problem = match error.downcast_ref() {
        Some(corpuscle::Error::Scene(error)) => error.problem(),
        _ => None,
    };
    let location = problem.and_then(|problem| problem.location.as_ref());
    let in_file = location.filter(|location| location.line.is_some());
    let in_option = location.filter(|location| location.line.is_none());
    json!({
        "ok": false,
        "error": in_words(error),
        "key": problem.map(|problem| &problem.key).filter(|key| !key.is_empty()),
        "file": in_file.map(|location| &location.source),
        "line": in_file.and_then(|location| location.line),
        "column": in_file.map(|location| location.column),
        "option": in_option.map(|location| &location.source),
    })
}

fn report(options: &CheckOptions) -> anyhow::Result<Report> {
    let named = scene_argument::read(options.scene.scene.as_deref(), &options.scene.overrides())?;
    fetch_for(&named.scene, &stop_on_interrupt()?)?;
    let mut simulation = while_shown("setting up the scene", || Simulation::open(named.scene, &named.folder))??;
    let particles_at_start = simulation.model().particles();
    let particles_to_come = simulation.particles_to_come().round() as usize;
    let probe = Probe::run(&mut simulation)?;
    let estimated_wall_time_s = probe.estimate(&simulation);
    let (terrain, scene) = (simulation.terrain(), simulation.scene());
    let (run, kind) = (&scene.run, models::of(scene).map_err(corpuscle::Error::from)?);
    let terrain = terrain.map(|terrain| Ground::of(terrain));
    let cells = terrain.as_ref().map_or(0, |ground| ground.columns * ground.rows);
    let particles = (particles_at_start + particles_to_come) as f64;
    let rows = |period: f64| (run.until_s / period).ceil() as u64 + 1;
    Ok(Report {
        ok: true,
        title: if scene.title.is_empty() { named.short_name } else { scene.title.clone() },
        model: simulation.model().name(),
        terrain,
        particles_at_start,
        called: kind.particles(),
        particles_to_come,
        memory_bytes: particles * kind.bytes_per_particle(scene) + cells as f64 * BYTES_PER_CELL,
        time_step_s: probe.time_step.filter(|_| kind.work() != "collisions"),
        estimated_wall_time_s,
        until_s: run.until_s,
        frames: rows(run.frame_period_s()),
        gauge_rows: rows(run.gauge_period_s()),
        gauges: simulation.model().gauge_columns().iter().map(|column| column.header()).collect(),
        notes: simulation.notes().to_vec(),
        warnings: simulation.warnings(),
    })
}

/// Time step and rate of a trial run.
struct Probe {
    /// Mean time step, s; none where nothing moved.
    time_step: Option<f64>,
    /// The whole trial run.
    whole: Work,
    /// Its last part, in which something moved: at least half of its simulated time.
    last: Work,
}

/// Work and time of a part of a run.
#[derive(Debug, Clone, Copy, Default)]
struct Work {
    time: f64,
    steps: u64,
    particle_steps: u64,
    wall: f64,
}

impl Work {
    /// The work of a run from `start` to now.
    fn of(model: &dyn Model, start: Instant) -> Self {
        let wall = start.elapsed().as_secs_f64();
        Self { time: model.time(), steps: model.steps(), particle_steps: model.particle_steps(), wall }
    }

    fn since(self, before: Self) -> Self {
        Self {
            time: self.time - before.time,
            steps: self.steps - before.steps,
            particle_steps: self.particle_steps - before.particle_steps,
            wall: self.wall - before.wall,
        }
    }
}

impl Probe {
    /// Runs the scene for some steps, or [`PROBE`] of wall-clock time.
    fn run(simulation: &mut Simulation) -> Result<Self, corpuscle::Error> {
        let end = simulation.scene().run.until_s;
        let stop = Arc::new(AtomicBool::new(false));
        let timer = stop.clone();
        thread::spawn(move || {
            thread::sleep(PROBE);
            timer.store(true, Ordering::Relaxed);
        });
        let start = Instant::now();
        let comes = simulation.particles_to_come() > 0.0;
        let model = simulation.model_mut();
        // Where water is to come the start alone says little.
        let enough =
            |model: &dyn Model| !comes && model.particle_steps() >= PROBE_STEPS * model.particles().max(1) as u64;
        let mut until = SHORTEST_PROBE * end;
        let [mut now, mut last] = [Work::default(); 2];
        while !enough(model) && model.time() < end && !stop.load(Ordering::Relaxed) {
            model.advance_to(until.min(end), &stop)?;
            until *= 2.0;
            let before = std::mem::replace(&mut now, Work::of(model, start));
            let part = now.since(before);
            if part.particle_steps > 0 && part.time > 0.0 {
                last = part;
            }
        }
        let moved = now.steps > 0 && now.time > 0.0;
        Ok(Self { time_step: moved.then(|| now.time / now.steps as f64), whole: now, last })
    }

    /// Estimated wall-clock time of the whole run, s. It assumes that the particles to come enter when the scene says and
    /// stay, and that time step and rate are those at the end of the trial run.
    fn estimate(&self, simulation: &Simulation) -> Option<f64> {
        let Self { whole, last, .. } = self;
        self.time_step?;
        let (now, until) = (simulation.model().time(), simulation.scene().run.until_s);
        if simulation.particles_to_come() == 0.0 {
            return Some(whole.wall / whole.time * until);
        }
        if last.particle_steps == 0 {
            return None;
        }
        let part = (until - now) / ESTIMATE_PARTS as f64;
        let particles = |k: usize| {
            simulation.model().particles() as f64 + simulation.particles_to_come_until(now + (k as f64 + 0.5) * part)
        };
        let mean = (0..ESTIMATE_PARTS).map(particles).sum::<f64>() / ESTIMATE_PARTS as f64;
        let [steps_per_time, wall_per_step] = [last.steps as f64 / last.time, last.wall / last.particle_steps as f64];
        Some(whole.wall + mean * (until - now) * steps_per_time * wall_per_step)
    }
}

/// The result as text.
fn text(report: &Report) -> String {
    let Report { title, model, terrain, .. } = report;
    let mut lines = vec![format!("{title} ({model})")];
    lines.extend(terrain.as_ref().map(ground_line));
    lines.extend([
        particles_line(report),
        format!("memory     about {} MB", number((report.memory_bytes / 1e6).ceil())),
        format!(
            "run        {} s, {} frames, {} gauge rows of {} values",
            number(report.until_s),
            report.frames,
            report.gauge_rows,
            report.gauges.len()
        ),
    ]);
    if let Some(step) = report.time_step_s {
        lines.push(format!("time step  {} s at the start", number(step)));
    }
    if let Some(wall_time) = report.estimated_wall_time_s {
        lines.push(format!("will take  about {} here", duration(wall_time)));
    }
    lines.extend(report.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(report.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.join("\n") + "\n"
}

fn particles_line(report: &Report) -> String {
    let Report { called, particles_at_start, particles_to_come, .. } = report;
    match &report.terrain {
        Some(_) => format!("{called:10} {particles_at_start} at the start, about {particles_to_come} to come"),
        None => format!("{called:10} {particles_at_start} at the start"),
    }
}

fn ground_line(ground: &Ground) -> String {
    let ([width, height], [cell_x, cell_y]) = (ground.size_m.map(number), ground.cell_m.map(number));
    format!("terrain    {width} x {height} m, {} x {} cells of {cell_x} x {cell_y} m", ground.columns, ground.rows)
}
