//! Runs that are interrupted, by hand or by a full disk.
#![cfg(unix)]

mod results;
mod tool;

use results::{compare, results};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tool::{BALLS, DEW, Ended, LAKE, Place};

/// What makes the small lake slosh, and long enough to be interrupted.
const LONG: [&str; 6] = [
    "--set=flood.spacing_m=0.5",
    "--set=flood.water.0.velocity_m_per_s=[0.5, 0.1]",
    "--set=run.until_s=12",
    "--set=run.frame_every_s=2",
    "--set=run.gauge_every_s=0.1",
    "--frames=csv",
];

/// What makes the balls run long enough to be interrupted.
const LONG_GAS: [&str; 5] = [
    "--set=run.until_s=600",
    "--set=run.frame_every_s=100",
    "--set=run.gauge_every_s=1",
    "--frames=csv",
    "--threads=2",
];

fn wait_for_rows(child: &mut Child, gauges: &Path, rows: usize) {
    let start = Instant::now();
    while fs::read_to_string(gauges).map_or(0, |text| text.lines().count()) < rows {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be interrupted");
        assert!(start.elapsed() < Duration::from_secs(60), "no gauges after a minute");
        sleep(Duration::from_millis(2));
    }
}

fn signal(name: &str, child: &Child) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn interrupted_or_killed_and_resumed_a_flood_gives_the_same_bytes() {
    interrupted_and_resumed(LAKE, &LONG);
}

#[test]
fn interrupted_or_killed_and_resumed_a_gas_gives_the_same_bytes() {
    interrupted_and_resumed(BALLS, &LONG_GAS);
}

fn interrupted_and_resumed(scene: &str, long: &[&str]) {
    let place = Place::new();
    place.write("scene.toml", scene);
    place.run(&[&["run", "scene.toml", "-o", "whole"], long].concat()).expect_status(0);
    let expected = results(&place.path("whole"));

    let arguments = [&["run", "scene.toml", "-o", "stopped"], long].concat();
    let mut child = place.command(&arguments).stderr(Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut child, &place.path("stopped/gauges.csv"), 20);
    signal("-INT", &child);
    let ended = Ended::of(child.wait_with_output().unwrap()).expect_status(1);
    assert!(ended.stderr.contains("corpuscle run --resume stopped"), "{}", ended.stderr);
    let summary: serde_json::Value = serde_json::from_slice(&place.read("stopped/summary.json")).unwrap();
    assert_eq!(summary["status"], "stopped");
    assert!(results(&place.path("stopped")).len() < expected.len());

    // Killed on the way, it goes on from the checkpoint that the interruption left.
    let mut child = place.command(&["run", "--resume", "stopped"]).stderr(Stdio::null()).spawn().unwrap();
    let rows = fs::read_to_string(place.path("stopped/gauges.csv")).unwrap().lines().count();
    wait_for_rows(&mut child, &place.path("stopped/gauges.csv"), rows + 5);
    signal("-KILL", &child);
    child.wait().unwrap();

    place.run(&["run", "--resume", "stopped", "--threads", "1"]).expect_status(0);
    compare(&results(&place.path("stopped")), &expected, "interrupted and killed");
    assert!(place.path("stopped/report.html").is_file());
}

#[test]
fn killed_at_ten_moments_and_resumed_a_flood_gives_the_same_bytes() {
    killed_and_resumed(&[]);
}

#[test]
fn killed_at_ten_moments_and_resumed_a_flood_by_scheme_sph_swe_gives_the_same_bytes() {
    killed_and_resumed(&["--set=flood.scheme=sph-swe"]);
}

/// Killed ten times, each time a little after some more rows, and checkpoints all the while: some kills meet one being written.
fn killed_and_resumed(changes: &[&str]) {
    let place = Place::new();
    place.write("scene.toml", LAKE);
    let long = [&LONG[..], &["--set=run.checkpoint_every_wall_s=0.005"], changes].concat();
    place.run(&[&["run", "scene.toml", "-o", "whole"], &long[..]].concat()).expect_status(0);
    let gauges = place.path("killed/gauges.csv");
    let mut rows = 0;
    for moment in 0..10_u64 {
        let arguments = match moment {
            0 => [&["run", "scene.toml", "-o", "killed"], &long[..]].concat(),
            _ => vec!["run", "--resume", "killed"],
        };
        let mut child = place.command(&arguments).stderr(Stdio::null()).spawn().unwrap();
        rows += 3 + moment as usize % 4;
        wait_for_rows(&mut child, &gauges, rows);
        sleep(Duration::from_micros(1700 * moment));
        signal("-KILL", &child);
        child.wait().unwrap();
    }
    place.run(&["run", "--resume", "killed"]).expect_status(0);
    let [found, expected] = ["killed", "whole"].map(|folder| results(&place.path(folder)));
    compare(&found, &expected, "killed ten times");
}

/// Each model with what makes it run long enough, and checkpoints all the while.
fn models() -> [(&'static str, &'static str, Vec<&'static str>); 4] {
    let often = "--set=run.checkpoint_every_wall_s=0.005";
    [
        ("gas", BALLS, [&LONG_GAS[..], &[often]].concat()),
        ("dew", DEW, vec!["--frames=csv"]),
        ("voronoi", LAKE, [&LONG[..], &[often]].concat()),
        ("sph-swe", LAKE, [&LONG[..], &[often, "--set=flood.scheme=sph-swe"]].concat()),
    ]
}

/// A run that a signal met ends by it: at once, or told with how to go on. One that is only just begun has no handler of signals yet.
fn assert_ended_by(signal: &str, output: &Output, when: &str) {
    let number = match signal {
        "-KILL" => 9,
        "-INT" => 2,
        _ => 15,
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(!told.contains("panicked"), "{when}: {told}");
    if output.status.signal() == Some(number) {
        return;
    }
    assert!(signal != "-KILL" && output.status.code() == Some(1), "{when}, {signal}: {} {told}", output.status);
    assert!(told.contains("corpuscle run --resume ended"), "{when}, {signal}: {told}");
}

/// Ended at so many random moments by signals in turn; the run that is left goes on to the same bytes.
fn ended_at_random_moments(signals: &[&str], moments: u64) {
    for (model, scene, long) in models() {
        let place = Place::new();
        place.write("scene.toml", scene);
        let start = Instant::now();
        place.run(&[&["run", "scene.toml", "-o", "whole"], &long[..]].concat()).expect_status(0);
        let duration = start.elapsed();
        let expected = results(&place.path("whole"));
        let compare = |when: &str| compare(&results(&place.path("ended")), &expected, &format!("{model}, {when}"));
        let begin = |resumes: bool| match resumes {
            true => vec!["run", "--resume", "ended"],
            false => [&["run", "scene.toml", "-o", "ended"], &long[..]].concat(),
        };
        let mut hits = 0;
        let mut random = 0x9e37_79b9_7f4a_7c15_u64;
        for moment in 0..moments {
            let resumes = place.path("ended/checkpoint/state").exists();
            if !resumes {
                // Ended before the first checkpoint: resuming says so, and nothing is lost but the beginning.
                if place.path("ended").exists() {
                    let ended = place.run(&begin(true)).expect_status(2);
                    assert!(ended.stderr.starts_with("error: "), "{model}: {}", ended.stderr);
                    fs::remove_dir_all(place.path("ended")).unwrap();
                }
            }
            let mut child =
                place.command(&begin(resumes)).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sleep(duration.mul_f64((random >> 40) as f64 / (1 << 24) as f64 / 4.0));
            let name = signals[moment as usize % signals.len()];
            let is_live = child.try_wait().unwrap().is_none();
            if is_live {
                signal(name, &child);
            }
            let output = child.wait_with_output().unwrap();
            if output.status.success() {
                compare(&format!("at its end before signal {moment}"));
                fs::remove_dir_all(place.path("ended")).unwrap();
                continue;
            }
            assert!(is_live, "{model}: ended by itself: {}", String::from_utf8_lossy(&output.stderr));
            assert_ended_by(name, &output, &format!("{model}, moment {moment}"));
            hits += 1;
        }
        println!("{model}: {hits} of {moments} signals met a run and ended it");
        assert!(2 * hits >= moments, "{model}: {hits} of {moments} signals met a run and ended it");
        let resumes = place.path("ended/checkpoint/state").exists();
        if !resumes {
            _ = fs::remove_dir_all(place.path("ended"));
        }
        place.run(&begin(resumes)).expect_status(0);
        compare("at its end");
    }
}

#[test]
fn killed_and_signalled_at_a_few_random_moments_each_model_gives_the_same_bytes() {
    ended_at_random_moments(&["-KILL", "-INT", "-TERM"], 6);
}

#[test]
#[ignore = "takes minutes"]
fn killed_at_a_hundred_random_moments_each_model_gives_the_same_bytes() {
    ended_at_random_moments(&["-KILL"], 100);
}

#[test]
#[ignore = "takes minutes"]
fn signalled_at_two_hundred_random_moments_each_model_gives_the_same_bytes() {
    ended_at_random_moments(&["-INT", "-TERM"], 200);
}

/// A limit on the size of files stands for a full disk: both fail a write half way.
#[test]
fn a_write_that_fails_ends_the_run_and_leaves_what_is_there_readable() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let binary = env!("CARGO_BIN_EXE_corpuscle");
    let long = LONG.map(|argument| format!("'{argument}'")).join(" ");
    let script =
        format!("trap '' XFSZ; ulimit -f 16; exec {binary} run lake.toml -o full {long} --set=flood.spacing_m=1");
    let output = Command::new("sh").args(["-c", &script]).current_dir(place.path("")).output().unwrap();
    let ended = Ended::of(output).expect_status(1);
    let words = ["cannot write", "full/", "stays readable"];
    assert!(words.iter().all(|word| ended.stderr.contains(word)), "{}", ended.stderr);
    let gauges = fs::read_to_string(place.path("full/gauges.csv")).unwrap();
    assert!(gauges.starts_with("time_s,") && gauges.ends_with('\n'));
    fs::read_dir(place.path("full/frames")).unwrap().for_each(|entry| {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(name.starts_with("frame_"), "litter: {name}");
    });
}

#[test]
fn standard_output_that_cannot_be_written_is_an_error_and_one_that_is_closed_is_not() {
    let place = Place::new();
    let script = format!("{} scenes | true", env!("CARGO_BIN_EXE_corpuscle"));
    let closed = Ended::of(Command::new("sh").args(["-c", &script]).output().unwrap()).expect_status(0);
    assert_eq!(closed.stderr, "");
    if cfg!(target_os = "linux") {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let ended = Ended::of(place.command(&["scenes"]).stdout(full).stderr(Stdio::piped()).output().unwrap());
        assert!(ended.expect_status(1).stderr.contains("standard output"));
    }
}
