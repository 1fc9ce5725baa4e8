//! A disk that is full: at the start, and in the middle of a run.
#![cfg(target_os = "linux")]

mod results;
mod tool;

use results::results;
use std::fs;
use std::process::Command;
use tool::{LAKE, Place};

/// Makes the small lake slosh, and write some megabytes.
const SLOSHING: &str = "--set=flood.spacing_m=1 --set=flood.water.0.velocity_m_per_s=[0.5,0.1] --set=run.until_s=6 \
                        --set=run.frame_every_s=0.2 --frames=csv";

/// Runs a script in a folder where `disk` is a disk of 1.5 MB of its own. None where this system does not allow that.
fn with_small_disk(place: &Place, script: &str) -> Option<()> {
    fs::create_dir(place.path("disk")).unwrap();
    let script = format!("mount -t tmpfs -o size=1500k tmpfs disk || exit 77\nC={}\n{script}", binary());
    let ended = Command::new("unshare").args(["-rm", "sh", "-c", &script]).current_dir(place.path("")).output().ok()?;
    let text = String::from_utf8_lossy(&ended.stderr).into_owned();
    match ended.status.code() {
        Some(0) => Some(()),
        // `unshare` itself ends with 1 where namespaces are not allowed.
        Some(1 | 77) if !place.path("began").exists() => {
            eprintln!("skipped: this system allows no disk of one's own ({})", text.trim());
            None
        }
        _ => panic!("{text}"),
    }
}

fn binary() -> &'static str {
    env!("CARGO_BIN_EXE_corpuscle")
}

fn text(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

#[test]
fn a_disk_that_is_full_at_the_start_leaves_nothing_behind() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let script = "touch began
        cat /dev/zero >disk/fill 2>/dev/null
        $C run lake.toml -o disk/run 2>told; echo $? >status
        ls -A disk >left
        rm disk/fill; mount -o remount,size=100m disk
        $C run lake.toml -o disk/run --frames none 2>again || { cat again >&2; exit 3; }";
    let Some(()) = with_small_disk(&place, script) else { return };
    assert_eq!(text(&place, "status"), "1\n");
    let told = text(&place, "told");
    assert!(told.contains("disk/run/scene.toml") && told.contains("free some space there"), "{told}");
    // Where it computes, and the error.
    let lines: Vec<_> = told.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("computing on ") && lines[1].starts_with("error: "), "{told}");
    assert!(!told.contains("--resume"), "{told}");
    assert_eq!(text(&place, "left"), "fill\n");
}

#[test]
fn a_disk_that_fills_up_ends_the_run_and_it_goes_on_once_there_is_room() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let script = format!(
        "touch began
        $C run lake.toml -o disk/run {SLOSHING} 2>told; echo $? >status
        cp -r disk/run then
        mount -o remount,size=100m disk
        $C run --resume disk/run 2>again || {{ cat again >&2; exit 3; }}
        cp -r disk/run now
        $C run lake.toml -o whole {SLOSHING} 2>>again"
    );
    let Some(()) = with_small_disk(&place, &script) else { return };
    assert_eq!(text(&place, "status"), "1\n");
    let told = text(&place, "told");
    let words = ["cannot", "disk/run/", "No space left", "corpuscle run --resume disk/run"];
    assert!(words.iter().all(|word| told.contains(word)) && !told.contains("panicked"), "{told}");
    // What was written is whole: it is part of what an undisturbed run writes.
    let whole = results(&place.path("whole"));
    let gauges = text(&place, "then/gauges.csv");
    assert!(text(&place, "whole/gauges.csv").starts_with(&gauges) && gauges.ends_with('\n'));
    let frames: Vec<_> =
        results(&place.path("then")).into_iter().filter(|(name, _)| name.starts_with("frames/")).collect();
    assert!(!frames.is_empty() && frames.iter().all(|frame| whole.contains(frame)));
    assert!(frames.len() < whole.iter().filter(|(name, _)| name.starts_with("frames/")).count());
    assert!(results(&place.path("now")) == whole, "the run that went on differs");
    assert!(place.path("now/report.html").is_file());
}
