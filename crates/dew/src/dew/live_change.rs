//! Live changes of dew: what is changed while it runs.
//!
//! A change holds from the end of the last step on, at most one step before the time shown. The energy that solids get by live changes is booked.

use super::{COLD, Dew, SourceChange};
use crate::air::{LEAST_SOUND, SOUND_OVER_MOTION};
use crate::fan::Fan;
use crate::humid_air::{HumidAir, ZERO_CELSIUS};
use crate::room::{Face, Inflow};
use crate::state::{Overrides, State};
use corpuscle_model::ModelError;
use corpuscle_scene::Table;
use serde::{Deserialize, Serialize};
use std::any::Any;

/// A change of dew that runs. Solids and fans are counted as in the scene, from 0; a face has an axis, 0 to 2, and an end, 0 at the
/// smaller coordinate and 1 at the larger.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum LiveChange {
    /// A solid is brought to a temperature, °C; one that is held is held there from now on, another goes on from there.
    SolidTemperature {
        /// The solid.
        solid: usize,
        /// Its temperature, °C.
        celsius: f64,
    },
    /// Air comes in at another temperature, °C, with as much vapour as before.
    InletTemperature {
        /// The face.
        face: [usize; 2],
        /// The temperature, °C.
        celsius: f64,
    },
    /// Air comes in with another relative humidity, 0 to 1, as warm as before.
    InletHumidity {
        /// The face.
        face: [usize; 2],
        /// The humidity.
        relative: f64,
    },
    /// Air comes in at another speed along an axis; across the face it leads into the box.
    Wind {
        /// The face.
        face: [usize; 2],
        /// Axis of the velocity.
        axis: usize,
        /// Velocity along it, m/s.
        velocity: f64,
    },
    /// A fan drives air to another velocity along an axis; a fan of no velocity drives nothing.
    FanVelocity {
        /// The fan.
        fan: usize,
        /// Axis of the velocity.
        axis: usize,
        /// Velocity along it, m/s.
        velocity: f64,
    },
    /// Gravity pulls otherwise along an axis, as in a box that is tilted.
    Gravity {
        /// The axis.
        axis: usize,
        /// Acceleration along it, m/s2.
        acceleration: f64,
    },
    /// Factor by which temperatures of solids and water on them change faster than in reality; at least 1.
    TimeFactor(f64),
    /// Something that heats or cools a solid changes.
    Source(SourceChange),
}

pub(super) fn refuse(what: impl Into<String>) -> ModelError {
    ModelError::Setup(what.into())
}

impl LiveChange {
    /// Changes a model that is one of dew.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it is none, has nothing of the kind, or the number is out of range: nothing has changed then;
    /// [`ModelError::Device`] where a GPU takes the steps and cannot go on with the change.
    pub fn change(self, model: &mut dyn Any) -> Result<(), ModelError> {
        match model.downcast_mut::<Dew>() {
            Some(dew) => dew.change_live(self),
            None => Err(refuse("this model is none of dew")),
        }
    }

    /// Refuses numbers that cannot be.
    fn check(self) -> Result<(), ModelError> {
        let (value, what, range) = match self {
            Self::SolidTemperature { celsius, .. } | Self::InletTemperature { celsius, .. } => {
                (celsius, "a temperature in °C", [-100.0, 300.0])
            }
            Self::Source(change) => change.range(),
            Self::InletHumidity { relative, .. } => (relative, "relative humidity", [0.0, 1.0]),
            Self::Wind { velocity, .. } | Self::FanVelocity { velocity, .. } => {
                (velocity, "a velocity in m/s", [-100.0, 100.0])
            }
            Self::Gravity { acceleration, .. } => (acceleration, "gravity in m/s2", [-1000.0, 1000.0]),
            Self::TimeFactor(factor) => (factor, "the time factor", [1.0, 1e6]),
        };
        if range[0] <= value && value <= range[1] {
            return Ok(());
        }
        Err(refuse(format!("{what} must be from {} to {}, not {value}", range[0], range[1])))
    }

    /// The axis that is meant, where one is.
    fn axis(self) -> usize {
        match self {
            Self::Wind { axis, .. } | Self::FanVelocity { axis, .. } | Self::Gravity { axis, .. } => axis,
            _ => 0,
        }
    }
}

impl Dew {
    fn change_live(&mut self, change: LiveChange) -> Result<(), ModelError> {
        change.check()?;
        if self.domain.is_some() {
            return Err(refuse("dew that several processes compute cannot be changed while it runs"));
        }
        if change.axis() > 2 {
            return Err(refuse(format!("there is no axis {}", change.axis())));
        }
        let before = self.as_it_is();
        match change {
            LiveChange::SolidTemperature { solid, celsius } => self.bring_to(solid, celsius)?,
            LiveChange::InletTemperature { face, celsius } => {
                self.end_inflow_over_time(face);
                self.change_inlet(face, |inflow, _| inflow.temperature = celsius + ZERO_CELSIUS)?;
            }
            LiveChange::InletHumidity { face, relative } => {
                self.end_inflow_over_time(face);
                self.change_inlet(face, |inflow, pressure| {
                    let air = HumidAir::with_relative_humidity(inflow.temperature, pressure, relative);
                    inflow.vapour = air.mass_fraction();
                })?;
            }
            LiveChange::Wind { face, axis, velocity } => {
                let inward = [1.0, -1.0][face[1].min(1)];
                if axis == face[0] && inward * velocity <= 0.0 {
                    return Err(refuse(format!("air that comes in must move into the box, not at {velocity} m/s")));
                }
                self.change_inlet(face, |inflow, _| inflow.velocity[axis] = velocity)?;
            }
            LiveChange::FanVelocity { fan, axis, velocity } => {
                let fan = self.fans.get_mut(fan).ok_or_else(|| refuse(format!("there is no fan {fan}")))?;
                *fan = fan.along(axis, velocity);
            }
            LiveChange::Gravity { axis, acceleration } => self.turn_gravity(axis, acceleration),
            LiveChange::TimeFactor(factor) => self.go_faster(factor),
            LiveChange::Source(change) => self.change_source(change)?,
        }
        self.as_set_up.get_or_insert(before);
        self.keep_sound_faster();
        self.state.overrides = Some(self.as_it_is());
        self.update_gpu(true)
    }

    /// True where something was changed live, in this state or in one before.
    pub(crate) fn has_been_touched(&self) -> bool {
        self.as_set_up.is_some()
    }

    /// Uploads the state to a GPU that takes the steps; where something was changed live it is set up anew.
    #[cfg_attr(not(feature = "gpu"), expect(unused_variables, clippy::unnecessary_wraps, reason = "there is no GPU"))]
    pub(crate) fn update_gpu(&mut self, anew: bool) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        self.upload_to_gpu(anew)?;
        Ok(())
    }

    fn bring_to(&mut self, solid: usize, celsius: f64) -> Result<(), ModelError> {
        let held = self.solids.bodies.get(solid).ok_or_else(|| refuse(format!("there is no solid {solid}")))?.1;
        let State { temperatures, energy, .. } = &mut self.state;
        for i in (0..self.solids.particles.len()).filter(|&i| self.solids.particles[i].body as usize == solid) {
            let before = std::mem::replace(&mut temperatures[i], celsius + COLD);
            if !held {
                energy.book(self.solids.heat_capacity(i) * (temperatures[i] - before));
            }
        }
        if let Some(Some(table)) = self.held_to.get_mut(solid) {
            *table = Table::constant(celsius);
        }
        Ok(())
    }

    /// From now on the air that comes in by a face is as it is now.
    fn end_inflow_over_time(&mut self, [axis, side]: [usize; 2]) {
        let ended = self.inflows.get_mut(axis).and_then(|sides| sides.get_mut(side)).and_then(Option::take);
        let Some(ended) = ended else { return };
        if let Face::Inlet(inflow) = &mut self.room.faces[axis][side] {
            [inflow.temperature, inflow.vapour] = ended.at(self.state.time);
        }
    }

    /// Changes the air that comes in, and that which stands before the inlet.
    fn change_inlet(&mut self, [axis, side]: [usize; 2], change: impl Fn(&mut Inflow, f64)) -> Result<(), ModelError> {
        let pressure = self.air.pressure;
        let Some(Face::Inlet(inflow)) = self.room.faces.get_mut(axis).and_then(|faces| faces.get_mut(side)) else {
            return Err(refuse("no air comes in at this side of the box"));
        };
        change(inflow, pressure);
        let inflow = *inflow;
        // Air of the velocity alone changes: what comes in over time stays so.
        let now = self.inflows[axis][side].as_ref().map(|own| own.at(self.state.time));
        let [temperature, vapour] = now.unwrap_or([inflow.temperature, inflow.vapour]);
        let coming = crate::air::Role::Coming(axis as u8, side as u8);
        for particle in self.state.air.iter_mut().filter(|particle| particle.role == coming) {
            (particle.temperature, particle.vapour) = (temperature, vapour);
            particle.velocity = inflow.velocity;
        }
        Ok(())
    }

    /// Gravity acts on drops, and on air where it rises and sinks.
    fn turn_gravity(&mut self, axis: usize, acceleration: f64) {
        if self.buoyant {
            self.settings.gravity[axis] = acceleration;
        }
        if let Some(wetting) = &mut self.wetting {
            wetting.gravity_mut()[axis] = acceleration;
        }
    }

    fn go_faster(&mut self, factor: f64) {
        let times = factor / self.settings.time_factor;
        self.settings.time_factor = factor;
        // Until the next evaluation: conduction in solids must not overshoot.
        self.state.time_step /= times.max(1.0);
    }

    /// The speed of sound stays ten times that of the fastest motion to come (Monaghan 1994); it is never lowered, so that nothing jumps
    /// that need not.
    fn keep_sound_faster(&mut self) {
        let needed = (SOUND_OVER_MOTION * self.fastest_to_come()).max(LEAST_SOUND);
        let now = self.air.sound_speed;
        if needed > now {
            self.air.sound_speed = needed;
            self.state.time_step *= now / needed;
        }
    }

    /// As where it was set up: at inlets and fans, or sqrt(g H dT/T), with which warm air would rise through the whole box, m/s.
    fn fastest_to_come(&self) -> f64 {
        let length = |vector: [f64; 3]| vector.iter().map(|along| along * along).sum::<f64>().sqrt();
        let inlets = self.room.faces.iter().flatten().filter_map(|face| match face {
            Face::Inlet(inflow) => Some(inflow),
            _ => None,
        });
        let ambient = self.settings.ambient_temperature;
        let temperatures =
            self.state.temperatures.iter().copied().chain(inlets.clone().map(|inflow| inflow.temperature));
        let contrast = temperatures.map(|other| (other / ambient - 1.0).abs()).fold(0.0, f64::max);
        let size = self.room.size();
        let fall: f64 = (0..3).map(|axis| self.settings.gravity[axis].abs() * size[axis]).sum();
        let driven = inlets.map(|inflow| length(inflow.velocity)).chain(self.fans.iter().map(Fan::speed));
        driven.fold((contrast * fall).sqrt(), f64::max)
    }

    fn as_it_is(&self) -> Overrides {
        Overrides {
            room: self.room,
            inflows: self.inflows.clone(),
            fans: self.fans.clone(),
            settings: self.settings,
            sound_speed: self.air.sound_speed,
            held_to: self.held_to.clone(),
            sources: self.sources.bodies.clone(),
            on_drops: self.wetting.as_ref().map(|wetting| wetting.drops().laws().gravity),
        }
    }

    /// All is as the state's overrides say, or as it was set up where there are none.
    pub(crate) fn apply_overrides(&mut self) {
        let Some(overrides) = self.state.overrides.clone().or_else(|| self.as_set_up.clone()) else { return };
        if self.as_set_up.is_none() {
            self.as_set_up = Some(self.as_it_is());
        }
        (self.room, self.fans, self.settings) = (overrides.room, overrides.fans, overrides.settings);
        self.inflows = overrides.inflows;
        self.air.sound_speed = overrides.sound_speed;
        self.held_to = overrides.held_to;
        self.sources.bodies = overrides.sources;
        if let (Some(wetting), Some(gravity)) = (&mut self.wetting, overrides.on_drops) {
            *wetting.gravity_mut() = gravity;
        }
    }
}
