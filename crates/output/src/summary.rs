//! `summary.json`: the summary of a run.

use crate::OutputError;
use crate::extent::ExtentScores;
use crate::whole::write_whole;
use corpuscle_model::Ledger;
use corpuscle_scene::read_text;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// The summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The model: `flood`.
    pub model: String,
    /// The backend: `cpu` or `gpu`.
    pub backend: String,
    /// Version of Corpuscle.
    pub version: String,
    /// How it ended.
    pub status: Status,
    /// Particles at the end.
    pub particles: usize,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time, s.
    pub simulated_time_s: f64,
    /// Wall-clock time, s, over all parts of an interrupted run.
    pub wall_time_s: f64,
    /// Particles moved per second of wall-clock time (of a model that steps; a gas counts collisions).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub particle_steps_per_s: Option<f64>,
    /// Collisions (of a gas).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collisions: Option<u64>,
    /// Collisions per second of wall-clock time (of a gas).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collisions_per_s: Option<f64>,
    /// Warnings to the user, in sentences.
    pub warnings: Vec<String>,
    /// The balances, by quantity: `water_m3`.
    pub ledger: BTreeMap<String, LedgerEntry>,
    /// How the flooded extent compares with an observed one, where one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent: Option<ExtentScores>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It reached its end.
    Done,
    /// It was stopped before its end and can be continued.
    Stopped,
    /// The computation broke down.
    Failed,
}

/// The account of one conserved quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LedgerEntry {
    /// Amount at the start.
    pub initial: f64,
    /// Amount that came in.
    #[serde(rename = "in")]
    pub inflow: f64,
    /// Amount that went out.
    #[serde(rename = "out")]
    pub outflow: f64,
    /// Amount at the end.
    #[serde(rename = "final")]
    pub end: f64,
    /// (final - initial - in + out) / max(initial + in, final + out).
    pub relative_error: f64,
}

/// The ledger as it stands in a summary.
pub fn ledger_entries(ledger: &Ledger) -> BTreeMap<String, LedgerEntry> {
    let entry = |balance: &corpuscle_model::Balance| LedgerEntry {
        initial: balance.initial,
        inflow: balance.inflow,
        outflow: balance.outflow,
        end: balance.now,
        relative_error: balance.relative_error(),
    };
    ledger.balances.iter().map(|balance| (balance.quantity.to_owned(), entry(balance))).collect()
}

impl Summary {
    /// Reads the `summary.json` of a run's folder.
    ///
    /// # Errors
    /// [`OutputError::Read`] or [`OutputError::Content`].
    pub fn read(folder: &Path) -> Result<Self, OutputError> {
        let path = folder.join("summary.json");
        let text = read_text(&path).map_err(OutputError::read(&path))?;
        serde_json::from_str(&text).map_err(|error| OutputError::content(&path, error))
    }

    /// Writes `summary.json` into a run's folder.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), OutputError> {
        let path = folder.join("summary.json");
        let text = serde_json::to_string_pretty(self).map_err(|error| OutputError::content(&path, error))?;
        write_whole(&path, |file| writeln!(file, "{text}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::Balance;
    use std::fs;

    #[test]
    fn reads_back_and_has_the_names_that_scripts_depend_on() {
        let water = Balance { quantity: "water_m3", initial: 0.1, inflow: 5.0, outflow: 3.0, now: 2.1, least: 0.0 };
        let summary = Summary {
            model: "flood".into(),
            backend: "cpu".into(),
            version: "0.1.0".into(),
            status: Status::Stopped,
            particles: 10,
            steps: 20,
            simulated_time_s: 0.1 + 0.2,
            wall_time_s: 1.0,
            particle_steps_per_s: Some(200.0),
            collisions: None,
            collisions_per_s: None,
            warnings: vec!["no reference system".into()],
            ledger: ledger_entries(&Ledger { balances: vec![water] }),
            extent: None,
        };
        let folder = tempfile::tempdir().unwrap();
        summary.write(folder.path()).unwrap();
        assert_eq!(Summary::read(folder.path()).unwrap(), summary);
        let json: serde_json::Value =
            serde_json::from_slice(&fs::read(folder.path().join("summary.json")).unwrap()).unwrap();
        assert_eq!(json["status"], "stopped");
        let keys: Vec<_> = json["ledger"]["water_m3"].as_object().unwrap().keys().cloned().collect();
        assert_eq!(keys, ["final", "in", "initial", "out", "relative_error"]);
    }
}
