//! What steps on the device that draws the window is drawn where it lies.

// Another test uses the rest of it.
#[allow(dead_code)]
mod stage;

use corpuscle::scene::builtin;
use corpuscle_app::{Snapshot, Source};
use stage::{Stage, stage_of_gpu};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

const SOON: Duration = Duration::from_secs(90);
/// Each has a device of its own, which takes all of the machine where software stands in for a GPU: one at a time.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A dam that breaks, on the GPU, playing.
fn dam(test: &str) -> Option<Stage> {
    let changes = [("flood.spacing_m", "2"), ("run.until_s", "200")];
    playing(test, "flood/dam-break", &changes)
}

/// A built-in scene with changes, on the GPU, playing, in the simple look, which is quicker without a GPU.
fn playing(test: &str, name: &str, changes: &[(&str, &str)]) -> Option<Stage> {
    let mut stage = stage_of_gpu(test)?;
    let changes = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    stage.window_mut().wait_at_start();
    stage.window_mut().open(Source { changes, ..builtin(name).unwrap().into() });
    stage.until(SOON, "it is open", |window| !window.is_waiting() && window.snapshot().is_some());
    stage.key(egui::Key::Num2);
    stage.click("Play");
    stage.until(SOON, "it goes on", |window| window.snapshot().is_some_and(goes_on));
    Some(stage)
}

/// Whether it is seen where it goes on.
fn goes_on(snapshot: Arc<Snapshot>) -> bool {
    snapshot.playing && snapshot.frame.time > 0.0 && !Arc::ptr_eq(&snapshot.frame, &snapshot.known)
}

#[test]
fn what_goes_on_is_drawn_where_it_lies_and_comes_back_when_it_waits() {
    let _alone = alone();
    let Some(mut stage) = dam("a flood on the GPU in the window") else { return };
    stage.key(egui::Key::Num3);
    let first = stage.window().snapshot().unwrap();
    // Rows of gauges come, and nothing else does.
    let later = |window: &corpuscle_app::Window| {
        let snapshot = window.snapshot().unwrap();
        snapshot.measures.time > first.measures.time && snapshot.frame.time > first.frame.time
    };
    stage.until(SOON, "gauges come", later);
    let now = stage.window().snapshot().unwrap();
    assert!(goes_on(now.clone()) && Arc::ptr_eq(&now.known, &first.known) && now.particles > 1000, "{now:?}");
    assert!(now.measures.gauges.len() == now.measures.names.len() && !now.measures.names.is_empty());
    let before = stage.picture("gpu-plays");
    stage.until(SOON, "water moves", |window| window.snapshot().unwrap().frame.time > now.frame.time + 0.5);
    assert!(stage.picture("gpu-plays-on").rgba != before.rgba);
    stage.click("Pause");
    stage.until(SOON, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
    let waits = stage.window().snapshot().unwrap();
    assert!(Arc::ptr_eq(&waits.known, &waits.frame) && waits.known.sets[0].len() == waits.particles);
    assert!(waits.frame.time == waits.measures.time && waits.on_device.is_some());
    stage.click("One step");
    stage.until(SOON, "it steps", |window| window.snapshot().unwrap().frame.time > waits.frame.time);
    stage.picture("gpu-waits");
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

#[test]
fn who_is_followed_comes_back_again_and_again_and_nobody_else_does() {
    let _alone = alone();
    let Some(mut stage) = dam("a particle of a flood on the GPU") else { return };
    let known = |window: &corpuscle_app::Window| window.snapshot().unwrap().known.time;
    // A particle is clicked on while it goes on, and with it the ground below.
    let before = known(stage.window());
    assert!(!stage.has("Stop following"));
    stage.click_picture([0.29, 0.39]);
    let told =
        |window: &corpuscle_app::Window| window.snapshot().unwrap().probed.is_some_and(|water| water.depth > 5.0);
    stage.until(SOON, "the spot tells of the water", told);
    assert!(stage.has("Stop following") && known(stage.window()) > before);
    let mut came = Vec::new();
    for _ in 0..3 {
        let from = known(stage.window());
        stage.until(SOON, "it is followed", |window| known(window) > from && window.snapshot().is_some_and(goes_on));
        came.push(Instant::now());
    }
    assert!(stage.has("Stop following") && !stage.has("The particle no longer exists."));
    stage.picture("gpu-follows");
    stage.key(egui::Key::Escape);
    // Nothing comes back any more, for longer than it took before.
    let long = (came[2] - came[0]).mul_f64(1.5);
    let (start, mut from, mut since) = (Instant::now(), known(stage.window()), Instant::now());
    while since.elapsed() < long {
        stage.run(Duration::from_millis(30));
        if known(stage.window()) != from {
            (from, since) = (known(stage.window()), Instant::now());
        }
        assert!(start.elapsed() < SOON, "it still comes back");
    }
    let now = stage.window().snapshot().unwrap();
    assert!(goes_on(now.clone()), "{} {} {:?}", now.playing, now.frame.time, stage.window().fault());
}

#[test]
fn a_film_is_made_of_what_lies_on_the_gpu() {
    let _alone = alone();
    let Some(mut stage) = dam("a film of a flood on the GPU") else { return };
    let folder = tempfile::tempdir().unwrap();
    stage.window_mut().save_into(folder.path().to_owned());
    stage.click("Record a film");
    let from = stage.time();
    stage.until(SOON, "it goes on", |window| window.snapshot().is_some_and(|now| now.frame.time > from + 0.8));
    assert!(stage.window().snapshot().is_some_and(goes_on));
    stage.click("End the film");
    let is_there = || {
        std::fs::read_dir(folder.path())
            .unwrap()
            .flatten()
            .any(|file| file.path().extension().is_some_and(|end| end == "mp4"))
    };
    stage.until(SOON, "the film is there", |_| is_there());
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

#[test]
fn dew_on_the_gpu_shows_its_drops_and_where_air_is_seen_the_air() {
    let _alone = alone();
    for (name, sees_air) in [("dew/pane", false), ("dew/three-boundaries", true)] {
        let Some(mut stage) = playing("dew on the GPU in the window", name, &[]) else { return };
        let first = stage.window().snapshot().unwrap();
        let later = |window: &corpuscle_app::Window| {
            let now = window.snapshot().unwrap();
            goes_on(now.clone()) && now.frame.time > first.frame.time && now.measures.time > first.measures.time
        };
        stage.until(SOON, "it goes on", later);
        let now = stage.window().snapshot().unwrap();
        assert!(
            now.on_device.is_some() == sees_air
                && now.frame.sets.iter().all(|set| ["drops", "unseen"].contains(&set.name.as_str()))
        );
        assert!(now.particles > 300 && Arc::ptr_eq(&now.known, &first.known));
        stage.picture(if sees_air { "gpu-air" } else { "gpu-pane" });
        stage.click("Pause");
        stage.until(SOON, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
        let waits = stage.window().snapshot().unwrap();
        // All of it has come back.
        assert!(waits.known.sets.iter().any(|set| set.name == "air" && set.len() > 200) && waits.particles > 300);
        assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
    }
}

#[test]
fn water_that_is_still_to_come_comes() {
    let _alone = alone();
    let Some(mut stage) = playing("a valley on the GPU in the window", "flood/valley", &[]) else { return };
    stage.until(SOON, "water comes", |window| {
        window.snapshot().is_some_and(|now| goes_on(now.clone()) && now.known.sets[0].is_empty() && now.particles > 20)
    });
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}
