//! What gauges measure.

use super::{DENSITY, VoronoiFlood};
use crate::gauges::{LineGauge, PointGauge};
use crate::obstacles::force_columns;
use corpuscle_model::GaugeColumn;

impl VoronoiFlood {
    /// The gauges that were placed while it runs.
    fn placed(&self) -> impl Iterator<Item = PointGauge> {
        self.state.overrides.gauges.iter().map(|(name, at)| PointGauge { name: name.clone(), at: *at })
    }

    pub(super) fn columns(&self) -> Vec<GaugeColumn> {
        let total = |quantity, unit| GaugeColumn { gauge: "water".into(), quantity, unit };
        let volume = |quantity| total(quantity, "m3");
        let points = self.points.iter().flat_map(PointGauge::columns);
        let lines = self.lines.iter().map(LineGauge::column).chain(self.structures.columns());
        let obstacles = self.settings.obstacle.iter().flat_map(|obstacle| force_columns(&obstacle.name));
        let weather = self.weather.iter().flat_map(|_| ["total_rain", "total_infiltration"].map(volume));
        let placed = self.placed().flat_map(|point| point.columns().collect::<Vec<_>>());
        points
            .chain(lines)
            .chain(obstacles)
            .chain(["stored", "total_inflow", "total_outflow"].map(volume))
            .chain(["energy", "energy_in", "energy_out", "dissipated"].map(|quantity| total(quantity, "J")))
            .chain(weather)
            .chain(placed)
            .collect()
    }

    pub(super) fn row(&self) -> Vec<f64> {
        let sampler = self.sampler();
        let point = |point: &PointGauge| point.row(&self.terrain, sampler.at(point.at[0], point.at[1]));
        let mut row: Vec<f64> = self.points.iter().flat_map(point).collect();
        row.extend(self.lines.iter().map(|line| {
            let samples: Vec<_> = line.places().map(|[x, y]| sampler.at(x, y)).collect();
            line.discharge(&samples)
        }));
        row.extend(self.state.flows.row());
        let of_obstacles = self.state.forces.iter().zip(&self.state.impulses);
        row.extend(of_obstacles.flat_map(|(force, sum)| [*force, *sum]).flatten().map(|push| DENSITY * push));
        let water = &self.state.water;
        row.extend([self.stored(), water.inflow.value(), water.outflow.value()]);
        let account = &self.state.energy;
        let (energy, came, went) = (self.energy(0.0).iter().sum(), account.inflow.value(), account.outflow.value());
        row.extend([energy, came, went, account.initial + came - went - energy]);
        if self.weather.is_some() {
            row.extend([self.state.soaked.rained.value(), self.state.soaked.infiltrated.value()]);
        }
        row.extend(self.placed().collect::<Vec<_>>().iter().flat_map(point));
        row
    }
}
