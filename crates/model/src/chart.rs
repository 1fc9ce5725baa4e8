//! What a model measured, to be drawn.

use serde::{Deserialize, Serialize};

/// A chart: one or more series over one pair of axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Chart {
    /// Name as in files: lower case, words joined by `_`: `speed_histogram`.
    pub name: String,
    /// What it shows, for its heading: `Speeds`.
    pub title: String,
    /// The axis across.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// What is drawn, the first below.
    pub series: Vec<ChartSeries>,
    /// One line of words and numbers that goes with it, as `p = 0.43`; empty for none.
    pub note: String,
}

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct ChartAxis {
    /// The quantity along it: `Speed`.
    pub label: String,
    /// Unit as printed: `m/s`; empty for a number and in reduced units.
    pub unit: String,
    /// True for a logarithmic axis.
    pub logarithmic: bool,
}

/// One series of a chart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct ChartSeries {
    /// Name for the legend: `Maxwell`.
    pub name: String,
    /// How it is drawn.
    pub style: ChartStyle,
    /// Places `[x, y]`, x rising. A y that is not a number is a gap.
    pub points: Vec<[f64; 2]>,
    /// Standard error of each y; empty where there is none.
    pub errors: Vec<f64>,
    /// Colour `#rrggbb`; none for the next of the charts' own.
    pub colour: Option<String>,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Eq, Default)]
pub enum ChartStyle {
    /// A line from point to point.
    #[default]
    Line,
    /// A dashed line: what theory says.
    Dashes,
    /// A mark at each point.
    Points,
    /// A bar round each x, all of one width, from 0 to y.
    Bars,
}
