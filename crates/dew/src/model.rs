//! What the model shows.

use crate::air::{Particle, order_of};
use crate::dew::Dew;
use crate::humid_air::HumidAir;
use crate::measures::drop_sizes;
use crate::state::State;
use crate::wetting::{Wetting, WettingState};
#[cfg(feature = "gpu")]
use corpuscle_model::{AdvanceObserver, CpuOnly, GpuModel, advance_with};
use corpuscle_model::{
    Chart, Column, Container, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Surface, Values,
};
use corpuscle_processes::Command;
use std::sync::atomic::AtomicBool;

impl Dew {
    /// Time from the state to the time shown, s.
    pub(crate) fn since(&self) -> f64 {
        self.shown - self.state.time
    }

    fn air_set(&self) -> ParticleSet {
        let since = self.since();
        let mut order = self.processes.gather_list(self.inside().copied().collect());
        order.sort_unstable_by_key(|particle| particle.id);
        let scalar = |of: &dyn Fn(&Particle) -> f64| Values::Scalar(order.iter().map(of).collect());
        let humidity = |particle: &Particle| {
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
                Column { name: "temperature", unit: "K", values: Values::Scalar(self.temperatures().to_vec()) },
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

    #[cfg(feature = "gpu")]
    fn backend(&self) -> &'static str {
        if self.gpu_solver.is_some() { "gpu" } else { "cpu" }
    }

    #[cfg(feature = "gpu")]
    fn cpu_only(&self) -> Option<CpuOnly> {
        self.on_cpu_only()
    }

    #[cfg(feature = "gpu")]
    fn on_gpu(&self) -> Option<&dyn GpuModel> {
        Some(self)
    }

    #[cfg(feature = "gpu")]
    fn on_gpu_mut(&mut self) -> Option<&mut dyn GpuModel> {
        Some(self)
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
        self.inside_count() + self.solids().particles.len()
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        if self.gpu_solver.is_some() {
            return corpuscle_gpu::wait_for(self.advance_on_gpu(time, stop));
        }
        self.processes.broadcast(&Command::Advance(time));
        self.advance_on_cpu(time, stop)
    }

    #[cfg(feature = "gpu")]
    fn advance_with(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
    ) -> Result<(), ModelError> {
        if self.gpu_solver.is_some() {
            corpuscle_gpu::wait_for(self.advance_measured(time, stop, observer, None))
        } else {
            advance_with(self, time, stop, observer)
        }
    }

    fn frame(&self) -> Frame {
        self.processes.broadcast(&Command::Frame);
        let air = self.shows.air.then(|| self.air_set());
        let solid = self.shows.solids.then(|| self.solid_set());
        let drops = self.wetting.iter().flat_map(Wetting::sets);
        Frame { time: self.shown, sets: air.into_iter().chain(solid).chain(drops).collect() }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        self.measured_columns()
    }

    fn gauge_row(&self) -> Vec<f64> {
        self.processes.broadcast(&Command::GaugeRow);
        self.measured(&self.totals())
    }

    fn charts(&self) -> Vec<Chart> {
        self.wetting.as_ref().and_then(|wetting| drop_sizes(wetting.drops())).into_iter().collect()
    }

    fn surfaces(&self) -> Vec<Surface> {
        let names = self.names.iter().enumerate();
        let of = |wetting: &Wetting| {
            names.map(|(solid, name)| wetting.surface(solid, name, &self.state.temperatures)).collect()
        };
        self.wetting.as_ref().map_or_else(Vec::new, of)
    }

    fn maps(&self) -> Vec<Map> {
        Vec::new()
    }

    fn container(&self) -> Option<Container> {
        Some(Container { from: self.room.low, to: self.room.high })
    }

    fn ledger(&self) -> Ledger {
        self.processes.broadcast(&Command::Ledger);
        let ([water, energy], _) = self.booked();
        let water = water.balance("water_kg", self.water());
        let energy = energy.balance("energy_J", self.energy());
        Ledger { balances: vec![water, energy] }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.iter().cloned().chain(self.frost()).collect()
    }

    fn save(&self) -> Vec<u8> {
        self.processes.broadcast(&Command::Save);
        let mut state = self.state.clone();
        ([state.water, state.energy], state.fogged) = self.booked();
        state.air = self.processes.gather_list(std::mem::take(&mut state.air));
        if self.domain.is_some() {
            // As it stands in one process.
            state.air.sort_unstable_by_key(|particle| order_of(particle, &self.room, self.scale.h()));
        }
        postcard::to_stdvec(&(self.shown, &state, self.wetting.as_ref().map(Wetting::state))).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        if self.domain.is_some() {
            self.processes.broadcast(&Command::Restore(state.to_vec()));
        }
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, state, drops): (f64, State, Option<WettingState>) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        if state.held_heat.len() != self.state.held_heat.len()
            || state.heat_flow.len() != self.state.heat_flow.len()
            || state.supplied.len() != self.state.supplied.len()
            || state.temperatures.len() != self.state.temperatures.len()
            || state.water_on.len() != self.state.water_on.len()
            || !state.air.iter().all(|particle| particle.role.names_a_face())
        {
            return Err(refused("it belongs to another scene".into()));
        }
        if self.domain.is_some() && state.overrides.is_some() {
            return Err(refused("dew was changed while it ran: resume it without `mpirun`".into()));
        }
        self.check_state(&state, drops.as_ref())?;
        let fits = match (&mut self.wetting, drops) {
            (None, None) => true,
            (Some(wetting), Some(drops)) => wetting.restore(drops),
            _ => false,
        };
        if !fits {
            return Err(refused("it belongs to another scene".into()));
        }
        (self.shown, self.state) = (shown, state);
        self.keep_part();
        self.set_evaporation();
        self.apply_overrides();
        self.update_gpu(self.has_been_touched())
    }
}
