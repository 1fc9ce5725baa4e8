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

/// A drift with waves over a flat box with joined sides: volume and momentum to rounding.
#[test]
fn volume_and_momentum_are_kept_while_cells_are_made_anew() {
    for time_steps in ["global", "local"] {
        let keys = format!("manning = 0\ntime_steps = \"{time_steps}\"\n{BY_HAND}{JOINED}");
        let level = |x: f64, y: f64| 1.0 + 0.2 * (PI * x / 15.0).sin() * (PI * y / 10.0).cos();
        let mut flood = flood(&keys, 3, |_, _| 0.0, level, [0.7, -0.4]);
        let (volume_before, (before, _)) = (volume(&flood), momentum(&flood));
        let mut random = ChaCha8Rng::seed_from_u64(4);
        for round in 1..=12 {
            flood.remake_cells(anywhere(&mut random)).unwrap();
            go(&mut flood, 0.5 * f64::from(round));
        }
        let (after, all) = momentum(&flood);
        let off = (0..2).map(|axis| (after[axis] - before[axis]).abs() / all).fold(0.0, f64::max);
        println!("{off:e} {:e}", volume(&flood) / volume_before - 1.0);
        assert!(all > 1000.0 && off < 1e-12, "{off:e} of {all}");
        assert!((volume(&flood) / volume_before - 1.0).abs() < 1e-13);
        assert!(flood.ledger().balances.iter().all(|balance| balance.relative_error().abs() < 1e-12));
    }
}

/// A lake with islands. Cells that are all under water and stay so keep it level; a cell at the shore has only a mean depth to hand out, and where it is
/// split or merged the water beside it moves a little. Volume is kept, and the lake calms down.
#[test]
fn a_shore_is_stirred_little_while_cells_are_made_anew() {
    for (seed, storage, fastest_after) in [(1, "mean", 1.0), (1, "level-volume", 1.0)] {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let keys = format!("manning = 0.03\nstorage = \"{storage}\"\n{BY_HAND}{WALLS}");
        let mut flood = flood(&keys, seed, rough(seed, 3.0), |_, _| 2.0, [0.0; 2]);
        let before = volume(&flood);
        let rms = |flood: &VoronoiFlood| {
            let sum: f64 = flood.wet_cells().map(|c| c.area * c.depth * (c.velocity[0].powi(2) + c.velocity[1].powi(2))).sum();
            (sum / volume(flood)).sqrt()
        };
        for round in 1..=6 {
            flood.remake_cells(anywhere(&mut random)).unwrap();
            let off: Vec<f64> = flood.wet_cells().map(|cell| (cell.level - 2.0).abs() * cell.area).collect();
            go(&mut flood, 2.0 * f64::from(round));
            println!("{storage} {round}: mean level off {:e}, rms {:e}", off.iter().sum::<f64>() / 7200.0, rms(&flood));
        }
        assert!((volume(&flood) / before - 1.0).abs() < 1e-13);
        go(&mut flood, 60.0);
        println!("{storage}: rms {:e}", rms(&flood));
        assert!(rms(&flood) < fastest_after);
    }
}

/// A dam breaks at the foot of a rough beach.
fn beach(x: f64, y: f64) -> f64 {
    0.04 * x + 0.02 * (0.8 * x).sin() * (0.7 * y).cos()
}

fn pool(x: f64, _: f64) -> f64 {
    if x < 40.0 { 3.5 } else { -10.0 }
}

const FOLLOWS: &str = "manning = 0.03\nadaptive = { finest_m = 0.4 }\n";

#[test]
fn finer_cells_follow_a_front() {
    let mut flood = flood(&format!("{FOLLOWS}{WALLS}"), 5, beach, pool, [0.0; 2]);
    for second in 0..=14 {
        go(&mut flood, f64::from(second));
        let fine: Vec<_> = flood.wet_cells().filter(|cell| cell.area < 0.3).collect();
        let all = flood.wet_cells().count();
        let front = flood.wet_cells().filter(|cell| cell.depth > 0.01).map(|cell| cell.centroid[0]).fold(0.0, f64::max);
        let [low, high] = fine.iter().fold([f64::MAX, 0.0], |[a, b]: [f64; 2], cell| [a.min(cell.centroid[0]), b.max(cell.centroid[0])]);
        let at_front = flood.wet_cells().filter(|cell| cell.depth > 0.01 && cell.centroid[0] > front - 2.0).map(|cell| cell.area.sqrt()).fold(0.0, f64::max);
        println!("{second} s: front {front:.1} m, fine {} of {all} from {low:.1} to {high:.1}, widest at the front {at_front:.2}, {} steps, {} remakes", fine.len(), flood.steps(), flood.remakes());
    }
    println!("{:?}", flood.ledger());
}

#[test]
fn threads_and_a_stop_change_no_bit() {
    let keys = format!(
        "{FOLLOWS}TIME{WALLS}[[flood.obstacle]]\nname = \"house\"\npolygon = [[50, 20], [58, 21], [57, 31]]\n\
         [[flood.inflow]]\nname = \"spring\"\nat = [70, 40]\ndischarge_m3_per_s = 2\n\
         [[flood.outflow]]\nname = \"drain\"\nat = [100, 30]\nrating = [[0, 0], [5, 3]]\n\
         [[flood.finer]]\nspacing_m = 0.8\ncircle = {{ centre = [90, 30], radius_m = 6 }}\n\
         [flood.infiltration.constant]\nrate_mm_per_h = 40\n"
    );
    for time_steps in ["", "time_steps = \"local\"\n"] {
        let keys = keys.replace("TIME", time_steps);
        let run = |threads: usize, stops: &[f64]| {
            let pool_of_threads = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool_of_threads.install(|| {
                let mut model = flood(&keys, 6, beach, pool, [0.0; 2]);
                for stop in stops {
                    go(&mut model, *stop);
                    let state = model.save();
                    let terrain = Arc::new(Terrain::gridded(BOUNDS, 0.5, beach));
                    model = VoronoiFlood::to_restore(&settings(&keys).unwrap(), 6, Path::new("."), terrain).unwrap();
                    model.restore(&state).unwrap();
                    assert!(model.save() == state);
                }
                go(&mut model, 8.0);
                assert!(model.remakes() > 3, "{}", model.remakes());
                assert!(model.ledger().balances[0].relative_error().abs() < 1e-12, "{:?}", model.ledger());
                model.save()
            })
        };
        let plain = run(1, &[]);
        assert!(plain == run(3, &[]), "{time_steps}");
        assert!(plain == run(2, &[2.1, 5.3]), "{time_steps}");
    }
}

#[test]
fn what_cannot_follow_the_water_is_told() {
    for (keys, told) in [
        ("adaptive = { finest_m = 2 }", "flood.adaptive.finest_m"),
        ("adaptive = { finest_m = 0.01 }", "64 times"),
        ("adaptive = { finest_m = 0.0 }", "larger than 0"),
        ("adaptive = {}", "finest_m is missing"),
        ("adaptive = { finest_m = 0.4, rise_over_depth = 0 }", "flood.adaptive.rise_over_depth"),
        ("adaptive = { finest_m = 0.4, every_steps = 0 }", "flood.adaptive.every_steps"),
        ("adaptive = { finest_m = 0.4, often = true }", "often"),
        ("scheme = \"balanced\"\nadaptive = { finest_m = 0.4 }", "is for scheme = \"voronoi\""),
    ] {
        let error = settings(keys).err().map_or(String::new(), |error| error.to_string());
        assert!(error.contains(told), "{keys}: {error}");
    }
    // A spacing that the terrain decides.
    let text = "run.until_s = 1\nterrain.plane.extent = { length_m = 120, width_m = 60, cell_m = 1 }\n[flood]\nadaptive = { finest_m = 30 }";
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let terrain = Arc::new(Terrain::gridded(BOUNDS, 0.5, |_, _| 0.0));
    let error = VoronoiFlood::new(&scene.flood().unwrap().flood, 1, Path::new("."), terrain).err();
    assert!(error.is_some_and(|error| error.to_string().contains("flood.adaptive.finest_m is 30")));
}
