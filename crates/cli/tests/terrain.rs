//! `corpuscle terrain`, and scenes that fetch their terrain, from a stand-in for the public bucket.

// Of the stand-in, which the tests of fetching use in full, only a part is wanted here.
#[allow(dead_code)]
#[path = "../../fetch/tests/common/mod.rs"]
mod bucket;

use bucket::{Bucket, Fault, tile_of};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Runs the binary with the stand-in as its server, or with none.
fn corpuscle(folder: &Path, bucket: &Bucket, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_corpuscle"))
        .current_dir(folder)
        .env("CORPUSCLE_GLO30", &bucket.base)
        .env("CORPUSCLE_CACHE", bucket.cache.path())
        .args(arguments)
        .output()
        .unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", told(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A valley that falls to the south, with a level channel along a meridian; far from it plain ground, quickly packed.
fn valley(longitude: f64, latitude: f64, channel: f64) -> f64 {
    if (longitude - channel).abs() > 0.04 {
        return 260.0;
    }
    let aside = ((longitude - channel).abs() * 83_000.0 - 40.0).max(0.0);
    200.0 + 2000.0 * (latitude - latitude.floor()) + 60.0 * (1.0 - (-(aside / 400.0).powi(2)).exp())
}

#[test]
fn a_box_is_fetched_told_of_and_cut() {
    let (bucket, folder) = (Bucket::with(&[[85, 6]]), TempDir::new().unwrap());
    let run = |arguments: &[&str]| corpuscle(folder.path(), &bucket, arguments);
    let fetch = ["terrain", "fetch", "--bbox", "6.40,85.50,6.50,85.52", "-o", "dem.tif", "--json"];
    let output = run(&fetch);
    let fetched = json(&output);
    assert_eq!((&fetched["columns"], &fetched["sea_tiles"]), (&37.into(), &serde_json::json!([])));
    assert!(fetched["bytes_fetched"].as_u64().unwrap() > 0 && fetched["attribution"].as_str().unwrap().contains("DLR"));
    assert!(told(&output).contains("produced using Copernicus WorldDEM-30") && told(&output).contains("wrote dem.tif"));

    let info = json(&run(&["terrain", "info", "dem.tif", "--json"]));
    let info = &info[0];
    assert_eq!((&info["reference_system"], &info["unit"]), (&"EPSG:4326".into(), &"degree".into()));
    assert_eq!((&info["columns"], &info["no_data_share"]), (&fetched["columns"], &0.0.into()));
    let [lowest, highest] = ["lowest_m", "highest_m"].map(|key| info[key].as_f64().unwrap());
    assert!(100.0 < lowest && lowest < highest && highest < 700.0);
    let text = String::from_utf8(run(&["terrain", "info", "dem.tif"]).stdout).unwrap();
    assert!(text.contains("cells      37 x") && text.contains("system     EPSG:4326"), "{text}");

    let clip = ["terrain", "clip", "dem.tif", "--bbox", "6.45,85.51,6.48,85.515", "-o", "part.tif", "--json"];
    let part = json(&run(&clip));
    assert!(part["columns"].as_u64().unwrap() < 15 && folder.path().join("part.tif").exists());

    // What exists is not overwritten.
    let before = fs::read(folder.path().join("dem.tif")).unwrap();
    for arguments in [&fetch[..], &["terrain", "clip", "part.tif", "--bbox", "6.45,85.51,6.48,85.515", "-o", "dem.tif"]]
    {
        let output = run(arguments);
        assert!(output.status.code() == Some(2) && told(&output).contains("not overwritten"), "{}", told(&output));
    }
    assert_eq!(fs::read(folder.path().join("dem.tif")).unwrap(), before);
    // Another address, of which nothing is in the cache.
    let from = ["terrain", "fetch", "--bbox", "6.4,85.5,6.5,85.52", "-o", "other.tif", "--from", "http://127.0.0.1:9"];
    let output = run(&from);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        told(&output).contains("check the network") && !folder.path().join("other.tif").exists(),
        "{}",
        told(&output)
    );
}

#[test]
fn what_cannot_be_is_refused_and_nothing_written() {
    let (bucket, folder) = (Bucket::with(&[[85, 6]]), TempDir::new().unwrap());
    let refused = |arguments: &[&str], words: &str| {
        let output = corpuscle(folder.path(), &bucket, arguments);
        let told = told(&output);
        assert!(output.status.code() == Some(2) && told.contains(words), "{arguments:?}: {told}");
    };
    refused(&["terrain", "fetch", "--bbox", "1,2,3", "-o", "a.tif"], "west,south,east,north");
    refused(&["terrain", "fetch", "--bbox", "3,2,1,4", "-o", "a.tif"], "west must be less");
    refused(&["terrain", "fetch", "--bbox", "0,0,50,50", "-o", "a.tif"], "take a smaller one");
    refused(&["terrain", "fetch", "--bbox", "20,85.1,20.1,85.2", "-o", "a.tif"], "no land in the box");
    refused(&["terrain", "info", "none.tif"], "none.tif cannot be read");
    refused(&["terrain", "clip", "none.tif", "--bbox", "0,0,1,1", "-o", "a.tif"], "none.tif cannot be read");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn an_interrupted_fetch_writes_nothing_and_goes_on_later() {
    let (bucket, folder) = (Bucket::with(&[[85, 6]]), TempDir::new().unwrap());
    bucket.fail(Fault::Trickle, usize::MAX);
    let fetch = ["terrain", "fetch", "--bbox", "6.40,85.50,6.50,85.52", "-o", "dem.tif"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_corpuscle"));
    command.current_dir(folder.path()).args(fetch).stderr(Stdio::piped());
    command.env("CORPUSCLE_GLO30", &bucket.base).env("CORPUSCLE_CACHE", bucket.cache.path());
    let child = command.spawn().unwrap();
    let start = Instant::now();
    while bucket.requests().is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing was asked for");
        sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let ended = child.wait_with_output().unwrap();
    assert!(ended.status.code() == Some(1) && told(&ended).contains("interrupted"), "{}", told(&ended));
    assert!(start.elapsed() < Duration::from_secs(60) && fs::read_dir(folder.path()).unwrap().count() == 0);
    bucket.fail(Fault::Trickle, 0);
    let output = corpuscle(folder.path(), &bucket, &fetch);
    assert!(output.status.success() && folder.path().join("dem.tif").exists(), "{}", told(&output));
}

/// A stand-in for the tile of a scene, whose channel runs along a meridian.
fn stand_in(corner: [i32; 2], channel: f64) -> Bucket {
    let bucket = Bucket::empty();
    let tile = tile_of(corner[0], corner[1], 3600, |longitude, latitude| valley(longitude, latitude, channel));
    bucket.put_tiles([(corner, tile)]);
    bucket
}

/// Runs a scene for some seconds and gives its folder and summary.
fn run_scene(folder: &Path, bucket: &Bucket, name: &str, until: &str) -> (PathBuf, serde_json::Value) {
    let out = folder.join("out");
    let path = out.to_string_lossy().into_owned();
    let arguments = ["run", name, "--until", until, "--frames", "none", "-o", &path, "--json"];
    let summary = json(&corpuscle(folder, bucket, &arguments));
    (out, summary)
}

#[test]
fn the_scenes_on_fetched_terrain_run() {
    let scenes = [("flood/iowa-river", [41, -92], -91.54), ("flood/chishui", [27, 104], 104.867)];
    for (name, corner, channel) in scenes {
        let (bucket, folder) = (stand_in(corner, channel), TempDir::new().unwrap());
        // Without a network the scene is told to need one.
        bucket.fail(Fault::Status(503), usize::MAX);
        let offline = corpuscle(folder.path(), &bucket, &["check", name]);
        assert_eq!(offline.status.code(), Some(1));
        assert!(told(&offline).contains("check the network"), "{}", told(&offline));
        bucket.fail(Fault::Silent, 0);
        let (out, summary) = run_scene(folder.path(), &bucket, name, "3");
        assert_eq!(summary["particles"], 12_000, "{name}");
        assert_eq!(summary["ledger"]["water_m3"]["relative_error"], 0.0);
        assert!(summary["warnings"].to_string().contains("WorldDEM-30"), "{summary}");
        assert!(fs::read_to_string(out.join("report.html")).unwrap().contains("WorldDEM-30"));
        // From the cache, and by the scene as it was written.
        bucket.fail(Fault::Status(503), usize::MAX);
        let scene = out.join("scene.toml").to_string_lossy().into_owned();
        let again = TempDir::new().unwrap();
        let (second, _) = run_scene(again.path(), &bucket, &scene, "3");
        let gauges = |folder: &Path| fs::read(folder.join("gauges.csv")).unwrap();
        assert_eq!(gauges(&second), gauges(&out));
    }
}
