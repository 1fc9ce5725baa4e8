//! What was measured over time, beside the laws that it follows.

use super::Measures;
use super::charts::{Context, axis, logarithmic, theory_series};
use crate::setup::{Partition, Setup, Side};
use crate::theory;
use corpuscle_model::{Chart, ChartSeries, ChartStyle};
use std::f64::consts::PI;

/// Points of a law's curve.
const POINTS: usize = 200;

impl Measures {
    /// The charts that this gas has a story for.
    pub(super) fn laws<const D: usize>(&self, context: &Context<D>) -> Vec<Chart> {
        if self.samples.len() < 2 {
            return Vec::new();
        }
        let partition = context.setup.partition.as_ref();
        let beyond = partition.map(|partition| self.beyond_chart(context, partition));
        let mixing = partition.is_some_and(|partition| partition.lifted_at.is_some()) && context.sets.len() > 1;
        let mixing = mixing.then(|| self.mixing_chart(context));
        [self.adiabat_chart(context), mixing, beyond, self.temperature_chart(context)].into_iter().flatten().collect()
    }

    /// Temperature, where it changes; of a granular gas with Haff's law.
    fn temperature_chart<const D: usize>(&self, context: &Context<D>) -> Option<Chart> {
        let points: Vec<[f64; 2]> = self.samples.iter().map(|sample| [sample.time, sample.temperature]).collect();
        let first = points[0][1];
        if points.iter().all(|point| (point[1] - first).abs() <= 1e-9 * first) {
            return None;
        }
        let mut series = vec![ChartSeries { name: "measured".into(), points, ..ChartSeries::default() }];
        let (mut x, mut y) = (axis("Time", context.unit("s")), axis("Temperature", context.unit("K")));
        if let Some(law) = self.haff(context) {
            (x, y) = (logarithmic(x), logarithmic(y));
            series.push(law);
        }
        Some(Chart { name: "temperature".into(), title: "Temperature".into(), x, y, series, note: String::new() })
    }

    /// How an even granular gas cools.
    fn haff<const D: usize>(&self, context: &Context<D>) -> Option<ChartSeries> {
        let (setup, start) = (context.setup, &self.samples[0]);
        let is_idle = |side: &Side| matches!(side, Side::Fixed | Side::Periodic);
        let is_driven =
            setup.shear.is_some() || setup.gravity != [0.0; D] || !setup.sides.iter().flatten().all(is_idle);
        let cools = setup.restitution < 1.0 && context.sets.len() == 1 && !is_driven;
        let packing = context.packing(start.volume).filter(|_| cools)?;
        let thermal = (setup.boltzmann * start.temperature / context.sets[0].mass).sqrt();
        let rate = theory::collision_rate::<D>(packing, context.radius?, thermal);
        let tau = theory::haff_time::<D>(setup.restitution, rate);
        let law = |sample: &super::Sample| [sample.time, start.temperature / (1.0 + sample.time / tau).powi(2)];
        Some(theory_series("Haff: even gas", self.samples.iter().map(law).collect()))
    }

    /// Temperature over volume of a gas that walls press together, beside the law of a slow one; none where heat comes in.
    fn adiabat_chart<const D: usize>(&self, context: &Context<D>) -> Option<Chart> {
        let (setup, start) = (context.setup, &self.samples[0]);
        let apart = setup.partition.is_none() && setup.restitution == 1.0 && setup.gravity == [0.0; D];
        let apart = apart && setup.well.is_none();
        let radius = context.radius.filter(|_| apart && context.sets.len() == 1 && is_pressed(setup))?;
        let mut points: Vec<[f64; 2]> = self.samples.iter().map(|sample| [sample.open, sample.temperature]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (least, most) = (points[0][0], points[points.len() - 1][0]);
        // All of the box, of which a margin as wide as a radius is not open: exact where one pair of sides moves.
        let wide =
            self.samples.iter().max_by(|a, b| (a.open - start.open).abs().total_cmp(&(b.open - start.open).abs()))?;
        let slope = (wide.volume - start.volume) / (wide.open - start.open);
        let packing_at = |open: f64| {
            let volume = start.volume + slope * (open - start.open);
            context.counts[0] as f64 * crate::ball_volume::<D>(radius) / volume
        };
        let law = |step: usize| {
            let open = least + (most - least) * step as f64 / POINTS as f64;
            [open, start.temperature * theory::adiabat::<D>(start.open, open, packing_at)]
        };
        let (what, unit) = if D == 2 { ("Area", "m²") } else { ("Volume", "m³") };
        Some(Chart {
            name: "adiabat".into(),
            title: format!("Temperature over {}", what.to_lowercase()),
            x: axis(&format!("{what} open to centres"), context.unit(unit)),
            y: axis("Temperature", context.unit("K")),
            series: vec![
                ChartSeries { name: "measured".into(), style: ChartStyle::Points, points, ..ChartSeries::default() },
                theory_series("slow and without heat, hard balls", (0..=POINTS).map(law).collect()),
            ],
            note: String::new(),
        })
    }

    /// Entropy of mixing, and where it ends.
    fn mixing_chart<const D: usize>(&self, context: &Context<D>) -> Chart {
        let points = self.samples.iter().map(|sample| [sample.time, sample.mixing]).collect();
        let all = context.counts.iter().sum::<usize>() as f64;
        let own = |&count: &usize| -(count as f64) * (count as f64 / all).ln();
        let full: f64 = context.counts.iter().map(own).sum();
        let name = if context.counts.windows(2).all(|pair| pair[0] == pair[1]) {
            format!("N ln {}", context.counts.len())
        } else {
            "fully mixed".into()
        };
        let end = self.samples[self.samples.len() - 1].time;
        Chart {
            name: "mixing_entropy".into(),
            title: "Entropy of mixing".into(),
            x: axis("Time", context.unit("s")),
            y: axis("Entropy over Boltzmann's constant", ""),
            series: vec![
                ChartSeries { name: "measured".into(), points, ..ChartSeries::default() },
                theory_series(&name, vec![[0.0, full], [end, full]]),
            ],
            note: String::new(),
        }
    }

    /// Balls beyond the partition, and how many there would be if they flew through its hole without meeting each other.
    fn beyond_chart<const D: usize>(&self, context: &Context<D>, partition: &Partition) -> Chart {
        let points = |set: usize| self.samples.iter().map(|sample| [sample.time, sample.beyond[set]]).collect();
        let sets = 0..context.sets.len();
        let mut series: Vec<ChartSeries> =
            sets.clone().map(|set| context.series(set, ChartStyle::Line, points(set))).collect();
        series.extend(sets.filter_map(|set| self.effusion(context, partition, set)));
        Chart {
            name: "balls_beyond".into(),
            title: "Balls beyond the partition".into(),
            x: axis("Time", context.unit("s")),
            y: axis("Balls", ""),
            series,
            note: String::new(),
        }
    }

    /// Effusion (Knudsen 1909): in a unit of time, sqrt(T / 2 pi m) balls of a density of 1 come through a hole of size 1 from
    /// each side.
    fn effusion<const D: usize>(&self, context: &Context<D>, partition: &Partition, set: usize) -> Option<ChartSeries> {
        let setup = context.setup;
        let hole = partition.hole.as_ref().filter(|_| partition.lifted_at.is_none())?;
        let size: f64 = hole.iter().map(|[from, to]| to - from).product();
        let start = &self.samples[0];
        let thermal = (setup.boltzmann * start.temperature / (2.0 * PI * context.sets[set].mass)).sqrt();
        let across = start.volume / setup.size[partition.axis];
        let (near, far) = (across * partition.at, across * (setup.size[partition.axis] - partition.at));
        let rate = size * thermal * (1.0 / near + 1.0 / far);
        let even = context.counts[set] as f64 * far / (near + far);
        let law =
            |sample: &super::Sample| [sample.time, even + (start.beyond[set] - even) * (-rate * sample.time).exp()];
        let name = format!("{}, free flight", context.sets[set].name);
        Some(ChartSeries {
            name,
            style: ChartStyle::Dashes,
            points: self.samples.iter().map(law).collect(),
            colour: context.sets[set].colour.clone(),
            ..ChartSeries::default()
        })
    }
}

/// True where walls move and none has a temperature.
fn is_pressed<const D: usize>(setup: &Setup<D>) -> bool {
    let mut sides = setup.sides.iter().flatten();
    let moves = |side: &Side| !matches!(side, Side::Fixed | Side::Periodic | Side::Thermal { .. });
    sides.clone().any(moves) && !sides.any(|side| matches!(side, Side::Thermal { .. }))
}
