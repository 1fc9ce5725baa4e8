//! Runs of random scenes one after another for hours, on the CPU and on a GPU, with pictures: memory, open files and threads stay as they are.

use crate::drive::scratch;
use crate::memory::{allocated, give_back};
use crate::scenes::{Kind, scene};
use corpuscle::gpu::Gpu;
use corpuscle::pictures::{PictureSettings, Pictures};
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
    /// Resident memory, KiB, once free memory has been given back to the system: what an allocator keeps in pieces differs from scene to scene, and grows for
    /// hours without anything being held.
    pub resident_kib: u64,
    /// Memory that the program itself has allocated, KiB, without that of libraries in C.
    pub allocated_kib: u64,
    /// Open files.
    pub files: usize,
    /// Threads.
    pub threads: u64,
    /// Memory in use on the GPU, KiB; 0 where there is none, or it does not say.
    pub gpu_kib: u64,
}

/// Longest time of a scene.
const LONGEST: Duration = Duration::from_secs(5);

/// Scenes that share a device. A driver may keep all programs that it has compiled until the device is closed, as Mesa's does: other
/// scenes ask for other ones.
const SCENES_A_DEVICE: u64 = 25;

/// Memory may rise by this over the first half of the time, KiB: what is kept differs from scene to scene.
const SPREAD_KIB: u64 = 50 * 1024;

impl Use {
    fn now(start: Instant, scenes: u64, gpu: Option<&Gpu>) -> std::io::Result<Self> {
        give_back();
        let status = fs::read_to_string("/proc/self/status")?;
        let number = |key: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(key));
            line.and_then(|rest| rest.split_whitespace().next()?.parse().ok()).unwrap_or(0)
        };
        Ok(Self {
            time_s: start.elapsed().as_secs_f64(),
            scenes,
            resident_kib: number("VmRSS:"),
            allocated_kib: allocated() as u64 / 1024,
            files: fs::read_dir("/proc/self/fd")?.count(),
            threads: number("Threads:"),
            gpu_kib: gpu.map_or(0, gpu_kib),
        })
    }
}

/// Memory in use on a GPU once it has done all that it was given, KiB.
fn gpu_kib(gpu: &Gpu) -> u64 {
    _ = gpu.device.poll(corpuscle::gpu::wgpu::PollType::wait_indefinitely());
    gpu.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes / 1024)
}

/// Runs scenes for a time, each recorded in a folder, interrupted and resumed; a row of the log for each of `rows` equal parts of the time. With a GPU, which
/// `open` opens, every second round of scenes takes its steps on it, what it can compute, and a picture of each is drawn.
///
/// # Errors
/// Where the system does not say what this process uses, or a file cannot be written.
pub fn soak(
    time: Duration,
    seed: u64,
    rows: u32,
    log: &Path,
    open: impl Fn() -> Option<Gpu>,
) -> std::io::Result<Vec<Use>> {
    let start = Instant::now();
    let folder = scratch()?;
    let mut file = fs::File::create(log)?;
    writeln!(file, "time_s\tscenes\tresident_kib\tallocated_kib\tfiles\tthreads\tgpu_kib")?;
    let (mut rows_of, mut scenes) = (Vec::new(), 0);
    let mut gpu = open();
    while start.elapsed() < time {
        if scenes % SCENES_A_DEVICE == SCENES_A_DEVICE - 1 && gpu.is_some() {
            drop(gpu);
            gpu = open();
        }
        let (_, kind) = Kind::ALL[(scenes % Kind::ALL.len() as u64) as usize];
        let (text, _) = scene(kind, seed + scenes, &[]);
        let are_steps_there = scenes / Kind::ALL.len() as u64 % 2 == 1;
        if let Err(error) = run(&text, &folder.path().join("run"), gpu.as_ref(), are_steps_there) {
            eprintln!("{kind:?}, seed {}: {error}", seed + scenes);
        }
        _ = fs::remove_dir_all(folder.path().join("run"));
        scenes += 1;
        if start.elapsed() >= (rows_of.len() as u32 + 1) * time / rows {
            let row = Use::now(start, scenes, gpu.as_ref())?;
            let Use { time_s, scenes, resident_kib, allocated_kib, files, threads, gpu_kib } = row;
            writeln!(file, "{time_s:.0}\t{scenes}\t{resident_kib}\t{allocated_kib}\t{files}\t{threads}\t{gpu_kib}")?;
            rows_of.push(row);
        }
    }
    Ok(rows_of)
}

/// A run that is stopped after half of its time, and resumed; then a picture, where there is a GPU.
fn run(text: &str, path: &Path, gpu: Option<&Gpu>, are_steps_there: bool) -> Result<(), corpuscle::Error> {
    let steps_on = gpu.filter(|_| are_steps_there);
    let mut simulation = Simulation::open(Scene::parse(text, "scene.toml", &[])?, Path::new(""))?;
    step_on(steps_on, &mut simulation)?;
    let mut recorder = Recorder::create(path, &simulation, FrameFormat::Vtp)?;
    stopped(|stop| simulation.run(&mut [&mut recorder], stop, &mut |_| {}).map(|_| ()))?;
    drop((simulation, recorder));
    let (mut simulation, mut recorder) = Recorder::resume(path)?;
    step_on(steps_on, &mut simulation)?;
    stopped(|stop| simulation.run(&mut [&mut recorder], stop, &mut |_| {}).map(|_| ()))?;
    gpu.map_or(Ok(()), |gpu| draw(&simulation, gpu))
}

/// Steps on a GPU from now on, where the model can.
fn step_on(gpu: Option<&Gpu>, simulation: &mut Simulation) -> Result<(), corpuscle::Error> {
    match gpu {
        Some(gpu) if simulation.model().cpu_only().is_none() => simulation.use_this_gpu(gpu.clone()),
        _ => Ok(()),
    }
}

/// A small picture of a model, from the GPU's own memory where it steps there.
fn draw(simulation: &Simulation, gpu: &Gpu) -> Result<(), corpuscle::Error> {
    let settings = PictureSettings { size: [320, 200], samples: 1, ..PictureSettings::default() };
    Pictures::open_on(gpu, simulation, settings)?.draw_model(simulation.model()).map(|_| ())
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
    let counts = |row: &Use| [row.resident_kib, row.allocated_kib, row.gpu_kib, row.files as u64, row.threads];
    let names = ["resident memory, KiB,", "allocated memory, KiB,", "memory on the GPU, KiB,", "open files", "threads"];
    for (number, (name, spread)) in names.into_iter().zip([SPREAD_KIB, SPREAD_KIB, 0, 0, 0]).enumerate() {
        let most = first.iter().map(|row| counts(row)[number]).max()?;
        let now = counts(last)[number];
        if now > most + spread {
            return Some(format!("{name} grew from {most} to {now}"));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(resident_kib: u64, files: usize, threads: u64) -> Use {
        Use { time_s: 1.0, scenes: 1, resident_kib, allocated_kib: 5, files, threads, gpu_kib: 7 }
    }

    #[test]
    fn growth_is_noticed_and_its_absence_too() {
        let flat = [row(100_000, 9, 3), row(120_000, 10, 3), row(90_000, 9, 3), row(121_000, 10, 3)];
        assert_eq!(growth(&flat), None);
        let allocated = Use { allocated_kib: 90_000, ..row(1000, 9, 3) };
        let on_gpu = Use { gpu_kib: 8, ..row(1000, 9, 3) };
        for (last, word) in [
            (row(200_000, 9, 3), "resident"),
            (allocated, "allocated"),
            (on_gpu, "GPU"),
            (row(1000, 11, 3), "files"),
            (row(1000, 9, 4), "threads"),
        ] {
            let rows = [&flat[..], &[last]].concat();
            assert!(growth(&rows).is_some_and(|words| words.contains(word)), "{word}");
        }
    }
}
