//! A bare pane: above the dew point it stays dry, below it the first drop comes when diffusion brings it, whatever the spacing.

use super::ledger::{dew_of, gauge};
use super::{advance, rows};
use crate::{Case, Options, Row};
use corpuscle_dew::Dew;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_model::ModelError;
use std::f64::consts::PI;

pub(super) const PANE: Case = Case {
    name: "dew/pane",
    about: "A pane in still air at 25 °C and 60 % (dew point 16.7 °C): at 17.5 °C it stays dry. At 5 °C the first drop and the water come at \
            three spacings within 5 % of each other, and the drop when diffusion, 2 rho (Y - Y_sat) sqrt(D t / pi) a square metre (Crank 1975, \
            equation 2.14, a half space whose surface is at Y_sat), has brought its water to the largest of the areas of random sites.",
    slow: false,
    reduced: 1.0,
    run: pane,
};

/// °C, and relative humidity.
const AIR: f64 = 25.0;
const HUMIDITY: f64 = 0.6;

/// Distances of particles, m.
const SPACINGS: [f64; 3] = [1e-3, 0.8e-3, 0.5e-3];

/// Radius of the smallest drop, m, whose contact angle is 90 degrees, and density of nucleation sites, 1/m2: some 160 on the pane.
const SMALLEST: f64 = 2e-5;
const SITES: f64 = 1e7;

/// How long a pane is watched, s.
const WATCHED: f64 = 4.0;

fn pane(_: &Options) -> Vec<Row> {
    rows(PANE.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = PANE.name;
    let mut mild = scene(17.5, SPACINGS[0])?;
    advance(&mut mild, WATCHED)?;
    let mut rows = vec![
        Row::at_most(name, "water_above_dew_point", gauge(&mild, "water.on_solids_kg"), "kg", 0.0),
        Row::at_most(name, "drops_above_dew_point", gauge(&mild, "drops.number"), "", 0.0),
    ];
    let (mut firsts, mut waters) = (Vec::new(), Vec::new());
    for spacing in SPACINGS {
        let mut cold = scene(5.0, spacing)?;
        advance(&mut cold, WATCHED)?;
        firsts.push(gauge(&cold, "drops.first_at_s"));
        waters.push(gauge(&cold, "pane.water_per_area_kg_per_m2"));
    }
    let even = estimate(5.0);
    rows.extend([
        Row::at_most(name, "spread_of_first_drop", spread(&firsts), "", 0.05),
        Row::at_most(name, "spread_of_water", spread(&waters), "", 0.05),
        // The areas of random sites are spread as gamma(3.575) (Ferenc & Neda 2007): the largest of 160 is 2 to 4.5 times the mean.
        Row::at_most(name, "first_drop_over_that_of_mean_area", firsts[2] / even, "", 0.25),
        Row::at_least(name, "first_drop_not_before", firsts[2] / even, "", 0.05),
    ]);
    Ok(rows)
}

/// The largest over the smallest, less 1; not a number where one is none.
fn spread(values: &[f64]) -> f64 {
    let [least, most] =
        values.iter().fold([f64::INFINITY, 0.0], |[a, b], &x| [if x < a { x } else { a }, if x > b { x } else { b }]);
    if values.iter().any(|x| x.is_nan()) { f64::NAN } else { most / least - 1.0 }
}

/// A pane at this temperature, °C, at the lower end of a column of air.
fn scene(celsius: f64, spacing: f64) -> Result<Dew, ModelError> {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.004, 0.004, 0.024]\nspacing_m = {spacing}\nbuoyancy = false\n\
         air = {{ temperature_c = {AIR}, relative_humidity = {HUMIDITY} }}\n\
         drops = {{ smallest_radius_m = {SMALLEST}, sites_per_m2 = {SITES} }}\n\
         [dew.faces]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n\
         [[dew.solid]]\nname = \"pane\"\nshape = {{ box = {{ size_m = [0.004, 0.004, 0.004] }} }}\nposition_m = [0.002, 0.002, 0.002]\n\
         material = \"copper\"\ntemperature_c = {celsius}\nheld = true\n"
    );
    dew_of(&text)
}

/// The time in which diffusion to a surface at this temperature, °C, brings the water of the smallest drop to each mean area of a site, s.
fn estimate(celsius: f64) -> f64 {
    let far = HumidAir::with_relative_humidity(ZERO_CELSIUS + AIR, 101_325.0, HUMIDITY);
    let near = HumidAir::with_relative_humidity(ZERO_CELSIUS + celsius, 101_325.0, 1.0);
    let (density, diffusivity) = (far.density(), 2.5e-5);
    let drop = 998.2 * 2.0 / 3.0 * PI * SMALLEST.powi(3);
    PI / diffusivity * (drop * SITES / (2.0 * density * (far.mass_fraction() - near.mass_fraction()))).powi(2)
}
