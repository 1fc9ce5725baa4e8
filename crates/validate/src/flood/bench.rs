//! Rates of the flood model.

use super::{run, settings, water_everywhere};
use crate::{Bench, BenchOptions, Rate};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Manning, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

pub(crate) const BENCHES: &[Bench] = &[
    Bench {
        name: "flood/balanced-60k",
        about: "Scheme balanced, everything on, 60,000 particles in waves over rough ground.",
        run: |options| rate("flood/balanced-60k", Scheme::Balanced, 60_000, options),
    },
    Bench {
        name: "flood/balanced-1m",
        about: "Scheme balanced, everything on, a million particles in waves over rough ground.",
        run: |options| rate("flood/balanced-1m", Scheme::Balanced, 1_000_000, options),
    },
    Bench {
        name: "flood/paper-60k",
        about: "Scheme paper, 60,000 particles in waves over rough ground (the paper: 75 steps a second on a GTX 1060).",
        run: |options| rate("flood/paper-60k", Scheme::Paper, 60_000, options),
    },
];

/// Seconds of wall-clock time measured.
const MEASURED: f64 = 10.0;

fn rate(name: &str, scheme: Scheme, particles: usize, options: &BenchOptions) -> Vec<Rate> {
    let measured = if options.quick { 0.2 * MEASURED } else { MEASURED };
    measure(name, scheme, particles, measured).into_iter().collect()
}

fn measure(name: &str, scheme: Scheme, particles: usize, seconds: f64) -> Result<Rate, ModelError> {
    let mut flood = waves(scheme, particles)?;
    let stop = AtomicBool::new(false);
    let ahead = |flood: &mut Flood, steps: u32| {
        let time = flood.time() + f64::from(steps) * flood.time_step();
        flood.advance_to(time, &stop)
    };
    ahead(&mut flood, 3)?;
    let (start, before) = (Instant::now(), flood.particle_steps());
    while start.elapsed().as_secs_f64() < seconds {
        ahead(&mut flood, 2)?;
    }
    let work = (flood.particle_steps() - before) as f64;
    Ok(Rate {
        name: name.into(),
        particles: flood.particles().len(),
        dimensions: 2,
        packing: None,
        threads: rayon::current_num_threads(),
        rate: work / start.elapsed().as_secs_f64(),
        rate_unit: "particle_steps_per_s".into(),
        bytes_per_particle: flood.bytes() as f64 / flood.particles().len() as f64,
    })
}

/// Water a metre deep, 1 m apart, with friction, waving over ground with a relief of its own.
fn waves(scheme: Scheme, particles: usize) -> Result<Flood, ModelError> {
    let side = (particles as f64).sqrt();
    let bounds = Bounds { x_min: 0.0, x_max: side, y_min: 0.0, y_max: side };
    let terrain = Arc::new(Terrain::gridded(bounds, 2.0, |x, y| 0.2 * (0.31 * x).sin() * (0.23 * y).cos()));
    let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(1e6, 1.0, 1.0, walls);
    settings.scheme = scheme;
    // The paper has no bed friction: its control force slows the water.
    settings.manning = Manning::Number(if scheme == Scheme::Paper { 0.0 } else { 0.03 });
    let ground = Arc::clone(&terrain);
    let depth = move |x: f64, y: f64| 1.0 + 0.1 * (0.05 * x).sin() - ground.height(x, y);
    run(&settings, &terrain, &[water_everywhere(bounds, depth, |_, y| [(0.07 * y).sin(), 0.0])], 0.0)
}
