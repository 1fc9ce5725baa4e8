//! A run's folder: what stands in it, that it is never overwritten, and that an interrupted run loses nothing.

mod common;

use common::{advance, finish, gauge_columns, scene, terrain, write_run};
use corpuscle_output::{Clock, FrameFormat, OutputError, Report, RunFolder, Summary, next_run_folder};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// All files below a folder with their content.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(current) = folders.pop() {
        for path in fs::read_dir(&current).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                all.insert(name, fs::read(path).unwrap());
            }
        }
    }
    all
}

#[test]
fn a_run_has_the_files_that_scripts_depend_on() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("run"));
    write_run(&path, &scene, &terrain(&scene), FrameFormat::Vtp);
    let all = files(&path);
    let expected = [
        "checkpoint/state",
        "frames/frame_000000.vtp",
        "frames/frame_000018.vtp",
        "frames/frames.pvd",
        "gauges.csv",
        "log.txt",
        "maps/arrival_s.tif",
        "maps/depth_000000.tif",
        "maps/depth_000018.tif",
        "maps/duration_s.tif",
        "maps/extent.geojson",
        "maps/run_up.geojson",
        "maps/hazard.tif",
        "maps/max_depth.tif",
        "maps/max_speed.tif",
        "maps/times.csv",
        "scene.toml",
        "summary.json",
    ];
    for name in expected {
        assert!(all.contains_key(name), "{name} is not there");
    }
    assert!(!all.contains_key("frames/frame_000019.vtp"));
    assert!(!all.contains_key("maps/depth.tif"));
    assert_eq!(Summary::read(&path).unwrap(), common::summary());
}

#[test]
fn an_interrupted_run_that_is_resumed_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene();
    let terrain = terrain(&scene);
    for format in [FrameFormat::Vtp, FrameFormat::Csv, FrameFormat::Xyz, FrameFormat::None] {
        let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(format!("{name}-{format:?}")));
        write_run(&whole, &scene, &terrain, format);
        let mut run = RunFolder::create(&broken, &scene.to_toml().unwrap(), &gauge_columns(&scene), format).unwrap();
        advance(&mut run, &scene, &terrain, 0, 1510.0);
        run.write_checkpoint(Clock { time_s: 1500.0, wall_time_s: 9.0 }, b"state at 1500 s").unwrap();
        let rows = run.gauge_rows();
        advance(&mut run, &scene, &terrain, rows, 2800.0);
        drop(run);
        // The crash tears the last row.
        let mut gauges = fs::read(broken.join("gauges.csv")).unwrap();
        gauges.truncate(gauges.len() - 7);
        fs::write(broken.join("gauges.csv"), gauges).unwrap();
        // And leaves a file half written.
        fs::write(broken.join("maps/.writing-1"), b"half").unwrap();

        let (mut run, clock, state) = RunFolder::resume(&broken).unwrap();
        assert_eq!((clock.time_s, state.as_slice()), (1500.0, b"state at 1500 s".as_slice()));
        assert_eq!((run.gauge_rows(), run.frame_format()), (51, format));
        assert_eq!(run.frame_times().last(), Some(&1500.0));
        assert!(!broken.join("maps/depth_000006.tif").exists());
        let rows = run.gauge_rows();
        advance(&mut run, &scene, &terrain, rows, scene.run.until_s);
        finish(&mut run, &scene, &terrain);
        let (whole, broken) = (files(&whole), files(&broken));
        assert_eq!(whole.keys().collect::<Vec<_>>(), broken.keys().collect::<Vec<_>>());
        for (name, content) in &whole {
            assert!(content == &broken[name], "{name} differs ({format:?})");
        }
    }
}

#[test]
fn a_run_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    RunFolder::create(&path, "first", &[], FrameFormat::None).unwrap();
    let error = RunFolder::create(&path, "second", &[], FrameFormat::None).unwrap_err();
    assert!(matches!(error, OutputError::Exists { .. }), "{error}");
    assert_eq!(fs::read_to_string(path.join("scene.toml")).unwrap(), "first");
}

#[test]
fn new_folders_are_numbered_and_free() {
    let folder = tempfile::tempdir().unwrap();
    let runs = folder.path().join("runs");
    let paths = [1, 2].map(|_| next_run_folder(&runs, "valley").unwrap());
    assert_eq!(paths, [runs.join("valley-1"), runs.join("valley-2")]);
    RunFolder::create(&paths[0], "scene", &[], FrameFormat::None).unwrap();
}

#[test]
fn what_cannot_be_resumed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(RunFolder::resume(folder.path()), Err(OutputError::Read { .. })));
    let path = folder.path().join("run");
    let run = RunFolder::create(&path, "scene", &[], FrameFormat::None).unwrap();
    assert!(matches!(RunFolder::resume(&path), Err(OutputError::NoCheckpoint { .. })));
    run.write_checkpoint(Clock { time_s: 0.0, wall_time_s: 0.0 }, b"state").unwrap();
    assert!(RunFolder::resume(&path).is_ok());
    fs::write(path.join("scene.toml"), "another scene").unwrap();
    assert!(matches!(RunFolder::resume(&path), Err(OutputError::Checkpoint { .. })));
}

#[test]
fn a_write_that_fails_names_the_file_and_spares_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("run"));
    let terrain = terrain(&scene);
    let mut run = write_run(&path, &scene, &terrain, FrameFormat::Vtp);
    let before = files(&path);
    // A folder that stands where the next file should be.
    fs::create_dir(path.join("frames/frame_000019.vtp")).unwrap();
    let wave = common::Wave::new(&terrain);
    let error = run.write_frame(&wave.frame(5700.0), None).unwrap_err().to_string();
    assert!(error.contains("frame_000019.vtp") && error.contains("stays readable"), "{error}");
    assert_eq!(run.frame_times().len(), 19);
    assert_eq!(files(&path), before);
    Report::read(&path, &scene, &terrain).unwrap();
}

#[test]
fn gauge_rows_must_fit_the_header() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene();
    let columns = gauge_columns(&scene);
    let mut run = RunFolder::create(&folder.path().join("run"), "scene", &columns, FrameFormat::None).unwrap();
    assert!(matches!(run.append_gauges(0.0, &[1.0]), Err(OutputError::GaugeCount { .. })));
}

#[test]
fn the_log_grows_line_by_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "scene", &[], FrameFormat::None).unwrap();
    run.log("started").unwrap();
    run.log("ended").unwrap();
    assert_eq!(fs::read_to_string(run.path().join("log.txt")).unwrap(), "started\nended\n");
}
