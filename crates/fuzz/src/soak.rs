//! Runs of random scenes one after another for hours: memory, open files and threads stay as they are.

use crate::drive::scratch;
use crate::scenes::{Kind, scene};
use corpuscle::{Recorder, Simulation};
use corpuscle_output::FrameFormat;
use corpuscle_scene::Scene;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// What the system says of this process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Use {
    /// Since the start, s.
    pub time_s: f64,
    /// Scenes run so far.
    pub scenes: u64,
    /// Resident memory, KiB.
    pub resident_kib: u64,
    /// Open files.
    pub files: usize,
    /// Threads.
    pub threads: u64,
}

/// Longest time of a scene.
const LONGEST: Duration = Duration::from_secs(5);

/// Resident memory may rise by this over the first half of the time, KiB: what the allocator keeps differs from scene to scene.
const SPREAD_KIB: u64 = 50 * 1024;

impl Use {
    fn now(start: Instant, scenes: u64) -> std::io::Result<Self> {
        let status = fs::read_to_string("/proc/self/status")?;
        let number = |key: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(key));
            line.and_then(|rest| rest.split_whitespace().next()?.parse().ok()).unwrap_or(0)
        };
        Ok(Self {
            time_s: start.elapsed().as_secs_f64(),
            scenes,
            resident_kib: number("VmRSS:"),
            files: fs::read_dir("/proc/self/fd")?.count(),
            threads: number("Threads:"),
        })
    }
}

/// Runs scenes for a time, each recorded in a folder, interrupted and resumed; a row of the log for each of `rows` equal parts of the time.
///
/// # Errors
/// Where the system does not say what this process uses, or a file cannot be written.
pub fn soak(time: Duration, seed: u64, rows: u32, log: &Path) -> std::io::Result<Vec<Use>> {
    let start = Instant::now();
    let folder = scratch()?;
    let mut file = fs::File::create(log)?;
    writeln!(file, "time_s\tscenes\tresident_kib\tfiles\tthreads")?;
    let (mut rows_of, mut scenes) = (Vec::new(), 0);
    while start.elapsed() < time {
        let (_, kind) = Kind::ALL[(scenes % Kind::ALL.len() as u64) as usize];
        let (text, _) = scene(kind, seed + scenes, &[]);
        _ = run(&text, &folder.path().join("run"));
        _ = fs::remove_dir_all(folder.path().join("run"));
        scenes += 1;
        if start.elapsed() >= (rows_of.len() as u32 + 1) * time / rows {
            let row = Use::now(start, scenes)?;
            writeln!(file, "{:.0}\t{}\t{}\t{}\t{}", row.time_s, row.scenes, row.resident_kib, row.files, row.threads)?;
            rows_of.push(row);
        }
    }
    Ok(rows_of)
}

/// A run that is stopped after half of its time, and resumed.
fn run(text: &str, path: &Path) -> Result<(), corpuscle::Error> {
    let scene = Scene::parse(text, "scene.toml", &[])?;
    let mut simulation = Simulation::open(scene, Path::new(""))?;
    let mut recorder = Recorder::create(path, &simulation, FrameFormat::Vtp)?;
    stopped(|stop| simulation.run(&mut [&mut recorder], stop, &mut |_| {}).map(|_| ()))?;
    drop((simulation, recorder));
    let (mut simulation, mut recorder) = Recorder::resume(path)?;
    stopped(|stop| simulation.run(&mut [&mut recorder], stop, &mut |_| {}).map(|_| ()))
}

/// Work that is told to stop after half of the longest time.
fn stopped<T>(work: impl FnOnce(&AtomicBool) -> T) -> T {
    let stop = Arc::new(AtomicBool::new(false));
    let (done, waits) = std::sync::mpsc::channel::<()>();
    let flag = stop.clone();
    let watch = thread::spawn(move || {
        _ = waits.recv_timeout(LONGEST / 2);
        flag.store(true, Ordering::Relaxed);
    });
    let result = work(&stop);
    drop(done);
    _ = watch.join();
    result
}

/// What has grown from the first half of the rows to the last one; none where all is flat.
pub fn growth(rows: &[Use]) -> Option<String> {
    let (last, before) = rows.split_last()?;
    let first = &before[..before.len().div_ceil(2)];
    let resident = first.iter().map(|row| row.resident_kib).max()?;
    if last.resident_kib > resident + SPREAD_KIB {
        return Some(format!("resident memory grew from {resident} to {} KiB", last.resident_kib));
    }
    for (name, of) in
        [("open files", (|row: &Use| row.files as u64) as fn(&Use) -> u64), ("threads", |row| row.threads)]
    {
        let most = first.iter().map(of).max()?;
        if of(last) > most {
            return Some(format!("{name} grew from {most} to {}", of(last)));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(resident_kib: u64, files: usize, threads: u64) -> Use {
        Use { time_s: 1.0, scenes: 1, resident_kib, files, threads }
    }

    #[test]
    fn growth_is_noticed_and_its_absence_too() {
        let flat = [row(100_000, 9, 3), row(120_000, 10, 3), row(90_000, 9, 3), row(121_000, 10, 3)];
        assert_eq!(growth(&flat), None);
        for (last, word) in [(row(200_000, 9, 3), "memory"), (row(1000, 11, 3), "files"), (row(1000, 9, 4), "threads")]
        {
            let rows = [&flat[..], &[last]].concat();
            assert!(growth(&rows).is_some_and(|words| words.contains(word)), "{word}");
        }
    }
}
