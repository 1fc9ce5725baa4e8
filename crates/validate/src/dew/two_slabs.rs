//! Heat between two slabs: warming up against the error function, and steady flux.

use super::{ACROSS, advance, column, ready, rows, slab};
use crate::device::reduction;
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_dew::solids::Material;
use corpuscle_dew::{Dew, Mean, Settings, Setup};
use corpuscle_model::ModelError;
use statrs::function::erf::erf;

pub(super) const TWO_SLABS: Case = Case {
    name: "dew/two-slabs",
    about: "Two slabs at 5 and 25 °C brought together: steel and glass, glass and air; contact temperature and profiles against \
            the error function (Carslaw & Jaeger 1959, section 2.14). Steady flux through 25 particles of a solid and 25 of \
            air, their conductivities as 10, 38 and 15000 to 1, against two resistances in a row; the arithmetic mean beside.",
    slow: true,
    reduced: 2.5,
    run: two_slabs,
};

const SPACING: f64 = 1e-3;
const COLD: f64 = ZERO_CELSIUS + 5.0;
const WARM: f64 = ZERO_CELSIUS + 25.0;

const STEEL: Material = Material { conductivity: 60.5, heat_capacity: 434.0, density: 7854.0 };
/// Soda-lime glass as the patent's authors may have had it: in air it comes to a contact temperature of 5.0767 °C.
const GLASS: Material = Material { conductivity: 1.0, heat_capacity: 840.0, density: 2500.0 };

fn two_slabs(_: &Options) -> Vec<Row> {
    rows(TWO_SLABS.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let row = |measure: &str, value, bound| Row::at_most(TWO_SLABS.name, measure, value, "", bound);
    let mut rows = Vec::new();
    for (name, solid) in [("steel_glass", Some(STEEL)), ("glass_air", None)] {
        let [contact, profile] = warming(solid)?;
        rows.push(row(&format!("contact_error_{name}"), contact, 0.01));
        rows.push(row(&format!("profile_error_{name}"), profile, 0.02));
    }
    for (name, ratio) in [("10", 10.0), ("38", 38.0), ("15000", 15_000.0)] {
        rows.push(row(&format!("flux_error_{name}"), flux_error(ratio, Mean::Harmonic)?, 0.005));
        // With the third ratio its time step would be thousands of times shorter.
        if ratio < 100.0 {
            let arithmetic = flux_error(ratio, Mean::Arithmetic)?;
            let why = "the arithmetic mean, shown beside the harmonic one";
            rows.push(Row::beside(
                TWO_SLABS.name,
                &format!("flux_error_{name}_arithmetic"),
                arithmetic,
                "",
                0.005,
                why,
            ));
        }
    }
    Ok(rows)
}

fn air() -> Properties {
    // The air rests: a slow sound lets steps be as long as diffusion allows.
    Properties::at_room_temperature(0.05)
}

fn still() -> Settings {
    Settings { gravity: [0.0; 3], fog: false, ..Settings::new(SPACING, WARM, 0.0) }
}

/// Layers of a slab that is as good as without end for so long, s.
const LAYERS: f64 = 80.0;
const LASTING: f64 = 16.0;

/// Errors of contact temperature and of profile over the difference: `steel` against warm glass, or, without it, glass against
/// warm air.
fn warming(steel: Option<Material>) -> Result<[f64; 2], ModelError> {
    let (layers, time) = ((LAYERS / reduction()) as usize, LASTING / reduction().powi(2));
    let air = air();
    let cold = steel.unwrap_or(GLASS);
    let of_air = Material { conductivity: air.conductivity, heat_capacity: air.heat_capacity, density: air.density };
    let warm = if steel.is_some() { GLASS } else { of_air };
    let mut bodies = vec![slab(0, layers, SPACING, cold, COLD, false)];
    if steel.is_some() {
        bodies.push(slab(layers, layers, SPACING, warm, WARM, false));
    }
    let room = column(2.0 * layers as f64 * SPACING, SPACING);
    let setup = Setup { settings: still(), air, room, bodies, fans: Vec::new(), seed: 1 };
    let mut dew = ready(Dew::new(&setup, |_| [WARM, 0.0])?)?;
    advance(&mut dew, time)?;
    let effusivity = |m: Material| (m.conductivity * m.heat_capacity * m.density).sqrt();
    let (e_cold, e_warm) = (effusivity(cold), effusivity(warm));
    let contact = (e_cold * COLD + e_warm * WARM) / (e_cold + e_warm);
    let face = layers as f64 * SPACING;
    let exact = |x: f64| {
        let (far, material) = if x < face { (COLD, cold) } else { (WARM, warm) };
        let diffusivity = material.conductivity / (material.heat_capacity * material.density);
        contact + (far - contact) * erf((x - face).abs() / (2.0 * (diffusivity * time).sqrt()))
    };
    let solids = dew.solids().particles.iter().map(|particle| particle.position[0]).zip(dew.temperatures().to_vec());
    let airs = dew.air().iter().map(|particle| (particle.position[0], particle.temperature));
    let found: Vec<(f64, f64)> = solids.chain(airs).collect();
    let worst = found.iter().map(|&(x, t)| (t - exact(x)).abs()).fold(0.0, f64::max);
    let layer = |number: i32| {
        let near = |x: f64| (x - face - (f64::from(number) + 0.5) * SPACING).abs() < 0.1 * SPACING;
        let here: Vec<f64> = found.iter().filter(|(x, _)| near(*x)).map(|(_, t)| *t).collect();
        here.iter().sum::<f64>() / here.len() as f64
    };
    // Straight on from the two layers nearest to the face, on either side; the worse of both.
    let from_cold = 1.5 * layer(-1) - 0.5 * layer(-2);
    let from_warm = 1.5 * layer(0) - 0.5 * layer(1);
    let miss = (from_cold - contact).abs().max((from_warm - contact).abs());
    Ok([miss / (WARM - COLD), worst / (WARM - COLD)])
}

/// Layers of each slab of the steady flux.
const THICK: f64 = 25.0;
/// Layers of the plates that hold the temperatures.
const PLATE: usize = 2;

/// Relative error of the steady flux through a solid that conducts `ratio` times as well as air, and air.
fn flux_error(ratio: f64, mean: Mean) -> Result<f64, ModelError> {
    let thick = (THICK / reduction()) as usize;
    let air = air();
    let conductivity = ratio * air.conductivity;
    // It warms twice as fast as the air, so that neither delays the other.
    let capacity = conductivity / (2.0 * air.heat_diffusivity());
    let solid = Material { conductivity, heat_capacity: capacity / 1000.0, density: 1000.0 };
    // From the middle of the plate's last layer to the face; the plates are of what they touch.
    let length = (thick as f64 + 0.5) * SPACING;
    let resistance = length / air.conductivity + length / conductivity;
    let flux = (WARM - COLD) / resistance;
    let contact = COLD + flux * length / conductivity;
    let of_air = Material { conductivity: air.conductivity, heat_capacity: air.heat_capacity, density: air.density };
    let bodies = vec![
        slab(0, PLATE, SPACING, solid, COLD, true),
        slab(PLATE, thick, SPACING, solid, 0.5 * (COLD + contact), false),
        slab(PLATE + 2 * thick, PLATE, SPACING, of_air, WARM, true),
    ];
    let layers = 2 * PLATE + 2 * thick;
    let room = column(layers as f64 * SPACING, SPACING);
    let setup = Setup { settings: Settings { mean, ..still() }, air, room, bodies, fans: Vec::new(), seed: 1 };
    let face = (PLATE + thick) as f64 * SPACING;
    let mut dew = ready(Dew::new(&setup, |[x, ..]| [contact + (WARM - contact) * (x - face) / length, 0.0])?)?;
    // Several times the time of the slowest part, L^2 / (pi^2 / 4 kappa).
    let slowest = length * length / (0.25 * std::f64::consts::PI.powi(2) * air.heat_diffusivity());
    advance(&mut dew, 4.0 * slowest)?;
    let (begin, before) = (dew.stepped_until(), [dew.heat_from(0), dew.heat_from(2)]);
    advance(&mut dew, 4.2 * slowest)?;
    let time = dew.stepped_until() - begin;
    let area = (ACROSS as f64 * SPACING).powi(2);
    let found = 0.5 * ((dew.heat_from(2) - before[1]) - (dew.heat_from(0) - before[0])) / (time * area);
    Ok((found / flux - 1.0).abs())
}
