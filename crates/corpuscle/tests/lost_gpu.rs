//! A GPU that is lost at any moment, amid steps or amid a picture: told in a line, and the run goes on from its checkpoint.
#![cfg(all(feature = "gpu", feature = "pictures"))]

use corpuscle::gpu::{Gpu, require_gpu};
use corpuscle::output::{FrameFormat, Status, Summary};
use corpuscle::pictures::{PictureSettings, Pictures};
use corpuscle::scene::{Scene, builtin};
use corpuscle::{Error, Recorder, Simulation, Sink};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// A scene that runs a second or some on software in place of a GPU.
struct Case {
    scene: &'static str,
    changes: &'static [(&'static str, &'static str)],
    /// Particles of the resumed run are those of the whole run to the bit. Not by scheme sph-swe, nor of dew: see the page on fuzzing.
    same_frames: bool,
}

const CASES: [Case; 3] = [
    Case {
        scene: "flood/dam-break",
        changes: &[("flood.spacing_m", "3"), ("run.until_s", "6"), ("run.gauge_every_s", "0.5")],
        same_frames: true,
    },
    Case {
        scene: "flood/cuboid",
        changes: &[("run.until_s", "2.2"), ("run.gauge_every_s", "0.1")],
        same_frames: false,
    },
    Case {
        scene: "dew/pane",
        changes: &[("dew.spacing_m", "0.003"), ("run.until_s", "0.15"), ("run.gauge_every_s", "0.01")],
        same_frames: false,
    },
];

impl Case {
    fn open(&self) -> Simulation {
        let often = ("run.checkpoint_every_wall_s".to_owned(), "0.05".to_owned());
        let changes = self.changes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
        let changes: Vec<_> = changes.chain([often]).collect();
        let scene = Scene::parse(builtin(self.scene).unwrap().text, self.scene, &changes).unwrap();
        Simulation::open(scene, Path::new("")).unwrap()
    }

    /// A run on the GPU into a folder, recorded. With `lost` the GPU is lost amid it: at that part of the run's time, and so much later.
    fn record(&self, folder: &Path, gpu: &Gpu, lost: Option<(f64, Duration)>) -> Result<Summary, Error> {
        let mut simulation = self.open();
        simulation.use_this_gpu(gpu.clone()).unwrap();
        let mut recorder = Recorder::create(folder, &simulation, FrameFormat::Csv).unwrap();
        let Some((part, later)) = lost else { return run(&mut simulation, &mut recorder) };
        let until = simulation.scene().run.until_s;
        let (reached, waits) = mpsc::channel();
        thread::scope(move |threads| {
            threads.spawn(move || take_away(gpu, waits, later));
            simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |progress| {
                if progress.time >= part * until {
                    _ = reached.send(());
                }
            })
        })
    }
}

fn run(simulation: &mut Simulation, sink: &mut dyn Sink) -> Result<Summary, Error> {
    simulation.run(&mut [sink], &AtomicBool::new(false), &mut |_| {})
}

/// Takes a GPU away a moment after the first message, if one comes.
fn take_away(gpu: &Gpu, message: mpsc::Receiver<()>, later: Duration) {
    if message.recv().is_ok() {
        thread::sleep(later);
        gpu.device.destroy();
    }
}

/// The numbers of a run's gauges, row by row; -1 where there is no value yet.
fn gauges(folder: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder.join("gauges.csv")).unwrap();
    let number = |field: &str| field.parse().ok().filter(|number: &f64| number.is_finite()).unwrap_or(-1.0);
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(|line| line.split(',').map(number).collect()).collect()
}

/// The particle files of a run, by name.
fn frames(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let files = fs::read_dir(folder.join("frames")).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.map(|path| (path.display().to_string(), fs::read(&path).unwrap())).collect();
    files.iter_mut().for_each(|(name, _)| *name = name.rsplit('/').next().unwrap_or_default().to_owned());
    files.sort();
    files
}

/// Takes the GPU away `count` times, at moments spread over the run, and resumes each time.
fn lose(case: &Case, count: u32) {
    if require_gpu("a GPU that is lost").is_none() {
        return;
    }
    let root = tempfile::tempdir().unwrap();
    let whole = root.path().join("whole");
    assert_eq!(case.record(&whole, &Gpu::open().unwrap(), None).unwrap().status, Status::Done);
    let (expected, expected_frames) = (gauges(&whole), frames(&whole));
    assert!(expected_frames.len() > 1);
    let (mut lost, mut resumed) = (0, 0);
    for number in 0..count {
        let folder = root.path().join(format!("{number}"));
        let part = (f64::from(number) + 0.5) / f64::from(count);
        let later = Duration::from_millis(u64::from(number * 7 % 20));
        let told = match case.record(&folder, &Gpu::open().unwrap(), Some((part, later))) {
            // It was over a moment later.
            Ok(summary) => {
                assert_eq!(summary.status, Status::Done);
                continue;
            }
            Err(error) => error.to_string(),
        };
        lost += 1;
        assert!(told.contains("gave no answer: it was lost"), "{told}");
        let summary = fs::read_to_string(folder.join("summary.json")).unwrap();
        assert!(summary.contains("\"failed\""), "{summary}");
        let before = gauges(&folder);
        assert_eq!(before, expected[..before.len()], "{}", case.scene);
        let shown = frames(&folder);
        assert!(shown == expected_frames[..shown.len()], "{}: frames before the loss differ", case.scene);
        match Recorder::resume(&folder) {
            Ok((mut simulation, mut recorder)) => {
                simulation.use_gpu().unwrap();
                assert_eq!(run(&mut simulation, &mut recorder).unwrap().status, Status::Done);
                assert_eq!(gauges(&folder), expected, "{} lost at {part} and {later:?} later", case.scene);
                let is_same = !case.same_frames || frames(&folder) == expected_frames;
                assert!(is_same, "{}: frames differ, lost at {part}", case.scene);
                resumed += 1;
            }
            // Before the first checkpoint.
            Err(error) => assert!(!folder.join("checkpoint/state").exists(), "{error}"),
        }
        fs::remove_dir_all(&folder).unwrap();
    }
    println!("{}: lost {lost} times amid a run, {resumed} times after a checkpoint and resumed", case.scene);
    assert!(2 * resumed >= count, "{resumed} of {count} were resumed");
}

#[test]
fn a_run_whose_gpu_is_lost_amid_steps_goes_on_from_its_checkpoint() {
    CASES.iter().for_each(|case| lose(case, 2));
}

#[test]
#[ignore = "takes long: 100 moments for each model"]
fn a_run_whose_gpu_is_lost_at_any_moment_goes_on_from_its_checkpoint() {
    CASES.iter().for_each(|case| lose(case, 100));
}

/// Draws pictures until the GPU is lost after a time; what is told then.
fn draw_until_lost(case: &Case, after: Duration) -> String {
    let gpu = Gpu::open().unwrap();
    let mut simulation = case.open();
    simulation.use_this_gpu(gpu.clone()).unwrap();
    let settings = PictureSettings { size: [320, 200], samples: 1, ..PictureSettings::default() };
    thread::scope(|threads| {
        threads.spawn(|| {
            thread::sleep(after);
            gpu.device.destroy();
        });
        let drawn = Pictures::open_on(&gpu, &simulation, settings).and_then(|mut pictures| {
            (0..100_000).try_for_each(|_| pictures.draw_model(simulation.model()).map(|_| ()))
        });
        drawn.unwrap_err().to_string()
    })
}

#[test]
fn a_gpu_lost_amid_a_picture_is_told() {
    if require_gpu("a GPU that is lost amid a picture").is_none() {
        return;
    }
    for case in &CASES {
        for wait in [0, 300, 1500] {
            let told = draw_until_lost(case, Duration::from_millis(wait));
            assert!(told.contains("gave no answer: it was lost"), "{}, {wait} ms: {told}", case.scene);
        }
    }
}
