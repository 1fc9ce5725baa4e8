//! Runs whose system calls fail one by one: a full disk at each write, files that cannot be opened, synchronised or renamed, reads that are
//! interrupted or fail, a clock that jumps, too little memory. `strace` makes the calls fail, `faketime` moves the clock.
#![cfg(target_os = "linux")]

mod results;
mod tool;

use results::{compare, results};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use tool::{BALLS, DEW, Ended, LAKE, Place};

/// Whether a tool works here; a test without it is skipped and says so.
///
/// # Panics
/// Where it does not, and the environment has `CORPUSCLE_REQUIRE_FAULTS=1`.
fn has(tool: &str, arguments: &[&str]) -> bool {
    let works = Command::new(tool).args(arguments).output().is_ok_and(|output| output.status.success());
    let required = std::env::var_os("CORPUSCLE_REQUIRE_FAULTS").is_some_and(|value| value == "1");
    assert!(works || !required, "{tool} is needed, and may trace or preload");
    if !works {
        eprintln!("skipped: needs {tool}, which may trace or preload");
    }
    works
}

/// A model that runs briefly and writes all kinds of files.
struct Model {
    name: &'static str,
    scene: &'static str,
    changes: &'static [&'static str],
    /// Calls of each kind that fail in the short test: the pictures of a flood take seconds in each run.
    few: usize,
}

const MODELS: [Model; 4] = [
    Model {
        name: "gas",
        few: 2,
        scene: BALLS,
        changes: &["--set=run.until_s=0.4", "--set=run.frame_every_s=0.2", "--set=run.gauge_every_s=0.1"],
    },
    Model {
        name: "dew",
        few: 2,
        scene: DEW,
        changes: &["--set=run.until_s=0.004", "--set=run.frame_every_s=0.002", "--set=run.gauge_every_s=0.001"],
    },
    Model {
        name: "flood, scheme voronoi",
        few: 1,
        scene: LAKE,
        changes: &["--set=run.until_s=0.4", "--set=run.frame_every_s=0.2", "--set=run.gauge_every_s=0.1"],
    },
    Model {
        name: "flood, scheme sph-swe",
        few: 1,
        scene: LAKE,
        changes: &[
            "--set=flood.scheme=sph-swe",
            "--set=run.until_s=0.4",
            "--set=run.frame_every_s=0.2",
            "--set=run.gauge_every_s=0.1",
        ],
    },
];

impl Model {
    /// The arguments that run it into a folder, checkpoints all the while.
    fn arguments<'a>(&self, folder: &'a str) -> Vec<&'a str> {
        self.arguments_with(folder, &["--threads=1", "--set=run.checkpoint_every_wall_s=0.02"])
    }

    /// The arguments that run it into a folder, with more of them.
    fn arguments_with<'a>(&self, folder: &'a str, more: &[&'static str]) -> Vec<&'a str> {
        let rest = ["run", "scene.toml", "-o", folder, "--frames=csv"];
        rest.into_iter().chain(self.changes.iter().copied()).chain(more.iter().copied()).collect()
    }
}

/// A system call, the error that it meets, and whether only the first such call fails or all from then on.
struct Fault {
    call: &'static str,
    error: &'static str,
    goes_on: bool,
    /// Nothing must come of it.
    is_harmless: bool,
}

const FAULTS: [Fault; 8] = [
    // A disk that is full, and one on which room is made again.
    Fault { call: "write", error: "ENOSPC", goes_on: true, is_harmless: false },
    Fault { call: "write", error: "ENOSPC", goes_on: false, is_harmless: false },
    Fault { call: "fdatasync", error: "EIO", goes_on: false, is_harmless: false },
    Fault { call: "fsync", error: "EIO", goes_on: false, is_harmless: false },
    Fault { call: "renameat", error: "EACCES", goes_on: false, is_harmless: false },
    Fault { call: "openat", error: "EACCES", goes_on: false, is_harmless: false },
    Fault { call: "read", error: "EIO", goes_on: false, is_harmless: false },
    Fault { call: "read", error: "EINTR", goes_on: false, is_harmless: true },
];

/// A command under `strace`, which writes what it traces to a file.
fn traced(place: &Place, options: &[&str], arguments: &[&str]) -> Command {
    let mut command = Command::new("strace");
    command.args(["-f", "-qq", "-y", "--seccomp-bpf", "-o", "trace"]).args(options);
    command
        .arg(env!("CARGO_BIN_EXE_corpuscle"))
        .args(arguments)
        .current_dir(place.path(""))
        .env_remove("CORPUSCLE_DATA");
    command
}

/// The system calls of a whole run of a model, as `strace` tells them.
fn trace_of_calls(place: &Place, model: &Model) -> String {
    let mut calls: Vec<_> = FAULTS.iter().map(|fault| fault.call).collect();
    calls.dedup();
    let trace = format!("trace={}", calls.join(","));
    let ended = Ended::of(traced(place, &["-e", &trace], &model.arguments("counted")).output().unwrap());
    let ended = ended.expect_status(0);
    let text = fs::read_to_string(place.path("trace")).unwrap();
    assert!(!text.is_empty(), "{}", ended.stderr);
    text
}

/// The numbers, from 1, of those calls of a kind that concern files of a folder. They are counted for each thread, as `strace` counts them
/// for what it lets fail.
fn numbers(trace: &str, call: &str, inside: &str, relative: &str) -> Vec<usize> {
    let (call, mut counts) = (format!("{call}("), BTreeMap::new());
    let calls = trace.lines().filter_map(|line| {
        let (thread, rest) = line.split_once(' ')?;
        if !rest.trim_start().starts_with(&call) {
            return None;
        }
        let count = counts.entry(thread).or_insert(0);
        *count += 1;
        (line.contains(inside) || line.contains(relative)).then_some(*count)
    });
    let mut found: Vec<usize> = calls.collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Nothing half-written is left beside what is whole.
fn assert_no_litter(folder: &Path) {
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).into_iter().flatten() {
            let path = entry.unwrap().path();
            assert!(
                !path.file_name().unwrap().to_string_lossy().starts_with(".writing-"),
                "litter: {}",
                path.display()
            );
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
}

/// A model with the files that it writes when nothing fails, and the calls that it makes.
struct Whole<'a> {
    model: &'a Model,
    place: Place,
    expected: Vec<(String, Vec<u8>)>,
    trace: String,
}

impl<'a> Whole<'a> {
    fn of(model: &'a Model) -> Self {
        let place = Place::new();
        place.write("scene.toml", model.scene);
        place.run(&model.arguments("whole")).expect_status(0);
        let (expected, trace) = (results(&place.path("whole")), trace_of_calls(&place, model));
        Self { model, place, expected, trace }
    }

    fn numbers(&self, call: &str) -> Vec<usize> {
        let file = if call == "read" { "scene.toml" } else { "counted" };
        numbers(&self.trace, call, &self.place.path(file).display().to_string(), &format!("\"{file}"))
    }
}

/// Least part of the runs in which the call that was to fail came and failed. How many calls there are depends a little on the clock.
const LEAST_INJECTED: f64 = 0.8;

/// Runs a model with such calls failing in turn, `most` of them spread over all; what is left goes on to the same bytes. The number of runs
/// in which a call failed.
fn fails_at_each(whole: &Whole<'_>, fault: &Fault, most: usize) -> usize {
    let Whole { model, place, expected, .. } = whole;
    let Model { name, .. } = model;
    let Fault { call, error, goes_on, is_harmless } = fault;
    let calls = whole.numbers(call);
    assert!(!calls.is_empty(), "{name}: {call} is never called");
    let (mut failed, mut injected, mut runs) = (0, 0, 0);
    // Files that cannot be opened end a run only where something is to be written to them or read from them.
    let most = if *call == "openat" { most.max(2) } else { most };
    // One alone is amid the run, and early enough that one with far fewer calls comes to it, as where the traced one was slow.
    let (first, apart) = if most == 1 { (calls.len() / 4, calls.len()) } else { (0, calls.len().div_ceil(most)) };
    for number in calls.into_iter().skip(first).step_by(apart) {
        let when = format!("{name}, {call} {number} fails with {error}");
        let inject = format!("inject={call}:error={error}:when={number}{}", if *goes_on { "+" } else { "" });
        let output = traced(place, &["-e", &format!("trace={call}"), "-e", &inject], &model.arguments("run")).output();
        let ended = Ended::of(output.unwrap());
        assert!(!ended.stderr.contains("panicked"), "{when}: {}", ended.stderr);
        let is_injected = fs::read_to_string(place.path("trace")).unwrap().contains("(INJECTED)");
        assert!(is_injected || ended.status == Some(0), "{when}: nothing failed, but {}", ended.stderr);
        // Where standard output and error are full, too, nothing can be said.
        let is_told = ended.stderr.lines().any(|line| line.starts_with("error: ")) || *goes_on;
        assert!(
            ended.status == Some(0) || matches!(ended.status, Some(1 | 2)) && is_told,
            "{when}: {:?} {}",
            ended.status,
            ended.stderr
        );
        assert!(!is_harmless || ended.status == Some(0), "{when}: {}", ended.stderr);
        assert_no_litter(&place.path("run"));
        if ended.status != Some(0) {
            failed += 1;
            let resumed = place.run(&["run", "--resume", "run"]);
            if resumed.status != Some(0) {
                assert!(
                    resumed.status == Some(2) && resumed.stderr.starts_with("error: "),
                    "{when}: {}",
                    resumed.stderr
                );
                assert!(!place.path("run/checkpoint/state").exists(), "{when}: {}", resumed.stderr);
                // Before the first checkpoint nothing is lost but the beginning.
                _ = fs::remove_dir_all(place.path("run"));
                place.run(&model.arguments("run")).expect_status(0);
            }
        }
        compare(&results(&place.path("run")), expected, &when);
        fs::remove_dir_all(place.path("run")).unwrap();
        (runs, injected) = (runs + 1, injected + usize::from(is_injected));
    }
    assert!(*is_harmless || failed > 0, "{name}: no failure of {call} was told");
    println!(
        "{name}, {call} fails with {error}: in {injected} of {runs} runs a call failed, {failed} ended by it, all gone on with to the same bytes"
    );
    assert!(
        injected as f64 >= LEAST_INJECTED * runs as f64,
        "{name}, {call}: in {injected} of {runs} runs a call failed"
    );
    injected
}

fn all_fail(model: &Model, most: usize) {
    if !has("strace", &["-o", "/dev/null", "true"]) {
        return;
    }
    let whole = Whole::of(model);
    let runs: usize = FAULTS.iter().map(|fault| fails_at_each(&whole, fault, most)).sum();
    println!("{}: {runs} runs in which a call failed", model.name);
}

/// What a checkpoint counts is on the disk before it, and its name when it is there.
#[test]
fn a_checkpoint_follows_the_rows_that_it_counts_onto_the_disk() {
    if !has("strace", &["-o", "/dev/null", "true"]) {
        return;
    }
    let whole = Whole::of(&MODELS[0]);
    let calls: Vec<&str> = whole.trace.lines().collect();
    let is_checkpoint = |line: &&str| line.contains("renameat") && line.contains("checkpoint/state");
    let renamed = calls.iter().position(is_checkpoint).unwrap();
    let rows = calls[..renamed].iter().any(|line| line.contains("fdatasync(") && line.contains("gauges.csv"));
    assert!(rows, "gauges.csv is not on the disk before the checkpoint: {}", calls[..renamed].join("\n"));
    let next = calls[renamed + 1..].iter().find(|line| line.contains("sync(")).unwrap();
    assert!(next.contains("fsync(") && next.contains("/checkpoint>"), "{next}");
}

// A test for each model, so that they run side by side.
#[test]
fn calls_of_a_gas_that_fail_are_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(&MODELS[0], MODELS[0].few);
}

#[test]
fn calls_of_dew_that_fail_are_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(&MODELS[1], MODELS[1].few);
}

#[test]
fn calls_of_a_flood_that_fail_are_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(&MODELS[2], MODELS[2].few);
}

#[test]
fn calls_of_a_flood_by_sph_swe_that_fail_are_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(&MODELS[3], MODELS[3].few);
}

#[test]
#[ignore = "takes minutes"]
fn each_call_that_fails_is_told_and_the_run_goes_on_to_the_same_bytes() {
    MODELS.iter().for_each(|model| all_fail(model, usize::MAX));
}

/// Whether a run whose files come from pipes, a few bytes in each read, writes what it else does.
fn reads_in_pieces(scene: &str, other: (&str, &str), changes: &[&str]) {
    let place = Place::new();
    let files = [("scene.toml", scene), other];
    let arguments = |folder| [&["run", "scene.toml", "--frames=csv", "-o", folder], changes].concat();
    files.iter().for_each(|(name, text)| place.write(name, text));
    place.run(&arguments("whole")).expect_status(0);
    let writers = files.map(|(name, text)| {
        fs::remove_file(place.path(name)).unwrap();
        assert!(Command::new("mkfifo").arg(place.path(name)).status().unwrap().success());
        let (path, text) = (place.path(name), text.to_owned());
        // Once for each time that the file is opened.
        std::thread::spawn(move || {
            loop {
                // Until the test is over and the pipe is gone.
                let Ok(mut pipe) = fs::OpenOptions::new().write(true).open(&path) else { return };
                for piece in text.as_bytes().chunks(3) {
                    // The reader may have read enough.
                    if pipe.write_all(piece).is_err() {
                        break;
                    }
                    std::thread::sleep(std::time::Duration::from_micros(200));
                }
                // The reader meets the end of the file before the pipe is opened again.
                drop(pipe);
                std::thread::sleep(std::time::Duration::from_millis(300));
            }
        })
    });
    place.run(&arguments("pieces")).expect_status(0);
    compare(&results(&place.path("pieces")), &results(&place.path("whole")), "little at a time");
    assert!(writers.iter().all(|writer| !writer.is_finished()));
}

#[test]
fn reads_of_a_flood_that_return_little_at_a_time_change_nothing() {
    let inflow = "[[flood.inflow]]\nname = \"pipe\"\nat = [5, 5]\ndischarge_m3_per_s = { csv = \"table.csv\" }\n";
    let table = ("table.csv", "time_s,discharge_m3_per_s\n0,0\n0.2,3\n0.4,1\n");
    reads_in_pieces(&format!("{LAKE}\n{inflow}"), table, &["--set=run.until_s=0.4"]);
}

#[test]
fn reads_of_a_gas_that_return_little_at_a_time_change_nothing() {
    let scene =
        "run = { until_s = 2.0, frame_every_s = 1.0 }\n[gas]\nsize = [40.0, 40.0, 40.0]\nstart_file = \"balls.csv\"\n";
    let balls = "set,id,x,y,z,vx,vy,vz,radius,mass\nlight,0,10,20,30,5,0,-1,2,1\nlight,1,30,20,10,-5,3,2,2,1\nheavy,2,20,20,20,0,0,0,4,9\n";
    reads_in_pieces(scene, ("balls.csv", balls), &[]);
}

#[test]
fn reads_of_dew_that_return_little_at_a_time_change_nothing() {
    let scene = DEW.replace("temperature_c = 5.0,", "temperature_c = { csv = \"pane.csv\" },");
    assert_ne!(scene, DEW);
    reads_in_pieces(&scene, ("pane.csv", "time_s,temperature_c\n0,5\n0.002,6\n0.004,4\n"), MODELS[1].changes);
}

/// Each model long enough for a clock to jump amid it, with checkpoints all the while.
const LONGER: [Model; 3] = [
    Model {
        name: "gas",
        few: 2,
        scene: BALLS,
        changes: &["--set=run.until_s=60", "--set=run.frame_every_s=20", "--set=run.gauge_every_s=1"],
    },
    Model { name: "dew", few: 0, scene: DEW, changes: &["--set=run.until_s=0.008", "--set=run.frame_every_s=0.004"] },
    Model { name: "flood", few: 0, scene: LAKE, changes: &["--set=flood.spacing_m=0.5"] },
];

#[test]
fn a_clock_that_jumps_changes_nothing() {
    let library = ["x86_64", "aarch64"].map(|arch| format!("/usr/lib/{arch}-linux-gnu/faketime/libfaketime.so.1"));
    let library = library.iter().find(|path| Path::new(path).exists());
    let required = std::env::var_os("CORPUSCLE_REQUIRE_FAULTS").is_some_and(|value| value == "1");
    let Some(library) = library else {
        assert!(!required, "faketime is needed");
        return eprintln!("skipped: needs faketime");
    };
    LONGER.iter().for_each(|model| jumps(model, library));
}

/// Runs a model while the clock jumps.
fn jumps(model: &Model, library: &str) {
    let place = Place::new();
    place.write("scene.toml", model.scene);
    let arguments = |folder| model.arguments_with(folder, &["--set=run.checkpoint_every_wall_s=0.01"]);
    place.run(&arguments("whole")).expect_status(0);
    place.write("clock", "+0");
    let mut command = place.command(&arguments("jumped"));
    command
        .env("LD_PRELOAD", library)
        .env("FAKETIME_TIMESTAMP_FILE", place.path("clock"))
        .env("FAKETIME_NO_CACHE", "1");
    let mut child = command.stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let jumps = ["-2d", "+30d", "-1h", "+0"];
    let mut made = 0;
    while child.try_wait().unwrap().is_none() {
        // A file that is read half-written would be no time: it is replaced whole.
        place.write("clock.new", jumps[made % jumps.len()]);
        fs::rename(place.path("clock.new"), place.path("clock")).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(20));
        made += 1;
    }
    Ended::of(child.wait_with_output().unwrap()).expect_status(0);
    assert!(made > 4, "{}: {made} jumps", model.name);
    compare(&results(&place.path("jumped")), &results(&place.path("whole")), model.name);
}

/// A limit on memory below what a run needs: the run ends, and what was written goes on to the same bytes where there is enough.
#[test]
fn memory_that_runs_out_loses_nothing_that_was_written() {
    LONGER.iter().for_each(|model| runs_out_of_memory(model, 32_000));
}

#[test]
#[ignore = "takes minutes"]
fn memory_that_runs_out_at_any_limit_loses_nothing_that_was_written() {
    LONGER.iter().for_each(|model| runs_out_of_memory(model, 4_000));
}

/// Runs a model with limits that are so many KiB apart, from too little memory to run anything to enough.
fn runs_out_of_memory(model: &Model, apart: usize) {
    let Model { name, .. } = model;
    let place = Place::new();
    place.write("scene.toml", model.scene);
    let arguments = |folder| model.arguments_with(folder, &["--threads=1", "--set=run.checkpoint_every_wall_s=0.05"]);
    place.run(&arguments("whole")).expect_status(0);
    let expected = results(&place.path("whole"));
    let (mut ended_early, binary) = (0, env!("CARGO_BIN_EXE_corpuscle"));
    let starts = |limit: &usize| {
        let script = format!("ulimit -v {limit}; exec {binary} --version");
        Command::new("sh").args(["-c", &script]).output().is_ok_and(|output| output.status.success())
    };
    let mut limits = (20_000..400_000).step_by(apart).skip_while(|limit| !starts(limit));
    let is_enough = limits.any(|limit| {
        let script = format!("ulimit -v {limit}; exec {binary} {}", arguments("small").join(" "));
        let output = Command::new("sh").args(["-c", &script]).current_dir(place.path("")).output().unwrap();
        let is_done = output.status.success();
        if !is_done {
            ended_early += 1;
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(!told.is_empty(), "{name}, {limit} KiB: nothing is told");
        }
        if place.path("small/checkpoint/state").exists() && !is_done {
            place.run(&["run", "--resume", "small"]).expect_status(0);
        }
        if is_done || place.path("small/checkpoint/state").exists() {
            compare(&results(&place.path("small")), &expected, &format!("{name}, {limit} KiB"));
        }
        _ = fs::remove_dir_all(place.path("small"));
        is_done
    });
    println!("{name}: ended early at {ended_early} limits");
    assert!(ended_early > 0 && is_enough, "{name}: ended early at {ended_early} limits, {is_enough}");
}
