//! The window, clicked through off screen.

mod stage;

use stage::{stage, stage_of_software, stage_without_device};
use std::time::Duration;

const SOON: Duration = Duration::from_secs(30);

#[test]
fn a_gas_is_opened_played_paused_stepped_and_started_again() {
    let Some(mut stage) = stage("a gas in the window") else { return };
    stage.click("Maxwell's speeds");
    stage.until(SOON, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 0.02));
    stage.click("Pause");
    stage.until(SOON, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
    let waiting = stage.time();
    stage.run(Duration::from_millis(200));
    assert_eq!(stage.time(), waiting);
    stage.click("One step");
    stage.until(SOON, "it steps", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > waiting));
    stage.picture("gas");
    stage.click("Restart");
    stage.until(SOON, "it starts again", |window| {
        window.snapshot().is_some_and(|snapshot| snapshot.frame.time < waiting)
    });
}

#[test]
fn a_gas_is_heated_and_its_parameters_wait_for_a_restart() {
    let Some(mut stage) = stage("heating a gas") else { return };
    stage.click("Free expansion");
    stage.until(SOON, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 0.0));
    stage.key(egui::Key::Space);
    stage.until(SOON, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
    let energy = |window: &corpuscle_app::Window| {
        let snapshot = window.snapshot().unwrap();
        snapshot.frame.sets.iter().flat_map(|set| &set.velocity).flatten().map(|along| along * along).sum::<f64>()
    };
    let before = energy(stage.window());
    stage.click("Heat");
    stage.until(SOON, "it is hotter", |window| energy(window) > 1.14 * before && energy(window) < 1.16 * before);
    stage.click("Lift the partition");
    assert!(stage.has("The partition is lifted") && stage.window().fault().is_none());
    // A change of the scene is offered, and taken by a restart.
    assert!(!stage.has("Restart with changes"));
    stage.type_into("Number, ", "300");
    stage.click("Restart with changes");
    stage.until(SOON, "it has fewer balls", |window| {
        window.snapshot().is_some_and(|snapshot| snapshot.particles == 300)
    });
    assert!(!stage.has("Restart with changes"));
}

#[test]
fn balls_are_put_in_a_temperature_is_held_and_a_piston_dragged() {
    let Some(mut stage) = stage("a gas in a hand") else { return };
    stage.choose("A piston falls onto a gas");
    let count = |window: &corpuscle_app::Window| window.snapshot().map_or(0, |snapshot| snapshot.particles);
    stage.until(SOON, "it plays", |window| !window.is_waiting() && gauge(window, "gas.packing") > 0.0);
    // Nobody drags the piston: it moves.
    stage.until(SOON, "it moves", |window| gauge(window, "x_max.velocity") < -1e-3);
    assert!(!stage.has("Release"));
    let before = count(stage.window());
    let part = (before as f64 * 0.1).round() as usize;
    stage.click(&format!("Add {part}"));
    stage.until(SOON, "there are more", |window| count(window) == before + part);
    stage.click("Hold the temperature");
    stage.run(Duration::from_millis(300));
    assert!(stage.has_beginning("Release the temperature") && stage.window().fault().is_none());
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

#[test]
fn a_flood_and_dew_are_opened_and_play() {
    let Some(mut stage) = stage("flood and dew in the window") else { return };
    for (title, name, least) in [("A lake at rest over a hill", "flood", 1e-3), ("A cold pane", "dew", 1e-3)] {
        stage.choose(title);
        let plays = |window: &corpuscle_app::Window| {
            !window.is_waiting() && window.snapshot().is_some_and(|snapshot| snapshot.frame.time > least)
        };
        stage.until(SOON, title, plays);
        stage.run(Duration::from_millis(1500));
        stage.key(egui::Key::Space);
        stage.until(SOON, "it waits", |window| window.snapshot().is_some_and(|snapshot| !snapshot.playing));
        stage.run(Duration::from_millis(600));
        assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
        stage.picture(name);
    }
}

#[test]
fn software_draws_the_same_window() {
    let (Some(mut usual), Some(mut quick)) = (stage("the window"), stage_of_software("the window of software")) else {
        return;
    };
    // The first page, and the keys over it.
    for page in ["first-page", "keys"] {
        let [one, other] = [(&mut usual, ""), (&mut quick, "-of-software")].map(|(stage, name)| {
            stage.run(Duration::from_millis(300));
            stage.picture(&format!("{page}{name}")).rgba
        });
        let off: Vec<_> = one.iter().zip(&other).map(|(one, other)| one.abs_diff(*other)).collect();
        let mean = off.iter().map(|off| f64::from(*off)).sum::<f64>() / off.len() as f64;
        let far = off.iter().filter(|off| **off > 16).count() as f64 / off.len() as f64;
        assert!(mean < 0.3 && far < 1e-3, "{page}: {mean} of 255 off, {far} of all far off");
        for stage in [&mut usual, &mut quick] {
            stage.key(egui::Key::F1);
        }
    }
}

/// Gauges of a flood by their names, as they were measured last.
fn gauge(window: &corpuscle_app::Window, name: &str) -> f64 {
    window.gauge(name).unwrap_or(f64::NAN)
}

#[test]
fn a_flood_is_rained_on_while_it_goes_on() {
    let Some(mut stage) = stage("touching a flood") else { return };
    stage.choose("A lake at rest over a hill");
    stage.until(SOON, "it plays", |window| !window.is_waiting() && gauge(window, "water.total_inflow_m3") >= 0.0);
    assert!(stage.window().gauge("water.total_rain_m3").is_none());
    stage.type_into("Rain, mm/h", "150");
    stage.until(SOON, "it rains", |window| gauge(window, "water.total_rain_m3") > 0.0);
    assert!(!stage.has("Restart with changes") && stage.window().fault().is_none());
}

#[test]
fn a_pane_is_cooled_while_it_goes_on() {
    let Some(mut stage) = stage("touching dew") else { return };
    stage.choose("A cold pane");
    stage.until(SOON, "it plays", |window| !window.is_waiting() && window.snapshot().is_some());
    let coldest = |window: &corpuscle_app::Window| gauge(window, "pane.mean_temperature_K");
    stage.type_into("Temperature of pane, °C", "1");
    stage.until(SOON, "it is colder", |window| coldest(window) < 275.0);
    assert!(!stage.has("Restart with changes") && stage.window().fault().is_none());
}

#[test]
fn terrain_that_is_dropped_is_flooded() {
    let Some(mut stage) = stage("terrain dropped on the window") else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("slope.asc");
    let row =
        |row: i32| (0..50).map(|column| format!("{} ", 30 - column / 2 + (row - 15).abs() / 5)).collect::<String>();
    let rows: Vec<String> = (0..30).map(row).collect();
    let head = "ncols 50\nnrows 30\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    std::fs::write(&file, format!("{head}{}\n", rows.join("\n"))).unwrap();
    stage.drop_file(&file);
    stage.until(SOON, "it is flooded", |window| gauge(window, "water.total_inflow_m3") > 0.0);
    assert!(stage.window().fault().is_none());
    stage.run(Duration::from_millis(1500));
    stage.picture("dropped");
    stage.drop_file(&folder.path().join("none.tif"));
    stage.until(SOON, "it is refused", |window| window.fault().is_some_and(|fault| fault.contains("none.tif")));
}

#[test]
fn a_spot_of_ground_is_picked_and_a_gauge_placed_there() {
    let Some(mut stage) = stage("a gauge placed in the window") else { return };
    stage.choose("A lake at rest over a hill");
    stage.until(SOON, "it plays", |window| !window.is_waiting() && gauge(window, "water.stored_m3") > 0.0);
    stage.key(egui::Key::Space);
    stage.run(Duration::from_millis(300));
    stage.click_picture([0.4, 0.45]);
    stage.until(SOON, "it is probed", |window| window.snapshot().is_some_and(|snapshot| snapshot.probed.is_some()));
    let probed = stage.window().snapshot().unwrap().probed.unwrap();
    stage.picture("spot");
    stage.click("Place a gauge here");
    stage.until(SOON, "there is a gauge", |window| window.gauge("P1.depth_m").is_some());
    assert_eq!(gauge(stage.window(), "P1.depth_m"), probed.depth);
    assert!(probed.depth > 0.1 && stage.has("There is a gauge here") && !stage.has("Restart with changes"));
    stage.key(egui::Key::R);
    stage.run(Duration::from_millis(100));
    stage.until(SOON, "it is there after a restart", |window| {
        !window.is_waiting() && window.gauge("P1.depth_m").is_some()
    });
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

/// A scene at its start.
fn waiting(test: &str, title: &str) -> Option<stage::Stage> {
    let mut stage = stage(test)?;
    stage.window_mut().wait_at_start();
    stage.choose(title);
    stage.until(SOON, title, |window| !window.is_waiting() && window.snapshot().is_some());
    Some(stage)
}

#[test]
fn the_story_of_a_gas_looks_as_it_did() {
    let Some(mut stage) = waiting("a gas as it looked", "Free expansion") else { return };
    stage.click("Lift the partition");
    stage.click("Heat");
    stage.steps(12);
    stage.same_as_reference("gas");
}

#[test]
fn the_story_of_a_flood_looks_as_it_did() {
    let Some(mut stage) = waiting("a flood as it looked", "A lake at rest over a hill") else { return };
    stage.type_into("Rain, mm/h", "180");
    stage.steps(2);
    stage.click_picture([0.42, 0.45]);
    stage.until(SOON, "it is probed", |window| window.snapshot().is_some_and(|snapshot| snapshot.probed.is_some()));
    stage.click("Place a gauge here");
    stage.click("Stop following");
    stage.same_as_reference("flood");
}

#[test]
fn the_story_of_dew_looks_as_it_did() {
    let Some(mut stage) = waiting("dew as it looked", "A cold pane") else { return };
    stage.type_into("Temperature of pane, °C", "2");
    stage.steps(30);
    stage.same_as_reference("dew");
}

#[test]
fn a_film_is_recorded_and_stills_and_scenes_are_saved() {
    let Some(mut stage) = waiting("a film in the window", "Maxwell's speeds") else { return };
    let folder = tempfile::tempdir().unwrap();
    stage.window_mut().save_into(folder.path().to_owned());
    stage.click("Record a film");
    stage.click("Play");
    stage.until(SOON, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 0.05));
    stage.click("End the film");
    let film = folder.path().join("gas-maxwell.mp4");
    stage.until(SOON, "there is a film", |_| film.exists());
    let bytes = std::fs::read(&film).unwrap();
    assert!(bytes.len() > 10_000 && &bytes[4..8] == b"ftyp", "{} bytes", bytes.len());
    stage.click("Save a still");
    stage.key(egui::Key::P);
    let still = folder.path().join("gas-maxwell.png");
    stage.until(SOON, "there is a still", |_| still.exists());
    assert!(stage.has("Record a film"));
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

/// A short run of two boxes of balls, as `corpuscle run` leaves it.
fn finished_run(folder: &std::path::Path) {
    let text = corpuscle::scene::builtin("gas/free-expansion").unwrap().text;
    let shorter = [("run.until_s", "0.5"), ("run.frame_every_s", "0.05"), ("run.gauge_every_s", "0.05")];
    let shorter: Vec<_> = shorter.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
    let scene = corpuscle::scene::Scene::parse(text, "gas/free-expansion", &shorter).unwrap();
    let mut simulation = corpuscle::Simulation::open(scene, std::path::Path::new("")).unwrap();
    let mut recorder = corpuscle::Recorder::create(folder, &simulation, Default::default()).unwrap();
    simulation.run(&mut [&mut recorder], &false.into(), &mut |_| {}).unwrap();
}

#[test]
fn a_finished_run_is_scrubbed_and_its_gauges_are_saved() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    finished_run(&run);
    let start = corpuscle_app::Start::Run(run);
    let Some(mut stage) = stage::stage_in("a finished run", egui::Theme::Light, start) else { return };
    stage.until(SOON, "it is open", |window| !window.is_waiting() && window.snapshot().is_some());
    stage.window_mut().save_into(folder.path().to_owned());
    stage.key(egui::Key::Space);
    stage.run(Duration::from_millis(300));
    // Back and forth: the frame nearest to where the bar is touched is shown, the same each time.
    let mut shown = Vec::new();
    for part in [0.8, 0.2, 0.8] {
        stage.touch_bar(part);
        let time = f64::from(part) * 0.5;
        stage.until(SOON, "its time is shown", |window| {
            window.snapshot().is_some_and(|snapshot| (snapshot.frame.time - time).abs() < 0.026)
        });
        shown.push(stage.window().snapshot().unwrap().frame.sets[0].position.clone());
    }
    assert!(shown[0] == shown[2] && shown[0] != shown[1]);
    stage.click("Save plot 1 as a table");
    let tables: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let table = tables.iter().find(|path| path.extension().is_some_and(|end| end == "csv")).expect("a table");
    let text = std::fs::read_to_string(table).unwrap();
    // Series, time and value, as often as the gauges were written.
    let times: Vec<f64> = text.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert!(times.len() == 11 && times[0] == 0.0 && (times[10] - 0.5).abs() < 1e-9, "{text}");
    assert!(stage.window().fault().is_none(), "{:?}", stage.window().fault());
}

#[test]
fn a_scene_is_saved_as_it_was_changed() {
    let Some(mut stage) = waiting("saving a scene", "Free expansion") else { return };
    let folder = tempfile::tempdir().unwrap();
    stage.window_mut().save_into(folder.path().to_owned());
    stage.type_into("Number, ", "300");
    stage.click("Lift the partition");
    stage.choose("Save the scene as changed");
    let file = folder.path().join("gas-free-expansion-changed.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let scene = corpuscle::scene::Scene::parse(&text, "changed", &[]).unwrap();
    let gas = scene.gas().unwrap();
    assert_eq!(gas.species[0].count, Some(300));
    assert_eq!(gas.partition.as_ref().unwrap().lifted_at_s, Some(0.0));
}

/// Without a device that draws a scene is still seen, played, turned and clicked: as discs, and floods as a map.
#[test]
fn without_a_device_pictures_are_discs_and_maps() {
    for (title, steps, name) in [
        ("Maxwell's speeds", 5, "gas"),
        ("A piston falls onto a gas", 2, "piston"),
        ("A lake at rest over a hill", 2, "flood"),
        ("A dam breaks above a town", 2, "city"),
        ("A cold pane", 60, "dew"),
    ] {
        let Some(mut stage) = stage_without_device("sketches") else { return };
        stage.window_mut().wait_at_start();
        stage.choose(title);
        stage.until(SOON, title, |window| !window.is_waiting() && window.snapshot().is_some());
        stage.steps(steps);
        stage.same_as_reference(&format!("sketch-{name}"));
        assert!(stage.window().fault().is_none(), "{title}: {:?}", stage.window().fault());
        // What only a device can do is not offered.
        assert!(!stage.has("Save a still") && !stage.has("Quality"), "{title}");
    }
}

#[test]
fn a_window_as_narrow_as_a_phone_has_the_picture_and_one_panel() {
    let Some(mut stage) = stage("a narrow window") else { return };
    stage.choose("Maxwell's speeds");
    stage.until(SOON, "it plays", |window| window.snapshot().is_some_and(|snapshot| snapshot.frame.time > 0.0));
    assert!(stage.has("Heat"));
    stage.resize([390.0, 800.0]);
    // All the width but the margins of the test.
    assert!(stage.picture_size()[0] > 370.0, "{:?}", stage.picture_size());
    assert!(!stage.has("Heat"));
    stage.click("Parameters");
    assert!(stage.has("Heat") && stage.picture_size()[1] > 250.0, "{:?}", stage.picture_size());
    stage.click("Plots");
    assert!(!stage.has("Heat"));
}

/// A ruler keeps its length in the world however the picture is zoomed, and its ends are dragged; on a flood it lies on the ground.
#[test]
fn a_ruler_measures_lengths_of_the_world() {
    let Some(mut stage) = stage("the ruler") else { return };
    stage.window_mut().wait_at_start();
    stage.choose("Brownian motion");
    stage.until(SOON, "the gas", |window| !window.is_waiting() && window.snapshot().is_some());
    stage.run(Duration::from_millis(100));
    assert_eq!(stage.window().ruler_length(), None);
    stage.click("Ruler");
    stage.run(Duration::from_millis(100));
    let first = stage.window().ruler_length().unwrap();
    // A quarter of the width of the picture or so, at first.
    let point = first / (0.24 * f64::from(stage.picture_size()[0]));
    stage.drag("Ruler, second end", [60.0, 0.0]);
    let longer = stage.window().ruler_length().unwrap();
    assert!((longer - first - 60.0 * point).abs() < 2.0 * point, "{first} {longer} {point}");
    stage.drag("Ruler, first end", [0.0, 80.0]);
    let slanted = stage.window().ruler_length().unwrap();
    assert!((slanted - longer.hypot(80.0 * point)).abs() < 2.0 * point, "{slanted}");
    stage.zoom(1.5);
    assert_eq!(stage.window().ruler_length(), Some(slanted));
    stage.picture("ruler");
    stage.key(egui::Key::M);
    assert_eq!(stage.window().ruler_length(), None);

    stage.choose("Dam break in a channel");
    stage.until(SOON, "the flood", |window| !window.is_waiting() && window.snapshot().is_some());
    stage.run(Duration::from_millis(100));
    stage.key(egui::Key::M);
    stage.run(Duration::from_millis(100));
    let before = stage.window().ruler_length().unwrap();
    stage.drag("Ruler, second end", [60.0, 0.0]);
    assert!(stage.window().ruler_length().unwrap() > before);
    stage.picture("ruler-flood");
}

/// The stopwatch counts simulated time while it runs, and the collisions of the followed ball.
#[test]
fn a_stopwatch_counts_simulated_time() {
    let Some(mut stage) = stage("the stopwatch") else { return };
    stage.window_mut().wait_at_start();
    stage.choose("Brownian motion");
    stage.until(SOON, "the gas", |window| !window.is_waiting() && window.snapshot().is_some());
    stage.steps(1);
    let began = stage.time();
    stage.key(egui::Key::W);
    stage.click("Start");
    stage.steps(3);
    let lap = stage.time() - began;
    assert!((stage.window().stopwatch_time().unwrap() - lap).abs() < 1e-12 * lap);
    stage.click("Lap");
    stage.steps(2);
    stage.click("Stop");
    let stopped = stage.time() - began;
    stage.steps(1);
    assert!((stage.window().stopwatch_time().unwrap() - stopped).abs() < 1e-12 * stopped);
    assert!(stage.has("collisions of the followed ball") && stage.has("lap 1"));
    stage.picture("stopwatch");
    stage.click("Reset");
    assert_eq!(stage.window().stopwatch_time(), Some(0.0));
    stage.click("Put the stopwatch away");
    assert_eq!(stage.window().stopwatch_time(), None);
}
