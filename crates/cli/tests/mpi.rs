//! Runs that processes started by `mpirun` share: the same bytes as one process writes, interrupted and killed or not.
//!
//! Built with the feature `mpi`. Skipped where there is no `mpirun`, unless `CORPUSCLE_REQUIRE_MPI` is set.
#![cfg(unix)]

mod results;
mod tool;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use results::{compare, results};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tool::{Ended, Place};

/// Whether there is `mpirun`.
fn has_mpi() -> bool {
    let found = Command::new("mpirun").arg("--version").output().is_ok_and(|output| output.status.success());
    assert!(found || std::env::var_os("CORPUSCLE_REQUIRE_MPI").is_none(), "there is no mpirun");
    if !found {
        eprintln!("skipped: there is no mpirun");
    }
    found
}

/// The program in some processes, each with some threads.
fn mpirun(place: &Place, processes: usize, threads: usize, arguments: &[&str]) -> Command {
    let (processes, threads) = (processes.to_string(), threads.to_string());
    let program = place.command(&[]);
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "-n", &processes]).arg(program.get_program()).args(["--threads", &threads]);
    command.args(arguments).current_dir(place.path(""));
    // In containers of tests everything belongs to root.
    command.envs([("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")]);
    command
}

fn run_on(place: &Place, processes: usize, threads: usize, arguments: &[&str]) -> Ended {
    Ended::of(mpirun(place, processes, threads, arguments).output().unwrap())
}

/// Runs a scene on one process and on others, and compares what they write.
fn same_on_all(arguments: &[&str], on: &[(usize, usize)]) {
    if !has_mpi() {
        return;
    }
    let place = Place::new();
    place.run(&[&["run", "-o", "whole"], arguments].concat()).expect_status(0);
    let expected = results(&place.path("whole"));
    for (processes, threads) in on {
        let folder = format!("on-{processes}-{threads}");
        let ended =
            run_on(&place, *processes, *threads, &[&["run", "-o", &folder], arguments].concat()).expect_status(0);
        let told = ended.stderr.contains(&format!("computing on {processes} processes"));
        assert!(told || *processes == 1, "{}", ended.stderr);
        let when = format!("{processes} processes with {threads} threads");
        compare(&results(&place.path(&folder)), &expected, &when);
        let [found, one] = [folder.as_str(), "whole"].map(|folder| summary(&place, folder));
        for key in ["status", "particles", "steps", "ledger", "simulated_time_s"] {
            assert_eq!(found[key], one[key], "{key}, {when}");
        }
    }
}

fn summary(place: &Place, folder: &str) -> serde_json::Value {
    serde_json::from_slice(&place.read(&format!("{folder}/summary.json"))).unwrap()
}

/// Processes and threads of each.
const ALL: [(usize, usize); 6] = [(2, 1), (3, 1), (4, 1), (1, 2), (2, 2), (3, 2)];

#[test]
fn a_city_has_the_same_bytes() {
    same_on_all(&["flood/city", "--until", "12"], &ALL);
}

#[test]
fn a_valley_has_the_same_bytes() {
    same_on_all(&["flood/valley", "--until", "60"], &ALL);
}

#[test]
fn malpasset_has_the_same_bytes() {
    let Some(data) = std::env::var_os("CORPUSCLE_DATA") else {
        assert!(std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_none(), "CORPUSCLE_DATA is not set");
        return eprintln!("skipped: CORPUSCLE_DATA is not set");
    };
    let place = Place::new();
    let file = |name: &str| Path::new(&data).join("malpasset").join(name).display().to_string();
    let (bed, depth) = (file("bed-20m.tif"), file("initial-depth-20m.tif"));
    let scene = format!(
        "run = {{ until_s = 120, frame_every_s = 60 }}\nterrain.file.path = {bed:?}\n[flood]\nspacing_m = 40\nmanning = 0.033\nwater = [{{ depth_raster = {depth:?} }}]\n"
    );
    place.write("malpasset.toml", &scene);
    same_on_all(&[place.path("malpasset.toml").to_str().unwrap()], &[(2, 1), (4, 1)]);
}

#[test]
fn a_pane_has_the_same_bytes() {
    same_on_all(&["dew/pane", "--until", "4"], &ALL);
}

/// A dam break that takes long enough to be interrupted, with checkpoints all the while.
const LONG: &str = r#"
run = { until_s = 40, frame_every_s = 8, gauge_every_s = 0.1, checkpoint_every_wall_s = 0.02 }
terrain.bump = { extent = { length_m = 200, width_m = 120, cell_m = 2 }, height_m = 2, width_m = 30 }
[flood]
spacing_m = 2
water = [{ level_m = 3, polygon = [[0, 0], [60, 0], [60, 120], [0, 120]] }]
edges = { west = "wall", south = "wall", north = "wall" }
gauge = [{ name = "mid", at = [100, 60] }]
"#;

/// The same of dew.
const LONG_DEW: &str = r#"
run = { until_s = 1.5, frame_every_s = 0.3, gauge_every_s = 0.005, checkpoint_every_wall_s = 0.02 }
[dew]
size_m = [0.04, 0.03, 0.03]
spacing_m = 0.0025
time_factor = 20
air = { temperature_c = 25.0, relative_humidity = 0.9 }
drops = { sites_per_m2 = 1e6, smallest_radius_m = 1e-4 }
faces = { x_max = { inflow = { velocity_m_per_s = [-0.05, 0.0, 0.0] } }, z_min = "open" }
solid = [{ name = "pane", shape = { box = { size_m = [0.005, 0.03, 0.03] } }, position_m = [0.0025, 0.015, 0.015], temperature_c = 5.0 }]
"#;

fn rows(gauges: &Path) -> usize {
    fs::read_to_string(gauges).map_or(0, |text| text.lines().count())
}

fn wait_for_rows(child: &mut Child, gauges: &Path, count: usize) {
    let start = Instant::now();
    while rows(gauges) < count {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be interrupted");
        assert!(start.elapsed() < Duration::from_secs(60), "no gauges after a minute");
        sleep(Duration::from_millis(2));
    }
}

fn signal(name: &str, process: u32) {
    assert!(Command::new("kill").args([name, &process.to_string()]).status().unwrap().success());
}

/// Interrupted by Ctrl-C on three processes, a run is resumed on two.
fn interrupted(scene: &str) {
    if !has_mpi() {
        return;
    }
    let place = Place::new();
    place.write("scene.toml", scene);
    place.run(&["run", "scene.toml", "-o", "whole"]).expect_status(0);
    let arguments = ["run", "scene.toml", "-o", "stopped"];
    let mut child = mpirun(&place, 3, 1, &arguments).stderr(Stdio::piped()).spawn().unwrap();
    wait_for_rows(&mut child, &place.path("stopped/gauges.csv"), 60);
    signal("-INT", child.id());
    let ended = Ended::of(child.wait_with_output().unwrap());
    assert!(ended.status != Some(0) && ended.stderr.contains("resume with"), "{}", ended.stderr);
    assert_eq!(summary(&place, "stopped")["status"], "stopped");
    run_on(&place, 2, 1, &["run", "--resume", "stopped"]).expect_status(0);
    let [found, expected] = ["stopped", "whole"].map(|folder| results(&place.path(folder)));
    compare(&found, &expected, "interrupted");
}

#[test]
fn a_flood_interrupted_on_three_is_resumed_on_two() {
    interrupted(LONG);
}

#[test]
fn dew_interrupted_on_three_is_resumed_on_two() {
    interrupted(LONG_DEW);
}

/// A process, which one is random, is killed at ten random moments; the run ends each time, and goes on from its last checkpoint on another number of
/// processes.
fn killed_at_ten_moments(scene: &str) {
    if !has_mpi() {
        return;
    }
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let place = Place::new();
    place.write("scene.toml", scene);
    place.run(&["run", "scene.toml", "-o", "whole"]).expect_status(0);
    let gauges = place.path("killed/gauges.csv");
    let mut wanted = 20;
    for moment in 0..10 {
        let processes = 2 + moment % 3;
        let arguments =
            if moment == 0 { vec!["run", "scene.toml", "-o", "killed"] } else { vec!["run", "--resume", "killed"] };
        let mut child = mpirun(&place, processes, 1, &arguments).stderr(Stdio::null()).spawn().unwrap();
        wait_for_rows(&mut child, &gauges, wanted);
        sleep(Duration::from_micros(random.random_range(0..20_000)));
        let children = Command::new("pgrep").args(["-P", &child.id().to_string()]).output().unwrap();
        let children: Vec<u32> =
            String::from_utf8(children.stdout).unwrap().lines().map(|line| line.parse().unwrap()).collect();
        assert_eq!(children.len(), processes);
        signal("-KILL", children[random.random_range(0..processes)]);
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < Duration::from_secs(30), "the others have not ended");
            sleep(Duration::from_millis(5));
        };
        assert!(!status.success());
        wanted = rows(&gauges) + 8;
    }
    run_on(&place, 3, 1, &["run", "--resume", "killed"]).expect_status(0);
    let [found, expected] = ["killed", "whole"].map(|folder| results(&place.path(folder)));
    compare(&found, &expected, "killed ten times");
}

#[test]
fn a_flood_killed_at_ten_moments_gives_the_same_bytes() {
    killed_at_ten_moments(LONG);
}

#[test]
fn dew_killed_at_ten_moments_gives_the_same_bytes() {
    killed_at_ten_moments(LONG_DEW);
}

/// What is wrong is told once, by the first process, and all of them end.
#[test]
fn errors_are_told_once() {
    if !has_mpi() {
        return;
    }
    let place = Place::new();
    place.write("scene.toml", LONG);
    fs::create_dir_all(place.path("full/something")).unwrap();
    let cases: [(&[&str], &str); 5] = [
        (&["run", "missing.toml"], "missing.toml"),
        (&["run", "scene.toml", "--set=flood.scheme=sph-swe"], "sph-swe\" is computed by one process only"),
        (&["run", "scene.toml", "-o", "full"], "full"),
        (&["run", "gas/maxwell"], "several processes compute dew, and floods"),
        (&["run", "scene.toml", "--set=flood.manning={ raster = \"no.tif\" }"], "no.tif"),
    ];
    for (arguments, what) in cases {
        let ended = run_on(&place, 3, 1, arguments);
        assert!(ended.status != Some(0), "{arguments:?}");
        let errors: Vec<&str> = ended.stderr.lines().filter(|line| line.starts_with("error:")).collect();
        assert!(errors.len() == 1 && errors[0].contains(what), "{arguments:?}: {}", ended.stderr);
    }
    assert!(!place.path("runs").exists());
}

/// A disk that fills up ends the run on all processes with one error; once there is room it goes on, on another number of them.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_all_and_the_run_goes_on() {
    if !has_mpi() {
        return;
    }
    let place = Place::new();
    place.write("scene.toml", LONG);
    place.run(&["run", "scene.toml", "-o", "whole"]).expect_status(0);
    fs::create_dir(place.path("disk")).unwrap();
    let program = place.command(&[]).get_program().to_str().unwrap().to_owned();
    let script = format!(
        "mount -t tmpfs -o size=700k tmpfs disk || exit 77
        touch began
        mpirun --oversubscribe -n 3 {program} --threads 1 run scene.toml -o disk/run 2>told; echo $? >status
        mount -o remount,size=100m disk
        mpirun --oversubscribe -n 2 {program} --threads 1 run --resume disk/run 2>again || {{ cat again >&2; exit 3; }}
        cp -r disk/run now"
    );
    let allowed = [("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")];
    let mut command = Command::new("unshare");
    let ended = command.args(["-rm", "sh", "-c", &script]).envs(allowed).current_dir(place.path("")).output().unwrap();
    if !place.path("began").exists() {
        return eprintln!("skipped: this system allows no disk of one's own");
    }
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    let told = String::from_utf8(place.read("told")).unwrap();
    assert_ne!(place.read("status"), b"0\n", "{told}");
    let errors: Vec<&str> = told.lines().filter(|line| line.starts_with("error:")).collect();
    assert!(errors.len() == 1 && errors[0].contains("No space left"), "{told}");
    let [found, expected] = ["now", "whole"].map(|folder| results(&place.path(folder)));
    compare(&found, &expected, "full disk");
}
