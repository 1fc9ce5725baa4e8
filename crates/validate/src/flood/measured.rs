//! Reading of measured series, and sampling of gauges to compare with them.

use corpuscle_model::{AdvanceObserver, Chart, ChartAxis, ChartSeries, ChartStyle, Model, ModelError, ModelProgress};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The gauges of a flood, sampled at equal intervals from its start.
pub(super) struct Watched {
    /// Interval of the samples, s.
    interval: f64,
    rows: Vec<Vec<f64>>,
}

impl AdvanceObserver for Watched {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        // The nearest multiple may be the time itself.
        let nearest = (time / self.interval).round();
        let next = if nearest * self.interval > time { nearest } else { nearest + 1.0 };
        Some(next * self.interval)
    }

    fn gauges(&mut self, _: f64, row: &[f64]) {
        self.rows.push(row.to_vec());
    }

    fn progressed(&mut self, _: ModelProgress) -> bool {
        true
    }
}

impl Watched {
    /// Runs a flood from its start to `until` s and samples its gauges every `interval` s.
    pub fn run(flood: &mut impl Model, until: f64, interval: f64) -> Result<Self, ModelError> {
        let mut watched = Self { interval, rows: vec![flood.gauge_row()] };
        let last = (until / interval).round() * interval;
        flood.advance_with(last, &AtomicBool::new(false), &mut watched)?;
        Ok(watched)
    }

    /// Times, s, and rows of the samples from the start on.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.rows.iter().enumerate().map(|(number, row)| (number as f64 * self.interval, &row[..]))
    }

    /// Value of a column at `time` s, linear between the samples before and after.
    pub fn at(&self, time: f64, column: usize) -> f64 {
        let last = (self.rows.len() - 1) as f64;
        let sample = (time / self.interval).clamp(0.0, last - 1e-9);
        let (before, part) = (sample as usize, sample.fract());
        self.rows[before][column] * (1.0 - part) + self.rows[before + 1][column] * part
    }

    /// Time of the first sample at which a column was `least` or more, s; infinite where none was.
    pub fn first(&self, column: usize, least: f64) -> f64 {
        let sample = self.rows.iter().position(|row| row[column] >= least);
        sample.map_or(f64::INFINITY, |sample| sample as f64 * self.interval)
    }

    /// A column over time, and beside it what was measured, as `[time, value]` in order of time, on its unit.
    pub fn chart(&self, column: usize, station: &str, quantity: &str, unit: &str, measured: Vec<[f64; 2]>) -> Chart {
        let computed =
            self.rows.iter().enumerate().map(|(sample, row)| [sample as f64 * self.interval, row[column]]).collect();
        let series =
            |name: &str, style, points| ChartSeries { name: name.into(), style, points, ..ChartSeries::default() };
        let axis = |label: &str, unit: &str| ChartAxis { label: label.into(), unit: unit.into(), logarithmic: false };
        Chart {
            name: format!("{}_{}", quantity.to_lowercase().replace(' ', "_"), station.to_lowercase()),
            title: format!("{quantity} at {station}"),
            x: axis("Time", "s"),
            y: axis(quantity, unit),
            series: vec![
                series("computed", ChartStyle::Line, computed),
                series("measured", ChartStyle::Points, measured),
            ],
            note: String::new(),
        }
    }

    /// The largest that a column read.
    pub fn largest(&self, column: usize) -> f64 {
        self.rows.iter().map(|row| row[column]).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Root of the mean square of the differences of pairs.
pub(super) fn root_mean_square(pairs: impl Iterator<Item = [f64; 2]>) -> f64 {
    let [sum, count] = pairs.fold([0.0; 2], |[sum, count], [a, b]| [sum + (a - b).powi(2), count + 1.0]);
    (sum / count).sqrt()
}

/// Rows of numbers, separated by commas or tabs, after some lines of headers; none where a field is empty.
pub(super) fn table(path: &Path, headers: usize) -> Result<Vec<Vec<Option<f64>>>, ModelError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| ModelError::Setup(format!("{} cannot be read: {error}", path.display())))?;
    let fields = |line: &str| line.split([',', '\t']).map(|field| field.trim().parse().ok()).collect();
    Ok(text.lines().skip(headers).filter(|line| !line.trim().is_empty()).map(fields).collect())
}
