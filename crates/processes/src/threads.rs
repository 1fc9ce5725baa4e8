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

/// As many threads' views of each other: each is to be used by one thread.
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

impl Thread {
    fn give(&self, to: usize, message: Message) {
        // One that has ended takes nothing; whoever waits for its answer ends in `take`.
        let _ = self.to[to].send(message);
    }

    fn take(&self, from: usize) -> Message {
        let receiver = self.from[from].lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv().unwrap_or_else(|_| panic!("process {from} has ended"))
    }

    fn others(&self) -> impl Iterator<Item = usize> + use<> {
        let rank = self.rank;
        (0..self.to.len()).filter(move |other| *other != rank)
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
            if let Message::Numbers(received) = self.take(*from) {
                numbers.copy_from_slice(&received);
            }
        }
    }

    fn pass(&self, outgoing: &[(usize, Vec<u8>)], from: &[usize]) -> Vec<Vec<u8>> {
        outgoing.iter().for_each(|(to, bytes)| self.give(*to, Message::Bytes(bytes.clone())));
        let received = from.iter().map(|from| match self.take(*from) {
            Message::Bytes(bytes) => bytes,
            Message::Numbers(_) | Message::Counts(_) => Vec::new(),
        });
        received.collect()
    }

    fn all_gather(&self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let outgoing: Vec<_> = (0..self.count()).map(|to| (to, bytes.to_vec())).collect();
        let from: Vec<_> = (0..self.count()).collect();
        self.pass(&outgoing, &from)
    }

    fn least(&self, values: &mut [f64]) {
        self.others().for_each(|other| self.give(other, Message::Numbers(values.to_vec())));
        for other in self.others() {
            if let Message::Numbers(theirs) = self.take(other) {
                values.iter_mut().zip(theirs).for_each(|(value, theirs)| *value = value.min(theirs));
            }
        }
    }

    fn total(&self, values: &mut [i64]) {
        self.others().for_each(|other| self.give(other, Message::Counts(values.to_vec())));
        for other in self.others() {
            if let Message::Counts(theirs) = self.take(other) {
                values.iter_mut().zip(theirs).for_each(|(value, theirs)| *value = value.wrapping_add(theirs));
            }
        }
    }
}
