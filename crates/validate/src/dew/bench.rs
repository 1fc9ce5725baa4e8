//! Rates of the dew model: steps of air particles in a second of wall-clock time, heat and humidity on.

use super::advance;
use crate::bench::Clock;
use crate::{Bench, BenchOptions, Rate};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Settings, Setup};
use corpuscle_model::{Model, ModelError};
use corpuscle_solids::{Pose, Shape, Solid};

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

/// Steps between two looks on a card: each look brings the air back.
const STEPS_ON_CARD: f64 = 20.0;

fn rate(name: &str, side: usize, options: &BenchOptions) -> Vec<Rate> {
    measure(name, side, options).unwrap_or_default().into_iter().collect()
}

/// The rate; none where the card cannot compute this.
fn measure(name: &str, side: usize, options: &BenchOptions) -> Result<Option<Rate>, ModelError> {
    let seconds = if options.quick { 2.0 } else { 8.0 };
    let mut dew = plate(side)?;
    let Some(mut clock) = Clock::start(options, |gpu| dew.use_card(gpu)) else { return Ok(None) };
    let steps = if clock.device.is_some() { STEPS_ON_CARD } else { 1.001 };
    let ahead = |dew: &mut Dew| advance(dew, dew.time() + steps * dew.time_step());
    while dew.steps() < STIRRED {
        ahead(&mut dew)?;
    }
    let before = dew.particle_steps();
    clock.restart(dew.seconds_on_card());
    while clock.seconds(dew.seconds_on_card()) < seconds {
        ahead(&mut dew)?;
    }
    let particles = dew.air().len();
    Ok(Some(Rate {
        name: name.into(),
        particles,
        dimensions: 3,
        packing: None,
        threads: clock.threads(),
        rate: (dew.particle_steps() - before) as f64 / clock.seconds(dew.seconds_on_card()),
        rate_unit: "particle_steps_per_s".into(),
        bytes_per_particle: dew.bytes_on_card().unwrap_or(dew.bytes() as u64) as f64 / particles as f64,
        device: clock.device,
    }))
}

/// Stirred air over a cold plate, `side` parcels each way.
fn plate(side: usize) -> Result<Dew, ModelError> {
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
    Ok(dew)
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::require_gpu;

    #[test]
    fn a_bench_of_dew_runs_on_the_card() {
        let Some(gpu) = require_gpu("a bench of dew") else { return };
        let name = Some(gpu.name.clone());
        let options = BenchOptions { quick: true, gpu: Some(gpu) };
        let rate = measure("dew/plate", 12, &options).unwrap().unwrap();
        assert!(rate.device == name && rate.threads == 0 && rate.particles > 1000, "{rate:?}");
        assert!(rate.rate > 0.0 && rate.bytes_per_particle > 100.0, "{rate:?}");
    }
}
