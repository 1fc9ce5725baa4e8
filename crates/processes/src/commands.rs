//! Commands of the first process, whose model is called, to the others.

use crate::{Processes, from_bytes, to_bytes};
use corpuscle_model::Model;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// What all processes do together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Advance to a time, s.
    Advance(f64),
    /// Make a frame.
    Frame,
    /// Make a row of gauges.
    GaugeRow,
    /// Make maps.
    Maps,
    /// Make the ledger.
    Ledger,
    /// Save the state.
    Save,
    /// Restore a state.
    Restore(Vec<u8>),
    /// The model of the first process is dropped.
    End,
}

/// A model of the first process, whose calls the others [follow](Processes::follow) until this is dropped.
#[derive(Debug)]
pub struct Lead(Processes);

impl Drop for Lead {
    fn drop(&mut self) {
        self.0.broadcast(&Command::End);
    }
}

impl Processes {
    /// From here on the other processes wait for commands.
    pub fn lead(&self) -> Lead {
        Lead(self.clone())
    }

    /// Sends a command to the other processes; does nothing at these.
    pub fn broadcast(&self, command: &Command) {
        let Some(link) = self.link().filter(|_| self.is_first()) else { return };
        let bytes = to_bytes(command);
        let outgoing: Vec<_> = (1..link.count()).map(|process| (process, &bytes[..])).collect();
        link.send_receive(&outgoing, &[]);
    }

    /// Takes part in what the model of the first process is called for, until that is dropped; for a process that is not the first. Errors are the same at the
    /// first, which may still call for output after one.
    pub fn follow(&self, model: &mut dyn Model) {
        let go_on = AtomicBool::new(false);
        while let Some(link) = self.link().filter(|_| !self.is_first()) {
            match from_bytes(&link.send_receive(&[], &[0])[0]) {
                Command::Advance(time) => drop(model.advance_to(time, &go_on)),
                Command::Frame => drop(model.frame()),
                Command::GaugeRow => drop(model.gauge_row()),
                Command::Maps => drop(model.maps()),
                Command::Ledger => drop(model.ledger()),
                Command::Save => drop(model.save()),
                Command::Restore(state) => drop(model.restore(&state)),
                Command::End => break,
            }
        }
    }
}
