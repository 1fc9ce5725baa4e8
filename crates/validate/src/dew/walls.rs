//! Heat through the layers of a wall behind a solid, beside exact answers.

use super::heat_sources::{START, STEFAN_BOLTZMANN, axis_of, slab_in_side, written};
use super::ledger::gauge;
use super::{advance, ledger_error, ledger_rounding, rows};
use crate::device::{is_reduced, reduced};
use crate::{Case, Options, Row};
use corpuscle_dew::Dew;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_model::ModelError;
use num_complex::Complex64;
use std::f64::consts::TAU;

pub(super) const WALLS: Case = Case {
    name: "dew/walls",
    about: "A wall of a slab of 3 mm, a gap, a sheet of metal of 0.5 mm and 2 mm of foam, while the temperature outside swings with a period of 16 s, in two sides of the \
            box: the swing in the slab beside the transfer matrices of the layers (Carslaw & Jaeger 1959, section 3.7; ISO 13786), at three spacings; with \
            time_factor 10 in a tenth of the time. A heated slab behind a second pane, a gap between them, that radiates to the sky: beside its heat balance.",
    slow: false,
    reduced: 1.5,
    run: walls,
};

fn walls(_: &Options) -> Vec<Row> {
    rows(WALLS.name, measure())
}

const SPACINGS: [f64; 3] = [1.5e-3, 1e-3, 0.75e-3];

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = WALLS.name;
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    let mut see = |dew: &Dew| balance = balance.max(ledger_error(dew));
    let mut errors = Vec::new();
    for &spacing in reduced(&SPACINGS) {
        let mm = spacing * 1e3;
        let (dew, error) = swing("x_max", spacing, WIDTH, 1.0)?;
        see(&dew);
        rows.push(Row::at_most(name, &format!("swing_error_{mm}_mm"), error, "", 0.005));
        errors.push(error);
        let (dew, error) = swing("z_min", spacing, UNEVEN_WIDTH, 1.0)?;
        see(&dew);
        rows.push(Row::at_most(name, &format!("swing_error_uneven_{mm}_mm"), error, "", 0.005));
    }
    if let Some(order) = order_of(&errors) {
        rows.push(Row::at_least(name, "swing_order", order, "", 1.5));
    }
    if !is_reduced() {
        let (dew, error) = swing("y_min", SPACINGS[1], UNEVEN_WIDTH, 10.0)?;
        see(&dew);
        rows.push(Row::at_most(name, "swing_error_time_factor_10", error, "", 0.005));
    }
    let exact = two_panes_exactly();
    let mut errors = Vec::new();
    for &spacing in reduced(&SPACINGS) {
        let dew = two_panes(spacing)?;
        see(&dew);
        let found = ["slab.mean_temperature_K", "slab.outside.1.mean_temperature_K"].map(|header| gauge(&dew, header));
        let [heated, second] =
            [0, 1].map(|pane| ((found[pane] - exact[pane]) / (exact[pane] - SKY - ZERO_CELSIUS)).abs());
        let mm = spacing * 1e3;
        rows.push(Row::at_most(name, &format!("heated_pane_error_{mm}_mm"), heated, "", 0.01));
        rows.push(Row::at_most(name, &format!("second_pane_error_{mm}_mm"), second, "", 1e-4));
        errors.push(heated);
    }
    if let Some(order) = order_of(&errors) {
        rows.push(Row::at_least(name, "heated_pane_order", order, "", 1.7));
    }
    rows.push(Row::at_most(name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

/// Order of errors at all spacings.
fn order_of(errors: &[f64]) -> Option<f64> {
    let [coarse, _, fine] = *errors else { return None };
    Some((coarse / fine).ln() / (SPACINGS[0] / SPACINGS[2]).ln())
}

/// Materials: conductivity, W/(m K), and heat capacity, J/(m3 K).
const SLAB: [f64; 2] = [0.2, 1e5];
const METAL: [f64; 2] = [50.0, 2e5];
const FOAM: [f64; 2] = [0.1, 3e4];

/// Thicknesses, m, and the gap's resistance, m2 K/W.
const SLAB_THICKNESS: f64 = 0.003;
const METAL_THICKNESS: f64 = 5e-4;
const FOAM_THICKNESS: f64 = 0.002;
const GAP: f64 = 0.005;

/// Side of the slab, m: one into which particles of every spacing go evenly, and one into which they do not.
const WIDTH: f64 = 0.006;
const UNEVEN_WIDTH: f64 = 0.0044;

/// The swing outside: W/(m2 K), s, °C, K; and after how many periods it is sampled for one, at reduced and full size.
const TRANSFER: f64 = 200.0;
const PERIOD: f64 = 16.0;
const MEAN: f64 = START;
const AMPLITUDE: f64 = 20.0;
const PERIODS: [u32; 2] = [1, 8];

/// Periods before the one that is sampled; at reduced size the swing has not settled then.
fn periods_before() -> u32 {
    if is_reduced() { PERIODS[0] } else { PERIODS[1] }
}

/// Rows of the swing's table in a period, by which its amplitude is 5e-5 smaller, and samples of the slab.
const ROWS: u32 = 256;
const SAMPLES: u32 = 32;

/// The slab after the swing, and the largest error of the swing in it over that outside.
fn swing(side: &str, spacing: f64, width: f64, factor: f64) -> Result<(Dew, f64), ModelError> {
    let rows: Vec<String> = (0..=(periods_before() + 1) * ROWS)
        .map(|row| {
            let periods = f64::from(row) / f64::from(ROWS);
            format!("[{}, {}]", periods * PERIOD / factor, MEAN + AMPLITUDE * (TAU * periods).cos())
        })
        .collect();
    let outside = format!(
        "outside = {{ side = \"{side}\", h_w_per_m2_k = {TRANSFER}, temperature_c = [{}], layers = [{{ resistance_m2_k_per_w = {GAP} }}, \
         {{ material = {}, thickness_m = {METAL_THICKNESS} }}, {{ material = {}, thickness_m = {FOAM_THICKNESS} }}] }}\n",
        rows.join(", "),
        written(METAL),
        written(FOAM),
    );
    let mut dew = slab_in_side(side, [SLAB_THICKNESS, width], spacing, factor, SLAB, &outside)?;
    let axis = axis_of(side);
    let depths: Vec<f64> =
        dew.solids().particles.iter().map(|particle| (particle.position[axis] - SLAB_THICKNESS).abs()).collect();
    let inner = inner_swing();
    let swings: Vec<Complex64> = depths.iter().map(|depth| inner * (wave_number(SLAB) * depth).cosh()).collect();
    let mut worst = 0.0_f64;
    for sample in 0..SAMPLES {
        advance(&mut dew, PERIOD / factor * (f64::from(periods_before()) + f64::from(sample) / f64::from(SAMPLES)))?;
        let angle = Complex64::cis(TAU * factor * dew.stepped_until() / PERIOD);
        for (swing, kelvin) in swings.iter().zip(dew.temperatures()) {
            worst = worst.max(((kelvin - ZERO_CELSIUS - MEAN) / AMPLITUDE - (swing * angle).re).abs());
        }
    }
    Ok((dew, worst))
}

/// Complex wave number of heat that swings, 1/m: its square is i omega C/k.
fn wave_number([conductivity, capacity]: [f64; 2]) -> Complex64 {
    Complex64::new(0.0, TAU / PERIOD * capacity / conductivity).sqrt()
}

/// Temperature and heat flux into it at the outer face of a layer from those at its inner face.
fn through(material: [f64; 2], thickness: f64, [temperature, flux]: [Complex64; 2]) -> [Complex64; 2] {
    let wave_number = wave_number(material);
    let (admittance, angle) = (material[0] * wave_number, wave_number * thickness);
    let (cosh, sinh) = (angle.cosh(), angle.sinh());
    [temperature * cosh + flux * sinh / admittance, temperature * admittance * sinh + flux * cosh]
}

/// Swing of the slab's inner face, through which no heat passes, over that of the air outside.
fn inner_swing() -> Complex64 {
    let slab = through(SLAB, SLAB_THICKNESS, [Complex64::ONE, Complex64::ZERO]);
    let gap = [slab[0] + GAP * slab[1], slab[1]];
    let metal = through(METAL, METAL_THICKNESS, gap);
    let [temperature, flux] = through(FOAM, FOAM_THICKNESS, metal);
    1.0 / (temperature + flux / TRANSFER)
}

/// Two panes, of which the inner one is heated: W/m2, °C, W/(m2 K), emissivity, °C, m, time_factor, and how long it takes them to settle, s.
const POWER: f64 = 300.0;
const OUTSIDE: f64 = -5.0;
const WIND: f64 = 25.0;
const EMISSIVITY: f64 = 0.84;
const SKY: f64 = -25.0;
const SECOND_PANE: f64 = 0.002;
const FACTOR: f64 = 20.0;
const SETTLED: f64 = 20.0;

fn two_panes(spacing: f64) -> Result<Dew, ModelError> {
    let rest = format!(
        "heater = {{ power_w_per_m2 = {POWER} }}\n\
         outside = {{ side = \"y_max\", temperature_c = {OUTSIDE}, h_w_per_m2_k = {WIND}, emissivity = {EMISSIVITY}, surroundings_c = {SKY}, \
         layers = [{{ resistance_m2_k_per_w = {GAP} }}, {{ material = {}, thickness_m = {SECOND_PANE} }}] }}\n",
        written(SLAB),
    );
    let mut dew = slab_in_side("y_max", [SLAB_THICKNESS, UNEVEN_WIDTH], spacing, FACTOR, SLAB, &rest)?;
    advance(&mut dew, SETTLED)?;
    Ok(dew)
}

/// Mean temperatures of the two panes, K: all heat leaves by wind and radiation of the outer surface, whose temperature is found by halving.
fn two_panes_exactly() -> [f64; 2] {
    let lost = |surface: f64| {
        let of_sky = (SKY + ZERO_CELSIUS).powi(4);
        WIND * (surface - ZERO_CELSIUS - OUTSIDE) + EMISSIVITY * STEFAN_BOLTZMANN * (surface.powi(4) - of_sky)
    };
    let [mut low, mut high] = [200.0, 400.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if lost(middle) < POWER { low = middle } else { high = middle }
    }
    // The heater warms evenly all through the inner pane, whose mean is warmer than its outer face by q L/(3 k).
    let second = low + 0.5 * POWER * SECOND_PANE / SLAB[0];
    let inner_face = low + POWER * (SECOND_PANE / SLAB[0] + GAP);
    [inner_face + POWER * SLAB_THICKNESS / (3.0 * SLAB[0]), second]
}
