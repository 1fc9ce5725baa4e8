//! Small drops that evaporate: as fast as the air round them carries their vapour off, whatever the spacing.

use super::ledger::dew_of;
use super::{advance, ledger_rounding, ready, rows};
use crate::device::{is_reduced, reduced};
use crate::{Case, Options, Row};
use corpuscle_dew::Dew;
use corpuscle_dew::air::transport;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_model::{Model, ModelError};
use statrs::function::erf::erfc;
use std::f64::consts::PI;

pub(super) const EVAPORATION: Case = Case {
    name: "dew/evaporation",
    about: "A plate with drops of 0.2 mm, 0.1 or 0.5 to a square millimetre, in still air of 30 %, all at 25 °C, at three spacings: the water that has gone after 1 s \
            beside diffusion into a half space through the resistance of the drops (Crank 1975, equation 3.37; Hu & Larson 2002; Cooper, Mikic & Yovanovich 1969). A wet \
            plate would lose 2.4 and 1.2 times as much.",
    slow: false,
    reduced: 2.0,
    run: evaporation,
};

const SPACINGS: [f64; 3] = [1e-3, 0.8e-3, 0.5e-3];

/// Relative humidity, temperature, °C, and how long, s.
const HUMIDITY: f64 = 0.3;
const CELSIUS: f64 = 25.0;
const WATCHED: f64 = 1.0;

/// Radius of the hemispheres, m, and how many, 1/m2.
const RADIUS: f64 = 2e-4;
const NUMBERS: [f64; 2] = [1e5, 5e5];

fn evaporation(_: &Options) -> Vec<Row> {
    rows(EVAPORATION.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = EVAPORATION.name;
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    for &number in reduced(&NUMBERS) {
        let per_mm2 = number / 1e6;
        let mut errors = [0.0; 3];
        for (error, &spacing) in errors.iter_mut().zip(reduced(&SPACINGS)) {
            let mut dew = ready(scene(number, spacing)?)?;
            let before = dew.water_on_body(0);
            advance(&mut dew, WATCHED)?;
            let gone = (before - dew.water_on_body(0)) / SIDE.powi(2);
            *error = (gone / exact(number, dew.stepped_until()) - 1.0).abs();
            balance =
                dew.ledger().balances.iter().map(|balance| balance.relative_error().abs()).fold(balance, f64::max);
            rows.push(Row::at_most(name, &format!("error_{per_mm2}_per_mm2_{}_mm", spacing * 1e3), *error, "", 0.03));
        }
        if is_reduced() {
            continue;
        }
        let order = (errors[0] / errors[2]).ln() / (SPACINGS[0] / SPACINGS[2]).ln();
        let why = "what is left is the noise of the areas of sites, of which there is less than one to a patch";
        rows.push(Row::beside(name, &format!("order_{per_mm2}_per_mm2"), order, "", 1.0, why));
    }
    rows.push(Row::at_most(name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

/// Side of the plate, m.
const SIDE: f64 = 0.004;

/// Air above a plate with so many drops, 1/m2.
fn scene(number: f64, spacing: f64) -> Result<Dew, ModelError> {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [{SIDE}, {SIDE}, 0.044]\nspacing_m = {spacing}\nbuoyancy = false\n\
         air = {{ temperature_c = {CELSIUS}, relative_humidity = {HUMIDITY} }}\ntransport.latent_heat = false\n\
         drops = {{ smallest_radius_m = 2e-3, sites_per_m2 = {number} }}\n\
         [dew.faces]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n\
         [[dew.solid]]\nname = \"plate\"\nshape = {{ box = {{ size_m = [0.02, 0.02, 0.008] }} }}\nposition_m = [0.002, 0.002, 0.0]\n\
         material = \"copper\"\ntemperature_c = {CELSIUS}\nheld = true\n"
    );
    let mut dew = dew_of(&text)?;
    dew.wet(0, 998.2 * 2.0 / 3.0 * PI * RADIUS.powi(3) * number);
    dew.transfer_water_to_drops();
    Ok(dew)
}

/// Water that has gone, kg/m2: from a surface through a resistance 1/h into a half space,
/// (C_s - C_0) / h (exp(h^2 D t) erfc(h sqrt(D t)) - 1 + 2 h sqrt(D t / pi)).
fn exact(number: f64, time: f64) -> f64 {
    let far = HumidAir::with_relative_humidity(ZERO_CELSIUS + CELSIUS, 101_325.0, HUMIDITY);
    let near = HumidAir { vapour_pressure: far.vapour_pressure / HUMIDITY, ..far };
    let diffusivity = transport::vapour_diffusivity(far.temperature, far.pressure);
    // What leaves a hemisphere: pi a D (0.27 angle^2 + 1.30).
    let of_drop = PI * (0.27 * (0.5 * PI).powi(2) + 1.30) * RADIUS;
    let covered = number * PI * RADIUS * RADIUS;
    let h = number * of_drop / (1.0 - covered.sqrt()).powf(1.5);
    let root = (diffusivity * time).sqrt();
    let part = ((h * root).powi(2)).exp() * erfc(h * root) - 1.0 + 2.0 * h * root / PI.sqrt();
    far.density() * (near.mass_fraction() - far.mass_fraction()) / h * part
}
