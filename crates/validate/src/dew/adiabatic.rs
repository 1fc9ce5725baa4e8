//! Moist air and a cold plate in a box that lets no heat out: the latent heat warms both.

use super::packings::ALL;
use super::{advance, ledger_rounding, ready, rows, slab_across};
use crate::device::reduced;
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS, latent_heat};
use corpuscle_dew::solids::Material;
use corpuscle_dew::{Dew, Face, Room, Settings, Setup};
use corpuscle_model::{Model, ModelError};

pub(super) const ADIABATIC: Case = Case {
    name: "dew/adiabatic",
    about: "Air at 25 °C and 90 % with a plate at 10 °C that is free to warm, in a box that lets nothing out, at three spacings, settled, \
            stirred and at random: the temperature to which the latent heat brings both above that of their mixing, from the balance of \
            energy and the saturation pressure. Water and energy balance.",
    slow: false,
    reduced: 2.0,
    run: adiabatic,
};

/// Thickness of the air and of the plate, m, layers of the air, and particles across the box.
const AIR: f64 = 0.012;
const PLATE: f64 = 0.003;
const LAYERS: [usize; 3] = [6, 9, 12];
const ACROSS: usize = 4;

/// As light as insulation, so that the air's heat counts.
const LIGHT: Material = Material { conductivity: 0.1, heat_capacity: 800.0, density: 4.0 };

const PRESSURE: f64 = 101_325.0;

fn adiabatic(_: &Options) -> Vec<Row> {
    rows(ADIABATIC.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    for (number, (name, _)) in reduced(&ALL).iter().enumerate() {
        for &layers in reduced(&LAYERS) {
            let [error, unbalanced] = run(number, layers)?;
            balance = balance.max(unbalanced);
            let measure = format!("relative_error_of_rise_{name}_{layers}");
            rows.push(Row::at_most(ADIABATIC.name, &measure, error.abs(), "", 1e-3));
        }
    }
    rows.push(Row::at_most(ADIABATIC.name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

/// Relative error of the rise of the temperature by latent heat, and the larger of those of water and energy.
fn run(packing: usize, layers: usize) -> Result<[f64; 2], ModelError> {
    let spacing = AIR / layers as f64;
    let thick = (PLATE / spacing).round() as usize;
    let [cold, warm] = [10.0, 25.0].map(|celsius| ZERO_CELSIUS + celsius);
    let vapour = HumidAir::with_relative_humidity(warm, PRESSURE, 0.9).mass_fraction();
    let air = Properties::at_room_temperature(0.05);
    let width = ACROSS as f64 * spacing;
    let room = Room {
        low: [0.0; 3],
        high: [(layers + thick) as f64 * spacing, width, width],
        faces: [[Face::Wall; 2], [Face::Periodic; 2], [Face::Periodic; 2]],
    };
    let bodies = vec![slab_across(ACROSS, 0, thick, spacing, LIGHT, cold, false)];
    let settings = Settings { gravity: [0.0; 3], fog: false, ..Settings::new(spacing, warm, vapour) };
    let start = |_: [f64; 3]| [warm, vapour];
    let mut dew = Dew::new(&Setup { settings, air, room, bodies, fans: Vec::new(), seed: 1 }, start)?;
    // Stirred air has given the plate heat and water before it is arranged: what all have together counts.
    ALL[packing].1.arrange(&mut dew, width, start)?;
    let together = Together::of(&dew, &air, latent_heat(warm));
    let mut dew = ready(dew)?;
    // The time in which heat goes through the air, many times over.
    let until = dew.time() + 4.0 * AIR * AIR / air.heat_diffusivity();
    advance(&mut dew, until)?;
    let mean = Together::of(&dew, &air, latent_heat(warm)).temperature();
    let (mixed, risen) = (together.temperature(), together.risen());
    let balance = dew.ledger().balances.iter().map(|balance| balance.relative_error().abs()).fold(0.0, f64::max);
    Ok([(mean - risen) / (risen - mixed), balance])
}

/// Heat capacities of air and plate, J/K, their heat from absolute zero, J, mass of the air, kg, its vapour, kg, and the latent heat, J/kg.
struct Together {
    capacity: f64,
    heat: f64,
    mass: f64,
    vapour: f64,
    latent_heat: f64,
}

impl Together {
    fn of(dew: &Dew, air: &Properties, latent_heat: f64) -> Self {
        let mass = dew.particle_mass();
        let particles = dew.air();
        let solid = dew.solids();
        let of_air = particles.len() as f64 * mass * air.heat_capacity;
        let of_solid: f64 = (0..solid.particles.len()).map(|i| solid.heat_capacity(i)).sum();
        let in_air: f64 = particles.iter().map(|particle| mass * air.heat_capacity * particle.temperature).sum();
        let in_solid: f64 = dew.temperatures().iter().enumerate().map(|(i, t)| solid.heat_capacity(i) * t).sum();
        Self {
            capacity: of_air + of_solid,
            heat: in_air + in_solid,
            mass: particles.len() as f64 * mass,
            vapour: particles.iter().map(|particle| mass * particle.vapour).sum(),
            latent_heat,
        }
    }

    /// That of both when they are mixed and nothing condenses, K.
    fn temperature(&self) -> f64 {
        self.heat / self.capacity
    }

    /// That at which the air is saturated and the heat of what has condensed is in both, K, by halving.
    fn risen(&self) -> f64 {
        let saturated = |kelvin| self.mass * HumidAir::with_relative_humidity(kelvin, PRESSURE, 1.0).mass_fraction();
        let missing = |kelvin: f64| {
            self.temperature() + self.latent_heat * (self.vapour - saturated(kelvin)) / self.capacity - kelvin
        };
        let (mut low, mut high) = (self.temperature(), self.temperature() + 50.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if missing(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}
