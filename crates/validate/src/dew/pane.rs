//! A bare pane: above the dew point it stays dry, below it the first drop comes when diffusion brings it.

use super::ledger::{dew_of, gauge};
use super::{advance, rows};
use crate::{Case, Options, Row};
use corpuscle_dew::Dew;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_model::{Model, ModelError};
use std::f64::consts::PI;

pub(super) const PANE: Case = Case {
    name: "dew/pane",
    about: "A pane in still air at 25 °C and 60 % (dew point 16.7 °C): at 17.5 °C it stays dry, at 5 °C the first drop comes within \
            twice the time in which diffusion brings its water, 2 rho (Y - Y_sat) sqrt(D t / pi) a square metre (Crank 1975, equation 2.14, \
            a half space whose surface is at Y_sat).",
    slow: false,
    reduced: 1.0,
    run: pane,
};

/// °C, and relative humidity.
const AIR: f64 = 25.0;
const HUMIDITY: f64 = 0.6;

/// Distance of particles, m; the radius of the smallest drop, m, and its contact angle is 90 degrees.
const SPACING: f64 = 1e-3;
const SMALLEST: f64 = 3e-5;

/// How long a pane above the dew point is watched, over the time in which one at 5 °C gets its first drop.
const WATCHED: f64 = 20.0;

fn pane(_: &Options) -> Vec<Row> {
    rows(PANE.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let estimate = estimate(5.0);
    let mut cold = scene(5.0)?;
    let first = first_drop(&mut cold, 4.0 * estimate)?;
    let mut mild = scene(17.5)?;
    advance(&mut mild, WATCHED * estimate)?;
    let water = gauge(&mild, "water.on_solids_kg");
    let drops = gauge(&mild, "drops.number");
    Ok(vec![
        Row::at_most(PANE.name, "water_above_dew_point", water, "kg", 0.0),
        Row::at_most(PANE.name, "drops_above_dew_point", drops, "", 0.0),
        Row::at_most(PANE.name, "first_drop_over_estimate", first / estimate, "", 2.0),
        // A drop before there is water for it would be as wrong.
        Row::at_least(PANE.name, "first_drop_not_before", first / estimate, "", 0.25),
    ])
}

/// A pane at this temperature, °C, at the lower end of a column of air.
fn scene(celsius: f64) -> Result<Dew, ModelError> {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.004, 0.004, 0.024]\nspacing_m = {SPACING}\nbuoyancy = false\n\
         air = {{ temperature_c = {AIR}, relative_humidity = {HUMIDITY} }}\ndrops = {{ smallest_radius_m = {SMALLEST} }}\n\
         [dew.faces]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n\
         [[dew.solid]]\nname = \"pane\"\nshape = {{ box = {{ size_m = [0.004, 0.004, 0.004] }} }}\nposition_m = [0.002, 0.002, 0.002]\n\
         material = \"copper\"\ntemperature_c = {celsius}\nheld = true\n"
    );
    dew_of(&text)
}

/// When the first drop was seen, s; not a number where none was until then.
fn first_drop(dew: &mut Dew, until: f64) -> Result<f64, ModelError> {
    while dew.time() < until && gauge(dew, "drops.number") == 0.0 {
        let time = dew.time() + 0.01 * until;
        advance(dew, time)?;
    }
    Ok(gauge(dew, "drops.first_at_s"))
}

/// The time in which diffusion to a surface at this temperature, °C, brings the water of the smallest drop on each particle's part of it, s.
fn estimate(celsius: f64) -> f64 {
    let far = HumidAir::with_relative_humidity(ZERO_CELSIUS + AIR, 101_325.0, HUMIDITY);
    let near = HumidAir::with_relative_humidity(ZERO_CELSIUS + celsius, 101_325.0, 1.0);
    let (density, diffusivity) = (far.density(), 2.5e-5);
    let drop = 998.2 * 2.0 / 3.0 * PI * SMALLEST.powi(3);
    let needed = drop / SPACING.powi(2);
    PI / diffusivity * (needed / (2.0 * density * (far.mass_fraction() - near.mass_fraction()))).powi(2)
}
