//! Without a GPU the window goes on while pictures are drawn that take long.

// Another test uses the rest of it.
#[allow(dead_code)]
mod stage;

use corpuscle::gpu::GpuKind;
use stage::{Stage, stage};
use std::time::{Duration, Instant};

const SOON: Duration = Duration::from_secs(90);

/// The valley in a window that stands at its start; none where a GPU draws, which is quick.
fn valley(test: &str) -> Option<Stage> {
    let mut stage = stage(test)?;
    if stage.screen.gpu.kind == GpuKind::Hardware {
        return None;
    }
    stage.window_mut().wait_at_start();
    stage.choose("A flood wave in a meandering valley");
    stage.until(SOON, "it is open", |window| !window.is_waiting() && window.snapshot().is_some());
    Some(stage)
}

/// Shows and draws the window until something holds of it, which must not keep it from going on: there are many pictures till then,
/// none of which takes a large part of that time.
fn goes_on_until(stage: &mut Stage, what: &str, holds: impl Fn(&Stage) -> bool) {
    let (start, mut pictures, mut longest) = (Instant::now(), 0, Duration::ZERO);
    while !holds(stage) {
        assert!(start.elapsed() < SOON, "not so after {SOON:?}: {what}; {:?}", stage.window().fault());
        let before = Instant::now();
        stage.picture(what);
        (pictures, longest) = (pictures + 1, longest.max(before.elapsed()));
    }
    let whole = start.elapsed();
    eprintln!("{what}: {pictures} pictures in {whole:?}, the longest {longest:?}");
    assert!(pictures > 5 && longest < whole / 3, "{what}: {pictures} pictures in {whole:?}, the longest {longest:?}");
}

#[test]
fn what_rests_gets_its_full_look_while_the_window_goes_on() {
    let Some(mut stage) = valley("the full look of a flood") else { return };
    assert!(!stage.window().is_complete());
    goes_on_until(&mut stage, "full look", |stage| stage.window().is_complete());
    let full = stage.picture("valley-full");
    // What changes is drawn simply at once.
    stage.key(egui::Key::T);
    assert!(!stage.window().is_complete());
    assert!(stage.picture("valley-plan").rgba != full.rgba && stage.window().fault().is_none());
}

#[test]
fn a_full_look_that_is_out_of_date_is_never_shown() {
    let Some(mut stage) = valley("an outdated look of a flood") else { return };
    let start = Instant::now();
    // The view changes while its picture is drawn, again and again.
    while start.elapsed() < Duration::from_secs(6) {
        stage.run(Duration::from_millis(450));
        stage.key(egui::Key::T);
        assert!(!stage.window().is_complete());
        let before = Instant::now();
        while before.elapsed() < Duration::from_millis(250) {
            stage.harness.step();
            assert!(!stage.window().is_complete(), "a picture of the view before");
        }
    }
}

#[test]
fn a_still_is_saved_while_it_plays_on() {
    let Some(mut stage) = valley("a still of a flood that plays") else { return };
    let folder = tempfile::tempdir().unwrap();
    stage.window_mut().save_into(folder.path().to_owned());
    stage.click("Play");
    stage.until(SOON, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 0.0));
    let from = stage.time();
    stage.click("Save a still");
    let file = folder.path().join("flood-valley.png");
    goes_on_until(&mut stage, "still", |_| file.exists());
    assert!(stage.time() > from && stage.window().fault().is_none());
    let size = std::fs::metadata(&file).unwrap().len();
    assert!(size > 100_000, "{size} bytes");
}

#[test]
fn the_window_closes_while_a_still_is_drawn_and_the_still_is_saved() {
    let Some(mut stage) = valley("closing while a still is drawn") else { return };
    let folder = tempfile::tempdir().unwrap();
    stage.window_mut().save_into(folder.path().to_owned());
    stage.click("Save a still");
    drop(stage);
    assert!(folder.path().join("flood-valley.png").exists());
}
