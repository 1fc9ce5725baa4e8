//! What was measured, as charts.

use super::{Measures, Set};
use crate::setup::Setup;
use crate::theory;
use corpuscle_model::{Chart, ChartAxis, ChartSeries, ChartStyle};
use std::f64::consts::PI;

/// Least number of balls with a profile.
const PROFILE_MIN_BALLS: usize = 20;

/// Properties of the gas that charts need besides the measures.
pub(crate) struct Context<'a, const D: usize> {
    pub sets: &'a [Set],
    /// Balls of each set.
    pub counts: Vec<usize>,
    pub setup: &'a Setup<D>,
    /// Radius of the balls, where all have the same.
    pub radius: Option<f64>,
    pub si: bool,
    /// Box along the profile's axis.
    pub extent: [f64; 2],
    pub p_value: f64,
    /// Mean kinetic energy of a ball of each set now.
    pub energies: Vec<f64>,
    /// Temperature now.
    pub temperature: f64,
}

pub(super) fn axis(label: &str, unit: &str) -> ChartAxis {
    ChartAxis { label: label.into(), unit: unit.into(), logarithmic: false }
}

pub(super) fn logarithmic(axis: ChartAxis) -> ChartAxis {
    ChartAxis { logarithmic: true, ..axis }
}

pub(super) fn theory_series(name: &str, points: Vec<[f64; 2]>) -> ChartSeries {
    ChartSeries { name: name.into(), style: ChartStyle::Dashes, points, ..ChartSeries::default() }
}

impl<const D: usize> Context<'_, D> {
    pub(super) fn unit(&self, si: &'static str) -> &'static str {
        if self.si { si } else { "" }
    }

    pub(super) fn series(&self, set: usize, style: ChartStyle, points: Vec<[f64; 2]>) -> ChartSeries {
        let Set { name, colour, .. } = &self.sets[set];
        ChartSeries { name: name.clone(), style, points, errors: Vec::new(), colour: colour.clone() }
    }

    /// Packing of the whole in a volume, where all balls are of one kind.
    pub(super) fn packing(&self, volume: f64) -> Option<f64> {
        let count = self.counts.iter().sum::<usize>() as f64;
        Some(count * crate::ball_volume::<D>(self.radius?) / volume)
    }
}

/// Mean kinetic energy of a ball of each set, beside the one that all share in equilibrium (equipartition: Maxwell 1860).
fn energies<const D: usize>(context: &Context<D>) -> Chart {
    let count = context.sets.len();
    let points = context.energies.iter().enumerate().map(|(set, energy)| [(set + 1) as f64, *energy]).collect();
    let shared = 0.5 * D as f64 * context.setup.boltzmann * context.temperature;
    let names: Vec<String> =
        context.sets.iter().enumerate().map(|(set, own)| format!("{}: {}", set + 1, own.name)).collect();
    Chart {
        name: "energies".into(),
        title: "Kinetic energy of a ball of each species now".into(),
        x: axis("Species", ""),
        y: axis("Mean kinetic energy", context.unit("J")),
        series: vec![
            ChartSeries { name: "measured".into(), style: ChartStyle::Bars, points, ..ChartSeries::default() },
            theory_series("equal shares", vec![[0.5, shared], [count as f64 + 0.5, shared]]),
        ],
        note: names.join(", "),
    }
}

impl Measures {
    /// All charts that there is something to show in.
    pub fn charts<const D: usize>(&self, context: &Context<D>) -> Vec<Chart> {
        let mut charts = self.laws(context);
        if self.averaged > 0 {
            for set in 0..context.sets.len() {
                charts.push(self.speeds::<D>(context, set));
                charts.push(self.velocities(context, set));
            }
            charts.push(self.profile(context));
            if self.pairs.expected > 0.0 {
                charts.push(self.pair_chart(context));
            }
            charts.push(self.displacement_chart(context));
            charts.extend(self.flow_chart(context));
        }
        if context.sets.len() > 1 {
            charts.push(energies(context));
        }
        charts
    }

    /// Name of a set's chart: the plain one where there is only one set.
    fn chart_name<const D: usize>(context: &Context<D>, name: &str, set: usize) -> String {
        let own = &context.sets[set].name;
        if context.sets.len() == 1 { name.into() } else { format!("{name}_{}", own.replace(['-', ' '], "_")) }
    }

    /// What stands beside the speeds of a gas that cools.
    fn speed_axis<const D: usize>(&self, context: &Context<D>, label: &str) -> ChartAxis {
        let cooled = if self.cools { ", as if it had not cooled" } else { "" };
        axis(&format!("{label}{cooled}"), context.unit("m/s"))
    }

    fn thermal_squared<const D: usize>(&self, context: &Context<D>, set: usize) -> f64 {
        context.setup.boltzmann * self.temperature() / context.sets[set].mass
    }

    fn speeds<const D: usize>(&self, context: &Context<D>, set: usize) -> Chart {
        let (largest, thermal2) = (self.largest[set], self.thermal_squared(context, set));
        // Maxwell 1860; in two dimensions the same as Rayleigh's.
        let maxwell = |v: f64| {
            let gauss = (-v * v / (2.0 * thermal2)).exp();
            if D == 2 { v / thermal2 * gauss } else { (2.0 / PI).sqrt() * v * v / thermal2.powf(1.5) * gauss }
        };
        let curve = (0..=200).map(|step| f64::from(step) / 200.0 * largest).map(|v| [v, maxwell(v)]).collect();
        Chart {
            name: Self::chart_name(context, "speed_histogram", set),
            title: format!("Speeds: {}", context.sets[set].name),
            x: self.speed_axis(context, "Speed"),
            y: axis("Probability density", context.unit("s/m")),
            series: vec![
                context.series(
                    set,
                    ChartStyle::Bars,
                    density(&self.speeds[set], self.averaged * context.counts[set], [0.0, largest]),
                ),
                theory_series("Maxwell", curve),
            ],
            note: match context.p_value {
                p if p.is_nan() => String::new(),
                p if p < 0.001 => "chi-square test of all speeds now: p < 0.001".into(),
                p => format!("chi-square test of all speeds now: p = {p:.3}"),
            },
        }
    }

    fn velocities<const D: usize>(&self, context: &Context<D>, set: usize) -> Chart {
        let (largest, thermal2) = (self.largest[set], self.thermal_squared(context, set));
        let gauss = |v: f64| (-v * v / (2.0 * thermal2)).exp() / (2.0 * PI * thermal2).sqrt();
        let curve = (-100..=100).map(|step| f64::from(step) / 100.0 * largest).map(|v| [v, gauss(v)]).collect();
        Chart {
            name: Self::chart_name(context, "velocity_histogram", set),
            title: format!("Velocities along x: {}", context.sets[set].name),
            x: self.speed_axis(context, "Velocity along x"),
            y: axis("Probability density", context.unit("s/m")),
            series: vec![
                context.series(
                    set,
                    ChartStyle::Bars,
                    density(&self.velocities[set], self.averaged * context.counts[set], [-largest, largest]),
                ),
                theory_series("Maxwell", curve),
            ],
            note: String::new(),
        }
    }

    fn profile<const D: usize>(&self, context: &Context<D>) -> Chart {
        let measure = &context.setup.measure;
        let ([low, high], bins) = (context.extent, measure.profile_bins as f64);
        let relative = |counts: &[u64]| {
            let all = counts.iter().sum::<u64>() as f64;
            let point = |(bin, &count): (usize, &u64)| {
                [low + (bin as f64 + 0.5) / bins * (high - low), count as f64 * bins / all]
            };
            counts.iter().enumerate().map(point).collect::<Vec<[f64; 2]>>()
        };
        let many = context.counts.iter().any(|&count| count >= PROFILE_MIN_BALLS);
        let sets = (0..context.sets.len()).filter(|&set| !many || context.counts[set] >= PROFILE_MIN_BALLS);
        let mut series: Vec<ChartSeries> =
            sets.map(|set| context.series(set, ChartStyle::Line, relative(&self.profile[set]))).collect();
        let laws = self.atmosphere(context);
        let falls = !laws.is_empty();
        series.extend(laws);
        let name = ["x", "y", "z"][measure.profile_axis.min(D - 1)];
        let y = axis("Number density over its mean", "");
        Chart {
            name: "density_profile".into(),
            title: format!("Density along {name}"),
            x: axis(name, context.unit("m")),
            y: if falls { logarithmic(y) } else { y },
            series,
            note: String::new(),
        }
    }

    /// Density over height under gravity along the profile's axis, over its mean: of points (Laplace's barometric law), and of
    /// balls of the size that they have.
    fn atmosphere<const D: usize>(&self, context: &Context<D>) -> Vec<ChartSeries> {
        let (setup, [low, high]) = (context.setup, context.extent);
        let axis = setup.measure.profile_axis.min(D - 1);
        let (height, gravity) = (high - low, -setup.gravity[axis]);
        let volume: f64 = self.samples.last().map_or(f64::NAN, |sample| sample.volume);
        let told = gravity > 0.0 && context.sets.len() == 1 && setup.well.is_none();
        let Some(mean) = context.packing(volume).filter(|_| told) else {
            return Vec::new();
        };
        let weight = context.sets[0].mass * gravity * height / (setup.boltzmann * self.temperature());
        let balls = theory::atmosphere::<D>(mean, weight);
        let steps = balls.len() - 1;
        let part = |step: usize| step as f64 / steps as f64;
        let points = |part: f64| [low + part * height, weight * (-weight * part).exp() / (1.0 - (-weight).exp())];
        vec![
            theory_series("points: exp(-m g h / T)", (0..=steps).map(|step| points(part(step))).collect()),
            theory_series(
                "balls of this size",
                balls.iter().enumerate().map(|(step, packing)| [low + part(step) * height, packing / mean]).collect(),
            ),
        ]
    }

    fn pair_chart<const D: usize>(&self, context: &Context<D>) -> Chart {
        Chart {
            name: "pair_distribution".into(),
            title: "Pair distribution g(r)".into(),
            x: axis("Distance of centres", context.unit("m")),
            y: axis("g", ""),
            series: vec![ChartSeries { name: "g(r)".into(), points: self.pairs.g::<D>(), ..ChartSeries::default() }],
            note: String::new(),
        }
    }

    /// Velocity over height in a sheared box, beside that of a Newtonian fluid.
    fn flow_chart<const D: usize>(&self, context: &Context<D>) -> Option<Chart> {
        let (flow, rate, height) = (self.flow.as_ref()?, context.setup.shear?.rate, context.setup.size[1]);
        let measured =
            ChartSeries { name: "measured".into(), points: flow.profile([0.0, height]), ..ChartSeries::default() };
        let law = vec![[0.0, -0.5 * rate * height], [height, 0.5 * rate * height]];
        Some(Chart {
            name: "flow_profile".into(),
            title: "Flow along x".into(),
            x: axis("y", context.unit("m")),
            y: axis("Mean velocity along x", context.unit("m/s")),
            series: vec![measured, theory_series("Newtonian fluid", law)],
            note: String::new(),
        })
    }

    fn displacement_chart<const D: usize>(&self, context: &Context<D>) -> Chart {
        let points = |set: usize| {
            let moving = self.samples.iter().filter(|sample| !sample.displacement.is_empty());
            moving.map(|sample| [sample.time - self.started, sample.displacement[set]]).collect()
        };
        // Of several sets one may be much slower than the others.
        let scaled = |axis: ChartAxis| if context.sets.len() > 1 { logarithmic(axis) } else { axis };
        Chart {
            name: "mean_square_displacement".into(),
            title: "Mean-square displacement".into(),
            x: scaled(axis("Time", context.unit("s"))),
            y: scaled(axis("Mean-square displacement", context.unit("m²"))),
            series: (0..context.sets.len()).map(|set| context.series(set, ChartStyle::Line, points(set))).collect(),
            note: if self.flow.is_some() {
                "Displacement along x is not counted: the flow carries balls along.".into()
            } else if D == 2 {
                "In two dimensions the slope has no limit at late times.".into()
            } else {
                String::new()
            },
        }
    }
}

/// Counts in bars from `low` to `high` as a probability density.
fn density(counts: &[u64], all: usize, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
    let width = (high - low) / counts.len() as f64;
    let point = |(bar, &count): (usize, &u64)| [low + (bar as f64 + 0.5) * width, count as f64 / (all as f64 * width)];
    counts.iter().enumerate().map(point).collect()
}
