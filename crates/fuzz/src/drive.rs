//! A target is called with one input after another, and watched.

use crate::Target;
use crate::memory::measured;
use crate::mutate::Mutator;
use crate::random::Random;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, Once, PoisonError};
use std::time::{Duration, Instant};
use std::{fs, thread};

/// Memory that a reader may allocate beyond what its input justifies, bytes.
pub const MEMORY: usize = 1 << 30;

/// Memory that each byte of an input justifies, bytes: compressed data hold up to 1032 times as much (Deflate).
pub const MEMORY_PER_BYTE: usize = 1032;

/// Longest time that a reader may compute.
pub const TIME: Duration = Duration::from_secs(10);

/// Exit status of a worker that found a call of more than [`TIME`].
pub const HANG: i32 = 70;

/// Until when a target is called.
#[derive(Debug, Clone, Copy)]
pub struct Until {
    /// This long.
    pub time: Duration,
    /// So many times.
    pub executions: u64,
}

/// What came of calling a target many times.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// Calls.
    pub executions: u64,
    /// Calls in which the input was read.
    pub read: u64,
    /// Different outcomes: refusals by their words, and kinds of what was read.
    pub outcomes: usize,
    /// Failures, each with the shortest input found.
    pub failures: BTreeMap<String, Vec<u8>>,
    /// Largest memory of a call, bytes.
    pub memory: usize,
    /// Longest call.
    pub longest: Duration,
    /// Time spent.
    pub time: Duration,
}

/// Position of the panic of the present call, with its message.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Whether a target is being called.
static IN_CALL: AtomicBool = AtomicBool::new(false);

/// When the present call began, ms after the first; [`u64::MAX`] between calls.
static BEGAN: AtomicU64 = AtomicU64::new(u64::MAX);

/// Records panics of calls instead of printing them.
fn record_panics() {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !IN_CALL.load(Ordering::Relaxed) {
                return before(panic);
            }
            let location =
                panic.location().map_or_else(String::new, |at| format!("{}:{}", short(at.file()), at.line()));
            let what = panic.payload_as_str().unwrap_or_default();
            let what: String = what.chars().filter(|c| !c.is_ascii_digit()).take(120).collect();
            *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = Some(format!("{location}: {what}"));
        }));
    });
}

/// The end of a path that says which crate it is of.
fn short(file: &str) -> String {
    let parts: Vec<&str> = file.split('/').collect();
    let from = parts.iter().rposition(|part| *part == "src").map_or(0, |at| at.saturating_sub(1));
    parts[from..].join("/")
}

/// Why a call failed.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// It panicked, at this position with these words.
    Panic(String),
    /// It allocated too much, bytes.
    Memory(usize),
}

impl Failure {
    /// What failures are told apart by.
    pub fn kind(&self) -> String {
        match self {
            Self::Panic(location) => format!("panic {location}"),
            Self::Memory(_) => "too much memory".into(),
        }
    }
}

/// Calls a target once.
///
/// # Errors
/// [`Failure`] where it panics or allocates more than the input justifies.
pub fn call(target: &Target, input: &[u8]) -> Result<(Result<String, String>, usize), Failure> {
    record_panics();
    *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = None;
    IN_CALL.store(true, Ordering::Relaxed);
    let (result, memory) = measured(|| catch_unwind(AssertUnwindSafe(|| (target.read)(input))));
    IN_CALL.store(false, Ordering::Relaxed);
    let Ok(answer) = result else {
        let location = PANIC.lock().unwrap_or_else(PoisonError::into_inner).take();
        return Err(Failure::Panic(location.unwrap_or_default()));
    };
    if memory > MEMORY + MEMORY_PER_BYTE * input.len() {
        return Err(Failure::Memory(memory));
    }
    Ok((answer, memory))
}

/// Interval at which the time of a call is looked at.
const INTERVAL: Duration = Duration::from_millis(100);

/// Processor time of this process so far.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Ends the process where a call takes too long. Time in which it computes counts in full; time in which it waits a tenth, since it may wait for a
/// processor that others use.
fn watch() {
    thread::spawn(move || {
        let (mut call, mut spent) = (u64::MAX, Duration::ZERO);
        loop {
            let (before, computed) = (Instant::now(), processor_time());
            thread::sleep(INTERVAL);
            let began = BEGAN.load(Ordering::Relaxed);
            if began == u64::MAX || began != call {
                (call, spent) = (began, Duration::ZERO);
                continue;
            }
            // A process that was stopped as a whole did not wait.
            let passed = before.elapsed().min(5 * INTERVAL);
            spent += processor_time().saturating_sub(computed).clamp(passed / 10, passed);
            if spent > TIME {
                println!("hang");
                std::process::exit(HANG);
            }
        }
    });
}

/// What outcomes are told apart by: the words, without numbers.
fn gist(answer: &Result<String, String>) -> u64 {
    let (is_read, words) = match answer {
        Ok(words) => (true, words),
        Err(words) => (false, words),
    };
    let mut hash = DefaultHasher::new();
    is_read.hash(&mut hash);
    // What stands in ticks or quotes is of the input.
    let mut is_outside = true;
    for letter in words.chars().take(400) {
        match letter {
            '`' | '"' | '\'' => is_outside = !is_outside,
            letter if is_outside && letter.is_ascii_alphabetic() => letter.hash(&mut hash),
            _ => {}
        }
    }
    hash.finish()
}

/// Calls a target with its seeds and then with inputs made of them. Each input is written to `current` before it is read, so that it is known
/// whatever ends the process.
///
/// # Errors
/// Where `current` cannot be written.
pub fn fuzz(target: &Target, seed: u64, until: Until, current: &Path, fresh: bool) -> std::io::Result<Outcome> {
    let seeds: Vec<Vec<u8>> = crate::corpus::of(target).into_iter().map(|(_, bytes)| bytes).collect();
    let mut waiting = if fresh { seeds.clone() } else { Vec::new() };
    let mut mutator = Mutator::new(seeds);
    let mut random = Random::new(seed);
    let mut outcome = Outcome::default();
    let mut known = HashSet::new();
    let mut file = fs::File::create(current)?;
    let start = Instant::now();
    watch();
    while outcome.executions < until.executions && start.elapsed() < until.time {
        let input = waiting.pop().unwrap_or_else(|| mutator.next(&mut random));
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&input)?;
        let began = start.elapsed();
        BEGAN.store(began.as_millis() as u64, Ordering::Relaxed);
        let result = call(target, &input);
        BEGAN.store(u64::MAX, Ordering::Relaxed);
        outcome.longest = outcome.longest.max(start.elapsed().saturating_sub(began));
        outcome.executions += 1;
        match result {
            Ok((answer, memory)) => {
                outcome.read += u64::from(answer.is_ok());
                outcome.memory = outcome.memory.max(memory);
                if known.insert(gist(&answer)) {
                    mutator.add(&input, &mut random);
                }
            }
            Err(failure) => {
                let kind = failure.kind();
                if let Entry::Vacant(new) = outcome.failures.entry(kind) {
                    let shortest = shortened(target, &input, new.key());
                    new.insert(shortest);
                }
            }
        }
    }
    outcome.outcomes = known.len();
    outcome.time = start.elapsed();
    Ok(outcome)
}

/// A shorter input that fails alike.
fn shortened(target: &Target, input: &[u8], kind: &str) -> Vec<u8> {
    let start = Instant::now();
    let fails = |input: &[u8]| call(target, input).is_err_and(|failure| failure.kind() == kind);
    let mut shortest = input.to_vec();
    let mut piece = shortest.len().div_ceil(2);
    while piece > 0 && start.elapsed() < Duration::from_secs(20) {
        let mut at = 0;
        while at < shortest.len() && start.elapsed() < Duration::from_secs(20) {
            let mut without = shortest.clone();
            without.drain(at..(at + piece).min(shortest.len()));
            if fails(&without) {
                shortest = without;
            } else {
                at += piece;
            }
        }
        piece /= 2;
    }
    shortest
}

/// Name of the file for an input that fails.
pub fn file_name(input: &[u8]) -> String {
    let mut hash = DefaultHasher::new();
    input.hash(&mut hash);
    format!("{:016x}", hash.finish())
}

/// A folder for files that are read and removed again: in memory where there is such a file system.
///
/// # Errors
/// Where it cannot be made.
pub fn scratch() -> std::io::Result<tempfile::TempDir> {
    let memory = PathBuf::from("/dev/shm");
    let in_memory = if memory.is_dir() { tempfile::tempdir_in(memory).ok() } else { None };
    in_memory.map_or_else(tempfile::tempdir, Ok)
}
