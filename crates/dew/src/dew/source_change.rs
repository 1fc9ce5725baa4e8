//! Live changes of heaters, the outside and radiation.

use super::Dew;
use super::live_change::refuse;
use crate::humid_air::ZERO_CELSIUS;
use crate::solids::sources::Surroundings;
use corpuscle_model::ModelError;
use corpuscle_scene::Table;
use serde::{Deserialize, Serialize};

/// A change of what heats or cools a solid, from now on. Solids are counted as in the scene, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum SourceChange {
    /// Power of a heater, W or W/m2 as in the scene.
    HeaterPower {
        /// The solid.
        solid: usize,
        /// Its power.
        power: f64,
    },
    /// Multiplies a heater's power in the scene by a factor, now and later.
    HeaterTimes {
        /// The solid.
        solid: usize,
        /// By what it is multiplied.
        times: f64,
    },
    /// Temperature of the air outside, °C; surroundings without a temperature in the scene have it too.
    OutsideTemperature {
        /// The solid.
        solid: usize,
        /// The temperature, °C.
        celsius: f64,
    },
    /// Heat transfer coefficient of the air outside, W/(m2 K).
    OutsideTransfer {
        /// The solid.
        solid: usize,
        /// The coefficient, W/(m2 K).
        coefficient: f64,
    },
    /// Mean radiant temperature outside, °C.
    OutsideSurroundings {
        /// The solid.
        solid: usize,
        /// The temperature, °C.
        celsius: f64,
    },
    /// Mean radiant temperature in the box, °C.
    Surroundings {
        /// The solid.
        solid: usize,
        /// The temperature, °C.
        celsius: f64,
    },
}

impl SourceChange {
    /// The number, what it is, and the range that it must be in.
    pub(super) fn range(self) -> (f64, &'static str, [f64; 2]) {
        match self {
            Self::HeaterPower { power, .. } => (power, "the power of a heater", [0.0, 1e6]),
            Self::HeaterTimes { times, .. } => (times, "the factor of a heater's power", [0.0, 1e3]),
            Self::OutsideTransfer { coefficient, .. } => {
                (coefficient, "a heat transfer coefficient in W/(m2 K)", [0.0, 1e5])
            }
            Self::OutsideTemperature { celsius, .. }
            | Self::OutsideSurroundings { celsius, .. }
            | Self::Surroundings { celsius, .. } => (celsius, "a temperature in °C", [-ZERO_CELSIUS, 1000.0]),
        }
    }
}

impl Dew {
    pub(super) fn change_source(&mut self, change: SourceChange) -> Result<(), ModelError> {
        match change {
            SourceChange::HeaterPower { solid, power } => *self.heater(solid)? = Table::constant(power),
            SourceChange::HeaterTimes { solid, times } => {
                let as_set_up = self.as_set_up.as_ref().and_then(|overrides| overrides.heater(solid)).cloned();
                let power = self.heater(solid)?;
                *power = as_set_up.unwrap_or_else(|| power.clone()).times(times);
            }
            SourceChange::OutsideTemperature { solid, celsius } => {
                self.outside_of(solid)?.air_temperature = Table::constant(celsius);
            }
            SourceChange::OutsideTransfer { solid, coefficient } => {
                self.outside_of(solid)?.transfer_coefficient = coefficient;
            }
            SourceChange::OutsideSurroundings { solid, celsius } => {
                self.outside_of(solid)?.radiant_temperature = Some(Table::constant(celsius));
            }
            SourceChange::Surroundings { solid, celsius } => {
                let radiation = self.sources.bodies.get_mut(solid).and_then(|of| of.radiation.as_mut());
                let radiation = radiation.ok_or_else(|| refuse(format!("solid {solid} does not radiate")))?;
                radiation.radiant_temperature = Some(Table::constant(celsius));
            }
        }
        Ok(())
    }

    /// Power of a solid's heater over time.
    fn heater(&mut self, solid: usize) -> Result<&mut Table, ModelError> {
        let heater = self.sources.bodies.get_mut(solid).and_then(|of| of.heater.as_mut());
        heater.map(|(power, _)| power).ok_or_else(|| refuse(format!("solid {solid} has no heater")))
    }

    /// Surroundings, outside the box, of a solid or of the wall behind it.
    fn outside_of(&mut self, solid: usize) -> Result<&mut Surroundings, ModelError> {
        let group = self.solids.wall_behind(solid).unwrap_or(solid);
        let outside = self.sources.bodies.get_mut(group).and_then(|of| of.outside.as_mut());
        outside
            .map(|outside| &mut outside.surroundings)
            .ok_or_else(|| refuse(format!("nothing is outside of solid {solid}")))
    }
}
