//! Time steps of their own change no promise of scheme voronoi, and save steps.

use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::Model;
use corpuscle_scene::{Flood, Scene};
use corpuscle_terrain::{Bounds, Terrain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const BOUNDS: Bounds = Bounds { x_min: 0.0, x_max: 120.0, y_min: 0.0, y_max: 60.0 };
const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";
const JOINED: &str =
    "edges = { west = \"periodic\", east = \"periodic\", south = \"periodic\", north = \"periodic\" }\n";

fn settings(keys: &str, time_steps: &str) -> Flood {
    let text = format!(
        "run.until_s = 100\nterrain.plane.extent = {{ length_m = 120, width_m = 60, cell_m = 1 }}\n[flood]\nspacing_m = 1.3\n\
         time_steps = \"{time_steps}\"\n{keys}"
    );
    let mut scene = Scene::parse(&text, "test", &[]).unwrap();
    scene.resolve_defaults();
    scene.flood().unwrap().flood.clone()
}

/// A shallow plain with a deep hole, rough all over.
fn hole(seed: u64) -> impl Fn(f64, f64) -> f64 + Sync {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let [x, y] = [random.random_range(20.0..100.0), random.random_range(15.0..45.0)];
    let phase: [f64; 2] = [random.random_range(0.0..6.0), random.random_range(0.0..6.0)];
    move |east: f64, north: f64| {
        let rough = 0.25 * (1.1 * east + phase[0]).sin() * (0.9 * north + phase[1]).sin();
        rough - 20.0 * (-((east - x).powi(2) + (north - y).powi(2)) / 20.0).exp()
    }
}

fn flood(
    settings: &Flood,
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
    VoronoiFlood::with_water(settings, seed, Path::new("."), terrain, &[water]).unwrap()
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

fn step_of(x: f64, _: f64) -> f64 {
    if x < 60.0 { 0.9 } else { 0.3 }
}

/// A wave over the plain and the hole: nothing is lost, fewer steps are taken, and the water stands as with steps that are all the same, to a tenth of
/// what half the spacing changes.
#[test]
fn fewer_steps_give_the_same_flood() {
    for seed in 1..4 {
        let run = |time_steps: &str, spacing_m: f64| {
            let settings = settings(&format!("manning = 0.03\n{WALLS}"), time_steps);
            let settings = Flood { spacing_m: Some(spacing_m), ..settings };
            let mut flood = flood(&settings, seed, hole(seed), step_of, [0.0; 2]);
            go(&mut flood, 12.0);
            flood
        };
        let (global, local, finer) = (run("global", 1.3), run("local", 1.3), run("global", 0.65));
        assert!(local.steps() * 2 < global.steps(), "{} {}", local.steps(), global.steps());
        // Water, and momentum, which ground and walls change.
        for (balance, most) in local.ledger().balances.iter().zip([1e-13, 1e-12]) {
            assert!(balance.relative_error().abs() < most, "{balance:?}");
        }
        let apart = |other: &VoronoiFlood| {
            let positions = (0..7200).map(|k| [f64::from(k % 120) + 0.5, f64::from(k / 120) + 0.5]);
            positions.map(|[x, y]| (global.sample(x, y).depth - other.sample(x, y).depth).abs()).sum::<f64>()
        };
        assert!(apart(&local) > 0.0 && apart(&local) < 0.1 * apart(&finer), "{} {}", apart(&local), apart(&finer));
    }
}

/// Momentum over flat ground, with finer cells that have shorter steps.
#[test]
fn momentum_is_kept_where_steps_differ() {
    let keys =
        format!("manning = 0\n{JOINED}finer = [{{ circle = {{ centre = [30, 20], radius_m = 4 }}, spacing_m = 0.4 }}]");
    let level = |x: f64, y: f64| 1.0 + 0.3 * (-((x - 50.0).powi(2) + (y - 30.0).powi(2)) / 30.0).exp();
    let run = |time_steps: &str| {
        let mut flood = flood(&settings(&keys, time_steps), 2, |_, _| 0.0, level, [0.7, -0.4]);
        let momentum = |flood: &VoronoiFlood| {
            let of =
                |axis: usize| flood.wet_cells().map(|cell| cell.area * cell.depth * cell.velocity[axis]).sum::<f64>();
            [of(0), of(1)]
        };
        let before = momentum(&flood);
        go(&mut flood, 6.0);
        let after = momentum(&flood);
        let off = (0..2).map(|axis| (after[axis] / before[axis] - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{off:e}");
        assert!(flood.ledger().balances[0].relative_error().abs() < 1e-13);
        flood.steps()
    };
    assert!(run("local") * 2 < run("global"));
}

/// Dry ground, islands and draining films: a lake at rest stays so, and no film gives more than it has.
#[test]
fn a_lake_at_rest_stays_at_rest() {
    let mut flood = flood(&settings(&format!("manning = 0\n{WALLS}"), "local"), 3, hole(3), |_, _| 0.1, [0.0; 2]);
    go(&mut flood, 20.0);
    assert!(flood.wet_cells().all(|cell| (cell.level - 0.1).abs() < 1e-12));
    assert!(flood.wet_cells().all(|cell| cell.velocity[0].hypot(cell.velocity[1]) < 1e-12));
}

/// Onto dry ground, on one, two and three threads, stopped and resumed: the same bits.
#[test]
fn threads_and_a_stop_change_no_bit() {
    let settings = settings(&format!("manning = 0.02\n{WALLS}"), "local");
    let level = |x: f64, _: f64| if x < 40.0 { 1.2 } else { -0.05 };
    let run = |threads: usize, stop: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut model = flood(&settings, 4, hole(4), level, [0.0; 2]);
            if stop {
                go(&mut model, 3.7);
                let state = model.save();
                let terrain = Arc::new(Terrain::gridded(BOUNDS, 0.5, hole(4)));
                model = VoronoiFlood::to_restore(&settings, 4, Path::new("."), terrain).unwrap();
                model.restore(&state).unwrap();
            }
            go(&mut model, 9.0);
            assert!(model.ledger().balances[0].relative_error().abs() < 1e-13);
            model.save()
        })
    };
    let plain = run(1, false);
    assert!(plain == run(2, false) && plain == run(3, false) && plain == run(2, true));
}
