//! Gases as a user of the binary meets them.

mod tool;

use serde_json::Value;
use std::fs;
use tool::{BALLS, Place};

/// The balances of a summary that must be kept, with the largest relative error that is rounding.
fn kept(summary: &Value, quantity: &str) {
    let error = summary["ledger"][quantity]["relative_error"].as_f64().unwrap();
    assert!(error.abs() <= 1e-12, "{quantity}: {error}");
}

#[test]
fn a_run_fills_its_folder_and_prints_its_summary() {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    let run = place.run(&["run", "balls.toml", "--json", "--frames", "csv"]).expect_status(0);
    let folder = place.path("runs/balls-1");
    for file in [
        "scene.toml",
        "frames/frame_000002.csv",
        "charts/speed_histogram_light.csv",
        "path.csv",
        "pictures/balls.png",
        "pictures/speed_histogram_light.png",
        "report.html",
    ] {
        assert!(folder.join(file).is_file(), "{file} is missing");
    }
    assert!(!folder.join("maps").exists());
    let summary: Value = serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap();
    assert_eq!(run.json(), summary);
    assert_eq!((&summary["model"], &summary["status"]), (&"gas".into(), &"done".into()));
    assert_eq!((&summary["particles"], &summary["simulated_time_s"]), (&101.into(), &2.0.into()));
    assert!(summary["collisions"].as_u64().unwrap() > 100 && summary["collisions_per_s"].as_f64().unwrap() > 0.0);
    assert!(summary.get("particle_steps_per_s").is_none());
    ["energy", "momentum"].iter().for_each(|quantity| kept(&summary, quantity));
    let gauges = fs::read_to_string(folder.join("gauges.csv")).unwrap();
    assert!(gauges.starts_with("time_s,gas.temperature,gas.kinetic_energy,"), "{gauges}");
    let frame = fs::read_to_string(folder.join("frames/frame_000002.csv")).unwrap();
    assert!(frame.starts_with("set,id,x,y,z,vx,vy,vz,radius,mass\nheavy,0,"), "{frame}");
    assert_eq!(frame.lines().count(), 1 + 101);

    // The scene as written gives the same run again, on any number of threads.
    let scene = folder.join("scene.toml").display().to_string();
    place.run(&["run", &scene, "-o", "again", "--frames", "csv", "--threads", "1"]).expect_status(0);
    for file in ["scene.toml", "gauges.csv", "frames/frame_000002.csv", "path.csv", "charts/density_profile.csv"] {
        assert_eq!(place.read(&format!("again/{file}")), place.read(&format!("runs/balls-1/{file}")), "{file}");
    }
}

#[test]
fn check_says_what_would_be_run_and_writes_nothing() {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    let report = place.run(&["check", "balls.toml", "--json"]).expect_status(0).json();
    assert_eq!((&report["ok"], &report["model"]), (&true.into(), &"gas".into()));
    assert_eq!((&report["particles_at_start"], &report["particles_to_come"]), (&101.into(), &0.into()));
    assert!(report["terrain"].is_null() && report["time_step_s"].is_null());
    let estimate = report["estimated_wall_time_s"].as_f64().unwrap();
    assert!(estimate > 0.0 && estimate < 60.0, "{estimate}");
    let text = place.run(&["check", "balls.toml"]).expect_status(0).stdout;
    assert!(text.contains("(gas)") && text.contains("101"), "{text}");
    assert!(!place.path("runs").exists());
}

#[test]
fn what_cannot_be_is_refused_with_its_place_and_a_remedy() {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    let near = "gas.ball.1={ position = [33, 20], radius = 4, mass = 1 }";
    for (change, words) in [
        (near, ["gas.ball.1.position", "overlaps gas.ball.0"]),
        ("gas.species.0.count=800", ["gas.species.0.count = 800", "close packing"]),
        ("gas.species.0.mass=0", ["gas.species.0.mass = 0.0", "larger than 0"]),
        ("gas.species.0.mass=-1", ["gas.species.0.mass = -1.0", "larger than 0"]),
        ("gas.species.0.temperature=nan", ["gas.species.0.temperature = nan", "finite"]),
        ("gas.species.0.radius=21", ["gas.species.0.radius = 21.0", "at most 20"]),
        ("gas.specis=1", ["gas.specis is not a key", "did you mean `species`"]),
        ("gas.walls.x_max=\"elastic\"", ["gas.walls.x_max", "piston"]),
        ("gas.walls.x_max={ moving = { velocity = -40, until_s = 1.4 } }", ["walls across x", "Stop the wall earlier"]),
        ("gas.walls.x_max={ moving = { velocity = -28 } }", ["walls across x", "Stop the wall earlier"]),
        ("gas.walls.x_max={ motion = { sinusoid = { amplitude = 55, period_s = 4 } } }", ["at t = ", "too little"]),
        ("gas.follow=101", ["gas.follow = 101", "0 to 100"]),
    ] {
        let refused = place.run(&["run", "balls.toml", "--set", change]).expect_status(2);
        assert!(words.iter().all(|word| refused.stderr.contains(word)), "{change}: {}", refused.stderr);
        assert_eq!(refused.stderr.trim().lines().count(), 1, "{}", refused.stderr);
    }
    place.write("bad.toml", &BALLS.replace("radius = 1.0", "radius = -1.0"));
    let refused = place.run(&["run", "bad.toml"]).expect_status(2);
    assert!(refused.stderr.contains("bad.toml:15:"), "{}", refused.stderr);
    assert!(!place.path("runs").exists(), "a refused scene leaves no folder");
}

/// A run from a frame of another goes on as that did, to the bit.
#[test]
fn a_gas_starts_from_a_frame_of_another() {
    let place = Place::new();
    place.run(&["run", "gas/maxwell", "--until", "2", "--frames", "xyz", "-o", "one"]).expect_status(0);
    for format in ["xyz", "csv"] {
        place.run(&["run", "gas/maxwell", "--until", "0.5", "--frames", format, "-o", format]).expect_status(0);
        let start = place.path(format!("{format}/frames/frame_000000.{format}"));
        let scene = format!(
            "[run]\nuntil_s = 2\nframe_every_s = 0.5\n[gas]\nsize = [800, 600]\nfollow = 410\nstart_file = {:?}\n",
            start.display().to_string()
        );
        place.write("again.toml", &scene);
        let again = format!("again-{format}");
        place.run(&["run", "again.toml", "--frames", "xyz", "-o", &again]).expect_status(0);
        let file = "frames/frame_000004.xyz";
        assert!(place.read(&format!("one/{file}")) == place.read(&format!("{again}/{file}")), "{format}");
    }
    let scene = "[run]\nuntil_s = 2\n[gas]\nsize = [800, 600]\nstart_file = \"none.xyz\"\n";
    place.write("none.toml", scene);
    let refused = place.run(&["run", "none.toml"]).expect_status(2);
    let error = refused.stderr;
    assert!(error.contains("none.xyz") && error.contains("gas.start_file"), "{error}");
    place.write(
        "few.toml",
        &scene.replace("none.xyz", "one/frames/frame_000000.xyz").replace("[gas]", "[gas]\nfollow = 800"),
    );
    let error = place.run(&["run", "few.toml"]).expect_status(2).stderr;
    assert!(error.contains("ids run from 0 to 799"), "{error}");
}
