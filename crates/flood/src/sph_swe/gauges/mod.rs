//! Values of gauges.

#[cfg(feature = "gpu")]
pub(super) mod on_gpu;
mod placed;

use super::{DENSITY, SphSweFlood};
use crate::gauges::{LineGauge, PointGauge};
use crate::obstacles::force_columns;
use crate::sampling::Sample;
use corpuscle_model::GaugeColumn;

/// Values of all gauges at a time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Reading {
    /// The water at each position of the gauges.
    pub samples: Vec<Sample>,
    /// Force on each obstacle and its sum over time, over the density of water: m4/s2 and m4/s.
    pub on_obstacles: Vec<[f64; 2]>,
    pub impulses: Vec<[f64; 2]>,
    /// Water in the model, and what came in and went out in all, m3.
    pub stored: f64,
    pub inflow: f64,
    pub outflow: f64,
}

#[cfg(feature = "gpu")]
impl Reading {
    /// Whether all of it are finite numbers.
    pub fn is_sound(&self) -> bool {
        let samples = self.samples.iter().map(|water| water.depth + water.velocity[0] + water.velocity[1]);
        let pushes = self.on_obstacles.iter().chain(&self.impulses).flatten();
        let sum: f64 = samples.sum::<f64>() + pushes.sum::<f64>();
        (sum + self.stored + self.inflow + self.outflow).is_finite()
    }
}

impl SphSweFlood {
    pub(super) fn measured_columns(&self) -> Vec<GaugeColumn> {
        let total = |quantity| GaugeColumn { gauge: "water".into(), quantity, unit: "m3" };
        let points = self.points.iter().flat_map(PointGauge::columns);
        let lines = self.lines.iter().map(LineGauge::column);
        let lines = lines.chain(self.surroundings.obstacles.names.iter().flat_map(|name| force_columns(name)));
        let placed = self.placed().flat_map(|point| point.columns().collect::<Vec<_>>());
        points.chain(lines).chain(["stored", "total_inflow", "total_outflow"].map(total)).chain(placed).collect()
    }

    /// The positions of the gauges: points, those along lines, and points that were placed live.
    pub(super) fn gauge_positions(&self) -> Vec<[f64; 2]> {
        let points = self.points.iter().map(|point| point.at);
        let along_lines = self.lines.iter().flat_map(LineGauge::positions);
        points.chain(along_lines).chain(self.placed().map(|point| point.at)).collect()
    }

    /// The values at the time shown.
    pub(super) fn reading(&self) -> Reading {
        let water = self.sampler(self.since());
        Reading {
            samples: self.gauge_positions().iter().map(|[x, y]| water.at(*x, *y)).collect(),
            on_obstacles: self.state.on_obstacles.clone(),
            impulses: self.state.impulses.clone(),
            stored: self.stored(),
            inflow: self.state.water.inflow.value(),
            outflow: self.state.water.outflow.value(),
        }
    }

    /// The values of the columns.
    pub(super) fn row(&self, reading: &Reading) -> Vec<f64> {
        let mut samples = &reading.samples[..];
        let mut next = |count: usize| samples.split_off(..count).unwrap_or_default();
        let terrain = &self.surroundings.terrain;
        let mut row: Vec<f64> = self
            .points
            .iter()
            .zip(next(self.points.len()))
            .flat_map(|(point, water)| point.row(terrain, *water))
            .collect();
        row.extend(self.lines.iter().map(|line| line.discharge(next(line.positions().count()))));
        let of_obstacles = reading.on_obstacles.iter().zip(&reading.impulses);
        row.extend(of_obstacles.flat_map(|(force, sum)| [*force, *sum]).flatten().map(|push| DENSITY * push));
        row.extend([reading.stored, reading.inflow, reading.outflow]);
        row.extend(self.placed().zip(samples).flat_map(|(point, water)| point.row(terrain, *water)));
        row
    }
}
