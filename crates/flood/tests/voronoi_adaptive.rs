//! Cells that follow the water change no promise of scheme voronoi, and are where they are wanted.

use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Flood, Scene};
use corpuscle_terrain::{Bounds, Terrain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const BOUNDS: Bounds = Bounds { x_min: 0.0, x_max: 120.0, y_min: 0.0, y_max: 60.0 };
const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";
const JOINED: &str =
    "edges = { west = \"periodic\", east = \"periodic\", south = \"periodic\", north = \"periodic\" }\n";
/// Cells that are made anew when a test says so, and not by themselves.
const BY_HAND: &str = "adaptive = { finest_m = 0.4, rise_over_depth = 1e9, every_steps = 1000000 }\n";

fn settings(keys: &str) -> Result<Flood, ModelError> {
    let text = format!(
        "run.until_s = 100\nterrain.plane.extent = {{ length_m = 120, width_m = 60, cell_m = 1 }}\n[flood]\nspacing_m = 1.6\n{keys}"
    );
    let mut scene = Scene::parse(&text, "test", &[]).map_err(|error| ModelError::Setup(error.to_string()))?;
    scene.resolve_defaults();
    Ok(scene.flood().unwrap().flood.clone())
}

fn flood(
    keys: &str,
    seed: u64,
    ground: impl Fn(f64, f64) -> f64 + Sync,
    level: impl Fn(f64, f64) -> f64 + Send + Sync + 'static,
    velocity: [f64; 2],
) -> VoronoiFlood {
    let terrain = Arc::new(Terrain::gridded(BOUNDS, 0.5, ground));
    let water = StartWater {
        filling: Filling::Level(Box::new(level)),
        polygon: None,
        velocity: Box::new(move |_, _| velocity),
    };
    VoronoiFlood::with_water(&settings(keys).unwrap(), seed, Path::new("."), terrain, &[water]).unwrap()
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Rough ground, its highest places above 2 m.
fn rough(seed: u64, highest: f64) -> impl Fn(f64, f64) -> f64 + Sync {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let heights: Vec<f64> = (0..41 * 21).map(|_| random.random_range(0.0..highest)).collect();
    move |x: f64, y: f64| heights[((y / 3.0) as usize).min(20) * 41 + ((x / 3.0) as usize).min(40)]
}

/// Finer cells in circles anywhere.
fn anywhere(random: &mut ChaCha8Rng) -> impl Fn(f64, f64) -> u8 + use<> {
    let circles: Vec<_> = (0..6).map(|_| [(); 3].map(|()| random.random_range(0.0..1.0))).collect();
    move |x: f64, y: f64| {
        let level = |[a, b, c]: &[f64; 3]| {
            let distance = (x - 120.0 * a).hypot(y - 60.0 * b);
            if distance < 4.0 + 12.0 * c { 1 + u8::from(*c > 0.5) } else { 0 }
        };
        circles.iter().map(level).max().unwrap_or(0)
    }
}

/// Momentum over density, m4/s, of the water, and the sum of its absolute values.
fn momentum(flood: &VoronoiFlood) -> ([f64; 2], f64) {
    let of = |axis: usize| flood.wet_cells().map(|cell| cell.area * cell.depth * cell.velocity[axis]).sum::<f64>();
    let all = flood.wet_cells().map(|cell| cell.area * cell.depth * cell.velocity[0].hypot(cell.velocity[1])).sum();
    ([of(0), of(1)], all)
}

fn volume(flood: &VoronoiFlood) -> f64 {
    flood.wet_cells().map(|cell| cell.area * cell.depth).sum()
}

/// All cells under water, over rough ground: level to rounding, whatever is made of the cells.
#[test]
fn a_lake_stays_level_while_cells_are_made_anew() {
    for (seed, edges) in [(1, WALLS), (2, JOINED)] {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let ground = rough(seed, 1.5);
        let ground = move |x: f64, y: f64| ground(x.rem_euclid(120.0), y.rem_euclid(60.0));
        let mut flood = flood(&format!("manning = 0\n{BY_HAND}{edges}"), seed, ground, |_, _| 2.0, [0.0; 2]);
        let before = volume(&flood);
        for round in 1..=12 {
            flood.remake_cells(anywhere(&mut random)).unwrap();
            go(&mut flood, 0.2 * f64::from(round));
        }
        assert!(flood.remakes() == 12 && flood.steps() > 50, "{} {}", flood.remakes(), flood.steps());
        let off = flood.wet_cells().map(|cell| (cell.level - 2.0).abs()).fold(0.0, f64::max);
        let fastest = flood.wet_cells().map(|cell| cell.velocity[0].hypot(cell.velocity[1])).fold(0.0, f64::max);
        println!("{off:e} m {fastest:e} m/s {:e}", volume(&flood) / before - 1.0);
        assert!(off < 1e-9 && fastest < 1e-9, "{off:e} m {fastest:e} m/s");
        assert!((volume(&flood) / before - 1.0).abs() < 1e-13);
    }
}
