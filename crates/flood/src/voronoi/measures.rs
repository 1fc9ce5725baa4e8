//! What gauges measure.

use super::domain::total;
use super::{DENSITY, State, VoronoiFlood};
use crate::gauges::{LineGauge, PointGauge};
use crate::obstacles::force_columns;
use crate::sampling::Sample;
use corpuscle_model::{Account, ExactSum, GaugeColumn};
use corpuscle_processes::Command;

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
        self.broadcast(&Command::GaugeRow);
        let placed: Vec<PointGauge> = self.placed().collect();
        let points = self.points.iter().chain(&placed).map(|point| point.at);
        let samples = self.samples(points.chain(self.lines.iter().flat_map(|line| line.places())).collect());
        let (of_points, mut of_lines) = samples.split_at(self.points.len() + placed.len());
        let mut rows =
            self.points.iter().chain(&placed).zip(of_points).map(|(point, water)| point.row(&self.terrain, *water));
        let mut row: Vec<f64> = rows.by_ref().take(self.points.len()).flatten().collect();
        for line in &self.lines {
            let (of_line, rest) = of_lines.split_at(line.places().count());
            row.push(line.discharge(of_line));
            of_lines = rest;
        }
        row.extend(self.state.flows.row());
        let of_obstacles = self.state.forces.iter().zip(&self.state.impulses);
        row.extend(of_obstacles.flat_map(|(force, sum)| [*force, *sum]).flatten().map(|push| DENSITY * push));
        let ([water, _, account], soaked) = self.booked();
        row.extend([self.stored(), water.inflow.value(), water.outflow.value()]);
        let (energy, came, went) = (self.energy(0.0).iter().sum(), account.inflow.value(), account.outflow.value());
        row.extend([energy, came, went, account.initial + came - went - energy]);
        if self.weather.is_some() {
            row.extend(soaked.map(|sum| sum.value()));
        }
        row.extend(rows.flatten());
        row
    }

    /// The water at positions, found by the processes whose cells hold them.
    fn samples(&self, positions: Vec<[f64; 2]>) -> Vec<Sample> {
        let sampler = self.sampler();
        let Some(domain) = &self.solver.domain else {
            return positions.iter().map(|[x, y]| sampler.at(*x, *y)).collect();
        };
        let own = positions.iter().enumerate().filter_map(|(number, [x, y])| {
            let cell = self.solver.mesh.cell_at([*x, *y]).filter(|cell| domain.owns(*cell))?;
            let Sample { depth, velocity: [u, v] } = sampler.in_cell(cell, *x, *y);
            Some((number, [depth, u, v]))
        });
        let own: Vec<(usize, [f64; 3])> = own.collect();
        let mut samples = vec![Sample::default(); positions.len()];
        for (number, [depth, u, v]) in domain.processes.gather(own).into_iter().flatten() {
            samples[number] = Sample { depth, velocity: [u, v] };
        }
        samples
    }

    /// The accounts of water, momentum and energy, and the rain and what soaked in, m3: of all processes.
    pub(super) fn booked(&self) -> ([Account; 3], [ExactSum; 2]) {
        let State { water, momentum, energy, soaked, .. } = &self.state;
        let mut accounts = [*water, *momentum, *energy];
        let mut of_weather = [soaked.rained, soaked.infiltrated];
        let of_accounts = accounts.iter_mut().flat_map(|account| [&mut account.inflow, &mut account.outflow]);
        total(self.solver.domain.as_ref(), &mut [], &mut of_accounts.chain(&mut of_weather).collect::<Vec<_>>());
        (accounts, of_weather)
    }
}
