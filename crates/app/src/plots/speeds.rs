//! The speeds of balls now, over Maxwell's law.

use corpuscle::model::{Chart, ChartAxis, ChartSeries, ChartStyle, Frame, ParticleSet};
use std::f64::consts::PI;

/// Bars, and where they end, thermal speeds.
const BARS: usize = 36;
const FASTEST: f64 = 4.2;
/// Fraction of the counts kept from picture to picture: bars of few balls flicker less.
const KEPT: f64 = 0.9;
/// Factor of the temperature beyond which the bars are rescaled.
const ELSEWHERE: f64 = 1.5;

/// Speeds counted, set by set.
#[derive(Debug)]
pub struct Speeds {
    dimensions: usize,
    sets: Vec<Counted>,
    time: f64,
}

#[derive(Debug, Clone)]
struct Counted {
    name: String,
    /// Width of a bar.
    width: f64,
    counts: Vec<f64>,
    /// Mean square of a component of velocity now: k T / m.
    thermal2: f64,
}

impl Speeds {
    pub fn new(dimensions: usize) -> Self {
        Self { dimensions, sets: Vec::new(), time: f64::NAN }
    }

    /// Restarts the counts.
    pub fn forget(&mut self) {
        self.sets.clear();
    }

    /// Adds the balls of another time.
    pub fn take(&mut self, frame: &Frame) {
        if frame.time == self.time && !self.sets.is_empty() {
            return;
        }
        self.time = frame.time;
        self.sets.resize_with(frame.sets.len(), Counted::none);
        for (counted, set) in self.sets.iter_mut().zip(&frame.sets) {
            counted.take(set, self.dimensions);
        }
    }

    /// The speeds of a set as a chart.
    pub fn chart(&self, set: usize) -> Option<Chart> {
        let counted = self.sets.get(set)?;
        let sum: f64 = counted.counts.iter().sum();
        if sum <= 0.0 {
            return None;
        }
        let middle = |bar: usize| (bar as f64 + 0.5) * counted.width;
        let bars = counted.counts.iter().enumerate().map(|(bar, count)| [middle(bar), count / (sum * counted.width)]);
        let far = BARS as f64 * counted.width;
        let curve = (0..=120).map(|step| f64::from(step) / 120.0 * far);
        let curve = curve.map(|speed| [speed, maxwell(self.dimensions, speed, counted.thermal2)]);
        let axis = |label: &str| ChartAxis { label: label.into(), ..ChartAxis::default() };
        Some(Chart {
            name: format!("speeds_{}", counted.name.replace(' ', "_")),
            title: "Speeds".into(),
            x: axis("Speed"),
            y: axis("Probability density"),
            series: vec![
                ChartSeries {
                    name: counted.name.clone(),
                    style: ChartStyle::Bars,
                    points: bars.collect(),
                    ..ChartSeries::default()
                },
                ChartSeries {
                    name: "Maxwell".into(),
                    style: ChartStyle::Dashes,
                    points: curve.collect(),
                    ..ChartSeries::default()
                },
            ],
            note: String::new(),
        })
    }
}

impl Counted {
    fn none() -> Self {
        Self { name: String::new(), width: 0.0, counts: vec![0.0; BARS], thermal2: 0.0 }
    }

    fn take(&mut self, set: &ParticleSet, dimensions: usize) {
        if self.name.is_empty() {
            self.name.clone_from(&set.name);
        }
        let squares = |velocity: &[f64; 3]| velocity.iter().map(|along| along * along).sum::<f64>();
        let sum: f64 = set.velocity.iter().map(squares).sum();
        self.thermal2 = sum / (dimensions * set.len().max(1)) as f64;
        let fitting = FASTEST * self.thermal2.sqrt() / BARS as f64;
        if self.width == 0.0 || !(1.0 / ELSEWHERE..ELSEWHERE).contains(&(fitting / self.width)) {
            self.width = fitting;
            self.counts.fill(0.0);
        }
        self.counts.iter_mut().for_each(|count| *count *= KEPT);
        if self.width > 0.0 {
            for velocity in &set.velocity {
                let bar = (squares(velocity).sqrt() / self.width) as usize;
                if let Some(count) = self.counts.get_mut(bar) {
                    *count += 1.0;
                }
            }
        }
    }
}

/// Probability density of speeds in a gas at rest whose velocities have this mean square along each axis (Maxwell, Philosophical
/// Magazine 19, 1860, 19; in two dimensions Rayleigh's distribution).
fn maxwell(dimensions: usize, speed: f64, thermal2: f64) -> f64 {
    let gauss = (-0.5 * speed * speed / thermal2).exp();
    match dimensions {
        2 => speed / thermal2 * gauss,
        _ => (2.0 / PI).sqrt() * speed * speed / thermal2.powf(1.5) * gauss,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_sums_to_one_and_has_its_mean_square() {
        for dimensions in [2, 3] {
            let thermal2 = 3.7;
            let step = 0.001;
            let sum = |power: i32| -> f64 {
                (0..40_000)
                    .map(|k| f64::from(k) * step)
                    .map(|v| v.powi(power) * maxwell(dimensions, v, thermal2) * step)
                    .sum()
            };
            assert!((sum(0) - 1.0).abs() < 1e-5, "{dimensions}: {}", sum(0));
            let mean_square = dimensions as f64 * thermal2;
            assert!((sum(2) / mean_square - 1.0).abs() < 1e-5, "{dimensions}: {}", sum(2));
        }
    }

    #[test]
    fn bars_are_a_density_and_follow_what_is_heated() {
        let mut speeds = Speeds::new(2);
        let frame = |time: f64, speed: f64| Frame {
            time,
            sets: vec![ParticleSet {
                name: "balls".into(),
                id: (0..100).collect(),
                velocity: (0..100).map(|k| [speed * f64::from(k) / 50.0, 0.0, 0.0]).collect(),
                ..ParticleSet::default()
            }],
        };
        speeds.take(&frame(0.0, 1.0));
        let area = |speeds: &Speeds| {
            let chart = speeds.chart(0).unwrap();
            let points = &chart.series[0].points;
            points.iter().map(|point| point[1]).sum::<f64>() * (points[1][0] - points[0][0])
        };
        assert!((area(&speeds) - 1.0).abs() < 1e-9);
        speeds.take(&frame(1.0, 4.0));
        let far = speeds.chart(0).unwrap().series[0].points.iter().rposition(|point| point[1] > 0.0).unwrap();
        assert!(far as f64 * speeds.sets[0].width > 6.0);
    }
}
