//! What time steps of their own save: a flood with finer cells round a place, with the same step for all and without.

use super::SEED;
use super::bench::waters;
use crate::Rate;
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Circle, Finer, TimeSteps};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Simulated between two looks at the clock, s.
const STRETCH: f64 = 1.0;

/// Stretches that both run in turn, after one that does not count.
const ROUNDS: usize = 5;

/// Core-seconds for a simulated second: the median of stretches that both ways take in turn.
pub(super) fn measured() -> Vec<Rate> {
    in_turn().unwrap_or_default()
}

fn in_turn() -> Result<Vec<Rate>, ModelError> {
    let open = |time_steps: TimeSteps| {
        waters(20_000, SEED, |settings| {
            settings.time_steps = time_steps;
            let circle = Some(Circle { centre: [60.0, 80.0], radius_m: 2.0 });
            settings.finer = vec![Finer { spacing_m: 0.125, circle, ..Finer::default() }];
        })
    };
    let mut floods = [open(TimeSteps::Global)?, open(TimeSteps::Local)?];
    let mut costs = [Vec::new(), Vec::new()];
    for round in 0..=ROUNDS {
        for (flood, costs) in floods.iter_mut().zip(&mut costs) {
            let cost = stretch(flood, round)?;
            if round > 0 {
                costs.push(cost);
            }
        }
    }
    let entry = |(name, flood, costs): (&str, &VoronoiFlood, &mut Vec<f64>)| {
        costs.sort_unstable_by(f64::total_cmp);
        let (particles, threads) = (flood.particles(), rayon::current_num_threads());
        Rate {
            name: format!("flood/voronoi-time-steps/{name}"),
            particles,
            dimensions: 2,
            packing: None,
            threads,
            device: None,
            rate: costs[ROUNDS / 2] * threads as f64,
            rate_unit: "core_s_per_s".into(),
            bytes_per_particle: flood.bytes() as f64 / particles as f64,
            passes: Vec::new(),
        }
    };
    let [global, local] = &floods;
    let [of_global, of_local] = &mut costs;
    Ok([("global", global, of_global), ("local", local, of_local)].map(entry).into())
}

/// Seconds for a simulated second in a stretch.
fn stretch(flood: &mut VoronoiFlood, round: usize) -> Result<f64, ModelError> {
    let began = Instant::now();
    flood.advance_to((round + 1) as f64 * STRETCH, &AtomicBool::new(false))?;
    Ok(began.elapsed().as_secs_f64() / STRETCH)
}
