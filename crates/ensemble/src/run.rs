//! Running the members that are missing.

use crate::member::compute;
use crate::{EnsembleError, Folder, Source};
use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;

/// How far the members are that this call runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Members that this call runs.
    pub members: usize,
    /// Members that are finished or failed.
    pub ended: usize,
    /// Members that failed.
    pub failed: usize,
    /// Part of the work that is done, 0 to 1: members that run count by their simulated time.
    pub part: f64,
}

/// How members run at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Workers {
    /// Members at the same time.
    pub members: usize,
    /// Threads of each.
    pub threads: usize,
}

impl Workers {
    /// Shares threads among members: a member on each thread, or more threads for each where there are fewer members.
    pub fn share(threads: usize, members: usize) -> Self {
        let at_once = members.clamp(1, threads.max(1));
        Self { members: at_once, threads: (threads / at_once).max(1) }
    }
}

/// What a worker tells.
enum Message {
    /// The part of a member's simulated time that is over.
    Part(usize, f64),
    /// A member has ended: whether it is finished; none where it was stopped.
    Ended(usize, Option<bool>),
    /// A file could not be written.
    Failed(EnsembleError),
}

/// Runs members that are not finished yet, and returns how many of them failed. Their files appear complete or not at all, so that after an interruption the
/// same call goes on; members that failed are run again. When `stop` becomes true members that run are given up.
///
/// # Errors
/// [`EnsembleError::Folder`] for a damaged record, [`EnsembleError::File`] where a file cannot be written: members that are done are kept.
pub fn run(
    folder: &Folder,
    source: &Source,
    members: &[usize],
    workers: Workers,
    stop: &AtomicBool,
    on_progress: &mut dyn FnMut(&Progress),
) -> Result<usize, EnsembleError> {
    let mut missing = Vec::new();
    for &number in members {
        if !folder.record(number)?.is_some_and(|record| record.is_finished()) {
            missing.push(number);
        }
    }
    // What ends one member by a full disk ends all.
    let given_up = AtomicBool::new(false);
    let queue = Mutex::new(missing.clone().into_iter().rev().collect::<Vec<_>>());
    let next = || {
        if stop.load(Ordering::Relaxed) || given_up.load(Ordering::Relaxed) { None } else { queue.lock().ok()?.pop() }
    };
    thread::scope(|scope| {
        let (sender, receiver) = channel();
        let handles: Vec<_> = (0..workers.members.min(missing.len()))
            .map(|worker| {
                let (sender, next) = (sender.clone(), &next);
                scope.spawn(move || work(folder, source, worker, workers.threads, stop, next, &sender))
            })
            .collect();
        drop(sender);
        let mut parts = vec![0.0; workers.members];
        let mut progress = Progress { members: missing.len(), ended: 0, failed: 0, part: 0.0 };
        let mut error = None;
        for message in receiver {
            match message {
                Message::Part(worker, part) => parts[worker] = part,
                Message::Ended(worker, finished) => {
                    parts[worker] = 0.0;
                    progress.ended += usize::from(finished.is_some());
                    progress.failed += usize::from(finished == Some(false));
                }
                Message::Failed(failed) => {
                    given_up.store(true, Ordering::Relaxed);
                    error.get_or_insert(failed);
                }
            }
            progress.part = (progress.ended as f64 + parts.iter().sum::<f64>()) / missing.len() as f64;
            on_progress(&progress);
        }
        for handle in handles {
            handle.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
        error.map_or(Ok(progress.failed), Err)
    })
}

/// Runs one member after another until there is none.
fn work(
    folder: &Folder,
    source: &Source,
    worker: usize,
    threads: usize,
    stop: &AtomicBool,
    next: &dyn Fn() -> Option<usize>,
    sender: &Sender<Message>,
) {
    while let Some(number) = next() {
        let mut told = |progress: &corpuscle::Progress| {
            // The receiver lives as long as its workers.
            let _ = sender.send(Message::Part(worker, progress.fraction()));
        };
        let message = match compute(folder, source, number, threads, stop, &mut told) {
            Ok(record) => Message::Ended(worker, record.map(|record| record.is_finished())),
            Err(error) => Message::Failed(error),
        };
        let _ = sender.send(message);
    }
}

#[cfg(test)]
mod tests {
    use super::Workers;

    #[test]
    fn threads_are_shared_among_members() {
        let shared = |threads, members| {
            let Workers { members, threads } = Workers::share(threads, members);
            [members, threads]
        };
        assert_eq!(
            [shared(8, 100), shared(8, 3), shared(8, 1), shared(1, 5), shared(4, 0)],
            [[8, 1], [3, 2], [1, 8], [1, 1], [1, 4]]
        );
    }
}
