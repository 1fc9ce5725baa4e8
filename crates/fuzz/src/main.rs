//! The command line of the fuzz targets.

use clap::{Parser, Subcommand};
use corpuscle::gpu::Gpu;
use corpuscle_fuzz::drive::{self, Until, call, file_name, fuzz};
use corpuscle_fuzz::scenes::{Kind, Trial, scene, shorter, try_scene};
use corpuscle_fuzz::soak::{growth, soak};
use corpuscle_fuzz::{Target, corpus, targets};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::num::NonZeroUsize;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

#[derive(Parser)]
#[command(about = "Fuzz targets of every reader of Corpuscle")]
struct Arguments {
    #[command(subcommand)]
    command: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Lists the targets
    List,
    /// Calls targets with changed inputs
    Run(Run),
    /// Runs random valid scenes for 200 steps each
    Scenes(Scenes),
    /// Runs a scene file as one of a kind
    Try {
        /// gas, dew, voronoi, sph-swe or lake
        kind: String,
        /// Scene file
        file: PathBuf,
    },
    /// Runs random scenes for hours, every second round of them on a GPU; logs memory, open files and threads
    #[command(hide = true)]
    Soak {
        /// Time, h
        #[arg(long, default_value_t = 1.0)]
        hours: f64,
        /// Seed of the scenes
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// File with a row for each hundredth of the time
        #[arg(long, default_value = "soak.tsv")]
        log: PathBuf,
    },
    /// Reads inputs once: the valid ones, those found, or a file
    Replay {
        /// Target, or `all`
        target: String,
        /// File to read instead
        file: Option<PathBuf>,
    },
}

#[derive(clap::Args)]
struct Scenes {
    /// gas, dew, voronoi, sph-swe, lake, or `all`
    kind: String,
    /// Scenes of each kind
    #[arg(long, default_value_t = 100)]
    count: u64,
    /// Seed of the first
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for scenes in which something does not hold
    #[arg(long, default_value = "fuzz-found")]
    out: PathBuf,
    /// Prints the scenes instead of running them
    #[arg(long)]
    print: bool,
}

#[derive(clap::Args, Clone)]
struct Run {
    /// Targets, or `all`
    #[arg(required = true)]
    targets: Vec<String>,
    /// Longest time for each target, s
    #[arg(long, default_value_t = 60.0)]
    seconds: f64,
    /// Most calls of each target
    #[arg(long, default_value_t = u64::MAX)]
    executions: u64,
    /// Seed of the changes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for inputs that fail
    #[arg(long, default_value = "fuzz-found")]
    out: PathBuf,
    /// File to which a line with what was measured is added for each target
    #[arg(long)]
    log: Option<PathBuf>,
    /// Address space that a worker may have, MiB
    #[arg(long, default_value_t = 8192)]
    address_space_mib: u64,
    /// Targets that are called at the same time
    #[arg(long, default_value_t = NonZeroUsize::MIN)]
    at_once: NonZeroUsize,
    /// Calls the target in this process
    #[arg(long, hide = true)]
    worker: Option<PathBuf>,
    /// Leaves out the first inputs as they are
    #[arg(long, hide = true)]
    no_seeds: bool,
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Task::List => {
            targets().iter().for_each(|target| println!("{:16} {}", target.name, target.about));
            Ok(true)
        }
        Task::Run(run) => match &run.worker {
            Some(current) => work(&run, current),
            None => run_all(&run),
        },
        Task::Scenes(scenes) => run_scenes(&scenes),
        Task::Try { kind, file } => try_file(&kind, &file),
        Task::Soak { hours, seed, log } => run_soak(hours, seed, &log),
        Task::Replay { target, file } => replay(&target, file.as_deref()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run_scenes(scenes: &Scenes) -> Result<bool, String> {
    let kinds: Vec<_> =
        Kind::ALL.into_iter().filter(|(name, _)| scenes.kind == "all" || scenes.kind == *name).collect();
    if kinds.is_empty() {
        return Err(format!("there are no scenes `{}`", scenes.kind));
    }
    let mut sound = true;
    for (name, kind) in kinds {
        let start = Instant::now();
        let (mut held, mut refused, mut found, mut steps) = (0, BTreeMap::new(), 0, 0);
        for seed in scenes.seed..scenes.seed + scenes.count {
            let (text, _) = scene(kind, seed, &[]);
            if scenes.print {
                println!("# {name} {seed}\n{text}");
                continue;
            }
            match try_scene(kind, &text) {
                Trial::Sound(taken) => {
                    held += 1;
                    steps += taken;
                }
                Trial::Refused(words) => {
                    let gist: String = words.chars().filter(|c| !c.is_ascii_digit()).take(100).collect();
                    *refused.entry(gist).or_insert(0) += 1;
                }
                Trial::Finding(finding) => {
                    found += 1;
                    let off = shorter(kind, seed, &finding);
                    let text = scene(kind, seed, &off).0;
                    let Trial::Finding(finding) = try_scene(kind, &text) else { continue };
                    let file = scenes.out.join(format!("{name}-{seed}.toml"));
                    let about = format!("# {}: {}\n{text}", finding.kind, finding.what.replace('\n', " "));
                    fs::create_dir_all(&scenes.out)
                        .and_then(|()| fs::write(&file, about))
                        .map_err(|error| error.to_string())?;
                    println!("{name} {seed}: {}: {}; {}", finding.kind, finding.what, file.display());
                }
            }
        }
        let seconds = start.elapsed().as_secs_f64();
        let no: u64 = refused.values().sum();
        println!("{name}: {held} sound, {steps} steps, {no} refused, {found} with findings, {seconds:.0} s");
        for (words, count) in refused {
            println!("    {count} x {words}");
        }
        sound &= found == 0;
    }
    Ok(sound)
}

fn try_file(name: &str, file: &Path) -> Result<bool, String> {
    let (_, kind) =
        Kind::ALL.into_iter().find(|(other, _)| *other == name).ok_or(format!("there are no scenes `{name}`"))?;
    let text = fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let trial = try_scene(kind, &text);
    println!("{trial:?}");
    Ok(!matches!(trial, Trial::Finding(_)))
}

fn run_soak(hours: f64, seed: u64, log: &Path) -> Result<bool, String> {
    let open = || Gpu::open().map_err(|error| println!("without a GPU: {error}")).ok();
    let time = Duration::from_secs_f64(3600.0 * hours);
    let rows = soak(time, seed, 100, log, open).map_err(|error| error.to_string())?;
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return Err("too short a time".into()) };
    println!("{} scenes; first row {first:?}; last row {last:?}", last.scenes);
    let growth = growth(&rows);
    println!("{}", growth.as_deref().unwrap_or("flat"));
    Ok(growth.is_none())
}

fn chosen(names: &[String]) -> Result<Vec<Target>, String> {
    let all = targets();
    if names == ["all"] {
        return Ok(all);
    }
    let find = |name: &String| {
        all.iter().copied().find(|target| target.name == name).ok_or_else(|| format!("there is no target `{name}`"))
    };
    names.iter().map(find).collect()
}

/// Calls a target in this process; says what came of it on standard output.
fn work(run: &Run, current: &Path) -> Result<bool, String> {
    let target = chosen(&run.targets)?[0];
    let until = Until { time: Duration::from_secs_f64(run.seconds), executions: run.executions };
    let outcome = fuzz(&target, run.seed, until, current, !run.no_seeds).map_err(|error| error.to_string())?;
    for (kind, input) in &outcome.failures {
        keep(&run.out, &target, kind, input)?;
    }
    println!(
        "done\t{}\t{}\t{}\t{}\t{}",
        outcome.executions,
        outcome.read,
        outcome.outcomes,
        outcome.memory,
        outcome.longest.as_secs_f64()
    );
    Ok(outcome.failures.is_empty())
}

/// Keeps an input that fails, with a word about it.
fn keep(out: &Path, target: &Target, kind: &str, input: &[u8]) -> Result<(), String> {
    let folder = out.join(target.name);
    let path = folder.join(file_name(input));
    fs::create_dir_all(&folder)
        .and_then(|()| fs::write(&path, input))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    println!("failure\t{kind}\t{} bytes\t{}", input.len(), path.display());
    Ok(())
}

/// After so many failures a target is called no longer.
const MOST_FAILURES: usize = 10;

/// What the workers of a target did.
#[derive(Default)]
struct Sum {
    executions: u64,
    read: u64,
    outcomes: u64,
    memory: u64,
    longest: f64,
    failures: usize,
}

fn run_all(run: &Run) -> Result<bool, String> {
    println!(
        "{:16} {:>12} {:>10} {:>7} {:>9} {:>9} {:>9} failures",
        "target", "executions", "per s", "read %", "outcomes", "MiB", "longest"
    );
    let waiting = Mutex::new(chosen(&run.targets)?.into_iter());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let lane = || -> Result<bool, String> {
        let mut is_sound = true;
        while let Some(target) = next() {
            let (sum, seconds) = run_target(run, &target)?;
            report(run, &target, &sum, seconds)?;
            is_sound &= sum.failures == 0;
        }
        Ok(is_sound)
    };
    thread::scope(|scope| {
        let lanes: Vec<_> = (0..run.at_once.get()).map(|_| scope.spawn(lane)).collect();
        let ended = lanes.into_iter().map(|lane| lane.join().map_err(|_| "a lane panicked".to_owned())?);
        ended.collect::<Result<Vec<_>, _>>().map(|sound| sound.into_iter().all(|is_sound| is_sound))
    })
}

/// Prints what came of a target, and adds it to the log.
fn report(run: &Run, target: &Target, sum: &Sum, seconds: f64) -> Result<(), String> {
    let rate = sum.executions as f64 / seconds;
    let read = 100.0 * sum.read as f64 / sum.executions.max(1) as f64;
    let mib = sum.memory as f64 / f64::from(1 << 20);
    println!(
        "{:16} {:>12} {rate:>10.0} {read:>7.1} {:>9} {mib:>9.1} {:>7.2} s {}",
        target.name, sum.executions, sum.outcomes, sum.longest, sum.failures
    );
    let Some(log) = &run.log else { return Ok(()) };
    let mut file = fs::OpenOptions::new().create(true).append(true).open(log).map_err(|error| error.to_string())?;
    let line = format!(
        "{}\t{}\t{seconds:.1}\t{read:.1}\t{}\t{mib:.1}\t{:.3}\t{}\n",
        target.name, sum.executions, sum.outcomes, sum.longest, sum.failures
    );
    file.write_all(line.as_bytes()).map_err(|error| error.to_string())
}

/// Has workers call a target until its time is over; one that ended before is followed by another.
fn run_target(run: &Run, target: &Target) -> Result<(Sum, f64), String> {
    let scratch = drive::scratch().map_err(|error| error.to_string())?;
    let current = scratch.path().join("current");
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let start = Instant::now();
    let mut sum = Sum::default();
    let mut seed = run.seed;
    loop {
        let left = run.seconds - start.elapsed().as_secs_f64();
        let more = run.executions.saturating_sub(sum.executions);
        if (left <= 0.0 || more == 0) && seed > run.seed {
            break;
        }
        // A limit on the address space ends a worker that takes too much memory before the machine has none.
        let mut command = Command::new("sh");
        command.args(["-c", &format!("ulimit -v {}; exec \"$0\" \"$@\"", run.address_space_mib * 1024)]);
        command.arg(&program).args(["run", target.name, "--worker"]).arg(&current).arg("--out").arg(&run.out);
        command.args([
            "--seconds",
            &left.max(0.0).to_string(),
            "--executions",
            &more.to_string(),
            "--seed",
            &seed.to_string(),
        ]);
        if seed > run.seed {
            command.arg("--no-seeds");
        }
        let words = fs::File::create(scratch.path().join("stderr")).map_err(|error| error.to_string())?;
        command.env("RUST_BACKTRACE", "0").stderr(words);
        let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| error.to_string())?;
        let lines = child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines).map_while(Result::ok);
        let mut is_done = false;
        for line in lines {
            let fields: Vec<&str> = line.split('\t').collect();
            match fields[..] {
                ["done", executions, read, outcomes, memory, longest] => {
                    is_done = true;
                    let number = |text: &str| text.parse::<u64>().unwrap_or(0);
                    sum.executions += number(executions);
                    sum.read += number(read);
                    sum.outcomes = sum.outcomes.max(number(outcomes));
                    sum.memory = sum.memory.max(number(memory));
                    sum.longest = sum.longest.max(longest.parse().unwrap_or(0.0));
                }
                ["failure", ..] => {
                    sum.failures += 1;
                    println!("{}: {line}", target.name);
                }
                _ => {}
            }
        }
        let status = child.wait().map_err(|error| error.to_string())?;
        if is_done {
            break;
        }
        let kind = match (status.code(), status.signal()) {
            (Some(drive::HANG), _) => format!("more than {} s", drive::TIME.as_secs()),
            (_, Some(signal)) => format!("ended by signal {signal}"),
            (code, _) => format!("ended with status {code:?}"),
        };
        let words = fs::read_to_string(scratch.path().join("stderr")).unwrap_or_default();
        let words: String = words.lines().find(|line| !line.is_empty()).unwrap_or_default().chars().take(120).collect();
        let input = fs::read(&current).map_err(|error| error.to_string())?;
        print!("{}: ", target.name);
        keep(&run.out, target, &format!("{kind}: {words}"), &input)?;
        sum.failures += 1;
        seed += 1;
        if sum.failures >= MOST_FAILURES {
            break;
        }
    }
    Ok((sum, start.elapsed().as_secs_f64()))
}

fn replay(name: &str, file: Option<&Path>) -> Result<bool, String> {
    let mut sound = true;
    for target in chosen(&[name.to_owned()])? {
        let inputs = match file {
            Some(file) => vec![(file.display().to_string(), fs::read(file).map_err(|error| error.to_string())?)],
            None => [corpus::of(&target), corpus::found(&target)].concat(),
        };
        for (name, input) in inputs {
            let start = Instant::now();
            let result = call(&target, &input);
            let seconds = start.elapsed().as_secs_f64();
            sound &= result.is_ok();
            match result {
                Ok((answer, memory)) => println!("{} {name}: {answer:?}, {memory} bytes, {seconds:.3} s", target.name),
                Err(failure) => println!("{} {name}: {failure:?}, {seconds:.3} s", target.name),
            }
        }
    }
    Ok(sound)
}
