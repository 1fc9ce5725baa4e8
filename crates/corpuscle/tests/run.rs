//! The run loop, with a small model whose every step can be counted.

use corpuscle::model::{Balance, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet};
use corpuscle::output::{Clock, FrameFormat, OutputError, Status, Summary};
use corpuscle::scene::Scene;
use corpuscle::terrain::Terrain;
use corpuscle::{Error, Progress, Recorder, Simulation, Sink};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A number that a map without pattern moves in steps of 0.01 s.
struct Counter {
    shown: f64,
    steps: u64,
    value: f64,
    /// The step at which it stops itself, or breaks down.
    stop_at: Option<u64>,
    break_at: Option<u64>,
    /// The step from which on it shows a velocity that is not a number, and does not notice.
    nan_from: Option<u64>,
}

const STEP: f64 = 0.01;

impl Counter {
    fn new() -> Self {
        Self { shown: 0.0, steps: 0, value: 0.3, stop_at: None, break_at: None, nan_from: None }
    }
}

impl Model for Counter {
    fn name(&self) -> &'static str {
        "flood"
    }
    fn time(&self) -> f64 {
        self.shown
    }
    fn steps(&self) -> u64 {
        self.steps
    }
    fn particle_steps(&self) -> u64 {
        self.steps
    }
    fn particles(&self) -> usize {
        1
    }
    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.steps as f64 * STEP < time {
            if self.stop_at == Some(self.steps) {
                stop.store(true, Ordering::Relaxed);
            }
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            if self.break_at == Some(self.steps) {
                return Err(ModelError::Breakdown { time: self.shown, step: self.steps, what: "on purpose".into() });
            }
            self.value = 3.9 * self.value * (1.0 - self.value);
            self.steps += 1;
            self.shown = self.shown.max((self.steps as f64 * STEP).min(time));
        }
        self.shown = time;
        Ok(())
    }
    fn frame(&self) -> Frame {
        let position = vec![[self.value, self.shown, 0.0]];
        let one = vec![1.0];
        let speed = if self.nan_from.is_some_and(|step| self.steps >= step) { f64::NAN } else { 0.0 };
        let set = ParticleSet {
            name: "water".into(),
            id: vec![7],
            position,
            velocity: vec![[speed, 0.0, 0.0]],
            radius: one.clone(),
            mass: one,
            columns: Vec::new(),
        };
        Frame { time: self.shown, sets: vec![set] }
    }
    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        vec![GaugeColumn { gauge: "P1".into(), quantity: "depth", unit: "m" }]
    }
    fn gauge_row(&self) -> Vec<f64> {
        vec![self.value]
    }
    fn maps(&self) -> Vec<Map> {
        let values = vec![self.value as f32; 100];
        ["depth", "max_depth"]
            .map(|name| Map { name, title: "Depth", unit: "m", columns: 10, rows: 10, values: values.clone() })
            .into()
    }
    fn ledger(&self) -> Ledger {
        Ledger {
            balances: vec![Balance {
                quantity: "water_m3",
                initial: 1.0,
                inflow: 0.0,
                outflow: 0.0,
                now: 1.0,
                least: 0.0,
            }],
        }
    }
    fn warnings(&self) -> Vec<String> {
        vec!["a model made for tests".into()]
    }
    fn save(&self) -> Vec<u8> {
        [self.shown, self.steps as f64, self.value].iter().flat_map(|value| value.to_le_bytes()).collect()
    }
    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let values: Vec<f64> =
            state.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
        (self.shown, self.steps, self.value) = (values[0], values[1] as u64, values[2]);
        Ok(())
    }
}

const SCENE: &str = "
[run]
until_s = 2.0
frame_every_s = 0.5
gauge_every_s = 0.3
[terrain.plane]
extent = { length_m = 10.0, width_m = 10.0, cell_m = 1.0 }
[flood]
";

fn simulation(model: Counter) -> Simulation {
    let mut scene = Scene::parse(SCENE, "test.toml", &[]).unwrap();
    scene.resolve_defaults();
    let terrain = Terrain::open(&scene.flood().unwrap().terrain, scene.seed, Path::new("")).unwrap();
    Simulation::new(scene, Some(Arc::new(terrain)), Box::new(model))
}

/// Notes when it was called.
#[derive(Default)]
struct Notes {
    gauges: Vec<f64>,
    frames: Vec<f64>,
    checkpoint: Option<(Clock, Vec<u8>)>,
    finished: Vec<Status>,
    fail_at_frame: Option<usize>,
}

impl Sink for Notes {
    fn gauges(&mut self, time: f64, _row: &[f64]) -> Result<(), Error> {
        self.gauges.push(time);
        Ok(())
    }
    fn frame(&mut self, model: &dyn Model) -> Result<(), Error> {
        if self.fail_at_frame == Some(self.frames.len()) {
            let source = std::io::ErrorKind::StorageFull.into();
            return Err(OutputError::Write { path: "frame".into(), source }.into());
        }
        self.frames.push(model.time());
        Ok(())
    }
    fn checkpoint(&mut self, model: &dyn Model, clock: Clock) -> Result<(), Error> {
        self.checkpoint = Some((clock, model.save()));
        Ok(())
    }
    fn finish(&mut self, _model: &dyn Model, summary: &mut Summary) -> Result<(), Error> {
        self.finished.push(summary.status);
        Ok(())
    }
}

fn run(simulation: &mut Simulation, sink: &mut dyn Sink) -> Result<Summary, Error> {
    simulation.run(&mut [sink], &AtomicBool::new(false), &mut |_| {})
}

#[test]
fn gauges_and_frames_come_at_multiples_of_their_periods_and_at_both_ends() {
    let mut notes = Notes::default();
    let summary = run(&mut simulation(Counter::new()), &mut notes).unwrap();
    assert_eq!(notes.gauges, [0.0, 0.3, 0.6, 3.0 * 0.3, 4.0 * 0.3, 1.5, 6.0 * 0.3, 2.0]);
    assert_eq!(notes.frames, [0.0, 0.5, 1.0, 1.5, 2.0]);
    assert_eq!(notes.finished, [Status::Done]);
    assert_eq!((summary.simulated_time_s, summary.steps), (2.0, 200));
    assert_eq!(summary.warnings.last().unwrap(), "a model made for tests");
    assert_eq!(summary.ledger["water_m3"].relative_error, 0.0);
}

#[test]
fn progress_rises_to_one() {
    let mut seen = Vec::new();
    let mut note = |progress: &Progress| seen.push((progress.fraction(), progress.left_s.unwrap()));
    simulation(Counter::new()).run(&mut [], &AtomicBool::new(false), &mut note).unwrap();
    assert!(seen.windows(2).all(|pair| pair[0].0 < pair[1].0));
    assert_eq!(*seen.last().unwrap(), (1.0, 0.0));
}

/// All files of a folder but the checkpoint, the log, and those that tell the wall-clock time, by name.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for sub in ["", "frames", "maps"] {
        for entry in std::fs::read_dir(folder.join(sub)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().display().to_string();
            if path.is_file() && !["summary.json", "report.html", "log.txt"].contains(&name.as_str()) {
                found.push((name, std::fs::read(path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn an_interrupted_and_resumed_run_gives_the_same_bytes_wherever_it_was_interrupted() {
    let temporary = tempfile::tempdir().unwrap();
    let whole = temporary.path().join("whole");
    let mut undisturbed = simulation(Counter::new());
    let mut recorder = Recorder::create(&whole, &undisturbed, FrameFormat::Csv).unwrap();
    run(&mut undisturbed, &mut recorder).unwrap();
    let expected = files(&whole);
    assert!(expected.iter().any(|(name, _)| name == "frames/frame_000004.csv"), "{expected:?}");

    for stop_at in [0, 1, 29, 30, 31, 50, 120, 199] {
        let folder = temporary.path().join(format!("stopped-{stop_at}"));
        let mut stopped = simulation(Counter { stop_at: Some(stop_at), ..Counter::new() });
        let mut recorder = Recorder::create(&folder, &stopped, FrameFormat::Csv).unwrap();
        let summary = run(&mut stopped, &mut recorder).unwrap();
        assert_eq!(summary.status, Status::Stopped);
        assert_eq!(Summary::read(&folder).unwrap(), summary);
        assert_ne!(files(&folder), expected);
        drop(recorder);

        // Rows written after the checkpoint, as by a run that was killed, are cut off.
        let gauges = folder.join("gauges.csv");
        let rows = std::fs::read_to_string(&gauges).unwrap() + "1.9,0.123\n1.95,0.1";
        std::fs::write(&gauges, rows).unwrap();
        let (mut resumed, mut recorder) = Recorder::resume_with(&folder, |_| Ok(simulation(Counter::new()))).unwrap();
        assert_eq!(run(&mut resumed, &mut recorder).unwrap().status, Status::Done);
        assert_eq!(files(&folder), expected, "stopped at step {stop_at}");
    }
}

#[test]
fn a_breakdown_is_told_and_the_sinks_are_finished() {
    let mut notes = Notes::default();
    let error = run(&mut simulation(Counter { break_at: Some(120), ..Counter::new() }), &mut notes).unwrap_err();
    assert!(error.to_string().contains("on purpose") && !error.is_refusal(), "{error}");
    assert_eq!(notes.finished, [Status::Failed]);
    assert_eq!(notes.frames, [0.0, 0.5, 1.0]);
}

#[test]
fn a_frame_with_a_value_that_is_not_a_number_is_not_written_and_ends_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut simulation = simulation(Counter { nan_from: Some(60), ..Counter::new() });
    let mut recorder = Recorder::create(&path, &simulation, FrameFormat::Csv).unwrap();
    let error = run(&mut simulation, &mut recorder).unwrap_err();
    let told = error.to_string();
    let is_told = ["velocity of `water` 7 at [", "t = 1 s", "NaN"].iter().all(|word| told.contains(word));
    assert!(is_told && !error.is_refusal(), "{told}");
    let mut frames: Vec<_> =
        std::fs::read_dir(path.join("frames")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    frames.sort();
    assert_eq!(frames, ["frame_000000.csv", "frame_000001.csv"]);
    assert_eq!(Summary::read(&path).unwrap().status, Status::Failed);
}

#[test]
fn a_sink_that_fails_ends_the_run_and_the_others_are_finished() {
    let mut failing = Notes { fail_at_frame: Some(2), ..Notes::default() };
    let mut other = Notes::default();
    let stop = AtomicBool::new(false);
    let error = simulation(Counter::new()).run(&mut [&mut other, &mut failing], &stop, &mut |_| {}).unwrap_err();
    assert!(matches!(error, Error::Output(OutputError::Write { .. })) && !error.is_refusal(), "{error}");
    assert_eq!((failing.finished, other.finished), (vec![Status::Failed], vec![Status::Failed]));
}

#[test]
fn a_stop_asked_for_before_the_start_keeps_the_state() {
    let mut notes = Notes::default();
    let summary = simulation(Counter::new()).run(&mut [&mut notes], &AtomicBool::new(true), &mut |_| {}).unwrap();
    assert_eq!((summary.status, summary.simulated_time_s), (Status::Stopped, 0.0));
    assert_eq!(notes.checkpoint.unwrap().0.time_s, 0.0);
    assert_eq!(notes.gauges, [0.0]);
}

#[test]
fn checkpoints_come_by_the_wall_clock() {
    let mut scene = simulation(Counter::new());
    let mut notes = Notes::default();
    run(&mut scene, &mut notes).unwrap();
    assert_eq!(notes.checkpoint.take().unwrap().0.time_s, 0.0, "60 s have not passed since the first");
    let overrides = [("run.checkpoint_every_wall_s".to_owned(), "1e-9".to_owned())];
    let eager = Scene::parse(SCENE, "test.toml", &overrides).unwrap();
    let terrain = scene.terrain().cloned();
    run(&mut Simulation::new(eager, terrain, Box::new(Counter::new())), &mut notes).unwrap();
    assert_eq!(notes.checkpoint.unwrap().0.time_s, 2.0);
}
