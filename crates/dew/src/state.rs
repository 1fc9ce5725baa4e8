//! The state of a run.

use crate::air::{Particle, Role};
use crate::fan::Fan;
use crate::room::{InflowsOverTime, Room};
use crate::settings::Settings;
use crate::solids::sources::BodySources;
use corpuscle_model::{Account, CompensatedSum, ExactSum};
use corpuscle_scene::Table;
use serde::{Deserialize, Serialize};

/// Everything that changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct State {
    pub time: f64,
    pub steps: u64,
    pub particle_steps: u64,
    /// Largest stable time step (CFL) from here, s.
    pub time_step: f64,
    pub next_id: u64,
    pub air: Vec<Particle>,
    /// Temperature of each particle of the solids, then of each cell of the walls behind them, K.
    pub temperatures: Vec<f64>,
    /// Water on each particle of the solids, kg.
    pub water_on: Vec<f64>,
    /// Vapour that has become fog less fog that has become vapour, kg.
    pub fogged: ExactSum,
    /// Heat that has come from each solid held at a temperature, J; negative where it took it.
    pub held_heat: Vec<CompensatedSum>,
    /// Heat that each solid, then each wall, has got from its heater, from outside and by radiation, J.
    pub supplied: Vec<[CompensatedSum; 3]>,
    /// Heat that each solid takes from the air through its surface, W, in the last step.
    pub heat_flow: Vec<f64>,
    /// Time of the last search for air of low utility, s.
    pub utility_seen: f64,
    /// How far the air before each inlet has come since its last layer, m.
    pub inlet_phase: [[f64; 2]; 3],
    pub water: Account,
    pub energy: Account,
    /// The values after live changes; none where there was none.
    pub overrides: Option<Overrides>,
    /// What all air of a closed room is still to gain for accelerated time: temperature, K, and vapour, part of the mass.
    #[serde(default)]
    pub drift: [f64; 2],
    /// By how much the air beyond each outlet is denser than at rest, over its density at rest.
    pub density_excess_beyond: [[f64; 2]; 3],
    /// Running mean, over the time in which sound crosses the room, of the velocity along its axis of the air before each outlet, m/s.
    pub running_mean_before: [[f64; 2]; 3],
}

impl State {
    /// The air in the room.
    pub fn inside(&self) -> impl Iterator<Item = &Particle> + Clone {
        self.air.iter().filter(|particle| particle.role == Role::Inside)
    }
}

/// All values that live changes can set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Overrides {
    /// The box, with what its faces do.
    pub room: Room,
    /// What comes in where it changes with time.
    pub inflows: InflowsOverTime,
    /// The fans.
    pub fans: Vec<Fan>,
    /// How the model works.
    pub settings: Settings,
    /// Artificial speed of sound, m/s.
    pub sound_speed: f64,
    /// Temperature over time, °C, of the bodies that are held.
    pub held_to: Vec<Option<Table>>,
    /// Heaters, the outside, radiation.
    pub sources: Vec<BodySources>,
    /// Gravity on drops, m/s2.
    pub on_drops: Option<[f64; 3]>,
}

impl Overrides {
    /// Power of a solid's heater over time.
    pub fn heater(&self, solid: usize) -> Option<&Table> {
        self.sources.get(solid)?.heater.as_ref().map(|(power, _)| power)
    }
}
