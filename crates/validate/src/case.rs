//! Cases with known answers, and their results.

use corpuscle_model::Chart;
use serde::Serialize;
use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};

/// One measure of one case, against its bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The case: `flood/voronoi/stoker`.
    pub case: String,
    /// Name of the measure: `relative_l1_error_1m`.
    pub measure: String,
    /// Its value; none where the case was skipped.
    pub value: Option<f64>,
    /// Unit of value and bound; empty for a number.
    pub unit: String,
    /// Required relation of value and bound: `<=`, `>=` or `==`.
    pub relation: String,
    /// The bound.
    pub bound: f64,
    /// Whether the bound was kept; none where the case was skipped, or is only shown beside a peer's value.
    pub pass: Option<bool>,
    /// Why the bound does not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// A case with a known answer.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name: the model and words, `flood/voronoi/stoker`.
    pub name: &'static str,
    /// What it tests and where the answer comes from, in a sentence.
    pub about: &'static str,
    /// True where it takes more than about ten seconds.
    pub slow: bool,
    /// Factor of the spacing at its reduced size, or, of dew, of the simulated time; 1 where it has none, as it takes
    /// little.
    pub reduced: f64,
    /// Runs it.
    pub run: fn(&Options) -> Vec<Row>,
}

impl Case {
    /// Runs it, its floods and its dew on the GPU where `options` names one.
    pub fn rows(&self, options: &Options) -> Vec<Row> {
        let factor = if options.reduced { self.reduced } else { 1.0 };
        let run = || crate::device::on_gpu(options.gpu.clone(), || (self.run)(options));
        crate::missed::mark(crate::device::coarser(factor, run))
    }
}

/// Options of cases.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The folder of reference data; without it the cases that need it are skipped.
    pub data: Option<PathBuf>,
    /// Missing data is a failure instead.
    pub require_data: bool,
    /// The GPU that takes the steps of floods and of dew, where one does.
    pub gpu: Option<corpuscle_gpu::Gpu>,
    /// Whether floods and dew have their reduced size, at which measures are those of two programs to be compared: bounds are meant for the full size,
    /// and so are the distances in the names of measures.
    pub reduced: bool,
    /// Charts of the cases, for a report.
    charts: RefCell<Vec<Chart>>,
}

impl Options {
    /// Cases with the folder of reference data, whose absence is a failure or not.
    pub fn new(data: Option<PathBuf>, require_data: bool) -> Self {
        Self { data, require_data, gpu: None, reduced: false, charts: RefCell::default() }
    }

    /// Takes the charts of cases since the last call.
    pub fn take_charts(&self) -> Vec<Chart> {
        self.charts.take()
    }

    /// Keeps a chart for the report.
    pub(crate) fn draw(&self, chart: Chart) {
        self.charts.borrow_mut().push(chart);
    }
}

static ADDED: RwLock<Vec<Case>> = RwLock::new(Vec::new());

/// Registers a case, in this process. Nothing changes where one of its name exists.
pub fn register_case(case: Case) {
    if cases().iter().all(|known| known.name != case.name) {
        ADDED.write().unwrap_or_else(PoisonError::into_inner).push(case);
    }
}

/// All cases.
pub fn cases() -> Vec<Case> {
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    [crate::flood::CASES, crate::gas::CASES, crate::dew::CASES, &added].concat()
}

impl Row {
    fn new(case: &str, measure: &str, value: f64, unit: &str, relation: &str, bound: f64, pass: bool) -> Self {
        Self {
            case: case.into(),
            measure: measure.into(),
            value: Some(value),
            unit: unit.into(),
            relation: relation.into(),
            bound,
            pass: Some(pass),
            reason: None,
        }
    }

    /// A measure that must not exceed its bound.
    pub fn at_most(case: &str, measure: &str, value: f64, unit: &str, bound: f64) -> Self {
        Self::new(case, measure, value, unit, "<=", bound, value <= bound)
    }

    /// A measure that must reach its bound.
    pub fn at_least(case: &str, measure: &str, value: f64, unit: &str, bound: f64) -> Self {
        Self::new(case, measure, value, unit, ">=", bound, value >= bound)
    }

    /// A measure that is known to miss the value of another program: shown beside it, neither passed nor failed.
    pub fn beside(case: &str, measure: &str, value: f64, unit: &str, peer: f64, why: &str) -> Self {
        Self { pass: None, reason: Some(why.into()), ..Self::at_most(case, measure, value, unit, peer) }
    }

    /// A case that broke down.
    pub fn broken(case: &str, why: &str) -> Self {
        Self {
            value: None,
            pass: Some(false),
            reason: Some(why.into()),
            ..Self::at_most(case, "completed", 0.0, "", 0.0)
        }
    }

    /// A case that was not run.
    pub fn skipped(case: &str, why: &str) -> Self {
        Self { pass: None, ..Self::broken(case, why) }
    }

    /// A case that needs the folder of reference data, which was not given: skipped, or failed where it is required.
    pub fn without_data(case: &str, options: &Options) -> Self {
        let why = "needs reference data: set CORPUSCLE_DATA to their folder";
        let pass = options.require_data.then_some(false);
        Self { pass, ..Self::broken(case, why) }
    }
}

#[cfg(test)]
mod tests {
    use super::Row;
    use serde_json::json;

    #[test]
    fn rows_have_the_names_that_scripts_depend_on() {
        let row = Row {
            case: "flood/stoker".into(),
            measure: "relative_l1_error_1m".into(),
            value: Some(0.001),
            unit: String::new(),
            relation: "<=".into(),
            bound: 0.0032,
            pass: Some(true),
            reason: None,
        };
        let mut form = json!({
            "case": "flood/stoker", "measure": "relative_l1_error_1m", "value": 0.001, "unit": "", "relation": "<=",
            "bound": 0.0032, "pass": true,
        });
        assert_eq!(serde_json::to_value(&row).unwrap(), form);
        let skipped = Row { value: None, pass: None, reason: Some("no data".into()), ..row };
        (form["value"], form["pass"], form["reason"]) = (json!(null), json!(null), json!("no data"));
        assert_eq!(serde_json::to_value(&skipped).unwrap(), form);
    }
}
