//! Rates of the dew model: steps of air particles in a second of wall-clock time, heat and humidity on.

use crate::bench::Measuring;
use crate::{Bench, BenchOptions, Rate};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Settings, Setup};
use corpuscle_model::ModelError;
use corpuscle_processes::Processes;
use corpuscle_solids::{Pose, Shape, Solid};

pub(crate) const BENCHES: &[Bench] = &[
    Bench {
        name: "dew/plate-100k",
        about: "100,000 particles of stirred humid air over a cold glass plate: motion, heat, vapour and condensation.",
        needs_gpu: false,
        is_shared: true,
        run: |options| rate("dew/plate-100k", 46, options),
    },
    Bench {
        name: "dew/plate-1m",
        about: "A million particles of stirred humid air over a cold glass plate: motion, heat, vapour and condensation.",
        needs_gpu: false,
        is_shared: true,
        run: |options| rate("dew/plate-1m", 100, options),
    },
    Bench {
        name: "dew/plate-5m",
        about: "Five million particles of stirred humid air over a cold glass plate: motion, heat, vapour and condensation.",
        needs_gpu: true,
        is_shared: false,
        run: |options| rate("dew/plate-5m", 171, options),
    },
];

/// Distance of particles, m.
const SPACING: f64 = 2e-3;

const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

/// After so many steps the lattice has gone. A step at a time; on a GPU more, as each check of the time reads the air back.
const MEASURING: Measuring = Measuring { name: "", dimensions: 3, settling: 40, steps: [1.001, 20.0], seconds: 8.0 };

fn rate(name: &'static str, side: usize, options: &BenchOptions) -> Vec<Rate> {
    let Ok(mut dew) = plate(side, &options.processes) else { return Vec::new() };
    if !options.processes.is_first() {
        options.processes.follow(&mut dew);
        return Vec::new();
    }
    Measuring { name, ..MEASURING }.rate(dew, options).unwrap_or_default().into_iter().collect()
}

/// Stirred air over a cold plate, `side` particles each way.
fn plate(side: usize, processes: &Processes) -> Result<Dew, ModelError> {
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
    let mut dew = Dew::new_on(processes, &setup, |_| [temperature, vapour])?;
    let wave = |at: f64| 0.05 * (std::f64::consts::TAU * at / length).sin();
    dew.stir(|[x, y, _]| [wave(y), wave(x), 0.0]);
    dew.lead();
    Ok(dew)
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::require_gpu;

    #[test]
    fn a_bench_of_dew_runs_on_the_gpu() {
        let Some(gpu) = require_gpu("a bench of dew") else { return };
        let name = Some(gpu.name.clone());
        let options = BenchOptions { quick: true, gpu: Some(gpu), passes: true, ..BenchOptions::default() };
        let [rate] = &rate("dew/plate", 12, &options)[..] else { panic!("no rate") };
        assert!(rate.device == name && rate.threads == 0 && rate.particles > 1000, "{rate:?}");
        assert!(rate.rate > 0.0 && rate.bytes_per_particle > 100.0, "{rate:?}");
        let forces = rate.passes.iter().find(|pass| pass.name == "dew_forces").expect("passes are timed");
        assert!((1.0..1.2).contains(&forces.times_a_step) && forces.seconds_a_step > 0.0, "{forces:?}");
    }
}
