//! What was measured, as charts.

use super::Measures;
use crate::setup::Measure;
use corpuscle_model::{Chart, ChartAxis, ChartSeries, ChartStyle};
use std::f64::consts::PI;

/// What charts need to know of the gas besides what was measured.
pub(crate) struct Context<'a> {
    pub names: &'a [String],
    pub masses: &'a [f64],
    pub colours: &'a [Option<String>],
    pub boltzmann: f64,
    pub si: bool,
    /// Box along the profile's axis.
    pub extent: [f64; 2],
    pub p_value: f64,
}

fn axis(label: &str, unit: &str) -> ChartAxis {
    ChartAxis { label: label.into(), unit: unit.into(), logarithmic: false }
}

impl Context<'_> {
    fn unit(&self, si: &'static str) -> &'static str {
        if self.si { si } else { "" }
    }

    fn series(&self, set: usize, style: ChartStyle, points: Vec<[f64; 2]>) -> ChartSeries {
        ChartSeries {
            name: self.names[set].clone(),
            style,
            points,
            errors: Vec::new(),
            colour: self.colours[set].clone(),
        }
    }
}

impl Measures {
    /// All charts that there is something to show in.
    pub fn charts<const D: usize>(&self, context: &Context, measure: &Measure) -> Vec<Chart> {
        let mut charts = Vec::new();
        if self.looks > 0 {
            for set in 0..context.names.len() {
                charts.push(self.speeds::<D>(context, set));
                charts.push(self.velocities(context, set));
            }
            charts.push(self.profile(context, measure));
            if self.pairs.expected > 0.0 {
                charts.push(self.pair_chart::<D>(context));
            }
            charts.push(self.displacement_chart::<D>(context));
        }
        if self.samples.len() > 1 {
            charts.push(self.temperature_chart(context));
        }
        charts
    }

    /// Name of a set's chart: the plain one where there is only one set.
    fn chart_name(context: &Context, name: &str, set: usize) -> String {
        if context.names.len() == 1 { name.into() } else { format!("{name}_{}", context.names[set].replace('-', "_")) }
    }

    fn speeds<const D: usize>(&self, context: &Context, set: usize) -> Chart {
        let largest = self.largest[set];
        let thermal2 = context.boltzmann * self.temperature() / context.masses[set];
        // Maxwell 1860; in two dimensions the same as Rayleigh's.
        let maxwell = |v: f64| {
            let gauss = (-v * v / (2.0 * thermal2)).exp();
            if D == 2 { v / thermal2 * gauss } else { (2.0 / PI).sqrt() * v * v / thermal2.powf(1.5) * gauss }
        };
        let curve = (0..=200).map(|step| f64::from(step) / 200.0 * largest).map(|v| [v, maxwell(v)]).collect();
        Chart {
            name: Self::chart_name(context, "speed_histogram", set),
            title: format!("Speeds: {}", context.names[set]),
            x: axis("Speed", context.unit("m/s")),
            y: axis("Probability density", context.unit("s/m")),
            series: vec![
                context.series(set, ChartStyle::Bars, density(&self.speeds[set], 0.0, largest)),
                theory("Maxwell", curve),
            ],
            note: if context.p_value.is_nan() {
                String::new()
            } else {
                format!("chi-square test of all speeds now: p = {:.3}", context.p_value)
            },
        }
    }

    fn velocities(&self, context: &Context, set: usize) -> Chart {
        let largest = self.largest[set];
        let thermal2 = context.boltzmann * self.temperature() / context.masses[set];
        let gauss = |v: f64| (-v * v / (2.0 * thermal2)).exp() / (2.0 * PI * thermal2).sqrt();
        let curve = (-100..=100).map(|step| f64::from(step) / 100.0 * largest).map(|v| [v, gauss(v)]).collect();
        Chart {
            name: Self::chart_name(context, "velocity_histogram", set),
            title: format!("Velocities along x: {}", context.names[set]),
            x: axis("Velocity along x", context.unit("m/s")),
            y: axis("Probability density", context.unit("s/m")),
            series: vec![
                context.series(set, ChartStyle::Bars, density(&self.velocities[set], -largest, largest)),
                theory("Maxwell", curve),
            ],
            note: String::new(),
        }
    }

    fn profile(&self, context: &Context, measure: &Measure) -> Chart {
        let [low, high] = context.extent;
        let all: u64 = self.profile.iter().flatten().sum();
        let bins = measure.profile_bins as f64;
        let relative = |counts: &[u64]| {
            let point = |(bin, &count): (usize, &u64)| {
                [low + (bin as f64 + 0.5) / bins * (high - low), count as f64 * bins / all as f64]
            };
            counts.iter().enumerate().map(point).collect::<Vec<[f64; 2]>>()
        };
        let sets = self.profile.iter().enumerate();
        Chart {
            name: "density_profile".into(),
            title: format!("Density along {}", ["x", "y", "z"][measure.profile_axis.min(2)]),
            x: axis(["x", "y", "z"][measure.profile_axis.min(2)], context.unit("m")),
            y: axis("Number density over the mean of all", ""),
            series: sets.map(|(set, counts)| context.series(set, ChartStyle::Line, relative(counts))).collect(),
            note: String::new(),
        }
    }

    fn pair_chart<const D: usize>(&self, context: &Context) -> Chart {
        Chart {
            name: "pair_distribution".into(),
            title: "Pair distribution g(r)".into(),
            x: axis("Distance of centres", context.unit("m")),
            y: axis("g", ""),
            series: vec![ChartSeries { name: "g(r)".into(), points: self.pairs.g::<D>(), ..ChartSeries::default() }],
            note: String::new(),
        }
    }

    fn displacement_chart<const D: usize>(&self, context: &Context) -> Chart {
        let points = |set: usize| {
            let told = self.samples.iter().filter(|sample| !sample.displacement.is_empty());
            told.map(|sample| [sample.time - self.started, sample.displacement[set]]).collect()
        };
        Chart {
            name: "mean_square_displacement".into(),
            title: "Mean-square displacement".into(),
            x: axis("Time", context.unit("s")),
            y: axis("Mean-square displacement", context.unit("m2")),
            series: (0..context.names.len()).map(|set| context.series(set, ChartStyle::Line, points(set))).collect(),
            note: if D == 2 { "In two dimensions the slope has no limit at late times.".into() } else { String::new() },
        }
    }

    fn temperature_chart(&self, context: &Context) -> Chart {
        let points = self.samples.iter().map(|sample| [sample.time, sample.temperature]).collect();
        Chart {
            name: "temperature".into(),
            title: "Temperature".into(),
            x: axis("Time", context.unit("s")),
            y: axis("Temperature", context.unit("K")),
            series: vec![ChartSeries { name: "temperature".into(), points, ..ChartSeries::default() }],
            note: String::new(),
        }
    }
}

fn theory(name: &str, points: Vec<[f64; 2]>) -> ChartSeries {
    ChartSeries { name: name.into(), style: ChartStyle::Dashes, points, ..ChartSeries::default() }
}

/// Counts in bars from `low` to `high` as a probability density.
fn density(counts: &[u64], low: f64, high: f64) -> Vec<[f64; 2]> {
    let all: u64 = counts.iter().sum();
    let width = (high - low) / counts.len() as f64;
    let point = |(bar, &count): (usize, &u64)| [low + (bar as f64 + 0.5) * width, count as f64 / (all as f64 * width)];
    counts.iter().enumerate().map(point).collect()
}
