//! The air as its particles come and go: what passes that add, remove and book them work on.

use crate::air::{Particle, Properties, Scale};
use crate::domain::Domain;
use crate::room::{InflowsOverTime, Room};
use crate::settings::Settings;
use crate::solids::{Solids, Surface};
use crate::state::State;
use corpuscle_processes::Processes;

/// The state, and what passes that add, remove and book particles of air need of the model beside it.
pub(crate) struct Inventory<'a> {
    /// How the model works.
    pub settings: &'a Settings,
    /// The air.
    pub air: &'a Properties,
    /// The box.
    pub room: &'a Room,
    /// The air that comes in where it changes with time.
    pub inflows: &'a InflowsOverTime,
    /// Size of particles.
    pub scale: &'a Scale,
    /// The solids.
    pub solids: &'a Solids,
    /// The surfaces of the bodies; none where one has none.
    pub surfaces: &'a [Surface],
    /// Density at which the pressure is that at rest, kg/m3.
    pub rest_density: f64,
    /// Heat of condensation, J/kg.
    pub latent_heat: f64,
    /// The processes that share the air.
    pub processes: &'a Processes,
    /// The part of this process, where there are several.
    pub domain: Option<&'a Domain>,
    /// All that changes.
    pub state: &'a mut State,
}

impl Inventory<'_> {
    /// Whether what is at a position is computed by this process.
    pub fn owns(&self, position: [f64; 3]) -> bool {
        self.domain.is_none_or(|domain| domain.owns(position))
    }

    /// Books a particle as come, with the sign 1, or as left, with -1.
    pub fn book(&mut self, particle: &Particle, sign: f64) {
        let mass = self.air.particle_mass(self.scale);
        let water = mass * (particle.vapour + particle.fog);
        let energy = mass * self.air.energy_of(particle, self.latent_heat);
        self.state.water.book(sign * water);
        self.state.energy.book(sign * energy);
    }
}
