//! The report: what must be in it, that it needs nothing else, and that odd runs have one too.

mod common;

use common::{Wave, scene, terrain, write_run};
use corpuscle_model::Map;
use corpuscle_output::{ExtentScores, FrameFormat, Report, RunFolder};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::fs;
use std::path::Path;

fn report(folder: &Path, scene: &Scene, terrain: &Terrain) -> String {
    Report::read(folder, scene, terrain).unwrap().write().unwrap();
    fs::read_to_string(folder.join("report.html")).unwrap()
}

#[test]
fn it_has_what_a_planner_needs_and_needs_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("run"));
    let terrain = terrain(&scene);
    let run = write_run(&path, &scene, &terrain, FrameFormat::None);
    let scores = ExtentScores {
        hit_rate: 0.875,
        false_alarm_ratio: 0.125,
        critical_success_index: 0.7778,
        simulated_area_m2: 1e6,
        observed_area_m2: 1e6,
    };
    run.finish(&corpuscle_output::Summary { extent: Some(scores), ..common::summary() }).unwrap();
    let html = report(&path, &scene, &terrain);
    for text in [
        "A flood wave in a meandering valley",
        "Flooded area",
        "Peak discharge",
        "900 m³/s",
        "Maximum depth",
        "Arrival of the water",
        "Maximum speed",
        "Flood hazard rating",
        "Duration of flooding",
        "Depth over time",
        "1 h 30 min",
        "upper bridge",
        "stays dry",
        "Discharge and storage",
        "river, inflow",
        "total outflow",
        "water, m³",
        "momentum",
        "Critical success index",
        "0.778",
        "no reference system",
        "corpuscle run run/scene.toml",
        "meander_length_m = 700.0",
        "contours every",
        "500 m",
    ] {
        assert!(html.contains(text), "`{text}` is not in the report");
    }
    // Self-contained: no script, and every address is data or a position on the page.
    assert!(!html.contains("<script") && !html.contains("@import") && !html.contains("url("));
    for (at, _) in html.match_indices("href=\"") {
        let address = &html[at + 6..at + 16];
        assert!(address.starts_with('#') || address.starts_with("data:image"), "{address}");
    }
    assert!(!html.contains("src=\""));
    assert!([" NaN", "\"NaN", ">NaN"].iter().all(|text| !html.contains(text)));
    for name in
        ["max_depth", "arrival_s", "max_speed", "hazard", "duration_s", "snapshots", "gauges", "discharge", "volume"]
    {
        let png = fs::read(path.join(format!("pictures/{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG") && png.len() > 5000, "{name}");
    }
}

/// A run on a terrain with one frame, no gauges, and water where `wet` says.
fn small_run(folder: &Path, terrain_table: &str, wet: impl Fn(usize) -> bool) -> String {
    let text =
        format!("description = \"<b>&\"\n[run]\nuntil_s = 1.0\n[terrain.{terrain_table}\n[flood]\nspacing_m = 1.0\n");
    let scene = Scene::parse(&text, "small", &[]).unwrap();
    let terrain = terrain(&scene);
    let grid = terrain.map_grid();
    let values = (0..grid.columns * grid.rows).map(|cell| if wet(cell) { 0.4 } else { f32::NAN }).collect();
    let map = |name| Map { name, title: "", unit: "", columns: grid.columns, rows: grid.rows, values };
    let path = folder.join("a run");
    let mut run = RunFolder::create(&path, &text, &[], FrameFormat::None).unwrap();
    let depth = map("depth");
    run.write_snapshot(0.0, std::slice::from_ref(&depth), &terrain).unwrap();
    run.write_final_maps(&[Map { name: "max_depth", ..depth }], &terrain).unwrap();
    run.finish(&common::summary()).unwrap();
    report(&path, &scene, &terrain)
}

#[test]
fn runs_without_gauges_or_water_have_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let plane = "plane]\nextent = { length_m = 100.0, width_m = 50.0, cell_m = 5.0 }";
    let html = small_run(folder.path(), plane, |_| false);
    assert!(html.contains("Nothing became wet."));
    let again = tempfile::tempdir().unwrap();
    assert!(html == small_run(again.path(), plane, |_| false), "the same run gives another report");
    assert!(html.contains("&lt;b&gt;&amp;") && !html.contains("<b>&"));
    assert!(html.contains("corpuscle run &#39;a run&#39;/scene.toml"));
    assert!(!html.contains("Hydrographs"));
}

/// Names in a scene have letters, digits, spaces, `_` and `-`; those in a folder from elsewhere can be anything.
#[test]
fn a_gauge_called_like_a_script_is_shown_as_text() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("run"));
    let terrain = terrain(&scene);
    write_run(&path, &scene, &terrain, FrameFormat::None).finish(&common::summary()).unwrap();
    let gauges = fs::read_to_string(path.join("gauges.csv")).unwrap();
    let hostile = "<script>alert(1)</script>";
    assert!(gauges.contains("mill weir."));
    fs::write(path.join("gauges.csv"), gauges.replace("mill weir.", &format!("{hostile}."))).unwrap();
    let mut renamed = scene.clone();
    renamed.title = hostile.into();
    let html = report(&path, &renamed, &terrain);
    assert!(!html.contains("<script"));
    assert!(html.matches("&lt;script&gt;alert(1)&lt;/script&gt;").count() > 2, "the title and the gauge are not shown");
    let text = common::SCENE.replace("\"mill weir\"", "\"<script>alert(1)</script>\"");
    let refusal = Scene::parse(&text, "sample", &[]).unwrap_err().to_string();
    assert!(refusal.contains("letters, digits"), "{refusal}");
}

#[test]
fn elongated_terrain_is_stretched_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let channel = "bump]\nextent = { length_m = 1000.0, width_m = 4.0, cell_m = 1.0 }\nheight_m = 0.5";
    let html = small_run(folder.path(), channel, |cell| cell % 1000 < 500);
    assert!(html.contains("stretched 25 times north–south"));
}

#[test]
fn huge_grids_make_small_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let plane = "plane]\nextent = { length_m = 2000.0, width_m = 2000.0, cell_m = 1.0 }\nslope_east = 0.01";
    let html = small_run(folder.path(), plane, |cell| cell % 7 < 5);
    assert!(html.len() < 6_000_000, "{} bytes", html.len());
}

#[test]
fn maps_of_another_terrain_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("run"));
    let ground = terrain(&scene);
    write_run(&path, &scene, &ground, FrameFormat::None);
    let other = Scene::parse(&common::SCENE.replace("cell_m = 5.0", "cell_m = 10.0"), "other", &[]).unwrap();
    let error = Report::read(&path, &other, &terrain(&other)).unwrap_err().to_string();
    assert!(error.contains("max_depth.tif") && error.contains("belongs to another"), "{error}");
}

#[test]
fn the_sample_wave_is_wet_and_dry() {
    let scene = scene();
    let terrain = terrain(&scene);
    let wave = Wave::new(&terrain);
    assert!(wave.at([400.0, 480.0], 1500.0).is_some_and(|[depth, _]| depth > 1.0));
    assert_eq!(wave.at([1200.0, 900.0], 1500.0), None);
}
