//! Balances of water and energy of a run with all processes.

use super::{advance, ledger_rounding, ready, rows};
use crate::{Case, Options, Row};
use corpuscle_dew::{Dew, open};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Scene;
use std::path::Path;

pub(super) const LEDGER: Case = Case {
    name: "dew/ledger",
    about: "Humid air flows over a pane that is cold and then warmed: inflow, condensation, merging and dripping, evaporation, air of low \
            utility taken out. Water and energy balance, and each of these happened.",
    slow: false,
    reduced: 1.0,
    run: ledger,
};

/// Flow past a pane, of which the air far downstream no longer matters; the pane is cold until half of the run.
pub(super) const SCENE: &str = r#"
run.until_s = 0.6
[dew]
size_m = [0.012, 0.012, 0.080]
spacing_m = 0.002
time_factor = 40
buoyancy = false
air = { temperature_c = 25, relative_humidity = 0.8, velocity_m_per_s = [0, 0, -0.07] }
drops = { smallest_radius_m = 1.5e-5, sites_per_m2 = 2e7, friction = 2e-6, viscosity_pa_s = 2e-5 }
[dew.faces]
y_min = "periodic"
y_max = "periodic"
z_max = { inflow = { velocity_m_per_s = [0, 0, -0.07] } }
z_min = "outflow"
[[dew.solid]]
name = "pane"
shape = { box = { size_m = [0.004, 0.012, 0.012] } }
position_m = [0.002, 0.006, 0.060]
temperature_c = 5
held = true
"#;

/// Air of low utility beyond four smoothing lengths. With two, single particles are shot into the holes that removed air leaves: one of twelve runs whose inflow
/// differs by 10^-6 m/s breaks down.
pub(super) const LOW_UTILITY: &str = "low_utility = { distance = 4.0, after_s = 0.02 }\n[dew.faces]";

/// The model of a scene.
pub(super) fn dew_of(text: &str) -> Result<Dew, ModelError> {
    dew_by_chance(text, 1)
}

/// The same with another seed of everything random.
pub(super) fn dew_by_chance(text: &str, seed: u64) -> Result<Dew, ModelError> {
    let scene = Scene::parse(text, "case", &[]).map_err(|error| ModelError::Setup(error.to_string()))?;
    ready(open(scene.dew().ok_or_else(|| ModelError::Setup("no scene of dew".into()))?, seed, Path::new(""))?)
}

/// A gauge by its header.
pub(super) fn gauge(dew: &Dew, header: &str) -> f64 {
    let at = dew.gauge_columns().iter().position(|column| column.header() == header);
    at.map_or(f64::NAN, |at| dew.gauge_row()[at])
}

fn ledger(_: &Options) -> Vec<Row> {
    rows(LEDGER.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let warmed = SCENE.replace("temperature_c = 5\n", "temperature_c = [[0, 5], [0.3, 5], [0.35, 60]]\n");
    let mut dew = dew_of(&warmed.replace("[dew.faces]", LOW_UTILITY))?;
    advance(&mut dew, 0.3)?;
    let (wettest, filled) = (gauge(&dew, "water.on_solids_kg"), gauge(&dew, "air.particles"));
    let dripped = gauge(&dew, "drops.left_kg");
    advance(&mut dew, 0.6)?;
    let evaporated = wettest - gauge(&dew, "water.on_solids_kg") - (gauge(&dew, "drops.left_kg") - dripped);
    let whole = dew_of(SCENE)?;
    let errors = dew.ledger().balances.into_iter().map(|balance| {
        let measure = if balance.quantity == "water_kg" { "water_error" } else { "energy_error" };
        Row::at_most(LEDGER.name, measure, balance.relative_error().abs(), "", ledger_rounding())
    });
    let happened = [
        ("condensed_kg", wettest, "kg"),
        ("drops_merged", gauge(&dew, "drops.merged"), ""),
        ("dripped_kg", dripped, "kg"),
        ("evaporated_kg", evaporated, "kg"),
        ("air_taken_out", gauge(&whole, "air.particles") - filled, ""),
    ];
    let happened =
        happened.map(|(measure, amount, unit)| Row::at_least(LEDGER.name, measure, amount, unit, f64::MIN_POSITIVE));
    Ok(errors.chain(happened).collect())
}
