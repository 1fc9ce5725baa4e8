//! How heat, momentum and vapour go through humid air, by its temperature and pressure.
//!
//! Vapour is a percent or two of the mass of air at room temperature; what it changes of viscosity and conductivity is below half a percent there
//! (Tsilingiris, Energy Conversion and Management 49, 2008, 1098) and left out.

use crate::humid_air::ZERO_CELSIUS;

/// Viscosity of air, Pa s (U.S. Standard Atmosphere, 1976, equation 51, after Sutherland 1893).
pub fn viscosity(temperature: f64) -> f64 {
    1.458e-6 * temperature.powf(1.5) / (temperature + 110.4)
}

/// Conductivity of heat of air, W/(m K) (U.S. Standard Atmosphere, 1976, equation 53).
pub fn conductivity(temperature: f64) -> f64 {
    2.646_38e-3 * temperature.powf(1.5) / (temperature + 245.4 * 10_f64.powf(-12.0 / temperature))
}

/// Diffusivity of vapour in air, m2/s, at a pressure, Pa (Massman, Atmospheric Environment 32, 1998, 1111).
pub fn vapour_diffusivity(temperature: f64, pressure: f64) -> f64 {
    2.178e-5 * (temperature / ZERO_CELSIUS).powf(1.81) * 101_325.0 / pressure
}

/// Heat capacity at constant pressure of air with this part of its mass of vapour, J/(kg K): that of its parts (ASHRAE Handbook Fundamentals,
/// 2017, chapter 1).
pub fn heat_capacity(vapour: f64) -> f64 {
    1006.0 * (1.0 - vapour) + 1860.0 * vapour
}

/// Temperature coefficient of a property, 1/K: (df/dT)/f.
pub fn temperature_coefficient(property: impl Fn(f64) -> f64, temperature: f64) -> f64 {
    let step = 0.1;
    (property(temperature + step) - property(temperature - step)) / (2.0 * step * property(temperature))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_is_as_in_tables() {
        // Incropera & DeWitt (2007), table A.4, at 250, 300 and 350 K: within a percent.
        let table = [(250.0, 159.6e-7, 22.3e-3), (300.0, 184.6e-7, 26.3e-3), (350.0, 208.2e-7, 30.0e-3)];
        for (temperature, viscous, conducts) in table {
            assert!((viscosity(temperature) / viscous - 1.0).abs() < 0.01, "{}", viscosity(temperature));
            assert!((conductivity(temperature) / conducts - 1.0).abs() < 0.01, "{}", conductivity(temperature));
        }
        // Table A.8 there has two digits.
        assert!((vapour_diffusivity(298.0, 101_325.0) / 0.26e-4 - 1.0).abs() < 0.03);
    }

    #[test]
    fn vapour_diffuses_faster_in_thin_air() {
        assert!((vapour_diffusivity(290.0, 50_000.0) / vapour_diffusivity(290.0, 100_000.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_coefficient_of_a_power_is_its_exponent_over_the_temperature() {
        assert!((temperature_coefficient(|t| t.powf(1.81), 300.0) - 1.81 / 300.0).abs() < 1e-8);
    }
}
