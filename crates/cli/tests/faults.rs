//! Runs whose system calls fail one by one: a full disk at each write, files that cannot be opened, synchronised or renamed, reads that are
//! interrupted or fail, a clock that jumps, too little memory. `strace` makes the calls fail, `faketime` moves the clock.
#![cfg(target_os = "linux")]

mod results;
mod tool;

use results::{compare, results};
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
}

const MODELS: [Model; 3] = [
    Model {
        name: "gas",
        scene: BALLS,
        changes: &["--set=run.until_s=0.4", "--set=run.frame_every_s=0.2", "--set=run.gauge_every_s=0.1"],
    },
    Model {
        name: "dew",
        scene: DEW,
        changes: &["--set=run.until_s=0.002", "--set=run.frame_every_s=0.001", "--set=run.gauge_every_s=0.0005"],
    },
    Model {
        name: "flood",
        scene: LAKE,
        changes: &["--set=run.until_s=0.4", "--set=run.frame_every_s=0.2", "--set=run.gauge_every_s=0.1"],
    },
];

impl Model {
    /// The arguments that run it into a folder, checkpoints all the while.
    fn arguments<'a>(&self, folder: &'a str) -> Vec<&'a str> {
        let rest = [
            "run",
            "scene.toml",
            "-o",
            folder,
            "--threads=1",
            "--frames=csv",
            "--set=run.checkpoint_every_wall_s=0.02",
        ];
        rest.into_iter().chain(self.changes.iter().copied()).collect()
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

const FAULTS: [Fault; 7] = [
    // A disk that is full, and one on which room is made again.
    Fault { call: "write", error: "ENOSPC", goes_on: true, is_harmless: false },
    Fault { call: "write", error: "ENOSPC", goes_on: false, is_harmless: false },
    Fault { call: "fdatasync", error: "EIO", goes_on: false, is_harmless: false },
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

/// The numbers, from 1, of those calls of a kind of a command that concern files of a folder.
fn calls(place: &Place, call: &str, arguments: &[&str], folder: &str) -> Vec<usize> {
    let trace = format!("trace={call}");
    let ended = Ended::of(traced(place, &["-e", &trace], arguments).output().unwrap()).expect_status(0);
    let text = fs::read_to_string(place.path("trace")).unwrap();
    assert!(!text.is_empty(), "{}", ended.stderr);
    let (inside, relative) = (place.path(folder).display().to_string(), format!("\"{folder}"));
    let lines = text.lines().filter(|line| line.contains(&format!("{call}("))).enumerate();
    lines.filter(|(_, line)| line.contains(&inside) || line.contains(&relative)).map(|(number, _)| number + 1).collect()
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

/// Runs a model with such calls failing in turn, `most` of them spread over all; what is left goes on to the same bytes. The number of such runs.
fn fails_at_each(model: &Model, fault: &Fault, most: usize) -> usize {
    let Model { name, .. } = model;
    let Fault { call, error, goes_on, is_harmless } = fault;
    let place = Place::new();
    place.write("scene.toml", model.scene);
    place.run(&model.arguments("whole")).expect_status(0);
    let expected = results(&place.path("whole"));
    let calls =
        calls(&place, call, &model.arguments("counted"), if *call == "read" { "scene.toml" } else { "counted" });
    assert!(!calls.is_empty(), "{name}: {call} is never called");
    let (mut failed, mut runs) = (0, 0);
    let apart = calls.len().div_ceil(most);
    for number in calls.into_iter().step_by(apart) {
        let when = format!("{name}, {call} {number} fails with {error}");
        let inject = format!("inject={call}:error={error}:when={number}{}", if *goes_on { "+" } else { "" });
        let output = traced(&place, &["-e", &format!("trace={call}"), "-e", &inject], &model.arguments("run")).output();
        let ended = Ended::of(output.unwrap());
        assert!(!ended.stderr.contains("panicked"), "{when}: {}", ended.stderr);
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
        compare(&results(&place.path("run")), &expected, &when);
        fs::remove_dir_all(place.path("run")).unwrap();
        runs += 1;
    }
    assert!(*is_harmless || failed > 0, "{name}: no failure of {call} was told");
    println!(
        "{name}, {call} fails with {error}: {runs} runs, {failed} ended by it, all gone on with to the same bytes"
    );
    runs
}

fn all_fail(most: usize) {
    if !has("strace", &["-o", "/dev/null", "true"]) {
        return;
    }
    for model in &MODELS {
        let runs: usize = FAULTS.iter().map(|fault| fails_at_each(model, fault, most)).sum();
        println!("{}: {runs} runs in which a call failed", model.name);
    }
}

#[test]
fn calls_that_fail_are_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(2);
}

#[test]
#[ignore = "takes minutes"]
fn each_call_that_fails_is_told_and_the_run_goes_on_to_the_same_bytes() {
    all_fail(usize::MAX);
}

/// A scene and a table that come from pipes, a few bytes in each read.
#[test]
fn reads_that_return_little_at_a_time_change_nothing() {
    let place = Place::new();
    let table = "time_s,discharge_m3_per_s\n0,0\n0.2,3\n0.4,1\n";
    let scene = format!(
        "{LAKE}\n[[flood.inflow]]\nname = \"pipe\"\nat = [5, 5]\ndischarge_m3_per_s = {{ csv = \"table.csv\" }}\n"
    );
    let arguments = |folder| ["run", "scene.toml", "--frames=csv", "--set=run.until_s=0.4", "-o", folder];
    place.write("scene.toml", &scene);
    place.write("table.csv", table);
    place.run(&arguments("whole")).expect_status(0);
    let writers = [("scene.toml", scene.as_str()), ("table.csv", table)].map(|(name, text)| {
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
fn a_clock_that_jumps_changes_nothing() {
    let library = ["x86_64", "aarch64"].map(|arch| format!("/usr/lib/{arch}-linux-gnu/faketime/libfaketime.so.1"));
    let library = library.iter().find(|path| Path::new(path).exists());
    let required = std::env::var_os("CORPUSCLE_REQUIRE_FAULTS").is_some_and(|value| value == "1");
    let Some(library) = library else {
        assert!(!required, "faketime is needed");
        return eprintln!("skipped: needs faketime");
    };
    let place = Place::new();
    place.write("scene.toml", LAKE);
    let long = [
        "run",
        "scene.toml",
        "--set=flood.spacing_m=0.5",
        "--frames=csv",
        "--set=run.checkpoint_every_wall_s=0.01",
        "-o",
    ];
    let with = |folder| long.into_iter().chain([folder]).collect::<Vec<_>>();
    place.run(&with("whole")).expect_status(0);
    place.write("clock", "+0");
    let mut command = place.command(&with("jumped"));
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
    assert!(made > 4, "{made} jumps");
    compare(&results(&place.path("jumped")), &results(&place.path("whole")), "a clock that jumps");
}

/// Balls that need more memory than there is: the run ends, and what was written goes on to the same bytes where there is enough.
#[test]
fn memory_that_runs_out_loses_nothing_that_was_written() {
    let place = Place::new();
    place.write("scene.toml", LAKE);
    let long = "scene.toml --set=flood.spacing_m=1 --frames=csv --threads=1 --set=run.checkpoint_every_wall_s=0.05";
    let arguments: Vec<_> = ["run"].into_iter().chain(long.split(' ')).chain(["-o", "whole"]).collect();
    place.run(&arguments).expect_status(0);
    let expected = results(&place.path("whole"));
    let (mut ended_early, binary) = (0, env!("CARGO_BIN_EXE_corpuscle"));
    let starts = |limit: &usize| {
        let script = format!("ulimit -v {limit}; exec {binary} --version");
        Command::new("sh").args(["-c", &script]).output().is_ok_and(|output| output.status.success())
    };
    // KiB of addresses: from too few to run anything to enough.
    for limit in (20_000..400_000).step_by(8_000).skip_while(|limit| !starts(limit)) {
        let script = format!("ulimit -v {limit}; exec {binary} run {long} -o small");
        let output = Command::new("sh").args(["-c", &script]).current_dir(place.path("")).output().unwrap();
        let is_done = output.status.success();
        if !is_done {
            ended_early += 1;
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(!told.is_empty(), "{limit} KiB: nothing is told");
        }
        if place.path("small/checkpoint/state").exists() && !is_done {
            place.run(&["run", "--resume", "small"]).expect_status(0);
            compare(&results(&place.path("small")), &expected, &format!("{limit} KiB"));
        } else if is_done {
            compare(&results(&place.path("small")), &expected, &format!("{limit} KiB"));
        }
        _ = fs::remove_dir_all(place.path("small"));
        if is_done {
            break;
        }
    }
    assert!(ended_early > 0, "{ended_early}");
}
