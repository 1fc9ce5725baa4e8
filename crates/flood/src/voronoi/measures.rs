//! What gauges measure.

use super::domain::total;
use super::{BOOKED, DENSITY, State, VoronoiFlood};
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
        let samples = self.samples(points.chain(self.lines.iter().flat_map(|line| line.positions())).collect());
        let (of_points, mut of_lines) = samples.split_at(self.points.len() + placed.len());
        let mut rows =
            self.points.iter().chain(&placed).zip(of_points).map(|(point, water)| point.row(&self.terrain, *water));
        let mut row: Vec<f64> = rows.by_ref().take(self.points.len()).flatten().collect();
        for line in &self.lines {
            let (of_line, rest) = of_lines.split_at(line.positions().count());
            row.push(line.discharge(of_line));
            of_lines = rest;
        }
        row.extend(self.state.flows.row());
        let share = self.share_shown();
        let rest = self.rest_of_step();
        let of_obstacles = self.state.forces.iter().zip(&self.state.impulses);
        let pushes = of_obstacles.flat_map(|(force, sum)| [*force, [0, 1].map(|axis| sum[axis] - rest * force[axis])]);
        row.extend(pushes.flatten().map(|push| DENSITY * push));
        let [booked, before] = [self.state.booked(), self.state.booked_before].map(|sums| self.in_all(sums));
        let booked = booked.map(|sum| sum.value());
        let before = before.map(|sum| sum.value());
        // As the water at the positions of gauges is: in between, where the time shown is within a step.
        let at_end = share == 1.0;
        let shown: [f64; BOOKED] =
            std::array::from_fn(|k| if at_end { booked[k] } else { between(before[k], booked[k], share) });
        let [came, went, energy_in, energy_out, rained, infiltrated] = shown;
        let to_come = (booked[0] - came) - (booked[1] - went);
        row.extend([self.stored() - to_come, came, went]);
        let mut energy: f64 = self.energy(0.0).iter().sum();
        if !at_end {
            energy = between(self.energy_of(self.solver.before(), 0.0).iter().sum(), energy, share);
        }
        row.extend([energy, energy_in, energy_out, self.state.energy.initial + energy_in - energy_out - energy]);
        if self.weather.is_some() {
            row.extend([rained, infiltrated]);
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

    /// Sums of all processes.
    pub(super) fn in_all(&self, mut sums: [ExactSum; BOOKED]) -> [ExactSum; BOOKED] {
        total(self.solver.domain.as_ref(), &mut [], &mut sums.iter_mut().collect::<Vec<_>>());
        sums
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

/// Linear from one value to another.
fn between(from: f64, to: f64, share: f64) -> f64 {
    from + share * (to - from)
}
