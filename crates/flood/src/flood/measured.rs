//! What gauges measure.

use super::{DENSITY, Flood};
use crate::gauges::{LineGauge, PointGauge, Reading};
use crate::obstacles::force_columns;
use crate::rain::Wetness;
use corpuscle_model::GaugeColumn;

impl Flood {
    pub(super) fn measured_columns(&self) -> Vec<GaugeColumn> {
        let total = |quantity| GaugeColumn { gauge: "water".into(), quantity, unit: "m3" };
        let points = self.points.iter().flat_map(PointGauge::columns);
        let lines = self.lines.iter().map(LineGauge::column).chain(self.structures.columns());
        let weather = self.ground.iter().flat_map(|_| ["total_rain", "total_infiltration", "film"].map(total));
        let lines = lines.chain(self.surroundings.obstacles.names.iter().flat_map(|name| force_columns(name)));
        let placed = self.placed().flat_map(|point| point.columns().collect::<Vec<_>>());
        points
            .chain(lines)
            .chain(["stored", "total_inflow", "total_outflow"].map(total))
            .chain(weather)
            .chain(placed)
            .collect()
    }

    /// The places that gauges look at: points, those along lines, and points that a hand has placed.
    pub(super) fn gauge_places(&self) -> Vec<[f64; 2]> {
        let points = self.points.iter().map(|point| point.at);
        let along_lines = self.lines.iter().flat_map(LineGauge::places);
        points.chain(along_lines).chain(self.placed().map(|point| point.at)).collect()
    }

    /// What they show at the time shown.
    pub(super) fn reading(&self) -> Reading {
        let water = self.sampler(self.since());
        let account = self.water();
        let Wetness { rained, infiltrated, .. } = &self.state.wetness;
        Reading {
            samples: self.gauge_places().iter().map(|[x, y]| water.at(*x, *y)).collect(),
            flows: self.state.flows.row().collect(),
            on_obstacles: self.state.on_obstacles.clone(),
            impulses: self.state.impulses.clone(),
            stored: self.stored(),
            inflow: account.inflow.value(),
            outflow: account.outflow.value(),
            rained: rained.value(),
            infiltrated: infiltrated.value(),
            film: self.state.wetness.on_the_ground(),
        }
    }

    /// What goes in the columns.
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
        row.extend(self.lines.iter().map(|line| line.discharge(next(line.places().count()))));
        row.extend(&reading.flows);
        let of_obstacles = reading.on_obstacles.iter().zip(&reading.impulses);
        row.extend(of_obstacles.flat_map(|(force, sum)| [*force, *sum]).flatten().map(|push| DENSITY * push));
        row.extend([reading.stored, reading.inflow, reading.outflow]);
        row.extend(self.ground.iter().flat_map(|_| [reading.rained, reading.infiltrated, reading.film]));
        row.extend(self.placed().zip(samples).flat_map(|(point, water)| point.row(terrain, *water)));
        row
    }
}
