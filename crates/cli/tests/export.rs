//! `corpuscle export`: what it writes, and what it refuses.

mod tool;

use std::fs;
use tool::{BALLS, LAKE, Place};

/// First bytes of a file.
fn begins(place: &Place, file: &str, with: &[u8]) -> bool {
    place.read(file).starts_with(with)
}

#[test]
fn a_run_is_exported_in_every_format() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    assert!(place.command(&["run", "lake.toml", "-o", "run"]).output().unwrap().status.success());
    let files = ["maps.nc", "gauges.parquet", "particles.vtkhdf", "particles.xyz"];
    let output = place.command(&[&["export", "run"], &files[..], &["--json"]].concat()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let written: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for (index, file) in files.into_iter().enumerate() {
        let bytes = fs::metadata(place.path(file)).unwrap().len();
        assert_eq!((&written[index]["file"], &written[index]["bytes"]), (&file.into(), &bytes.into()));
    }
    assert_eq!(written[0]["format"], "nc");
    let hdf5 = b"\x89HDF\r\n\x1a\n";
    assert!(begins(&place, "maps.nc", hdf5) && begins(&place, "particles.vtkhdf", hdf5));
    assert!(begins(&place, "gauges.parquet", b"PAR1"));
    let text = String::from_utf8(place.read("particles.xyz")).unwrap();
    // Frames at 0, 1 and 2 s.
    assert_eq!(text.lines().filter(|line| line.contains("Properties=")).count(), 3);
}

#[test]
fn what_cannot_be_exported_is_refused_and_writes_nothing() {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    place.write("there.parquet", "mine");
    assert!(place.command(&["run", "balls.toml", "-o", "run", "--frames", "none"]).output().unwrap().status.success());
    let refused = [
        (["export", "run", "maps.nc"], "holds no maps; floods write them"),
        (["export", "run", "particles.vtkhdf"], "run its scene.toml again with `--frames vtp`"),
        (["export", "run", "gauges.xlsx"], "end its name with .nc"),
        (["export", "run", "there.parquet"], "not overwritten"),
        (["export", "elsewhere", "gauges.parquet"], "holds no run"),
    ];
    for (arguments, message) in refused {
        let output = place.command(&arguments).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && told.contains(message), "{told}");
        let written = arguments[2] != "there.parquet" && place.path(arguments[2]).exists();
        assert!(!written, "{} was written", arguments[2]);
    }
    assert_eq!(place.read("there.parquet"), b"mine");
    // One bad name among several: none is written.
    let output = place.command(&["export", "run", "gauges.parquet", "there.parquet"]).output().unwrap();
    assert!(output.status.code() == Some(2) && !place.path("gauges.parquet").exists());
}
