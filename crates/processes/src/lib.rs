//! Processes that share a run: messages between them, sums and minima over all.
//!
//! All of them call the same functions in the same order. Between machines they are those that `mpirun` started (crate `corpuscle-mpi`); in tests they are threads
//! of one process.

#![warn(missing_docs)]

mod commands;
mod load;
mod threads;

pub use commands::{Command, Lead};
pub use load::{MAX_IMBALANCE, STEPS_BETWEEN_BALANCING, imbalance};
pub use threads::{on_threads, threads};

use corpuscle_model::ExactSum;
use serde::Serialize;
use serde::de::DeserializeOwned;
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

    /// What each process gives, in their order.
    pub fn gather_all<T: Serialize + DeserializeOwned>(&self, own: T) -> Vec<T> {
        match self.link() {
            None => vec![own],
            Some(link) => link.all_gather(&to_bytes(&own)).iter().map(|bytes| from_bytes(bytes)).collect(),
        }
    }

    /// What each process gives, at the first; nothing at others.
    pub fn gather<T: Serialize + DeserializeOwned>(&self, own: T) -> Vec<T> {
        let Some(link) = self.link() else { return vec![own] };
        if !self.is_first() {
            link.send_receive(&[(0, &to_bytes(&own))], &[]);
            return Vec::new();
        }
        let others: Vec<usize> = (1..link.count()).collect();
        let received = link.send_receive(&[], &others);
        std::iter::once(own).chain(received.iter().map(|bytes| from_bytes(bytes))).collect()
    }

    /// The elements of all processes' lists, by their processes, at the first; nothing at others.
    pub fn gather_list<T: Serialize + DeserializeOwned>(&self, own: Vec<T>) -> Vec<T> {
        match self.link() {
            None => own,
            Some(_) => self.gather(own).into_iter().flatten().collect(),
        }
    }

    /// Sends something to some processes, and receives what others send, with the process that it comes from.
    pub fn swap<T: DeserializeOwned>(&self, outgoing: Vec<(usize, impl Serialize)>) -> Vec<(usize, T)> {
        let Some(link) = self.link() else { return Vec::new() };
        let to: Vec<usize> = outgoing.iter().map(|(to, _)| *to).collect();
        let all = self.gather_all(to);
        let senders = all.iter().enumerate().filter(|(_, to)| to.contains(&self.rank()));
        let from: Vec<usize> = senders.map(|(from, _)| from).collect();
        let bytes: Vec<_> = outgoing.into_iter().map(|(to, what)| (to, to_bytes(&what))).collect();
        let outgoing: Vec<_> = bytes.iter().map(|(to, bytes)| (*to, &bytes[..])).collect();
        let received = link.send_receive(&outgoing, &from);
        from.into_iter().zip(received).map(|(from, bytes)| (from, from_bytes(&bytes))).collect()
    }

    /// Replaces counts and sums by those over all processes.
    pub fn total(&self, counts: &mut [i64], sums: &mut [&mut ExactSum]) {
        let Some(link) = self.link() else { return };
        let mut all = counts.to_vec();
        sums.iter().for_each(|sum| all.extend(sum.addends()));
        link.sum(&mut all);
        let (of_counts, of_sums) = all.split_at(counts.len());
        counts.copy_from_slice(of_counts);
        for (sum, addends) in sums.iter_mut().zip(of_sums.as_chunks().0) {
            **sum = ExactSum::of_addends(addends);
        }
    }

    /// The sum of all processes' sums.
    pub fn total_of(&self, mut sum: ExactSum) -> f64 {
        self.total(&mut [], &mut [&mut sum]);
        sum.value()
    }

    /// Whether something holds for any process.
    pub fn any(&self, holds: bool) -> bool {
        let mut count = [i64::from(holds)];
        self.total(&mut count, &mut []);
        count[0] > 0
    }

    /// The least of a value over all processes.
    pub fn least(&self, value: f64) -> f64 {
        let Some(link) = self.link() else { return value };
        let mut least = [value];
        link.min(&mut least);
        least[0]
    }
}

fn to_bytes(what: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(what).unwrap_or_default()
}

/// What another process sent: of the type that it sent, or the processes do different things.
fn from_bytes<T: DeserializeOwned>(bytes: &[u8]) -> T {
    postcard::from_bytes(bytes).unwrap_or_else(|error| panic!("a message of another process is damaged: {error}"))
}
