//! What a gas shows of itself.

use super::Gas;
use super::observe::{collision_rate, mean_free_path, pressure_virial};
use crate::measure::charts::Context;
use crate::measure::region::OverTime;
use crate::measure::{Estimate, Sample};
use corpuscle_model::{
    Balance, Chart, Container, CpuOnly, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Path,
};
use std::sync::atomic::AtomicBool;

/// Number of balls above which overlaps are not searched at every row of gauges.
const OVERLAP_CHECK_MAX_BALLS: usize = 20_000;

fn padded<const D: usize>(vector: [f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| vector.get(axis).copied().unwrap_or(0.0))
}

impl<const D: usize> Gas<D> {
    /// Named values and their units in SI, in the order of the gauges.
    fn gauges(&self) -> Vec<(String, &'static str, &'static str, f64)> {
        let recent = self.recent();
        let over_time = recent.len() > 1;
        let rate = |value: &dyn Fn() -> f64| if over_time { value() } else { f64::NAN };
        let pressure = if D == 2 { "N_per_m" } else { "Pa" };
        let mut rows: Vec<(&'static str, &'static str, f64)> = vec![
            ("temperature", "K", self.temperature()),
            ("kinetic_energy", "J", self.kinetic_energy()),
            ("energy", "J", self.energy()),
            ("collisions", "", self.collisions() as f64),
            ("collision_rate", "per_s", rate(&|| collision_rate(&recent) / self.len() as f64)),
            (
                "mean_free_path",
                "m",
                if self.drifts_periodically() { f64::NAN } else { rate(&|| mean_free_path(&recent)) },
            ),
            ("pressure_virial", pressure, rate(&|| pressure_virial::<D>(&recent))),
        ];
        let world = self.mover.world();
        if !world.walls.is_empty() {
            rows.push(("pressure_walls", pressure, rate(&|| self.recent_pressure_walls(&recent))));
        }
        rows.extend(
            ["centre_x", "centre_y", "centre_z"]
                .into_iter()
                .zip(self.centre_of_mass())
                .map(|(name, position)| (name, "m", position))
                // A sheared gas has no centre along the flow.
                .skip(usize::from(self.setup.shear.is_some())),
        );
        rows.push(("packing", "", self.packing()));
        rows.push(("maxwell_p_value", "", self.maxwell_p_value()));
        if self.sets.len() > 1 {
            rows.push(("mixing_entropy", "", self.mixing_entropy()));
        }
        if world.well.is_some() {
            let [captures, escapes, returns] = self.rim_events().map(|count| count as f64);
            rows.extend([
                ("potential_energy", "J", self.potential_energy()),
                ("pairs_in_wells", "", self.pairs_in_wells() as f64),
                ("captures", "", captures),
                ("escapes", "", escapes),
                ("returns_at_rims", "", returns),
            ]);
        }
        if world.walls.iter().any(|wall| wall.moves || wall.temperature.is_some()) || self.setup.shear.is_some() {
            rows.push(("work", "J", self.work()));
        }
        if self.len() <= OVERLAP_CHECK_MAX_BALLS {
            rows.push(("deepest_overlap", "", self.deepest_overlap()));
        }
        if let Some((overlaps, missed, _)) = self.faults() {
            rows.extend([("overlaps", "", overlaps as f64), ("missed_hits", "", missed as f64)]);
        }
        let mut gauges: Vec<_> =
            rows.into_iter().map(|(name, unit, value)| ("gas".into(), name, unit, value)).collect();
        gauges.extend(self.transport_gauges());
        gauges.extend(self.wall_gauges());
        // A single species may be called `gas` too: what it has in common with the gas is there already.
        let of_sets = self.set_gauges().into_iter();
        let of_gas: Vec<&str> = gauges.iter().filter(|gauge| gauge.0 == "gas").map(|gauge| gauge.1).collect();
        let new: Vec<_> = of_sets.filter(|gauge| gauge.0 != "gas" || !of_gas.contains(&gauge.1)).collect();
        gauges.extend(new);
        gauges.extend(self.region_gauges(&recent));
        if let Some(followed) = &world.followed {
            gauges.push((format!("ball {}", followed.id), "collisions", "", followed.collisions as f64));
        }
        gauges
    }

    /// Number and temperature in each region now, pressure and flow over the last samples.
    fn region_gauges(&self, recent: &[Sample]) -> Vec<(String, &'static str, &'static str, f64)> {
        let (pressure, flux) = if D == 2 { ("N_per_m", "per_m_s") } else { ("Pa", "per_m2_s") };
        let mut gauges = Vec::new();
        for (number, region) in self.setup.regions.iter().enumerate() {
            let over = OverTime { recent, number };
            let mut add = |quantity, unit, value| gauges.push((region.name.clone(), quantity, unit, value));
            add("number", "", over.now().number);
            add("temperature", "K", over.temperature(D, self.setup.boltzmann));
            add("pressure", pressure, over.pressure(D));
            let flows = ["flow_x", "flow_y", "flow_z"].into_iter().take(D).enumerate();
            flows.for_each(|(axis, name)| add(name, flux, over.flow(axis)));
        }
        gauges
    }

    /// Viscosity and thermal conductivity with their standard errors, where they are measured.
    fn transport_gauges(&self) -> Vec<(String, &'static str, &'static str, f64)> {
        let mut gauges = Vec::new();
        if self.setup.shear.is_some() {
            let (stress, unit) = (self.shear_stress(), if D == 2 { "N_per_m" } else { "Pa" });
            gauges.push(("gas".into(), "shear_stress", unit, stress.mean));
            gauges.push(("gas".into(), "shear_stress_standard_error", unit, stress.error));
        }
        if self.measures_transport() {
            let (viscosity, unit) = (self.viscosity(), if D == 2 { "N_s_per_m" } else { "Pa_s" });
            gauges.push(("gas".into(), "viscosity", unit, viscosity.mean));
            gauges.push(("gas".into(), "viscosity_standard_error", unit, viscosity.error));
        }
        if self.measures_conductivity() {
            let (conductivity, unit) = (self.conductivity(), if D == 2 { "W_per_K" } else { "W_per_m_K" });
            gauges.push(("gas".into(), "conductivity", unit, conductivity.mean));
            gauges.push(("gas".into(), "conductivity_standard_error", unit, conductivity.error));
        }
        gauges
    }

    fn wall_gauges(&self) -> Vec<(String, &'static str, &'static str, f64)> {
        let recent = self.recent();
        let mut gauges = Vec::new();
        for axis in 0..D {
            for end in 0..2 {
                let name = format!("{}_{}", ["x", "y", "z"][axis], ["min", "max"][end]);
                if let Some(pressure) = self.recent_pressure_on(&recent, axis, end) {
                    let unit = if D == 2 { "N_per_m" } else { "Pa" };
                    gauges.push((name.clone(), "pressure", unit, pressure));
                }
                let moves = !matches!(
                    self.setup.sides[axis][end],
                    crate::Side::Fixed | crate::Side::Periodic | crate::Side::Thermal { .. }
                );
                if let Some([position, speed]) = self.wall(axis, end).filter(|_| moves) {
                    gauges.push((name.clone(), "position", "m", position));
                    gauges.push((name, "velocity", "m_per_s", speed));
                }
            }
        }
        gauges
    }

    fn set_gauges(&self) -> Vec<(String, &'static str, &'static str, f64)> {
        let snapshot = self.snapshot(self.shown);
        let displacements = self.measures.displacements(&snapshot);
        let beyond = self.beyond(&snapshot);
        let energies = self.energies();
        let mut gauges = Vec::new();
        let world = self.mover.world();
        let mut masses = vec![0.0; snapshot.set.len()];
        for (ball, record) in world.records.iter().enumerate() {
            masses[record.id as usize] = world.mass(ball);
        }
        for (number, set) in self.sets.iter().enumerate() {
            let (mut squares, mut count) = (0.0, 0.0);
            for (ball, &own) in snapshot.set.iter().enumerate() {
                let velocity = snapshot.thermal_velocity(ball);
                if own as usize == number {
                    // Balls of one name may differ.
                    squares += masses[ball] * velocity.iter().map(|v| v * v).sum::<f64>();
                    count += 1.0;
                }
            }
            let temperature = squares / (D as f64 * count * self.setup.boltzmann);
            gauges.push((set.name.clone(), "temperature", "K", temperature));
            if self.sets.len() > 1 {
                gauges.push((set.name.clone(), "kinetic_energy", "J", energies[number]));
            }
            gauges.push((set.name.clone(), "mean_square_displacement", "m2", displacements[number]));
            let late = self.measures.started.is_finite() && self.mean_square_displacement(number).len() > 3;
            let none = Estimate { mean: f64::NAN, error: f64::NAN };
            let diffusion = if late { self.diffusion(number) } else { none };
            gauges.push((set.name.clone(), "diffusion", "m2_per_s", diffusion.mean));
            gauges.push((set.name.clone(), "diffusion_standard_error", "m2_per_s", diffusion.error));
            if let Some(&beyond) = beyond.get(number) {
                gauges.push((set.name.clone(), "beyond_partition", "", beyond));
            }
        }
        gauges
    }

    fn energy_balance(&self) -> Balance {
        let world = self.mover.world();
        let gained: f64 = world.wall_tallies.iter().map(|tally| tally.gained.value()).sum();
        let lost: f64 = world.wall_tallies.iter().map(|tally| tally.lost.value()).sum();
        let gained = gained + world.tally.shear.gained.value() + self.live.gained.value();
        let lost = lost + world.tally.shear.lost.value();
        let outflow = lost + world.tally.dissipated.value() + self.live.lost.value();
        let quantity = if self.si { "energy_J" } else { "energy" };
        Balance { quantity, initial: self.initial[0], inflow: gained, outflow, now: self.energy(), least: 0.0 }
    }

    fn momentum_balance(&self) -> Balance {
        let world = self.mover.world();
        let (mut inflow, mut outflow) = (0.0, 0.0);
        let mut book = |amount: f64| if amount >= 0.0 { inflow += amount } else { outflow -= amount };
        for tally in &world.wall_tallies {
            book(-tally.momentum.value() + tally.dragged.value());
        }
        book(self.live.momentum.value());
        book(world.tally.shear.momentum.value());
        let mass: f64 = (0..world.balls.len()).map(|ball| world.mass(ball)).sum();
        world.field.gravity.iter().for_each(|gravity| book(mass * gravity * self.shown));
        let now: f64 = self.momentum().iter().sum();
        // Opposite momenta may add up to 0: an error is set against their magnitudes.
        let magnitudes: f64 = (0..world.balls.len())
            .map(|ball| world.mass(ball) * crate::world::speed(&world.balls[ball].velocity))
            .sum();
        Balance { quantity: "momentum", initial: self.initial[1], inflow, outflow, now, least: magnitudes }
    }
}

impl<const D: usize> Model for Gas<D> {
    fn name(&self) -> &'static str {
        "gas"
    }

    fn cpu_only(&self) -> Option<CpuOnly> {
        Some(CpuOnly { what: "the gas model runs on the CPU only", remedy: "leave `--backend gpu` out" })
    }

    fn time(&self) -> f64 {
        self.shown
    }

    fn steps(&self) -> u64 {
        self.collisions()
    }

    fn particle_steps(&self) -> u64 {
        self.collisions()
    }

    fn particles(&self) -> usize {
        self.len()
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        self.advance(time, stop)
    }

    fn frame(&self) -> Frame {
        let snapshot = self.snapshot(self.shown);
        let world = self.mover.world();
        let mut bodies = vec![(0.0, 0.0); world.balls.len()];
        for (ball, record) in world.records.iter().enumerate() {
            bodies[record.id as usize] = (world.radius(ball), world.mass(ball));
        }
        let mut sets: Vec<ParticleSet> =
            self.sets.iter().map(|set| ParticleSet { name: set.name.clone(), ..ParticleSet::default() }).collect();
        for (number, (radius, mass)) in bodies.into_iter().enumerate() {
            let set = &mut sets[snapshot.set[number] as usize];
            set.id.push(number as u64);
            set.position.push(padded(snapshot.position[number]));
            set.velocity.push(padded(snapshot.velocity[number]));
            set.radius.push(radius);
            set.mass.push(mass);
        }
        Frame { time: self.shown, sets }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        let column =
            |(gauge, quantity, unit, _)| GaugeColumn { gauge, quantity, unit: if self.si { unit } else { "" } };
        self.gauges().into_iter().map(column).collect()
    }

    fn gauge_row(&self) -> Vec<f64> {
        self.gauges().into_iter().map(|(_, _, _, value)| value).collect()
    }

    fn maps(&self) -> Vec<Map> {
        Vec::new()
    }

    fn charts(&self) -> Vec<Chart> {
        let axis = self.setup.measure.profile_axis.min(D - 1);
        let world = self.mover.world();
        let context = Context {
            sets: &self.sets,
            counts: self.counts(),
            setup: &self.setup,
            radius: self.only_radius(),
            si: self.si,
            extent: world.extent(axis, world.in_window(self.shown)),
            p_value: self.maxwell_p_value(),
            energies: self
                .thermal_energies()
                .iter()
                .zip(self.counts())
                .map(|(energy, count)| energy / count as f64)
                .collect(),
            temperature: self.temperature(),
        };
        self.measures.charts(&context)
    }

    fn paths(&self) -> Vec<Path> {
        let path = self.path();
        let Some(followed) = self.mover.world().followed.as_ref() else { return Vec::new() };
        vec![Path {
            name: format!("ball {}", followed.id),
            times: path.iter().map(|(time, _)| *time).collect(),
            points: path.into_iter().map(|(_, position)| padded(position)).collect(),
        }]
    }

    fn container(&self) -> Option<Container> {
        let world = self.mover.world();
        let now = world.in_window(self.shown);
        let extent: [[f64; 2]; D] = std::array::from_fn(|axis| world.extent(axis, now));
        Some(Container { from: padded(extent.map(|[low, _]| low)), to: padded(extent.map(|[_, high]| high)) })
    }

    fn ledger(&self) -> Ledger {
        let mut balances = vec![self.energy_balance(), self.momentum_balance()];
        let (added, removed) = (self.live.added as f64, self.live.removed as f64);
        if added + removed > 0.0 {
            let now = self.len() as f64;
            let initial = now - added + removed;
            balances.push(Balance { quantity: "balls", initial, inflow: added, outflow: removed, now, least: 0.0 });
        }
        Ledger { balances }
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let from = self.setup.measure.from;
        if let Some(until) = self.setup.measure.until.filter(|until| from >= *until) {
            warnings.push(format!(
                "gas.measure.from_s = {from}: the run ends at {until}, so nothing is averaged, and all that is has no value"
            ));
        }
        if let Some((overlaps, missed, deepest)) = self.faults().filter(|(overlaps, missed, _)| overlaps + missed > 0) {
            warnings.push(format!(
                "fixed steps: {overlaps} overlaps were found, the deepest {deepest:.3} of a radius, and {missed} hits were \
                 missed; the exact methods have none"
            ));
        }
        warnings
    }

    fn save(&self) -> Vec<u8> {
        self.saved()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        self.take_back(state)
    }
}
