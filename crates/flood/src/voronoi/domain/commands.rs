//! Commands of the first process, whose model is called, to the others.

use super::super::VoronoiFlood;
use super::{Domain, to_bytes};
use corpuscle_model::Model;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// What all processes do together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in super::super) enum Command {
    /// Advance to a time, s.
    Advance(f64),
    Frame,
    GaugeRow,
    Maps,
    Ledger,
    Save,
    Restore(Vec<u8>),
    End,
}

impl Domain {
    /// Sends a command to the other processes; does nothing at these.
    pub fn broadcast(&self, command: Command) {
        if self.is_first() {
            let bytes = to_bytes(&command);
            let outgoing: Vec<_> = (1..self.count()).map(|process| (process, &bytes[..])).collect();
            self.link.send_receive(&outgoing, &[]);
        }
    }

    /// The next command of the first process.
    fn next_command(&self) -> Command {
        let received = self.link.send_receive(&[], &[0]);
        received.first().and_then(|bytes| postcard::from_bytes(bytes).ok()).unwrap_or(Command::End)
    }

    /// The number of processes.
    pub fn count(&self) -> usize {
        self.link.count()
    }
}

impl VoronoiFlood {
    /// Sends a command to the other processes, if there are any.
    pub(in super::super) fn broadcast(&self, command: Command) {
        if let Some(domain) = &self.solver.domain {
            domain.broadcast(command);
        }
    }

    /// Takes part in what the model of the first process is called for, until that is dropped; for a process that is not the first. Errors are the same at the
    /// first, which may still call for output after one.
    pub fn follow(&mut self) {
        let go_on = AtomicBool::new(false);
        while let Some(domain) = self.solver.domain.as_ref().filter(|domain| !domain.is_first()) {
            match domain.next_command() {
                Command::Advance(time) => drop(self.advance_to(time, &go_on)),
                Command::Frame => drop(self.frame()),
                Command::GaugeRow => drop(self.gauge_row()),
                Command::Maps => drop(self.maps()),
                Command::Ledger => drop(self.ledger()),
                Command::Save => drop(self.save()),
                Command::Restore(state) => drop(self.restore(&state)),
                Command::End => break,
            }
        }
    }
}

impl Drop for Domain {
    fn drop(&mut self) {
        if self.is_open {
            self.broadcast(Command::End);
        }
    }
}
