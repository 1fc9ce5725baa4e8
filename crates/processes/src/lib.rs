//! Processes that share a run: messages between them, sums and minima over all.
//!
//! All of them call the same functions in the same order. Between machines they are those that `mpirun` started (crate `corpuscle-mpi`); in tests they are threads
//! of one process.

#![warn(missing_docs)]

mod threads;

pub use threads::threads;

use std::fmt;
use std::sync::Arc;

/// What connects a process to the others. A lost connection ends the process.
pub trait Link: Send + Sync {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;

    /// The number of processes.
    fn count(&self) -> usize;

    /// Sends numbers to processes, and receives some from each process in `incoming`, as many as its buffer has: what is sent must be what the other side
    /// expects.
    fn exchange(&self, outgoing: &[(usize, Vec<f64>)], incoming: &mut [(usize, Vec<f64>)]);

    /// Sends bytes to processes, and receives what each of the processes `from` sends, in this order.
    fn send_receive(&self, outgoing: &[(usize, &[u8])], from: &[usize]) -> Vec<Vec<u8>>;

    /// What each process gives, in the order of their numbers.
    fn all_gather(&self, bytes: &[u8]) -> Vec<Vec<u8>>;

    /// Replaces each value by the minimum over all processes.
    fn min(&self, values: &mut [f64]);

    /// Replaces each value by the sum over all processes, with wrapping.
    fn sum(&self, values: &mut [i64]);
}

/// The processes of a run, as one of them sees them.
#[derive(Clone)]
pub struct Processes(Option<Arc<dyn Link>>);

impl fmt::Debug for Processes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "process {} of {}", self.rank(), self.count())
    }
}

impl Default for Processes {
    fn default() -> Self {
        Self::alone()
    }
}

impl Processes {
    /// One process without others.
    pub fn alone() -> Self {
        Self(None)
    }

    /// The processes at the other ends of a link.
    pub fn of(link: Arc<dyn Link>) -> Self {
        Self((link.count() > 1).then_some(link))
    }

    /// The link to the others; none where there are none.
    pub fn link(&self) -> Option<&Arc<dyn Link>> {
        self.0.as_ref()
    }

    /// The number of this process, from 0.
    pub fn rank(&self) -> usize {
        self.0.as_ref().map_or(0, |link| link.rank())
    }

    /// The number of processes.
    pub fn count(&self) -> usize {
        self.0.as_ref().map_or(1, |link| link.count())
    }

    /// An error of any process, at all of them: its own where a process has one, else that of the first that has, in words, made an error by `of_other`.
    ///
    /// # Errors
    /// Where a process has an error.
    pub fn agree<T, E: fmt::Display>(&self, result: Result<T, E>, of_other: impl FnOnce(String) -> E) -> Result<T, E> {
        let Some(link) = self.link() else { return result };
        let own = result.as_ref().err().map_or(String::new(), ToString::to_string);
        let all = link.all_gather(own.as_bytes());
        match all.iter().position(|error| !error.is_empty()) {
            None => result,
            Some(process) => {
                let what = format!("process {process}: {}", String::from_utf8_lossy(&all[process]));
                result.and_then(|_| Err(of_other(what)))
            }
        }
    }

    /// Whether this is the process that writes files and reports to the user.
    pub fn is_first(&self) -> bool {
        self.rank() == 0
    }
}
