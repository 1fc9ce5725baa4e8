//! Rates of the dew model: steps of air particles in a second of wall-clock time, heat and humidity on.

use super::advance;
use crate::{Bench, BenchOptions, Rate};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Settings, Setup};
use corpuscle_model::{Model, ModelError};
use corpuscle_solids::{Pose, Shape, Solid};
use std::time::Instant;

pub(crate) const BENCHES: &[Bench] = &[
    Bench {
        name: "dew/plate-100k",
        about: "100,000 particles of stirred humid air over a cold glass plate: motion, heat, vapour and condensation.",
        run: |options| rate("dew/plate-100k", 46, options),
    },
    Bench {
        name: "dew/plate-1m",
        about: "A million particles of stirred humid air over a cold glass plate: motion, heat, vapour and condensation.",
        run: |options| rate("dew/plate-1m", 100, options),
    },
];

/// Distance of particles, m.
const SPACING: f64 = 2e-3;

const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

/// Steps before the clock is started: the lattice has gone.
const STIRRED: u64 = 40;

fn rate(name: &str, side: usize, options: &BenchOptions) -> Vec<Rate> {
    measure(name, side, if options.quick { 2.0 } else { 8.0 }).into_iter().collect()
}

fn measure(name: &str, side: usize, seconds: f64) -> Result<Rate, ModelError> {
    let temperature = ZERO_CELSIUS + 25.0;
    let vapour = HumidAir::with_relative_humidity(temperature, 101_325.0, 0.7).mass_fraction();
    let length = side as f64 * SPACING;
    let thick = 4.0 * SPACING;
    let plate = Shape::cuboid([length, length, thick]).map_err(|error| ModelError::Setup(error.to_string()))?;
    let solid = Solid::of_shape(plate, Pose::new([0.5 * length, 0.5 * length, 0.5 * thick], [0.0; 3]));
    let mut body = Body::sampled(solid, SPACING, GLASS, ZERO_CELSIUS + 5.0, true)?;
    // It fills the room from side to side: only its upper side is surface.
    body.surface = Some(std::sync::Arc::new(move |[_, _, z]: [f64; 3]| z - thick));
    let periodic = [Face::Periodic; 2];
    let setup = Setup {
        settings: Settings::new(SPACING, temperature, vapour),
        air: Properties::at_room_temperature(1.0),
        room: Room {
            low: [0.0; 3],
            high: [length, length, length + thick],
            faces: [periodic, periodic, [Face::Wall; 2]],
        },
        bodies: vec![body],
        fans: Vec::new(),
        seed: 1,
    };
    let mut dew = Dew::new(&setup, |_| [temperature, vapour])?;
    let wave = |at: f64| 0.05 * (std::f64::consts::TAU * at / length).sin();
    dew.stir(|[x, y, _]| [wave(y), wave(x), 0.0]);
    while dew.steps() < STIRRED {
        ahead(&mut dew)?;
    }
    let (start, before) = (Instant::now(), dew.particle_steps());
    while start.elapsed().as_secs_f64() < seconds {
        ahead(&mut dew)?;
    }
    Ok(Rate {
        name: name.into(),
        particles: dew.air().len(),
        dimensions: 3,
        packing: None,
        threads: rayon::current_num_threads(),
        rate: (dew.particle_steps() - before) as f64 / start.elapsed().as_secs_f64(),
        rate_unit: "particle_steps_per_s".into(),
        bytes_per_particle: dew.bytes() as f64 / dew.air().len() as f64,
        device: None,
    })
}

/// A step or so.
fn ahead(dew: &mut Dew) -> Result<(), ModelError> {
    let time = dew.time() + 1.001 * dew.time_step();
    advance(dew, time)
}
