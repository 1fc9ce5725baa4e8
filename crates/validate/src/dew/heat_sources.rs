//! Heaters, heat to the outside, and radiation of solids, each beside its known answer.

use super::ledger::dew_of;
use super::{advance, ledger_error, ledger_rounding, rows};
use crate::device::{is_reduced, reduced};
use crate::{Case, Options, Row};
use corpuscle_dew::Dew;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_model::ModelError;
use std::f64::consts::PI;

pub(super) const HEAT_SOURCES: Case = Case {
    name: "dew/heat-sources",
    about: "A slab of 6 mm at 20 °C that is heated by 300 W/m2 and loses heat through one face to -10 °C, h 50 W/(m2 K), in three sides of the box, at three spacings, \
            beside Fourier's series (Carslaw & Jaeger 1959, section 3.11) with uniform heating. A sphere at 200 °C, emissivity 0.8, off any lattice, that \
            radiates to 20 °C, beside dT/dt by the Stefan-Boltzmann law; the same in a tenth of the time with time_factor 10.",
    slow: false,
    reduced: 2.0,
    run: heat_sources,
};

fn heat_sources(_: &Options) -> Vec<Row> {
    rows(HEAT_SOURCES.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = HEAT_SOURCES.name;
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    let mut see = |dew: &Dew| balance = balance.max(ledger_error(dew));
    let mut errors = Vec::new();
    for &spacing in reduced(&SPACINGS) {
        let mut worst = [0.0_f64; 2];
        for side in ["x_min", "y_max", "z_min"] {
            let dew = slab(side, spacing)?;
            see(&dew);
            let found = slab_errors(&dew, side);
            worst = [0, 1].map(|of| worst[of].max(found[of]));
        }
        let mm = spacing * 1e3;
        rows.push(Row::at_most(name, &format!("slab_temperature_error_{mm}_mm"), worst[0], "", 0.005));
        let measure = format!("slab_heat_to_outside_error_{mm}_mm");
        rows.push(if spacing == SPACINGS[2] {
            Row::at_most(name, &measure, worst[1], "", 0.005)
        } else {
            Row::beside(name, &measure, worst[1], "", 0.005, WHY)
        });
        errors.push(worst);
    }
    if let [coarse, .., fine] = errors[..] {
        let order = |of: usize| (coarse[of] / fine[of]).ln() / (SPACINGS[0] / SPACINGS[2]).ln();
        rows.push(Row::at_least(name, "slab_heat_to_outside_order", order(1), "", 1.0));
        let why = "no even order: the slab is 2.9, 4.4 and 6.3 particles wide; in one that they fill evenly it is 1.9 (dew/walls)";
        rows.push(Row::beside(name, "slab_temperature_order", order(0), "", 2.0, why));
    }
    for &spacing in reduced(&SPHERE_SPACINGS) {
        let dew = sphere(spacing, 1.0)?;
        see(&dew);
        let error = sphere_error(&dew, 1.0);
        rows.push(Row::at_most(name, &format!("sphere_error_{}_mm", spacing * 1e3), error, "", 0.003));
    }
    if !is_reduced() {
        let dew = sphere(SPHERE_SPACINGS[0], 10.0)?;
        see(&dew);
        rows.push(Row::at_most(name, "sphere_error_time_factor_10", sphere_error(&dew, 10.0), "", 0.003));
    }
    rows.push(Row::at_most(name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

const SPACINGS: [f64; 3] = [1.5e-3, 1e-3, 0.7e-3];

/// W/(m2 K4) (CODATA 2018).
pub(super) const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// Why the heat of the coarser spacings is shown only.
const WHY: &str = "bounded with nine layers; with four and six the layer that has cooled is as thin as they are";

/// Air that neither warms nor moves.
const STILL_AIR: &str = "buoyancy = false\nair = { temperature_c = 20, relative_humidity = 0 }\ntransport.air_conductivity_w_per_m_k = 1e-7\ndrops.smallest_radius_m = 5e-4\n";

/// The slab: m, W/(m K), J/(m3 K).
const THICKNESS: f64 = 0.006;
const CONDUCTIVITY: f64 = 0.2;
const CAPACITY: f64 = 1e5;

/// W/(m2 K), °C, °C, W/m2, s.
const TRANSFER: f64 = 50.0;
const OUTSIDE: f64 = -10.0;
pub(super) const START: f64 = 20.0;
const POWER: f64 = 300.0;
const WATCHED: f64 = 6.0;

/// Side of the slab, m.
const WIDTH: f64 = 0.0044;

pub(super) fn axis_of(side: &str) -> usize {
    ["x", "y", "z"].iter().position(|axis| side.starts_with(axis)).unwrap_or(0)
}

/// A slab of conductivity, W/(m K), and heat capacity, J/(m3 K), in a side of a box twice as thick that is periodic across, at 20 °C, in air that neither warms nor
/// moves; thickness and width in m. `rest` are keys of the solid.
pub(super) fn slab_in_side(
    side: &str,
    [thickness, width]: [f64; 2],
    spacing: f64,
    factor: f64,
    material: [f64; 2],
    rest: &str,
) -> Result<Dew, ModelError> {
    let axis = axis_of(side);
    let of = |along: f64, across: f64| {
        let mut all = [across; 3];
        all[axis] = along;
        all
    };
    let middle = if side.ends_with("min") { 0.5 * thickness } else { 1.5 * thickness };
    let periodic = |other: usize| ["x", "y", "z"].map(|name| (other != axis).then_some(name))[other];
    let faces: String = (0..3)
        .filter_map(periodic)
        .map(|name| format!("{name}_min = \"periodic\"\n{name}_max = \"periodic\"\n"))
        .collect();
    dew_of(&format!(
        "run.until_s = 1\n[dew]\nsize_m = {:?}\nspacing_m = {spacing}\ntime_factor = {factor}\n{STILL_AIR}[dew.faces]\n{faces}[[dew.solid]]\nname = \"slab\"\n\
         shape = {{ box = {{ size_m = {:?} }} }}\nposition_m = {:?}\ntemperature_c = {START}\nmaterial = {}\n{rest}",
        of(2.0 * thickness, width),
        of(thickness, width),
        of(middle, 0.5 * width),
        written(material),
    ))
}

/// A material of a conductivity, W/(m K), and a heat capacity, J/(m3 K).
pub(super) fn written([conductivity, capacity]: [f64; 2]) -> String {
    format!(
        "{{ conductivity_w_per_m_k = {conductivity}, heat_capacity_j_per_kg_k = {}, density_kg_per_m3 = 1000 }}",
        capacity / 1000.0
    )
}

/// The slab after `WATCHED`.
fn slab(side: &str, spacing: f64) -> Result<Dew, ModelError> {
    let rest = format!(
        "heater = {{ power_w_per_m2 = {POWER} }}\n\
         outside = {{ side = \"{side}\", temperature_c = {OUTSIDE}, h_w_per_m2_k = {TRANSFER} }}\n"
    );
    let mut dew = slab_in_side(side, [THICKNESS, WIDTH], spacing, 1.0, [CONDUCTIVITY, CAPACITY], &rest)?;
    advance(&mut dew, WATCHED)?;
    Ok(dew)
}

/// Largest error of temperature over the difference to the outside, and error of the heat that has gone there over itself.
fn slab_errors(dew: &Dew, side: &str) -> [f64; 2] {
    let axis = axis_of(side);
    let time = dew.stepped_until();
    let from_inner_face =
        |position: f64| if side.ends_with("min") { THICKNESS - position } else { position - THICKNESS };
    let exact = Series::new(time);
    let particles = dew.solids().particles.iter().zip(dew.temperatures());
    let error = |(particle, kelvin): (&corpuscle_dew::solids::SolidParticle, &f64)| {
        (kelvin - ZERO_CELSIUS - exact.at(from_inner_face(particle.position[axis]))).abs()
    };
    let worst = particles.map(error).fold(0.0, f64::max);
    let area = WIDTH * WIDTH;
    let gained = (exact.mean() - START) * CAPACITY * THICKNESS * area;
    let from_outside = gained - POWER * area * time;
    [worst / (START - OUTSIDE), (dew.heat_supplied(0)[1] / from_outside - 1.0).abs()]
}

/// Temperature of the slab, °C, as its steady state and a sum of A cos(b x) exp(-a b^2 t) with b tan(b L) = h/k, x from the face that is insulated.
struct Series {
    /// Pairs of b, 1/m, and A exp(-a b^2 t), K.
    terms: Vec<[f64; 2]>,
}

/// Terms of the series.
const TERMS: usize = 60;

impl Series {
    fn new(time: f64) -> Self {
        let terms = (0..TERMS).map(|number| {
            let b = wave_number(number);
            let (sine, cosine) = (b * THICKNESS).sin_cos();
            let constant = START - steady(0.0);
            let of_square = POWER / (2.0 * CONDUCTIVITY * THICKNESS);
            let square = THICKNESS.powi(2) * sine / b + 2.0 * THICKNESS * cosine / (b * b) - 2.0 * sine / b.powi(3);
            let norm = 0.5 * THICKNESS + sine * cosine / (2.0 * b);
            let amplitude = (constant * sine / b + of_square * square) / norm;
            [b, amplitude * (-CONDUCTIVITY / CAPACITY * b * b * time).exp()]
        });
        Self { terms: terms.collect() }
    }

    fn at(&self, x: f64) -> f64 {
        steady(x) + self.terms.iter().map(|[b, amplitude]| amplitude * (b * x).cos()).sum::<f64>()
    }

    fn mean(&self) -> f64 {
        let of_term = |[b, amplitude]: &[f64; 2]| amplitude * (b * THICKNESS).sin() / (b * THICKNESS);
        let steady = OUTSIDE + POWER / TRANSFER + POWER * THICKNESS / (3.0 * CONDUCTIVITY);
        steady + self.terms.iter().map(of_term).sum::<f64>()
    }
}

/// Steady temperature, °C: all heat leaves through the outer face.
fn steady(x: f64) -> f64 {
    OUTSIDE + POWER / TRANSFER + POWER * (THICKNESS.powi(2) - x * x) / (2.0 * CONDUCTIVITY * THICKNESS)
}

/// The root of b tan(b L) = h/k after so many others, by halving, 1/m.
fn wave_number(number: usize) -> f64 {
    let [mut low, mut high] = [number as f64 * PI, (number as f64 + 0.5) * PI].map(|angle| angle / THICKNESS);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle * (middle * THICKNESS).tan() < TRANSFER / CONDUCTIVITY { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

const SPHERE_SPACINGS: [f64; 3] = [2e-3, 1.5e-3, 1e-3];

/// The sphere: m, emissivity, W/(m K), °C, s.
const RADIUS: f64 = 0.005;
const EMISSIVITY: f64 = 0.8;
const SPHERE_CONDUCTIVITY: f64 = 2.0;
const HOT: f64 = 200.0;
const RADIATED: f64 = 6.0;

/// A sphere that has radiated for so long that, by the factor, `RADIATED` has gone by for it.
fn sphere(spacing: f64, factor: f64) -> Result<Dew, ModelError> {
    let text = format!(
        "run.until_s = {RADIATED}\n[dew]\nsize_m = [0.015, 0.016, 0.0155]\nspacing_m = {spacing}\ntime_factor = {factor}\n{STILL_AIR}[[dew.solid]]\nname = \"ball\"\n\
         shape = {{ sphere = {{ radius_m = {RADIUS} }} }}\nposition_m = [0.0073, 0.0082, 0.00781]\ntemperature_c = {HOT}\n\
         material = {{ conductivity_w_per_m_k = {SPHERE_CONDUCTIVITY}, heat_capacity_j_per_kg_k = {}, density_kg_per_m3 = 1000 }}\n\
         radiation = {{ emissivity = {EMISSIVITY}, surroundings_c = {START} }}\n",
        CAPACITY / 1000.0,
    );
    let mut dew = dew_of(&text)?;
    advance(&mut dew, RADIATED / factor)?;
    Ok(dew)
}

/// Error of the mean temperature over the fall of it.
fn sphere_error(dew: &Dew, factor: f64) -> f64 {
    let exact = radiated(factor * dew.stepped_until());
    let of = dew.solids().particles.iter().zip(dew.temperatures());
    let sums = of.fold([0.0; 2], |[heat, volume], (particle, kelvin)| {
        [heat + particle.volume * kelvin, volume + particle.volume]
    });
    let hot = HOT + ZERO_CELSIUS;
    ((sums[0] / sums[1] - exact) / (hot - exact)).abs()
}

/// Mean temperature of the sphere after a time, K: C R/3 dT/dt = -q, q = e sigma (T_s^4 - T_r^4). Its surface is colder by q R/(5 k), as where it cools evenly
/// all through. Runge and Kutta's method.
fn radiated(time: f64) -> f64 {
    let around = START + ZERO_CELSIUS;
    let rate = |mean: f64| {
        let mut flux = 0.0;
        for _ in 0..30 {
            let surface = mean - flux * RADIUS / (5.0 * SPHERE_CONDUCTIVITY);
            flux = EMISSIVITY * STEFAN_BOLTZMANN * (surface.powi(4) - around.powi(4));
        }
        -3.0 * flux / (CAPACITY * RADIUS)
    };
    let steps = 1000;
    let step = time / f64::from(steps);
    (0..steps).fold(HOT + ZERO_CELSIUS, |mean, _| {
        let a = rate(mean);
        let b = rate(mean + 0.5 * step * a);
        let c = rate(mean + 0.5 * step * b);
        let d = rate(mean + step * c);
        mean + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    })
}
