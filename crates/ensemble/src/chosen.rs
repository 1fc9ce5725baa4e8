//! Choice of the statistics of an ensemble.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Choice of the statistics that are computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Chosen {
    /// Maps; none is all.
    pub maps: Option<Vec<String>>,
    /// Thresholds of probabilities by map, in its unit; none is 0.3 m of `max_depth`, where there is that map.
    pub above: Option<BTreeMap<String, Vec<f64>>>,
    /// Percentiles of maps and gauges, from 0 to 100.
    pub percentiles: Vec<f64>,
    /// Columns of gauges; none is the first twelve.
    pub gauges: Option<Vec<String>>,
}

impl Default for Chosen {
    fn default() -> Self {
        Self { maps: None, above: None, percentiles: vec![5.0, 50.0, 95.0], gauges: None }
    }
}

impl Chosen {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<(), String> {
        if self.percentiles.is_empty() || !self.percentiles.iter().all(|percent| (0.0..=100.0).contains(percent)) {
            return Err(format!("statistics.percentiles = {:?}: must be numbers from 0 to 100", self.percentiles));
        }
        match self
            .above
            .iter()
            .flatten()
            .find(|(_, values)| values.is_empty() || values.iter().any(|value| !value.is_finite()))
        {
            Some((map, values)) => {
                Err(format!("statistics.above.{map} = {values:?}: must be a list of finite numbers"))
            }
            None => Ok(()),
        }
    }
}
