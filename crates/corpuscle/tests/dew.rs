//! Dew from a scene file to a run's folder: files, ledger and report; interrupted or not, the same.

use corpuscle::output::{FrameFormat, Status};
use corpuscle::scene::{Scene, builtin};
use corpuscle::{Recorder, Simulation};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// The scene of the guide's page on dew, for a shorter time.
fn scene() -> Scene {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/first-dew.md");
    let page = fs::read_to_string(page).unwrap();
    let text = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    // Drops so small are seen at once.
    let changes = [
        set("run.until_s", "0.02"),
        set("run.frame_every_s", "0.01"),
        set("dew.drops.smallest_radius_m", "5e-6"),
        set("dew.drops.sites_per_m2", "1e8"),
    ];
    Scene::parse(text, "first-dew.md", &changes).unwrap()
}

#[test]
fn a_run_leaves_its_files_and_is_the_same_when_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, parted] = ["whole", "parted"].map(|name| folder.path().join(name));
    let mut simulation = Simulation::open(scene(), Path::new("")).unwrap();
    let mut recorder = Recorder::create(&whole, &simulation, FrameFormat::Csv).unwrap();
    let summary = simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    assert_eq!((summary.status, summary.model.as_str()), (Status::Done, "dew"));
    for quantity in ["water_kg", "energy_J"] {
        assert!(summary.ledger[quantity].relative_error.abs() < 1e-10, "{:?}", summary.ledger);
    }
    let report = fs::read_to_string(whole.join("report.html")).unwrap();
    assert!(report.contains("First drop") && report.contains("drops cover") && report.contains("true to scale"));

    let mut simulation = Simulation::open(scene(), Path::new("")).unwrap();
    let mut recorder = Recorder::create(&parted, &simulation, FrameFormat::Csv).unwrap();
    let stop = AtomicBool::new(false);
    let halfway = &mut |progress: &corpuscle::Progress| stop.store(progress.time > 0.008, Ordering::Relaxed);
    let summary = simulation.run(&mut [&mut recorder], &stop, halfway).unwrap();
    assert_eq!(summary.status, Status::Stopped);
    let (mut simulation, mut recorder) = Recorder::resume(&parted).unwrap();
    simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    for file in ["gauges.csv", "frames/frame_000001.csv", "frames/frame_000002.csv", "scene.toml"] {
        let [whole, parted] = [&whole, &parted].map(|folder| fs::read_to_string(folder.join(file)).unwrap());
        assert_eq!(whole, parted, "{file}");
        assert!(!whole.is_empty());
    }
}

#[test]
fn the_report_of_much_air_in_motion_shows_it() {
    let folder = tempfile::tempdir().unwrap();
    let text = builtin("dew/three-boundaries").unwrap().text;
    let changes =
        ["run.until_s", "run.frame_every_s", "run.gauge_every_s"].map(|key| (key.to_owned(), "5e-4".to_owned()));
    let mut simulation =
        Simulation::open(Scene::parse(text, "three-boundaries", &changes).unwrap(), Path::new("")).unwrap();
    let run = folder.path().join("run");
    let mut recorder = Recorder::create(&run, &simulation, FrameFormat::Csv).unwrap();
    simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    let report = fs::read_to_string(run.join("report.html")).unwrap();
    assert!(report.contains("A slice through the middle of the box") && report.contains("Vacuum before the surface"));
    assert!(run.join("pictures/air.png").exists());
}
