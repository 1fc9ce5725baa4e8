//! The model of the example `ions`, which is added from outside: what the workbench does with it.

#[path = "../examples/ions/main.rs"]
mod ions;
#[allow(dead_code)]
#[path = "../../app/tests/stage/mod.rs"]
mod stage;

use corpuscle::model::Model;
use corpuscle::output::{FrameFormat, Status};
use corpuscle::pictures::{PictureSettings, Pictures};
use corpuscle::{Recorder, Simulation};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

fn open(changes: &[(&str, &str)]) -> Simulation {
    let changes: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    Simulation::open(ions::scene(&changes), Path::new("")).unwrap()
}

fn energy_error(model: &dyn Model) -> f64 {
    model.ledger().balances[0].relative_error().abs()
}

#[test]
fn it_is_run_and_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut simulation = open(&[]);
    let mut recorder = Recorder::create(&path, &simulation, FrameFormat::Vtp).unwrap();
    let summary = simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    assert!(summary.status == Status::Done && summary.model == "ions" && summary.particle_steps_per_s.unwrap() > 0.0);
    assert!(energy_error(simulation.model()) < 1e-12, "{}", energy_error(simulation.model()));
    let report = fs::read_to_string(path.join("report.html")).unwrap();
    for word in ["Argon ions in a magnetic field", "Mean velocity x", "Kinetic energy", "energy, J", "[ions]"] {
        assert!(report.contains(word), "{word}");
    }
    for file in ["gauges.csv", "frames/frames.pvd", "pictures/kinetic_energy_over_time.png", "summary.json"] {
        assert!(path.join(file).exists(), "{file}");
    }
}

#[test]
fn it_is_stopped_and_resumed_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut simulation = open(&[]);
    let mut recorder = Recorder::create(&path, &simulation, FrameFormat::None).unwrap();
    let stop = AtomicBool::new(false);
    let mut half = |progress: &corpuscle::Progress| stop.store(progress.time > 1e-3, Ordering::Relaxed);
    let summary = simulation.run(&mut [&mut recorder], &stop, &mut half).unwrap();
    assert!(summary.status == Status::Stopped && recorder.can_resume());
    let (mut simulation, mut recorder) = Recorder::resume(&path).unwrap();
    let summary = simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    assert_eq!(summary.status, Status::Done);
    let mut whole = open(&[]);
    whole.model_mut().advance_to(2e-3, &AtomicBool::new(false)).unwrap();
    assert_eq!(whole.model().frame(), simulation.model().frame());
}

#[test]
fn its_mistakes_are_told() {
    ions::register();
    let text = include_str!("../examples/ions/scene.toml").replace("field_t = 0.01", "field_t = -0.01");
    let error = corpuscle::scene::Scene::parse(&text, "ions.toml", &[]).unwrap_err().to_string();
    assert!(error.contains("ions.toml:16:11: ions.field_t = -0.01: must be larger than 0"), "{error}");
}

#[test]
fn its_case_is_kept() {
    ions::register();
    let cases = corpuscle_validate::cases();
    let rows = cases.iter().find(|case| case.name == "ions/turns").unwrap().rows(&Default::default());
    assert!(rows.len() == 2 && rows.iter().all(|row| row.pass == Some(true)), "{rows:?}");
}

#[test]
fn it_is_drawn() {
    let Some(gpu) = corpuscle::gpu::require_gpu("a picture of ions") else { return };
    let simulation = open(&[]);
    let settings = PictureSettings { size: [480, 270], ..PictureSettings::default() };
    let mut pictures = Pictures::open_on(&gpu, &simulation, settings.clone()).unwrap();
    let image = pictures.draw_model(simulation.model()).unwrap();
    if let Some(folder) = std::env::var_os("CORPUSCLE_SHOTS") {
        let file = Path::new(&folder).join("ions.png");
        corpuscle::output::write_picture(&file, [image.width, image.height], &image.rgba).unwrap();
    }
    // Some hundred balls are seen in their colour, and not where there are none.
    let is_blue = |pixel: &&[u8]| pixel[2] > pixel[0].saturating_add(60) && pixel[2] > pixel[1].saturating_add(20);
    let blue = image.rgba.chunks(4).filter(is_blue).count();
    let few = open(&[("ions.count", "4")]);
    let mut pictures = Pictures::open_on(&gpu, &few, settings).unwrap();
    let fewer = pictures.draw_model(few.model()).unwrap().rgba.chunks(4).filter(is_blue).count();
    assert!(blue > 500 && fewer < 50, "{blue} {fewer}");
}

#[test]
fn it_is_in_the_window() {
    ions::register();
    let soon = Duration::from_secs(30);
    let Some(mut stage) = stage::stage("ions in the window") else { return };
    stage.choose("Argon ions in a magnetic field");
    stage.until(soon, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 1e-5));
    stage.click("Pause");
    stage.until(soon, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
    stage.type_into("count, ", "100");
    stage.click("Restart with changes");
    stage
        .until(soon, "it has fewer ions", |window| window.snapshot().is_some_and(|snapshot| snapshot.particles == 100));
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
    stage.click("Pause");
    stage.until(Duration::from_secs(60), "all there is", corpuscle_app::Window::is_complete);
    stage.picture("ions-window");
}
