//! Threads of one process in place of processes, for tests.

use crate::{Link, Processes};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// A thread among others.
struct Thread {
    rank: usize,
    to: Vec<Sender<Message>>,
    from: Vec<Mutex<Receiver<Message>>>,
}

enum Message {
    Bytes(Vec<u8>),
    Numbers(Vec<f64>),
    Counts(Vec<i64>),
}

/// Connections between so many threads: one for each of them.
pub fn threads(count: usize) -> Vec<Processes> {
    let mut from: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    let mut to: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for sender in &mut to {
        for receiver in &mut from {
            let (end, other) = channel();
            sender.push(end);
            receiver.push(Mutex::new(other));
        }
    }
    let all = to.into_iter().zip(from).enumerate();
    all.map(|(rank, (to, from))| Processes::of(Arc::new(Thread { rank, to, from }))).collect()
}

/// Runs `run` on so many threads in place of processes, and returns what the first makes.
///
/// # Panics
/// Where a thread panics.
pub fn on_threads<T: Send>(count: usize, run: impl Fn(Processes) -> T + Sync) -> T {
    std::thread::scope(|scope| {
        let run = &run;
        let all: Vec<_> = threads(count).into_iter().map(|process| scope.spawn(move || run(process))).collect();
        let results: Vec<T> = all.into_iter().map(|thread| thread.join().expect("a thread has panicked")).collect();
        results.into_iter().next().expect("there is no thread")
    })
}

impl Thread {
    fn give(&self, to: usize, message: Message) {
        // A thread that has ended receives nothing; who waits for its answer panics in `take`.
        let _ = self.to[to].send(message);
    }

    fn take(&self, from: usize) -> Message {
        let receiver = self.from[from].lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv().unwrap_or_else(|_| panic!("process {from} has ended"))
    }

    /// Gives values to all others, and takes theirs.
    fn swap<T: Clone>(&self, own: &[T], message: fn(Vec<T>) -> Message, expect: fn(Message) -> Vec<T>) -> Vec<Vec<T>> {
        let others: Vec<usize> = (0..self.to.len()).filter(|other| *other != self.rank).collect();
        others.iter().for_each(|other| self.give(*other, message(own.to_vec())));
        others.iter().map(|other| expect(self.take(*other))).collect()
    }
}

impl Message {
    // Another kind than expected: the processes call different functions.
    fn bytes(self) -> Vec<u8> {
        if let Self::Bytes(bytes) = self { bytes } else { panic!("bytes were expected from another process") }
    }

    fn numbers(self) -> Vec<f64> {
        if let Self::Numbers(numbers) = self { numbers } else { panic!("numbers were expected from another process") }
    }

    fn counts(self) -> Vec<i64> {
        if let Self::Counts(counts) = self { counts } else { panic!("counts were expected from another process") }
    }
}

impl Link for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn exchange(&self, outgoing: &[(usize, Vec<f64>)], incoming: &mut [(usize, Vec<f64>)]) {
        outgoing.iter().for_each(|(to, numbers)| self.give(*to, Message::Numbers(numbers.clone())));
        for (from, numbers) in incoming {
            numbers.copy_from_slice(&self.take(*from).numbers());
        }
    }

    fn send_receive(&self, outgoing: &[(usize, &[u8])], from: &[usize]) -> Vec<Vec<u8>> {
        outgoing.iter().for_each(|(to, bytes)| self.give(*to, Message::Bytes(bytes.to_vec())));
        from.iter().map(|from| self.take(*from).bytes()).collect()
    }

    fn all_gather(&self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut all = self.swap(bytes, Message::Bytes, Message::bytes);
        all.insert(self.rank, bytes.to_vec());
        all
    }

    fn min(&self, values: &mut [f64]) {
        for theirs in self.swap(values, Message::Numbers, Message::numbers) {
            values.iter_mut().zip(theirs).for_each(|(value, theirs)| *value = value.min(theirs));
        }
    }

    fn sum(&self, values: &mut [i64]) {
        for theirs in self.swap(values, Message::Counts, Message::counts) {
            values.iter_mut().zip(theirs).for_each(|(value, theirs)| *value = value.wrapping_add(theirs));
        }
    }
}
