//! Live changes of a flood: what is changed while it runs.

use crate::as_flood_mut;
use crate::error::setup;
use corpuscle_model::ModelError;
use serde::{Deserialize, Serialize};
use std::any::Any;

/// A change of a flood that runs. Inflows and stages are counted as in the scene, from 0; sides are 0 west, 1 east, 2 south, 3 north.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum LiveChange {
    /// An inflow brings so much from now on.
    Discharge {
        /// The inflow.
        inflow: usize,
        /// Discharge, m3/s, 0 or more.
        discharge: f64,
    },
    /// An inflow brings so many times what the scene says, now and later.
    DischargeTimes {
        /// The inflow.
        inflow: usize,
        /// The factor, 0 or more.
        times: f64,
    },
    /// It rains so hard from now on, mm/h, 0 or more; also where the scene has no rain.
    Rain(f64),
    /// It rains so many times as hard as the scene says, now and later; 0 or more.
    RainTimes(f64),
    /// A stage is held at another level from now on.
    Level {
        /// The stage.
        stage: usize,
        /// Level, m.
        level: f64,
    },
    /// An edge that is held at a level is held at another from now on.
    EdgeLevel {
        /// The side.
        side: usize,
        /// Level, m.
        level: f64,
    },
    /// Manning's n, s/m^(1/3), 0 or more, where no kind of ground has its own.
    Manning(f64),
    /// The control force of scheme sph-swe is on or off.
    ControlForce(bool),
}

impl LiveChange {
    /// Changes a model that is a flood.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it is none, has nothing of the kind, or the number is out of range: nothing has changed then.
    /// [`ModelError::Device`] where a GPU takes the steps and cannot go on with the change.
    pub fn change(self, model: &mut dyn Any) -> Result<(), ModelError> {
        match as_flood_mut(model) {
            Some(flood) => flood.change(self),
            None => Err(setup("this model is no flood")),
        }
    }

    /// Refuses numbers that cannot be.
    pub(crate) fn check(self) -> Result<(), ModelError> {
        let (value, what, least) = match self {
            Self::Discharge { discharge, .. } => (discharge, "a discharge", 0.0),
            Self::DischargeTimes { times, .. } => (times, "the factor of a discharge", 0.0),
            Self::Rain(rain) => (rain, "rain", 0.0),
            Self::RainTimes(times) => (times, "the factor of rain", 0.0),
            Self::Manning(n) => (n, "Manning's n", 0.0),
            Self::Level { level, .. } | Self::EdgeLevel { level, .. } => (level, "a level", f64::MIN),
            Self::ControlForce(_) => return Ok(()),
        };
        if value.is_finite() && value >= least {
            return Ok(());
        }
        let range = if least == 0.0 { "0 or more" } else { "a finite number" };
        Err(setup(format!("{what} must be {range}, not {value}")))
    }
}
