//! Results of cases.

use crate::Options;
use serde::Serialize;

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
