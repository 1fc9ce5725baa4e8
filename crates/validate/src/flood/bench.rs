//! Rates of the flood model.

use super::{GRAVITY, error_cost, time_steps};
use crate::bench::Measuring;
use crate::{Bench, BenchOptions, Rate};
use corpuscle_flood::{Filling, FloodModel, InitialWater, SphSweFlood, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_processes::Processes;
use corpuscle_scene::{Edge, Edges, Flood, Manning, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(crate) const BENCHES: &[Bench] = &[
    Bench {
        name: "flood/voronoi-60k",
        about: "Scheme voronoi, everything on, 60,000 particles in waves over rough ground.",
        needs_gpu: false,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-60k", 60_000, true, options),
    },
    Bench {
        name: "flood/voronoi-1m",
        about: "Scheme voronoi, everything on, a million particles in waves over rough ground.",
        needs_gpu: false,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-1m", 1_000_000, true, options),
    },
    Bench {
        name: "flood/voronoi-still-60k",
        about: "Scheme voronoi, everything on, 60,000 particles in still water over rough ground.",
        needs_gpu: false,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-still-60k", 60_000, false, options),
    },
    Bench {
        name: "flood/voronoi-still-1m",
        about: "Scheme voronoi, everything on, a million particles in still water over rough ground.",
        needs_gpu: false,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-still-1m", 1_000_000, false, options),
    },
    Bench {
        name: "flood/voronoi-10m",
        about: "Scheme voronoi, everything on, ten million particles in waves over rough ground.",
        needs_gpu: true,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-10m", 10_000_000, true, options),
    },
    Bench {
        name: "flood/voronoi-still-10m",
        about: "Scheme voronoi, everything on, ten million particles in still water over rough ground.",
        needs_gpu: true,
        is_shared: true,
        run: |options| voronoi_rate("flood/voronoi-still-10m", 10_000_000, false, options),
    },
    Bench {
        name: "flood/sph-swe-60k",
        about: "Scheme sph-swe, 60,000 particles in waves over rough ground (the paper: 75 steps a second on a GTX 1060).",
        needs_gpu: false,
        is_shared: false,
        run: |options| sph_swe_rate("flood/sph-swe-60k", 60_000, options),
    },
    Bench {
        name: "flood/error-cost",
        about: "Error and cost of the dam breaks of Stoker (wet) and Ritter (dry) by scheme voronoi at 4, 2 and 1 m; use --threads 1.",
        needs_gpu: false,
        is_shared: false,
        run: |_| error_cost::measured(),
    },
    Bench {
        name: "flood/voronoi-vortex",
        about: "Error and cost of a vortex that a current carries through a periodic box three times, by scheme voronoi at 2, 1 and 0.5 m; use --threads 1.",
        needs_gpu: false,
        is_shared: false,
        run: |_| error_cost::of_vortex(),
    },
    Bench {
        name: "flood/voronoi-time-steps",
        about: "Scheme voronoi with finer cells over a part (a quarter as wide over 8 m, an eighth over 4 m), with one time step for all and with local time steps, in turn; use --threads 1.",
        needs_gpu: false,
        is_shared: false,
        run: |_| time_steps::measured(),
    },
];

/// Water and the ground that it waves over.
pub type BenchWater = (Box<dyn FloodModel>, Arc<Terrain>);

/// The water of a bench of the flood, by its name, to be drawn. None for any other bench.
///
/// # Errors
/// Those of setting it up.
pub fn bench_water(name: &str) -> Result<Option<BenchWater>, ModelError> {
    Ok(match name {
        "flood/voronoi-60k" => Some((Box::new(voronoi(60_000, true)?), ground(60_000))),
        "flood/voronoi-1m" => Some((Box::new(voronoi(1_000_000, true)?), ground(1_000_000))),
        "flood/voronoi-10m" => Some((Box::new(voronoi(10_000_000, true)?), ground(10_000_000))),
        "flood/sph-swe-60k" => Some((Box::new(sph_swe(60_000)?), ground(60_000))),
        _ => None,
    })
}

/// Two steps at a time; 64 on a GPU, as each sample brings the water back.
const MEASURING: Measuring = Measuring { name: "", dimensions: 2, settling: 1, steps: [2.0, 64.0], seconds: 10.0 };

fn sph_swe_rate(name: &'static str, particles: usize, options: &BenchOptions) -> Vec<Rate> {
    let measure = |flood| Measuring { name, ..MEASURING }.rate(flood, options);
    sph_swe(particles).and_then(measure).unwrap_or_default().into_iter().collect()
}

fn voronoi_rate(name: &'static str, particles: usize, waves: bool, options: &BenchOptions) -> Vec<Rate> {
    let Ok(mut flood) = filled_on(&options.processes, particles, if waves { 0.1 } else { 0.0 }, |_| ()) else {
        return Vec::new();
    };
    if !options.processes.is_first() {
        options.processes.follow(&mut flood);
        return Vec::new();
    }
    Measuring { name, ..MEASURING }.rate(flood, options).unwrap_or_default().into_iter().collect()
}

/// The same water by scheme voronoi; still at a level of 1 m where it has no waves.
fn voronoi(particles: usize, waves: bool) -> Result<VoronoiFlood, ModelError> {
    filled(particles, if waves { 0.1 } else { 0.0 }, |_| ())
}

/// The same water in waves of a height, m, with settings changed.
pub(super) fn filled(
    particles: usize,
    height: f64,
    change: impl FnOnce(&mut Flood),
) -> Result<VoronoiFlood, ModelError> {
    filled_on(&Processes::alone(), particles, height, change)
}

/// The same, shared out over processes.
fn filled_on(
    processes: &Processes,
    particles: usize,
    height: f64,
    change: impl FnOnce(&mut Flood),
) -> Result<VoronoiFlood, ModelError> {
    let mut settings = Flood { manning: Manning::Number(0.03), ..basin(Scheme::Voronoi) };
    change(&mut settings);
    let water = StartWater {
        filling: Filling::Level(Box::new(move |x, _| 1.0 + height * (0.05 * x).sin())),
        polygon: None,
        velocity: Box::new(move |_, y| [10.0 * height * (0.07 * y).sin(), 0.0]),
    };
    VoronoiFlood::with_water_on(processes, &settings, SEED, Path::new("."), ground(particles), &[water])
}

/// Seed of where particles are at the start.
const SEED: u64 = 1;

/// Ground with a relief of its own under room for so many particles 1 m apart.
fn ground(particles: usize) -> Arc<Terrain> {
    let side = (particles as f64).sqrt();
    let bounds = Bounds { x_min: 0.0, x_max: side, y_min: 0.0, y_max: side };
    Arc::new(Terrain::gridded(bounds, 2.0, |x, y| 0.2 * (0.31 * x).sin() * (0.23 * y).cos()))
}

/// Water between walls with particles 1 m apart, without friction. Its maps are not used.
fn basin(scheme: Scheme) -> Flood {
    Flood {
        scheme,
        spacing_m: Some(1.0),
        spacing_depth_m: Some(1.0),
        gravity_m_per_s2: GRAVITY,
        manning: Manning::Number(0.0),
        map_every_s: Some(5e3),
        edges: Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall },
        ..Flood::default()
    }
}

/// The same water by scheme sph-swe. The paper has no bed friction: its control force slows the water.
fn sph_swe(particles: usize) -> Result<SphSweFlood, ModelError> {
    let terrain = ground(particles);
    let water = InitialWater {
        depth: Box::new(|x, y| 1.0 + 0.1 * (0.05 * x).sin() - terrain.height(x, y)),
        inside: Box::new(|_, _| true),
        within: terrain.bounds(),
        velocity: Box::new(|_, y| [(0.07 * y).sin(), 0.0]),
    };
    SphSweFlood::with_water(&basin(Scheme::SphSwe), SEED, Path::new("."), Arc::clone(&terrain), &[water])
}
