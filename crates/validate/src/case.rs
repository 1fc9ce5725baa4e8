//! What a case is and what it gives.

use serde::Serialize;
use std::path::PathBuf;

/// One measure of one case, against its bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The case: `flood/stoker`.
    pub case: String,
    /// What is measured, in words joined by `_`: `relative_l1_error_1m`.
    pub measure: String,
    /// What was found; none where the case was skipped.
    pub value: Option<f64>,
    /// Unit of value and bound; empty for a number.
    pub unit: String,
    /// How the value must stand to the bound: `<=`, `>=` or `==`.
    pub relation: String,
    /// The bound.
    pub bound: f64,
    /// Whether the bound was kept; none where the case was skipped.
    pub pass: Option<bool>,
    /// Why the case was skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// A case with a known answer.
pub struct Case {
    /// Name: the model and words, `flood/stoker`.
    pub name: &'static str,
    /// What it tests and where the answer comes from, in a sentence.
    pub about: &'static str,
    /// True where it takes more than about ten seconds.
    pub slow: bool,
    /// Runs it.
    pub run: fn(&Options) -> Vec<Row>,
}

/// What cases are run with.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The folder of reference data; without it the cases that need it are skipped.
    pub data: Option<PathBuf>,
    /// Missing data is a failure instead.
    pub require_data: bool,
}

/// All cases.
pub fn cases() -> &'static [Case] {
    &[]
}
