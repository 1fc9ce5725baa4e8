//! Humid air: how much water it holds, and at what temperature it gives it up.
//!
//! Temperatures are in K, pressures in Pa. Air and vapour are ideal gases. Saturation is over liquid water at all
//! temperatures: frost is out of scope, and [`is_frost`] gives where it would form.

pub use corpuscle_scene::dew::ZERO_CELSIUS;

/// Gas constant, J/(mol K): exact by the definition of the mole and the kelvin (SI, 2019).
const GAS_CONSTANT: f64 = 8.314_462_618_153_24;

/// Molar mass of water, kg/mol, and of dry air (ASHRAE Handbook Fundamentals, 2017, chapter 1).
const WATER_MOLAR_MASS: f64 = 18.015_268e-3;
const DRY_AIR_MOLAR_MASS: f64 = 28.966e-3;

/// Molar mass of water over that of dry air.
pub(crate) const MASS_RATIO: f64 = WATER_MOLAR_MASS / DRY_AIR_MOLAR_MASS;

/// Specific gas constant of vapour, J/(kg K).
pub const VAPOUR_GAS_CONSTANT: f64 = GAS_CONSTANT / WATER_MOLAR_MASS;

/// Specific gas constant of dry air, J/(kg K).
pub const DRY_AIR_GAS_CONSTANT: f64 = GAS_CONSTANT / DRY_AIR_MOLAR_MASS;

/// The constants of e_s = e_0 exp(b T / (c + T)), T in °C: Bolton, Monthly Weather Review 108 (1980) 1046, equation 10.
/// Within 0.1 % of tables from -30 to 35 °C.
const AT_ZERO: f64 = 611.2;
pub(crate) const B: f64 = 17.67;
pub(crate) const C: f64 = 243.5;

/// Pressure of saturated vapour over water, Pa, at a temperature above -243.5 °C.
pub fn saturation_pressure(temperature: f64) -> f64 {
    let celsius = temperature - ZERO_CELSIUS;
    AT_ZERO * (B * celsius / (C + celsius)).exp()
}

/// Slope of [`saturation_pressure`] over temperature, Pa/K.
pub fn saturation_slope(temperature: f64) -> f64 {
    let above = C + temperature - ZERO_CELSIUS;
    saturation_pressure(temperature) * B * C / (above * above)
}

/// Temperature at which vapour of this pressure (Pa, above 0) is saturated, K: the inverse of [`saturation_pressure`].
pub fn dew_point(vapour_pressure: f64) -> f64 {
    from_gamma((vapour_pressure / AT_ZERO).ln())
}

/// Dew point of air at a temperature and relative humidity in (0, 1], K (August, Roche, Magnus):
/// gamma = ln(RH) + b T / (c + T);  T_dp = c gamma / (b - gamma), T in °C.
pub fn dew_point_of(temperature: f64, relative_humidity: f64) -> f64 {
    let celsius = temperature - ZERO_CELSIUS;
    from_gamma(relative_humidity.ln() + B * celsius / (C + celsius))
}

fn from_gamma(gamma: f64) -> f64 {
    ZERO_CELSIUS + C * gamma / (B - gamma)
}

/// True where what condenses would freeze: below 0 °C.
pub fn is_frost(temperature: f64) -> bool {
    temperature < ZERO_CELSIUS
}

/// Heat that a kilogram of vapour gives off when it condenses at this temperature, J/kg: (2.501 - 0.00237 T) MJ/kg, T in
/// °C (Bolton 1980, equation 2; Stull, An Introduction to Boundary Layer Meteorology, 1988, page 641).
pub fn latent_heat(temperature: f64) -> f64 {
    2.501e6 - 2370.0 * (temperature - ZERO_CELSIUS)
}

/// Mass of saturated vapour in a cubic metre, kg/m³.
pub fn saturation_density(temperature: f64) -> f64 {
    saturation_pressure(temperature) / (VAPOUR_GAS_CONSTANT * temperature)
}

/// Air at a temperature and pressure with vapour in it. Humidity is set and read in any measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HumidAir {
    /// Temperature, K.
    pub temperature: f64,
    /// Pressure of air and vapour together, Pa.
    pub pressure: f64,
    /// Pressure of the vapour alone, Pa; above the saturation pressure where the air is supersaturated.
    pub vapour_pressure: f64,
}

impl HumidAir {
    /// Air of a relative humidity: vapour pressure over that of saturation at the air's own temperature.
    pub fn with_relative_humidity(temperature: f64, pressure: f64, relative_humidity: f64) -> Self {
        Self { temperature, pressure, vapour_pressure: relative_humidity * saturation_pressure(temperature) }
    }

    /// Air of a dew point, K.
    pub fn with_dew_point(temperature: f64, pressure: f64, dew_point: f64) -> Self {
        Self { temperature, pressure, vapour_pressure: saturation_pressure(dew_point) }
    }

    /// Air with this mass of vapour for a mass of dry air.
    pub fn with_mixing_ratio(temperature: f64, pressure: f64, mixing_ratio: f64) -> Self {
        Self { temperature, pressure, vapour_pressure: pressure * mixing_ratio / (MASS_RATIO + mixing_ratio) }
    }

    /// Air of which this part of the mass is vapour.
    pub fn with_mass_fraction(temperature: f64, pressure: f64, mass_fraction: f64) -> Self {
        let vapour_pressure = pressure * mass_fraction / (MASS_RATIO + (1.0 - MASS_RATIO) * mass_fraction);
        Self { temperature, pressure, vapour_pressure }
    }

    /// Air with this mass of vapour in a cubic metre, kg/m³.
    pub fn with_vapour_density(temperature: f64, pressure: f64, vapour_density: f64) -> Self {
        Self { temperature, pressure, vapour_pressure: vapour_density * VAPOUR_GAS_CONSTANT * temperature }
    }

    /// Vapour pressure over that of saturation at the air's own temperature.
    pub fn relative_humidity(&self) -> f64 {
        self.vapour_pressure / saturation_pressure(self.temperature)
    }

    /// Dew point, K.
    pub fn dew_point(&self) -> f64 {
        dew_point(self.vapour_pressure)
    }

    /// Mass of vapour for a mass of dry air.
    pub fn mixing_ratio(&self) -> f64 {
        MASS_RATIO * self.vapour_pressure / (self.pressure - self.vapour_pressure)
    }

    /// Part of the mass that is vapour.
    pub fn mass_fraction(&self) -> f64 {
        MASS_RATIO * self.vapour_pressure / (self.pressure - (1.0 - MASS_RATIO) * self.vapour_pressure)
    }

    /// How fast the mass fraction grows with the vapour pressure, 1/Pa.
    pub fn mass_fraction_slope(&self) -> f64 {
        let rest = self.pressure - (1.0 - MASS_RATIO) * self.vapour_pressure;
        MASS_RATIO * self.pressure / (rest * rest)
    }

    /// Mass of vapour in a cubic metre, kg/m³.
    pub fn vapour_density(&self) -> f64 {
        self.vapour_pressure / (VAPOUR_GAS_CONSTANT * self.temperature)
    }

    /// Mass of air and vapour in a cubic metre, kg/m³.
    pub fn density(&self) -> f64 {
        let dry = (self.pressure - self.vapour_pressure) / (DRY_AIR_GAS_CONSTANT * self.temperature);
        dry + self.vapour_density()
    }
}

/// How much lighter vapour makes air: the coefficient of its mass fraction in the virtual temperature (Stull 1988, equation 1.5.1).
pub(crate) const VAPOUR_LIGHTNESS: f64 = 0.608;

/// T (1 + 0.608 Y), K: temperature at which dry air is as light.
pub(crate) fn virtual_temperature(temperature: f64, vapour: f64) -> f64 {
    temperature * (1.0 + VAPOUR_LIGHTNESS * vapour)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PRESSURE: f64 = 101_325.0;

    #[test]
    fn air_at_25_degrees_and_half_saturated_is_as_psychrolib_has_it() {
        // PsychroLib 2.5.0: GetSatVapPres(25), GetHumRatioFromRelHum(25, 0.5, 101325), GetMoistAirDensity(25, that, 101325).
        let air = HumidAir::with_relative_humidity(25.0 + ZERO_CELSIUS, PRESSURE, 0.5);
        assert!((saturation_pressure(air.temperature) / 3_169.216_470_143_628 - 1.0).abs() < 1e-3);
        assert!((air.mixing_ratio() / 9.881_043_690_749_623e-3 - 1.0).abs() < 1e-3);
        assert!((air.density() / 1.176_958_186_416_38 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn air_half_saturated_at_25_degrees_would_be_at_182_percent_at_5() {
        let warm = HumidAir::with_relative_humidity(25.0 + ZERO_CELSIUS, PRESSURE, 0.5);
        let cold = HumidAir { temperature: 5.0 + ZERO_CELSIUS, ..warm };
        assert!((cold.relative_humidity() - 1.82).abs() < 0.005, "{}", cold.relative_humidity());
    }

    #[test]
    fn frost_is_below_zero_celsius() {
        assert!(is_frost(273.0) && !is_frost(ZERO_CELSIUS) && !is_frost(280.0));
    }

    #[test]
    fn clausius_and_clapeyron_hold_within_a_percent() {
        // de/dT = L e / (R_v T^2), which the fitted formula does not satisfy exactly.
        for celsius in [0.0, 10.0, 20.0, 30.0] {
            let temperature = celsius + ZERO_CELSIUS;
            let law = latent_heat(temperature) * saturation_pressure(temperature)
                / (VAPOUR_GAS_CONSTANT * temperature * temperature);
            assert!((saturation_slope(temperature) / law - 1.0).abs() < 0.01, "{celsius}");
        }
    }

    proptest! {
        #[test]
        fn every_measure_of_humidity_gives_back_the_same_air(
            temperature in 250.0..320.0, pressure in 5e4..1.2e5, humidity in 0.001..1.0,
        ) {
            let air = HumidAir::with_relative_humidity(temperature, pressure, humidity);
            let again = [
                HumidAir::with_dew_point(temperature, pressure, air.dew_point()),
                HumidAir::with_dew_point(temperature, pressure, dew_point_of(temperature, humidity)),
                HumidAir::with_mixing_ratio(temperature, pressure, air.mixing_ratio()),
                HumidAir::with_mass_fraction(temperature, pressure, air.mass_fraction()),
                HumidAir::with_vapour_density(temperature, pressure, air.vapour_density()),
            ];
            for same in again {
                prop_assert!((same.relative_humidity() / humidity - 1.0).abs() < 1e-10);
            }
            prop_assert!((air.vapour_density() / air.density() / air.mass_fraction() - 1.0).abs() < 1e-12);
        }

        #[test]
        fn the_slope_of_the_mass_fraction_is_its_derivative(vapour_pressure in 10.0..5e3) {
            let air = HumidAir { temperature: 300.0, pressure: PRESSURE, vapour_pressure };
            let beside = HumidAir { vapour_pressure: vapour_pressure + 0.01, ..air };
            let difference = (beside.mass_fraction() - air.mass_fraction()) / 0.01;
            prop_assert!((difference / air.mass_fraction_slope() - 1.0).abs() < 1e-5);
        }

        #[test]
        fn the_slope_is_the_derivative(temperature in 250.0..320.0) {
            let step = 1e-3;
            let difference = saturation_pressure(temperature + step) - saturation_pressure(temperature - step);
            prop_assert!((difference / (2.0 * step) / saturation_slope(temperature) - 1.0).abs() < 1e-7);
        }
    }
}
