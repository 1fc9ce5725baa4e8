//! The binary as a user meets it: exit status, messages, JSON, folders.

mod tool;

use serde_json::Value;
use std::fs;
use tool::{LAKE, Place, SMALL_TERRAIN};

#[test]
fn scenes_are_listed_shown_and_copied_but_never_over_a_file() {
    let place = Place::new();
    let list = place.run(&["scenes"]).expect_status(0);
    assert!(list.stdout.contains("flood/valley") && list.stdout.contains("flood/lake-at-rest"));
    let rows = place.run(&["scenes", "--json"]).expect_status(0).json();
    let valley = rows.as_array().unwrap().iter().find(|row| row["name"] == "flood/valley").unwrap();
    assert!(valley["description"].as_str().unwrap().len() > 20);
    let shown = place.run(&["scenes", "flood/dam-break"]).expect_status(0);
    place.run(&["scenes", "flood/dam-break", "--copy", "mine.toml"]).expect_status(0);
    assert_eq!(fs::read_to_string(place.path("mine.toml")).unwrap(), shown.stdout);
    place.write("mine.toml", "mine");
    let again = place.run(&["scenes", "flood/dam-break", "--copy", "mine.toml"]).expect_status(2);
    assert!(again.stderr.contains("mine.toml exists already"), "{}", again.stderr);
    assert_eq!(fs::read_to_string(place.path("mine.toml")).unwrap(), "mine");
    let unknown = place.run(&["scenes", "flood/vally"]).expect_status(2);
    assert!(unknown.stderr.contains("did you mean flood/valley?"), "{}", unknown.stderr);
}

#[test]
fn a_scene_that_is_wrong_is_refused_with_its_line() {
    let place = Place::new();
    place.write("bad.toml", &LAKE.replace("spacing_m", "spacng_m"));
    for command in ["run", "check"] {
        let refused = place.run(&[command, "bad.toml"]).expect_status(2);
        assert!(refused.stderr.contains("bad.toml:9:1: flood.spacng_m"), "{}", refused.stderr);
        assert!(refused.stderr.contains("did you mean `spacing_m`") && refused.stderr.contains("^^^"));
        assert!(refused.stdout.is_empty(), "{}", refused.stdout);
    }
    let report = place.run(&["check", "bad.toml", "--json"]).expect_status(2).json();
    assert_eq!((&report["ok"], &report["line"], &report["key"]), (&false.into(), &9.into(), &"flood.spacng_m".into()));
    place.write("lake.toml", LAKE);
    let report = place.run(&["check", "lake.toml", "--json", "--set", "flood.spacing_m=-1"]).expect_status(2).json();
    assert_eq!((&report["option"], &report["key"]), (&"--set flood.spacing_m=-1".into(), &"flood.spacing_m".into()));
    assert!(report["file"].is_null() && report["line"].is_null() && report["column"].is_null(), "{report}");
    place.write("nan.toml", &LAKE.replace("level_m = 2.0", "level_m = nan"));
    let refused = place.run(&["run", "nan.toml"]).expect_status(2);
    assert!(refused.stderr.contains("flood.water.0.level_m = nan: must be a finite number"), "{}", refused.stderr);
    place.write("binary.toml", "\u{0}\u{1}");
    place.run(&["run", "binary.toml"]).expect_status(2);
    fs::write(place.path("latin1.toml"), b"title = \"\xe9\"").unwrap();
    place.run(&["run", "latin1.toml"]).expect_status(2);
    assert!(!place.path("runs").exists(), "a refused scene leaves no folder");
}

#[test]
fn what_is_not_there_is_refused() {
    let place = Place::new();
    let missing = place.run(&["run", "none.toml"]).expect_status(2);
    assert!(missing.stderr.contains("none.toml") && missing.stderr.contains("flood/valley"), "{}", missing.stderr);
    place.write("lake.toml", LAKE);
    let series = "--set=flood.inflow.0={ name = \"river\", at = [5, 5], discharge_m3_per_s = { csv = \"q.csv\" } }";
    let missing = place.run(&["run", "lake.toml", series]).expect_status(2);
    assert!(missing.stderr.contains("q.csv"), "{}", missing.stderr);
    let missing =
        place.run(&["run", "lake.toml", "--set", "terrain={ file = { path = \"no.tif\" } }"]).expect_status(2);
    assert!(missing.stderr.contains("no.tif"), "{}", missing.stderr);
    let missing = place.run(&["run", "--resume", "nowhere"]).expect_status(2);
    assert!(missing.stderr.contains("nowhere"), "{}", missing.stderr);
    place.run(&["run", "gas/maxwell", "--backend", "gpu"]).expect_status(2);
    place.run(&["run", "--set", "nonsense"]).expect_status(2);
    place.run(&["run", "--threads", "0"]).expect_status(2);
    place.run(&["frobnicate"]).expect_status(2);
    place.run(&["validate", "flood/none"]).expect_status(2);
    place.run(&["bench", "flood/none"]).expect_status(2);
}

#[test]
fn overrides_are_named_when_they_are_wrong() {
    let place = Place::new();
    for (arguments, words) in [
        (
            ["--set", "flood.scheme=sph-sw"],
            "--set flood.scheme=sph-sw: flood.scheme: `sph-sw` is not known here; did you mean `sph-swe`",
        ),
        (["--until", "-3"], "run.until_s = -3"),
        (["--until", "nan"], "run.until_s = nan"),
    ] {
        let refused = place.run(&[&["run", "flood/lake-at-rest"], &arguments[..]].concat()).expect_status(2);
        assert!(refused.stderr.contains(words), "{}", refused.stderr);
    }
}

#[test]
fn a_run_fills_its_folder_and_prints_its_summary() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let run = place.run(&["run", "lake.toml", "--json", "--frames", "csv"]).expect_status(0);
    let folder = place.path("runs/lake-1");
    for file in
        ["scene.toml", "summary.json", "gauges.csv", "frames/frame_000002.csv", "maps/max_depth.tif", "report.html"]
    {
        assert!(folder.join(file).is_file(), "{file} is missing");
    }
    let summary: Value = serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap();
    assert_eq!(run.json(), summary);
    assert_eq!(
        (&summary["model"], &summary["backend"], &summary["status"]),
        (&"flood".into(), &"cpu".into(), &"done".into())
    );
    assert_eq!(summary["simulated_time_s"], 2.0);
    assert!(summary["ledger"]["water_m3"]["relative_error"].as_f64().unwrap().abs() <= 1e-12);
    let gauges = fs::read_to_string(folder.join("gauges.csv")).unwrap();
    assert!(gauges.starts_with("time_s,P1.depth_m,"), "{gauges}");
    assert_eq!(gauges.lines().count(), 1 + 201);

    // The scene as written gives the same run again.
    let scene = folder.join("scene.toml").display().to_string();
    place.run(&["run", &scene, "-o", "again", "--frames", "csv", "--threads", "1"]).expect_status(0);
    for file in ["scene.toml", "gauges.csv", "frames/frame_000002.csv", "maps/max_depth.tif"] {
        assert_eq!(place.read(&format!("again/{file}")), place.read(&format!("runs/lake-1/{file}")), "{file}");
    }
    place.run(&["run", "lake.toml", "--until", "0.02", "--frames", "none"]).expect_status(0);
    assert!(place.path("runs/lake-2/summary.json").is_file() && !place.path("runs/lake-2/frames").exists());
}

#[test]
fn a_folder_that_holds_a_run_is_left_alone() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.write("kept/summary.json", "{}");
    let refused = place.run(&["run", "lake.toml", "-o", "kept"]).expect_status(2);
    assert!(refused.stderr.contains("never overwritten") && refused.stderr.contains("--resume"), "{}", refused.stderr);
    assert_eq!(place.read("kept/summary.json"), b"{}");
    assert!(!place.path("kept/scene.toml").exists());
}

#[test]
fn check_says_what_would_be_run_and_writes_nothing() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let report = place.run(&["check", "lake.toml", "--json"]).expect_status(0).json();
    assert_eq!(report["ok"], true);
    assert_eq!(report["terrain"]["columns"], 20);
    assert_eq!(report["gauge_rows"], 201);
    assert_eq!(report["frames"], 3);
    assert!(report["particles_at_start"].as_u64().unwrap() > 20);
    assert!(report["time_step_s"].as_f64().unwrap() > 0.0);
    let text = place.run(&["check", "lake.toml"]).expect_status(0).stdout;
    assert!(text.contains("20 x 20 m") && text.contains("time step"), "{text}");
    let inflow = "flood.inflow.0={ name = \"river\", at = [5, 5], discharge_m3_per_s = 100 }";
    let sph_swe = ["check", "lake.toml", "--json", "--set", inflow, "--set", "flood.scheme=sph-swe"];
    let report = place.run(&sph_swe).expect_status(0).json();
    assert_eq!(report["particles_to_come"], 25, "200 m3 in particles of 2 x 2 x 2 m3");
    assert!(report["estimated_wall_time_s"].as_f64().unwrap() > 0.0);
    let report = place.run(&["check", "lake.toml", "--json", "--set", inflow]).expect_status(0).json();
    assert_eq!(report["particles_to_come"], 0, "all the ground is wet at the start");
    // Nothing is there at the start; 820,000 m3 come in, thought of as 1 m deep, over particles of 4 x 4 m.
    let report = place.run(&["check", "flood/valley", "--json"]).expect_status(0).json();
    assert_eq!(report["particles_at_start"], 0);
    let to_come = report["particles_to_come"].as_f64().unwrap();
    // A whole number of cells fits the terrain: they are up to 2 % larger than asked for.
    assert!((0.98 * 51_250.0..=51_250.0).contains(&to_come), "{to_come}");
    assert!(report["estimated_wall_time_s"].as_f64().unwrap() > 1.0);
    assert!(!place.path("runs").exists());
}

#[test]
fn a_terrain_is_refused_with_a_scene_that_runs() {
    let place = Place::new();
    place.write("data/hills.asc", SMALL_TERRAIN);
    let refused = place.run(&["run", "data/hills.asc"]).expect_status(2);
    let lines: Vec<_> = refused.stderr.lines().filter(|line| line.contains(" = ")).collect();
    assert_eq!(lines.len(), 3, "{}", refused.stderr);
    assert!(lines[0].contains("data/hills.asc"));
    place.write("flood.toml", &lines.join("\n"));
    let report = place.run(&["check", "flood.toml", "--json"]).expect_status(0).json();
    assert_eq!(report["terrain"]["columns"], 5);
    assert_eq!(report["particles_to_come"], 80, "all of 50 x 40 m gets wet, particles 5 m apart");
    place.write("data/broken.asc", "ncols 5\n");
    let refused = place.run(&["run", "data/broken.asc"]).expect_status(2);
    assert!(refused.stderr.contains("broken.asc"), "{}", refused.stderr);
}

#[test]
fn validation_makes_a_page() {
    let place = Place::new();
    place.run(&["validate", "gas/figure-11", "--report", "page.html"]).expect_status(0);
    let page = String::from_utf8(place.read("page.html")).unwrap();
    let words = ["<h2>gas/figure-11</h2>", "<th scope=\"row\">", "0 do not", "</html>"];
    assert!(words.iter().all(|word| page.contains(word)), "{page}");
    let ended = place.run(&["validate", "gas/figure-11", "--report", "nowhere/page.html"]).expect_status(1);
    assert!(ended.stderr.contains("nowhere/page.html"), "{}", ended.stderr);
}

#[test]
fn an_old_name_is_told() {
    let place = Place::new();
    place.write("lake.toml", &LAKE.replace("[flood]\n", "[flood]\nscheme = \"paper\"\n"));
    let told = place.run(&["run", "lake.toml", "-o", "lake"]).expect_status(0).stderr;
    let log = String::from_utf8(place.read("lake/log.txt")).unwrap();
    for text in [told, log] {
        assert!(
            text.contains("note: ") && text.contains("lake.toml:") && text.contains("write flood.scheme = \"sph-swe\""),
            "{text}"
        );
    }
}

#[test]
fn a_spacing_that_is_left_out_is_chosen_from_the_terrain_and_told() {
    let place = Place::new();
    place.write("lake.toml", &LAKE.replace("spacing_m = 2.0\n", ""));
    let report = place.run(&["check", "lake.toml", "--json"]).expect_status(0).json();
    assert_eq!(report["particles_at_start"], 400);
    let told = place.run(&["run", "lake.toml", "-o", "first"]).expect_status(0).stderr;
    assert!(told.contains("note: flood.spacing_m is not given: particles stand 1 m apart"), "{told}");
    let [log, scene, report] = ["log.txt", "scene.toml", "report.html"]
        .map(|name| String::from_utf8(place.read(&format!("first/{name}"))).unwrap());
    assert!(log.contains("flood.spacing_m is not given") && scene.contains("spacing_m = 1.0"), "{log}\n{scene}");
    assert!(report.contains("Spacing"));
    let again = place.run(&["run", "first/scene.toml", "-o", "second"]).expect_status(0).stderr;
    assert!(!again.contains("is not given"), "{again}");
    assert_eq!(place.read("first/gauges.csv"), place.read("second/gauges.csv"));
}
