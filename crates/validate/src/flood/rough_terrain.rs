//! What the control force of scheme sph-swe does on rough ground.

use super::device::ready;
use super::{built_in, rows};
use crate::device::is_reduced;
use crate::{Case, Options, Row};
use corpuscle_flood::SphSweFlood;
use corpuscle_model::{Model, ModelError};
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub(super) const ROUGH_TERRAIN: Case = Case {
    name: "flood/rough-terrain",
    about: "The built-in scene flood/rough-terrain with the control force of scheme sph-swe and without: how unevenly the water's \
            density is spread over the particles and how fast the fastest is, 20 s, 40 s and 60 s after the release. The paper's claim: \
            with it nothing piles up on valley floors, and nothing splashes about.",
    slow: true,
    reduced: 4.0,
    run: rough_terrain,
};

/// Times of the table, s, and the names of its rows.
const TABLE: [(f64, &str, &str); 3] = [
    (20.0, "density_spread_20s", "fastest_20s"),
    (40.0, "density_spread_40s", "fastest_40s"),
    (60.0, "density_spread_60s", "fastest_60s"),
];

/// At the reduced size the first.
fn times() -> impl Iterator<Item = (f64, &'static str, &'static str)> {
    TABLE.into_iter().take(if is_reduced() { 1 } else { TABLE.len() })
}

/// The spread is no smaller with the force: without it the water stays a spray over all of the ground, with it it collects in hollows.
const WITHOUT: &str = "beside that without the control force";

fn rough_terrain(_: &Options) -> Vec<Row> {
    let measure = || {
        let [with, without] = [measured("true")?, measured("false")?];
        let mut rows = Vec::new();
        for (((_, spread, fastest), with), without) in times().zip(with).zip(without) {
            rows.push(Row::beside(ROUGH_TERRAIN.name, spread, with[0], "", without[0], WITHOUT));
            rows.push(Row::at_most(ROUGH_TERRAIN.name, fastest, with[1], "m/s", without[1]));
        }
        Ok(rows)
    };
    rows(ROUGH_TERRAIN.name, measure())
}

/// Standard deviation over mean of the density, and the fastest particle's speed, m/s, at the times of the table.
fn measured(control: &str) -> Result<Vec<[f64; 2]>, ModelError> {
    let (scene, settings, terrain) = built_in(ROUGH_TERRAIN.name, &[("flood.sph_swe.control_force", control)])?;
    let mut flood = ready(SphSweFlood::new(&settings, scene.seed, Path::new("."), terrain)?)?;
    let sample = |(time, ..): (f64, &str, &str)| {
        flood.advance_to(time, &AtomicBool::new(false))?;
        let particles = flood.particles();
        let count = particles.len() as f64;
        let mean = particles.iter().map(|particle| particle.depth).sum::<f64>() / count;
        let variance = particles.iter().map(|particle| (particle.depth - mean).powi(2)).sum::<f64>() / count;
        let fastest = particles.iter().map(|particle| particle.speed()).fold(0.0, f64::max);
        Ok([variance.sqrt() / mean, fastest])
    };
    times().map(sample).collect()
}
