//! What air is like.

use crate::settings::Conductor;
use serde::{Deserialize, Serialize};

/// Properties of the air, the same everywhere: it differs in temperature by a few tens of degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Density, kg/m3.
    pub density: f64,
    /// Kinematic viscosity, m2/s.
    pub viscosity: f64,
    /// Conductivity of heat, W/(m K).
    pub conductivity: f64,
    /// Heat capacity at constant pressure, J/(kg K).
    pub heat_capacity: f64,
    /// Diffusivity of vapour, m2/s.
    pub vapour_diffusivity: f64,
    /// Pressure, Pa.
    pub pressure: f64,
    /// Artificial speed of sound, m/s: about ten times the fastest motion keeps the density within a percent (Monaghan 1994).
    pub sound_speed: f64,
    /// Pressure by which particles spread evenly, over density times the square of the speed of sound (Adami, Hu & Adams
    /// 2013, who take 1). It moves particles, not the air: without it they would clump where the pressure is below that
    /// at rest, and with a background in the equation of state instead, its noise would brake the air.
    pub spreading: f64,
}

impl Properties {
    /// Dry air at 25 °C and 101325 Pa (Incropera & DeWitt, 6th edition, table A.4, interpolated); vapour diffuses at
    /// 2.5e-5 m2/s (Massman 1998).
    pub fn at_room_temperature(sound_speed: f64) -> Self {
        Self {
            density: 1.184,
            viscosity: 1.57e-5,
            conductivity: 0.0261,
            heat_capacity: 1007.0,
            vapour_diffusivity: 2.5e-5,
            pressure: 101_325.0,
            sound_speed,
            spreading: 1.0,
        }
    }

    /// Diffusivity of heat, m2/s.
    pub fn heat_diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }

    /// What matters for conduction.
    pub fn conductor(&self) -> Conductor {
        Conductor { conductivity: self.conductivity, capacity: self.density * self.heat_capacity }
    }
}
