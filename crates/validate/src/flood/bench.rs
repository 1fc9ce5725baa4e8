//! Rates of the flood model.

use super::{SEED, error_cost, run, settings, time_steps, water_everywhere};
use crate::bench::Measuring;
use crate::{Bench, BenchOptions, Rate};
use corpuscle_flood::{Filling, Flood, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges, Flood as Settings, Manning, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(crate) const BENCHES: &[Bench] = &[
    Bench {
        name: "flood/voronoi-60k",
        about: "Scheme voronoi, everything on, 60,000 particles in waves over rough ground.",
        needs_card: false,
        run: |options| voronoi_rate("flood/voronoi-60k", 60_000, true, options),
    },
    Bench {
        name: "flood/voronoi-1m",
        about: "Scheme voronoi, everything on, a million particles in waves over rough ground.",
        needs_card: false,
        run: |options| voronoi_rate("flood/voronoi-1m", 1_000_000, true, options),
    },
    Bench {
        name: "flood/voronoi-still-60k",
        about: "Scheme voronoi, everything on, 60,000 particles in still water over rough ground.",
        needs_card: false,
        run: |options| voronoi_rate("flood/voronoi-still-60k", 60_000, false, options),
    },
    Bench {
        name: "flood/voronoi-still-1m",
        about: "Scheme voronoi, everything on, a million particles in still water over rough ground.",
        needs_card: false,
        run: |options| voronoi_rate("flood/voronoi-still-1m", 1_000_000, false, options),
    },
    Bench {
        name: "flood/balanced-60k",
        about: "Scheme balanced, everything on, 60,000 particles in waves over rough ground.",
        needs_card: false,
        run: |options| rate("flood/balanced-60k", options),
    },
    Bench {
        name: "flood/balanced-1m",
        about: "Scheme balanced, everything on, a million particles in waves over rough ground.",
        needs_card: false,
        run: |options| rate("flood/balanced-1m", options),
    },
    Bench {
        name: "flood/balanced-10m",
        about: "Scheme balanced, everything on, ten million particles in waves over rough ground.",
        needs_card: true,
        run: |options| rate("flood/balanced-10m", options),
    },
    Bench {
        name: "flood/sph-swe-60k",
        about: "Scheme sph-swe, 60,000 particles in waves over rough ground (the paper: 75 steps a second on a GTX 1060).",
        needs_card: false,
        run: |options| rate("flood/sph-swe-60k", options),
    },
    Bench {
        name: "flood/error-cost",
        about: "Error and cost of the dam breaks of Stoker (wet) and Ritter (dry) by schemes voronoi and balanced at 4, 2 and 1 m; use --threads 1.",
        needs_card: false,
        run: |_| error_cost::measured(),
    },
    Bench {
        name: "flood/voronoi-vortex",
        about: "Error and cost of a vortex that a current carries through a periodic box three times, by scheme voronoi at 2, 1 and 0.5 m; use --threads 1.",
        needs_card: false,
        run: |_| error_cost::of_vortex(),
    },
    Bench {
        name: "flood/voronoi-time-steps",
        about: "Scheme voronoi with finer cells over a part (a quarter as wide over 8 m, an eighth over 4 m), with one time step for all and with local time steps, in turn; use --threads 1.",
        needs_card: false,
        run: |_| time_steps::measured(),
    },
];

/// Scheme and particles of each.
const WATERS: [(&str, Scheme, usize); 4] = [
    ("flood/balanced-60k", Scheme::Balanced, 60_000),
    ("flood/balanced-1m", Scheme::Balanced, 1_000_000),
    ("flood/balanced-10m", Scheme::Balanced, 10_000_000),
    ("flood/sph-swe-60k", Scheme::SphSwe, 60_000),
];

/// The water of a bench of the flood, by its name, and the ground that it waves over: for whoever draws it. None for any other bench.
///
/// # Errors
/// Those of setting it up.
pub fn bench_water(name: &str) -> Result<Option<(Flood, Arc<Terrain>)>, ModelError> {
    let of_it = WATERS.into_iter().find(|water| water.0 == name);
    of_it.map(|(_, scheme, particles)| waves(scheme, particles)).transpose()
}

/// Two steps at a time; 64 on a card, as each look brings the water back.
const MEASURING: Measuring = Measuring { name: "", dimensions: 2, settling: 1, steps: [2.0, 64.0], seconds: 10.0 };

fn rate(name: &'static str, options: &BenchOptions) -> Vec<Rate> {
    let measure = |(flood, _)| Measuring { name, ..MEASURING }.rate(flood, options);
    bench_water(name).and_then(|water| water.map_or(Ok(None), measure)).unwrap_or_default().into_iter().collect()
}

fn voronoi_rate(name: &'static str, particles: usize, waves: bool, options: &BenchOptions) -> Vec<Rate> {
    let measure = |flood| Measuring { name, ..MEASURING }.rate(flood, options);
    voronoi(particles, waves).and_then(measure).unwrap_or_default().into_iter().collect()
}

/// The same water by scheme voronoi; still at a level of 1 m where it has no waves.
fn voronoi(particles: usize, waves: bool) -> Result<VoronoiFlood, ModelError> {
    filled(particles, if waves { 0.1 } else { 0.0 }, |_| ())
}

/// The same water in waves of a height, m, with settings changed.
pub(super) fn filled(
    particles: usize,
    height: f64,
    change: impl FnOnce(&mut Settings),
) -> Result<VoronoiFlood, ModelError> {
    let (_, terrain, mut settings) = basin(Scheme::Voronoi, particles);
    settings.manning = Manning::Number(0.03);
    change(&mut settings);
    let water = StartWater {
        filling: Filling::Level(Box::new(move |x, _| 1.0 + height * (0.05 * x).sin())),
        polygon: None,
        velocity: Box::new(move |_, y| [10.0 * height * (0.07 * y).sin(), 0.0]),
    };
    VoronoiFlood::with_water(&settings, SEED, Path::new("."), terrain, &[water])
}

/// Ground with a relief of its own under room for so many particles 1 m apart, and the settings of a flood there.
fn basin(scheme: Scheme, particles: usize) -> (Bounds, Arc<Terrain>, Settings) {
    let side = (particles as f64).sqrt();
    let bounds = Bounds { x_min: 0.0, x_max: side, y_min: 0.0, y_max: side };
    let terrain = Arc::new(Terrain::gridded(bounds, 2.0, |x, y| 0.2 * (0.31 * x).sin() * (0.23 * y).cos()));
    let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(1e6, 1.0, 1.0, walls);
    settings.scheme = scheme;
    (bounds, terrain, settings)
}

/// Water a metre deep, 1 m apart, with friction, waving over ground with a relief of its own.
fn waves(scheme: Scheme, particles: usize) -> Result<(Flood, Arc<Terrain>), ModelError> {
    let (bounds, terrain, mut settings) = basin(scheme, particles);
    // The paper has no bed friction: its control force slows the water.
    settings.manning = Manning::Number(if scheme == Scheme::SphSwe { 0.0 } else { 0.03 });
    let ground = Arc::clone(&terrain);
    let depth = move |x: f64, y: f64| 1.0 + 0.1 * (0.05 * x).sin() - ground.height(x, y);
    let flood = run(&settings, &terrain, &[water_everywhere(bounds, depth, |_, y| [(0.07 * y).sin(), 0.0])], 0.0)?;
    Ok((flood, terrain))
}
