//! Vapour from a warm wet plate condenses on a cold one.

use super::{ACROSS, advance, column, ledger_rounding, ready, rows, slab};
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::Material;
use corpuscle_dew::{Dew, Settings, Setup};
use corpuscle_model::{Model, ModelError};

pub(super) const FILM: Case = Case {
    name: "dew/film",
    about: "Air between a wet plate at 25 °C and a cold one at 10 °C, without fog: water condenses at the exact steady rate \
            J = rho D (Y_warm - Y_cold) / L, rho D constant and without Stefan's flow, and water is conserved.",
    slow: false,
    reduced: 1.0,
    run: film,
};

const SPACING: f64 = 1e-3;
const LAYERS: usize = 25;
const PLATE: usize = 2;

/// Conducts so well that it is at one temperature up to its surface.
const PERFECT: Material = Material { conductivity: 1e9, heat_capacity: 1000.0, density: 1000.0 };

fn film(_: &Options) -> Vec<Row> {
    rows(FILM.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let (cold, warm) = (ZERO_CELSIUS + 10.0, ZERO_CELSIUS + 25.0);
    let air = Properties::at_room_temperature(0.05);
    let saturated = |temperature| HumidAir::with_relative_humidity(temperature, air.pressure, 1.0).mass_fraction();
    let settings = Settings { gravity: [0.0; 3], fog: false, ..Settings::new(SPACING, warm, 0.0) };
    let bodies =
        vec![slab(0, PLATE, SPACING, PERFECT, cold, true), slab(PLATE + LAYERS, PLATE, SPACING, PERFECT, warm, true)];
    let room = column((2 * PLATE + LAYERS) as f64 * SPACING, SPACING);
    let start = 0.5 * (saturated(cold) + saturated(warm));
    let mut dew = Dew::new(&Setup { settings, air, room, bodies, fans: Vec::new(), seed: 1 }, |_| [warm, start])?;
    dew.wet(1, 1.0);
    let mut dew = ready(dew)?;
    let length = LAYERS as f64 * SPACING;
    let slowest = length * length / (std::f64::consts::PI.powi(2) * air.vapour_diffusivity);
    advance(&mut dew, 8.0 * slowest)?;
    let (begin, before) = (dew.stepped_until(), dew.water_on_body(0));
    advance(&mut dew, 9.0 * slowest)?;
    let area = (ACROSS as f64 * SPACING).powi(2);
    let rate = (dew.water_on_body(0) - before) / ((dew.stepped_until() - begin) * area);
    let exact = air.density * air.vapour_diffusivity * (saturated(warm) - saturated(cold)) / length;
    let water = dew.ledger().balances[0].relative_error().abs();
    let row = |measure, value, bound| Row::at_most(FILM.name, measure, value, "", bound);
    Ok(vec![
        row("relative_error_of_rate", (rate / exact - 1.0).abs(), 0.005),
        row("water_error", water, ledger_rounding()),
    ])
}
