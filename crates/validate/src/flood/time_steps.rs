//! What local time steps save: a flood with finer cells over a part, with one step for all and with local steps.

use super::bench::filled;
use crate::Rate;
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Circle, Finer, TimeSteps};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Simulated time between two readings of the clock, s.
const STRETCH: f64 = 1.0;

/// Stretches that both run in turn, after one that does not count.
const ROUNDS: usize = 5;

/// Core-seconds for a simulated second: the median of stretches that both ways take in turn, with cells a quarter and an eighth as wide as elsewhere over a
/// circle.
pub(super) fn measured() -> Vec<Rate> {
    let parts = [("quarter", 0.25, 4.0), ("eighth", 0.125, 2.0)];
    parts.into_iter().flat_map(|(name, spacing, radius)| in_turn(name, spacing, radius).unwrap_or_default()).collect()
}

fn in_turn(part: &str, spacing_m: f64, radius_m: f64) -> Result<Vec<Rate>, ModelError> {
    let open = |time_steps: TimeSteps| {
        filled(20_000, 0.1, |settings| {
            settings.time_steps = time_steps;
            let circle = Some(Circle { centre: [60.0, 80.0], radius_m });
            settings.finer = vec![Finer { spacing_m, circle, ..Finer::default() }];
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
            name: format!("flood/voronoi-time-steps/{part}-{name}"),
            particles,
            dimensions: 2,
            packing: None,
            threads,
            device: None,
            rate: costs[ROUNDS / 2] * threads as f64,
            rate_unit: "core_s_per_s".into(),
            processes: None,
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
