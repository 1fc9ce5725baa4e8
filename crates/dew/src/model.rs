//! What the model shows.

use crate::dew::{Dew, State};
use crate::humid_air::HumidAir;
use crate::wetting::{Wetting, WettingState};
use corpuscle_model::{
    Column, Container, ExactSum, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Values,
};
use std::sync::atomic::{AtomicBool, Ordering};

impl Dew {
    /// Time from the state to the time shown, s.
    fn since(&self) -> f64 {
        self.shown - self.state.time
    }

    fn air_set(&self) -> ParticleSet {
        let since = self.since();
        let mut order: Vec<_> = self.inside().collect();
        order.sort_unstable_by_key(|particle| particle.id);
        let scalar = |of: &dyn Fn(&crate::air::Particle) -> f64| {
            Values::Scalar(order.iter().map(|particle| of(particle)).collect())
        };
        let humidity = |particle: &crate::air::Particle| {
            let air = HumidAir::with_mass_fraction(particle.temperature, self.air.pressure, particle.vapour);
            air.relative_humidity()
        };
        ParticleSet {
            name: "air".into(),
            id: order.iter().map(|particle| particle.id).collect(),
            position: order
                .iter()
                .map(|particle| [0, 1, 2].map(|axis| particle.position[axis] + since * particle.velocity[axis]))
                .collect(),
            velocity: order.iter().map(|particle| particle.velocity).collect(),
            radius: vec![0.5 * self.scale().spacing; order.len()],
            mass: vec![self.particle_mass(); order.len()],
            columns: vec![
                Column { name: "temperature", unit: "K", values: scalar(&|particle| particle.temperature) },
                Column { name: "vapour", unit: "kg/kg", values: scalar(&|particle| particle.vapour) },
                Column { name: "relative_humidity", unit: "", values: scalar(&humidity) },
                Column { name: "fog", unit: "kg/kg", values: scalar(&|particle| particle.fog) },
            ],
        }
    }

    /// Water on a body, kg, and its mean temperature, K.
    fn totals_of(&self, body: usize) -> [f64; 2] {
        let of_body = |at: &usize| self.solids.particles[*at].body as usize == body;
        let (mut water, mut heat, mut volume) = (0.0, 0.0, 0.0);
        for at in (0..self.solids.particles.len()).filter(of_body) {
            water += self.state.water_on[at];
            heat += self.solids.particles[at].volume * self.state.temperatures[at];
            volume += self.solids.particles[at].volume;
        }
        [water, heat / volume]
    }

    fn solid_set(&self) -> ParticleSet {
        let particles = &self.solids().particles;
        let area =
            |particle: &crate::solids::SolidParticle| if particle.normal.is_some() { particle.area } else { 0.0 };
        ParticleSet {
            name: "solid".into(),
            id: (0..particles.len() as u64).collect(),
            position: particles.iter().map(|particle| particle.position).collect(),
            velocity: vec![[0.0; 3]; particles.len()],
            radius: particles.iter().map(|particle| 0.5 * particle.volume.cbrt()).collect(),
            mass: (0..particles.len()).map(|i| self.solids().material(i).density * particles[i].volume).collect(),
            columns: vec![
                Column { name: "temperature", unit: "K", values: Values::Scalar(self.state.temperatures.clone()) },
                Column { name: "water", unit: "kg", values: Values::Scalar(self.state.water_on.clone()) },
                Column { name: "area", unit: "m2", values: Values::Scalar(particles.iter().map(area).collect()) },
                Column {
                    name: "normal",
                    unit: "",
                    values: Values::Vector(
                        particles.iter().map(|particle| particle.normal.unwrap_or([0.0; 3])).collect(),
                    ),
                },
            ],
        }
    }
}

impl Model for Dew {
    fn name(&self) -> &'static str {
        "dew"
    }

    fn time(&self) -> f64 {
        self.shown
    }

    fn steps(&self) -> u64 {
        self.state.steps
    }

    fn particle_steps(&self) -> u64 {
        self.state.particle_steps
    }

    fn particles(&self) -> usize {
        self.inside().count() + self.solids().particles.len()
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            self.step()?;
        }
        self.shown = time;
        Ok(())
    }

    fn frame(&self) -> Frame {
        let air = self.shows.air.then(|| self.air_set());
        let solid = self.shows.solids.then(|| self.solid_set());
        let drops = self.wetting.as_ref().map(Wetting::set);
        Frame { time: self.shown, sets: air.into_iter().chain(solid).chain(drops).collect() }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
        let mut columns = vec![
            column("water", "vapour", "kg"),
            column("water", "fog", "kg"),
            column("water", "on_solids", "kg"),
            column("air", "mean_temperature", "K"),
            column("air", "largest_speed", "m_per_s"),
            column("solids", "covered_area", "m2"),
            column("solids", "heat_from_held", "J"),
        ];
        if self.wetting.is_some() {
            columns.extend([
                column("drops", "number", ""),
                column("drops", "largest_radius", "m"),
                column("drops", "first_at", "s"),
                column("drops", "left", "kg"),
            ]);
        }
        for name in &self.names {
            columns.extend([
                column(name, "water", "kg"),
                column(name, "mean_temperature", "K"),
                column(name, "heat_given", "J"),
            ]);
        }
        columns
    }

    fn gauge_row(&self) -> Vec<f64> {
        let mass = self.particle_mass();
        let count = self.inside().count() as f64;
        let sum = |of: fn(&crate::air::Particle) -> f64| self.inside().map(of).sum::<f64>();
        let speed = self.inside().map(crate::air::Particle::speed_squared).fold(0.0, f64::max).sqrt();
        let particles = self.solids().particles.iter().zip(&self.state.water_on);
        let wet = || particles.filter(|(_, water)| **water > 0.0).map(|(particle, _)| particle.area).sum();
        let drops = self.wetting.as_ref().map(Wetting::drops);
        let covered = drops.map_or_else(wet, |drops| drops.covered_area());
        let mut row = vec![
            mass * sum(|particle| particle.vapour),
            mass * sum(|particle| particle.fog),
            self.water_on_all(),
            sum(|particle| particle.temperature) / count,
            speed,
            covered,
            self.state.held_heat.iter().map(ExactSum::value).sum(),
        ];
        if let Some(wetting) = &self.wetting {
            let drops = wetting.drops();
            let largest = drops.drops().iter().map(|drop| drops.covered_radius(drop)).fold(0.0, f64::max);
            let first = wetting.first().unwrap_or(f64::NAN);
            row.extend([drops.drops().len() as f64, largest, first, drops.dripped()]);
        }
        for body in 0..self.names.len() {
            row.extend(self.totals_of(body));
            row.push(self.heat_from(body));
        }
        row
    }

    fn maps(&self) -> Vec<Map> {
        Vec::new()
    }

    fn container(&self) -> Option<Container> {
        Some(Container { from: self.room.low, to: self.room.high })
    }

    fn ledger(&self) -> Ledger {
        let water = self.state.water.balance("water_kg", self.water());
        let energy = self.state.energy.balance("energy_J", self.energy());
        Ledger { balances: vec![water, energy] }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.shown, &self.state, self.wetting.as_ref().map(Wetting::state))).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, state, drops): (f64, State, Option<WettingState>) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        if state.held_heat.len() != self.state.held_heat.len()
            || state.temperatures.len() != self.state.temperatures.len()
            || state.water_on.len() != self.state.water_on.len()
        {
            return Err(refused("it belongs to another scene".into()));
        }
        let fits = match (&mut self.wetting, drops) {
            (None, None) => true,
            (Some(wetting), Some(drops)) => wetting.restore(drops),
            _ => false,
        };
        if !fits {
            return Err(refused("it belongs to another scene".into()));
        }
        (self.shown, self.state) = (shown, state);
        Ok(())
    }
}
