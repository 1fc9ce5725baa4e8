//! A gas that is held at a temperature by scaling its velocities from time to time (Woodcock 1971).

use super::super::Gas;
use corpuscle_model::ModelError;
use serde::{Deserialize, Serialize};

/// Time between two scalings, over that in which a ball at thermal speed crosses the shortest side of the box.
const SCALING_PERIOD: f64 = 0.1;

/// Largest shear between two scalings: work of shear heats the gas meanwhile.
const SCALING_SHEAR: f64 = 0.05;

/// What holds the temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Thermostat {
    temperature: f64,
    /// Time between two scalings.
    every: f64,
    /// When it scales next.
    pub next: f64,
}

impl Thermostat {
    /// Whether its numbers are some with which time goes on.
    pub fn goes_on(&self) -> bool {
        self.temperature.is_finite() && self.next + self.every > self.next
    }
}

impl<const D: usize> Gas<D> {
    /// Holds the temperature from now on, or no longer.
    pub(in super::super) fn hold_temperature(&mut self, temperature: Option<f64>) -> Result<(), ModelError> {
        let Some(temperature) = temperature else {
            self.live.thermostat = None;
            return Ok(());
        };
        if self.temperature() <= 0.0 {
            return Err(ModelError::Setup("balls that do not move have no temperature that could be scaled".into()));
        }
        let lightest = self.sets.iter().map(|set| set.mass).fold(f64::INFINITY, f64::min);
        let thermal = (self.setup.boltzmann * temperature / lightest).sqrt();
        let shortest = self.setup.size.iter().copied().fold(f64::INFINITY, f64::min);
        let shear = self.setup.shear.map_or(f64::INFINITY, |shear| SCALING_SHEAR / shear.rate);
        let every = (SCALING_PERIOD * shortest / thermal).min(shear);
        self.come_to_now();
        let next = self.mover.world().time() + every;
        self.live.thermostat = Some(Thermostat { temperature, every, next });
        self.scale_energy(temperature / self.temperature());
        Ok(())
    }

    /// Scales the velocities to the temperature that is held.
    pub(in super::super) fn regulate(&mut self) {
        let Some(thermostat) = &mut self.live.thermostat else { return };
        thermostat.next += thermostat.every;
        let (wanted, now) = (thermostat.temperature, self.temperature_at_the_event());
        // Where nothing moves there is nothing to scale.
        if now > 0.0 {
            self.scale_energy(wanted / now);
        }
    }

    /// [`Gas::temperature`] at the time of the last event.
    fn temperature_at_the_event(&self) -> f64 {
        let world = self.mover.world();
        let (mut mass, mut momentum, mut energy) = (0.0, [0.0; D], 0.0);
        for ball in 0..world.balls.len() {
            let (own, velocity) = (world.mass(ball), world.thermal_velocity(ball, world.now));
            mass += own;
            for axis in 0..D {
                momentum[axis] += own * velocity[axis];
                energy += 0.5 * own * velocity[axis] * velocity[axis];
            }
        }
        let freedom = self.setup.degrees_of_freedom(world.balls.len());
        2.0 * (energy - self.drift_energy(&momentum, mass)) / (freedom * self.setup.boltzmann)
    }
}
