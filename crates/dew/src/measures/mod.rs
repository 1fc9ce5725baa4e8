//! What is measured: totals of the air, and how large the drops are.

use crate::air::Particle;
use crate::drops::Drops;
use corpuscle_model::{Chart, ChartAxis, ChartSeries, ChartStyle};
use corpuscle_processes::Processes;
use std::f64::consts::SQRT_2;

/// Totals of the air for gauges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Totals {
    /// Particles inside.
    pub count: f64,
    /// Sums over them: temperatures, K, vapour and fog, parts of the mass.
    pub temperature: f64,
    pub vapour: f64,
    pub fog: f64,
    /// The largest speed, m/s.
    pub fastest: f64,
}

impl Totals {
    /// Of the air in the room of all processes; `inside` is that of this one, `count` the number of all.
    pub fn of<'a>(inside: impl Iterator<Item = &'a Particle> + Clone, count: usize, processes: &Processes) -> Self {
        let sum = |of: fn(&Particle) -> f64| processes.total_of(inside.clone().map(of).collect());
        let fastest = inside.clone().map(Particle::speed_squared).fold(0.0, f64::max).sqrt();
        Self {
            count: count as f64,
            temperature: sum(|particle| particle.temperature),
            vapour: sum(|particle| particle.vapour),
            fog: sum(|particle| particle.fog),
            fastest: -processes.least(-fastest),
        }
    }
}

/// How many drops there are of each size, in classes half an octave wide; none where there are no drops.
pub(crate) fn drop_sizes(drops: &Drops) -> Option<Chart> {
    let radii: Vec<f64> = drops.drops().iter().map(|drop| drop.radius).collect();
    let class = |radius: f64| (radius.ln() / SQRT_2.ln()).floor() as i32;
    let first = radii.iter().map(|&radius| class(radius)).min()?;
    let last = radii.iter().map(|&radius| class(radius)).max()?;
    let mut counts = vec![0_u32; (last - first) as usize + 1];
    radii.iter().for_each(|&radius| counts[(class(radius) - first) as usize] += 1);
    // The middle of a class, mm.
    let middle = |index: usize| 1e3 * SQRT_2.powf(f64::from(first) + index as f64 + 0.5);
    let points = counts.iter().enumerate().map(|(index, &count)| [middle(index), f64::from(count)]).collect();
    Some(Chart {
        name: "drop_sizes".into(),
        title: "Sizes of the drops at the end".into(),
        x: ChartAxis { label: "Radius of the covered disk".into(), unit: "mm".into(), logarithmic: true },
        y: ChartAxis { label: "Drops in a class, each √2 wide".into(), unit: String::new(), logarithmic: true },
        series: vec![ChartSeries { name: "drops".into(), style: ChartStyle::Bars, points, ..ChartSeries::default() }],
        note: String::new(),
    })
}
