//! Options of cases.

use corpuscle_model::Chart;
use std::cell::RefCell;
use std::path::PathBuf;

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
