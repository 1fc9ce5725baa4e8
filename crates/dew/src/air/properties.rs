//! What air is like.

use super::{Particle, Scale, transport};
use crate::humid_air::{HumidAir, ZERO_CELSIUS};
use crate::settings::Conductor;
use serde::{Deserialize, Serialize};

/// The speed of sound over the fastest motion: the density then stays within a percent (Monaghan 1994).
pub(crate) const SOUND_OVER_MOTION: f64 = 10.0;

/// Least speed of sound, m/s: air at rest stays evenly spread.
pub(crate) const LEAST_SOUND: f64 = 0.1;

/// Properties of the air: its density and heat capacity are the same everywhere (Boussinesq); how it conducts may grow with its temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Density, kg/m3.
    pub density: f64,
    /// Kinematic viscosity, m2/s, at the reference temperature.
    pub viscosity: f64,
    /// Conductivity of heat, W/(m K), at the reference temperature.
    pub conductivity: f64,
    /// Heat capacity at constant pressure, J/(kg K).
    pub heat_capacity: f64,
    /// Diffusivity of vapour, m2/s, at the reference temperature.
    pub vapour_diffusivity: f64,
    /// Temperature at which these hold, K.
    pub reference_temperature: f64,
    /// How they change from there.
    pub coefficients: TemperatureCoefficients,
    /// Pressure, Pa.
    pub pressure: f64,
    /// Artificial speed of sound, m/s: about ten times the fastest motion keeps the density within a percent (Monaghan 1994).
    pub sound_speed: f64,
    /// Pressure by which particles spread evenly, over density times the square of the speed of sound (Adami, Hu & Adams
    /// 2013, who take 1). It moves particles, not the air: without it they would clump where the pressure is below that
    /// at rest, and with a background in the equation of state instead, its noise would brake the air.
    pub spreading: f64,
}

/// Temperature coefficients of properties, 1/K. A straight line is within half a percent of the laws of [`transport`] up to 40 K off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct TemperatureCoefficients {
    /// Of the viscosity.
    pub viscosity: f64,
    /// Of the conductivity of heat.
    pub conductivity: f64,
    /// Of density times diffusivity of vapour, over the density.
    pub vapour_diffusivity: f64,
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
            reference_temperature: ZERO_CELSIUS + 25.0,
            coefficients: TemperatureCoefficients::default(),
            pressure: 101_325.0,
            sound_speed,
            spreading: 1.0,
        }
    }

    /// Humid air, whose viscosity, conductivity and diffusivity grow with its temperature.
    pub fn of(air: &HumidAir, sound_speed: f64) -> Self {
        let HumidAir { temperature, pressure, .. } = *air;
        // What diffuses is density times diffusivity; the model's density does not change with temperature, that of air goes as 1/T.
        let diffuses = |kelvin: f64| transport::vapour_diffusivity(kelvin, pressure) * temperature / kelvin;
        Self {
            density: air.density(),
            viscosity: transport::viscosity(temperature) / air.density(),
            conductivity: transport::conductivity(temperature),
            heat_capacity: transport::heat_capacity(air.mass_fraction()),
            vapour_diffusivity: diffuses(temperature),
            reference_temperature: temperature,
            coefficients: TemperatureCoefficients {
                viscosity: transport::temperature_coefficient(transport::viscosity, temperature),
                conductivity: transport::temperature_coefficient(transport::conductivity, temperature),
                vapour_diffusivity: transport::temperature_coefficient(diffuses, temperature),
            },
            pressure,
            sound_speed,
            spreading: 1.0,
        }
    }

    /// Mass of a particle, kg.
    pub(crate) fn particle_mass(&self, scale: &Scale) -> f64 {
        self.density * scale.volume
    }

    /// Energy of a particle over its mass, J/kg: its heat above 0 °C, and the heat, `latent_heat` J/kg, that its vapour gives off when it condenses.
    pub(crate) fn energy_of(&self, particle: &Particle, latent_heat: f64) -> f64 {
        let heat = self.heat_capacity * (particle.temperature - ZERO_CELSIUS);
        heat + latent_heat * particle.vapour
    }

    /// Diffusivity of heat, m2/s.
    pub fn heat_diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }

    /// Conductivity of heat at a temperature, W/(m K).
    pub fn conductivity_at(&self, temperature: f64) -> f64 {
        self.conductivity * self.factor(self.coefficients.conductivity, temperature)
    }

    /// Diffusivity of vapour at a temperature, m2/s.
    pub fn vapour_diffusivity_at(&self, temperature: f64) -> f64 {
        self.vapour_diffusivity * self.factor(self.coefficients.vapour_diffusivity, temperature)
    }

    /// Kinematic viscosity at a temperature, m2/s.
    pub fn viscosity_at(&self, temperature: f64) -> f64 {
        self.viscosity * self.factor(self.coefficients.viscosity, temperature)
    }

    /// The largest of viscosity and diffusivities at a temperature, m2/s.
    pub fn largest_diffusivity_at(&self, temperature: f64) -> f64 {
        let heat = self.heat_diffusivity() * self.factor(self.coefficients.conductivity, temperature);
        self.viscosity_at(temperature).max(self.vapour_diffusivity_at(temperature)).max(heat)
    }

    /// Kirchhoff's transform of a temperature, K: the integral of the conductivity from the reference temperature, over the conductivity there. Heat goes
    /// by its differences (Carslaw & Jaeger 1959, section 1.6).
    pub fn transformed(&self, temperature: f64) -> f64 {
        let above = temperature - self.reference_temperature;
        above * (1.0 + 0.5 * self.coefficients.conductivity * above)
    }

    fn factor(&self, coefficient: f64, temperature: f64) -> f64 {
        1.0 + coefficient * (temperature - self.reference_temperature)
    }

    /// What matters for conduction at a temperature, K.
    pub fn conductor_at(&self, temperature: f64) -> Conductor {
        Conductor { conductivity: self.conductivity_at(temperature), ..self.conductor() }
    }

    /// What matters for conduction at the reference temperature.
    pub fn conductor(&self) -> Conductor {
        Conductor { conductivity: self.conductivity, capacity: self.density * self.heat_capacity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn straight_lines_are_near_the_laws(celsius in 0.0..40.0, off in -40.0..40.0, humidity in 0.0..1.0, pressure in 6e4..1.1e5) {
            let air = HumidAir::with_relative_humidity(ZERO_CELSIUS + celsius, pressure, humidity);
            let there = air.temperature + off;
            let properties = Properties::of(&air, 1.0);
            let diffuses = transport::vapour_diffusivity(there, pressure) * air.temperature / there;
            let errors = [
                properties.conductivity_at(there) / transport::conductivity(there),
                properties.viscosity_at(there) * air.density() / transport::viscosity(there),
                properties.vapour_diffusivity_at(there) / diffuses,
            ];
            for error in errors {
                prop_assert!((error - 1.0).abs() < 0.005, "{error}");
            }
        }

        #[test]
        fn differences_of_the_transform_are_those_of_the_mean_conductivity(a in 250.0..330.0, b in 250.0..330.0) {
            let properties = Properties::of(&HumidAir::with_relative_humidity(293.0, 101_325.0, 0.5), 1.0);
            let by_mean = properties.conductivity_at(0.5 * (a + b)) * (a - b);
            let by_transform = properties.conductivity * (properties.transformed(a) - properties.transformed(b));
            prop_assert!((by_mean - by_transform).abs() < 1e-12);
        }
    }
}
