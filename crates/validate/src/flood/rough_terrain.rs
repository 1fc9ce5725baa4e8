//! What the control force of scheme paper does on rough ground.

use super::device::ready;
use super::rows;
use crate::{Case, Options, Row};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Scene, builtin};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub(super) const ROUGH_TERRAIN: Case = Case {
    name: "flood/rough-terrain",
    about: "The built-in scene flood/rough-terrain with the control force of scheme paper and without: how unevenly the water's \
            density is spread over the particles and how fast the fastest is, 20 s, 40 s and 60 s after the release. The paper's claim: \
            with it nothing piles up on valley floors, and nothing splashes about.",
    slow: true,
    reduced: 1.0,
    run: rough_terrain,
};

/// Times of the table, s, and the names of its rows.
const TABLE: [(f64, &str, &str); 3] = [
    (20.0, "density_spread_20s", "fastest_20s"),
    (40.0, "density_spread_40s", "fastest_40s"),
    (60.0, "density_spread_60s", "fastest_60s"),
];

/// The spread is no smaller with the force: it holds what has piled up on impact where it is.
const WITHOUT: &str = "beside that without the control force";

fn rough_terrain(_: &Options) -> Vec<Row> {
    let measure = || {
        let [with, without] = [measured("true")?, measured("false")?];
        let mut rows = Vec::new();
        for (((_, spread, fastest), with), without) in TABLE.into_iter().zip(with).zip(without) {
            rows.push(Row::beside(ROUGH_TERRAIN.name, spread, with[0], "", without[0], WITHOUT));
            rows.push(Row::at_most(ROUGH_TERRAIN.name, fastest, with[1], "m/s", without[1]));
        }
        Ok(rows)
    };
    rows(ROUGH_TERRAIN.name, measure())
}

/// Standard deviation over mean of the density, and the fastest particle's speed, m/s, at the times of the table.
fn measured(control: &str) -> Result<Vec<[f64; 2]>, ModelError> {
    let name = ROUGH_TERRAIN.name;
    let text = builtin(name).ok_or_else(|| ModelError::Setup(format!("no built-in scene {name}")))?.text;
    let switch = [("flood.paper.control_force".to_owned(), control.to_owned())];
    let mut scene = Scene::parse(text, name, &switch).map_err(|error| ModelError::Setup(error.to_string()))?;
    scene.resolve_defaults();
    let flood = scene.flood().ok_or_else(|| ModelError::Setup(format!("{name} is no flood")))?;
    let terrain = Terrain::open(&flood.terrain, scene.seed, Path::new("."));
    let terrain = terrain.map_err(|error| ModelError::Setup(error.to_string()))?;
    let mut flood = ready(Flood::new(&flood.flood, scene.seed, Path::new("."), Arc::new(terrain))?)?;
    let look = |(time, ..): (f64, &str, &str)| {
        flood.advance_to(time, &AtomicBool::new(false))?;
        let particles = flood.particles();
        let count = particles.len() as f64;
        let mean = particles.iter().map(|particle| particle.depth).sum::<f64>() / count;
        let variance = particles.iter().map(|particle| (particle.depth - mean).powi(2)).sum::<f64>() / count;
        let fastest = particles.iter().map(|particle| particle.speed()).fold(0.0, f64::max);
        Ok([variance.sqrt() / mean, fastest])
    };
    TABLE.into_iter().map(look).collect()
}
