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

/// Rough ground, its highest positions above 2 m.
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
    let mut steps = Vec::new();
    for time_steps in ["global", "local"] {
        let keys = format!("manning = 0\ntime_steps = \"{time_steps}\"\n{BY_HAND}{JOINED}");
        let level = |x: f64, y: f64| 1.0 + 0.2 * (PI * x / 15.0).sin() * (PI * y / 10.0).cos();
        let mut flood = flood(&keys, 3, |_, _| 0.0, level, [0.7, -0.4]);
        let (volume_before, (before, _)) = (volume(&flood), momentum(&flood));
        for round in 1..=12 {
            // A round part that goes along a line over a corner.
            let at = 5.0 * f64::from(round);
            let away = |x: f64, size: f64| (x - at + 1.5 * size).rem_euclid(size) - 0.5 * size;
            flood.remake_cells(|x, y| if away(x, 120.0).hypot(away(y, 60.0)) < 4.0 { 2 } else { 0 }).unwrap();
            go(&mut flood, 0.5 * f64::from(round));
        }
        steps.push(flood.steps());
        let (after, all) = momentum(&flood);
        let off = (0..2).map(|axis| (after[axis] - before[axis]).abs() / all).fold(0.0, f64::max);
        println!("{off:e} {:e}", volume(&flood) / volume_before - 1.0);
        assert!(all > 1000.0 && off < 1e-12, "{off:e} of {all}");
        assert!((volume(&flood) / volume_before - 1.0).abs() < 1e-13);
        assert!(flood.ledger().balances.iter().all(|balance| balance.relative_error().abs() < 1e-12));
    }
    assert!(2 * steps[1] < steps[0], "{steps:?}");
}

/// Root of the mean square of the speed, by volume, m/s.
fn rms(flood: &VoronoiFlood) -> f64 {
    let squared = |[u, v]: [f64; 2]| u * u + v * v;
    let sum: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth * squared(cell.velocity)).sum();
    (sum / volume(flood)).sqrt()
}

/// A lake with islands. A cell at the shore that is split or merged stirs the water: where its ground counts as level it has a mean depth to hand out, which is
/// not that of its parts. Volume is kept, and the lake calms down.
#[test]
fn shores_are_stirred_while_cells_are_made_anew() {
    for (storage, most_stirred, most_later) in [("mean", 0.12, 0.02), ("level-volume", 0.005, 1e-3)] {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let keys = format!("manning = 0.03\nstorage = \"{storage}\"\n{BY_HAND}{WALLS}");
        let mut flood = flood(&keys, 1, rough(1, 3.0), |_, _| 2.0, [0.0; 2]);
        let before = volume(&flood);
        let mut stirred = 0.0_f64;
        for round in 1..=4 {
            flood.remake_cells(anywhere(&mut random)).unwrap();
            go(&mut flood, 2.0 * f64::from(round));
            stirred = stirred.max(rms(&flood));
        }
        go(&mut flood, 40.0);
        println!("{storage}: {stirred} {}", rms(&flood));
        assert!((volume(&flood) / before - 1.0).abs() < 1e-13);
        assert!(stirred < most_stirred && rms(&flood) < most_later, "{storage}: {stirred} {}", rms(&flood));
    }
}

/// The same lake with cells that follow the water: finer at its shores from the start on, and at rest.
#[test]
fn a_lake_with_islands_is_finer_at_its_shores_and_stays_at_rest() {
    let keys = format!("manning = 0\nadaptive = {{ finest_m = 0.4, rise_over_depth = 2 }}\n{WALLS}");
    let hills = |x: f64, y: f64| 1.4 + 1.4 * (x / 18.0).sin() * (y / 14.0).cos() + 0.03 * (1.3 * x + y).sin();
    let mut flood = flood(&keys, 1, hills, |_, _| 2.0, [0.0; 2]);
    let sizes = |flood: &VoronoiFlood| flood.wet_cells().map(|cell| (cell.area.sqrt(), cell.depth)).collect::<Vec<_>>();
    let cells = sizes(&flood);
    let shallow: Vec<f64> = cells.iter().filter(|(_, depth)| *depth < 0.05).map(|(size, _)| *size).collect();
    let fine = shallow.iter().filter(|size| **size < 0.6).count();
    let coarse = cells.iter().filter(|(size, depth)| *size > 1.2 && *depth > 0.5).count();
    // All but a few where the ground is nearly level.
    assert!(fine > 100 && 20 * (shallow.len() - fine) < fine && coarse > 30, "{fine} of {}, {coarse}", shallow.len());
    go(&mut flood, 5.0);
    assert!(flood.steps() > 50 && flood.remakes() == 0, "{} {}", flood.steps(), flood.remakes());
    assert!(flood.wet_cells().all(|cell| (cell.level - 2.0).abs() < 1e-10));
    assert!(flood.wet_cells().all(|cell| cell.velocity[0].hypot(cell.velocity[1]) < 1e-10));
}

/// Water that stands level at open sides stays so: what is known beyond them goes along with their faces.
#[test]
fn still_water_at_open_sides_stays_still() {
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut flood = flood(&format!("manning = 0\n{BY_HAND}"), 8, rough(8, 1.5), |_, _| 2.0, [0.0; 2]);
    for round in 1..=4 {
        flood.remake_cells(anywhere(&mut random)).unwrap();
        flood.remake_cells(|x, _| u8::from(x < 10.0 * f64::from(round))).unwrap();
        go(&mut flood, f64::from(round));
    }
    assert!(flood.wet_cells().all(|cell| (cell.level - 2.0).abs() < 1e-9));
}

/// What soaked in stays where it is, and the maps of maxima are nearly those of cells that stay.
#[test]
fn what_is_known_of_cells_goes_along() {
    let keys = format!("manning = 0.03\n{BY_HAND}{WALLS}[flood.infiltration.constant]\nrate_mm_per_h = 2000\n");
    let run = |remakes: bool| {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let mut flood = flood(&keys, 9, beach, pool, [0.0; 2]);
        for second in 1..=6 {
            go(&mut flood, f64::from(second));
            if remakes {
                flood.remake_cells(anywhere(&mut random)).unwrap();
            }
        }
        flood.remake_cells(|_, _| 0).unwrap();
        flood
    };
    let map = |flood: &VoronoiFlood, name: &str| flood.maps().into_iter().find(|map| map.name == name).unwrap().values;
    let wet = |values: &[f32]| {
        values.iter().filter(|value| !value.is_nan()).map(|value| f64::from(*value)).collect::<Vec<_>>()
    };
    let [stayed, remade] = [false, true].map(run);
    for (name, most) in [
        ("max_depth", 0.02),
        ("max_speed", 0.06),
        ("arrival_s", 0.02),
        ("duration_s", 0.02),
        ("hazard", 0.06),
        ("infiltration", 0.02),
    ] {
        let [a, b] = [&stayed, &remade].map(|flood| map(flood, name));
        let both = a.iter().zip(&b).filter(|(a, b)| !a.is_nan() && !b.is_nan());
        let off: f64 = both.clone().map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
            / both.map(|(a, _)| f64::from(a.abs())).sum::<f64>();
        println!("{name}: {off}, {} of {}", wet(&b).len(), wet(&a).len());
        assert!(off < most, "{name}: {off}");
        assert!((wet(&b).len() as f64 / wet(&a).len() as f64 - 1.0).abs() < 0.02);
    }
    // All of what soaked in, with no step between.
    let mut remade = remade;
    let soaked = |flood: &VoronoiFlood| wet(&map(flood, "infiltration")).iter().sum::<f64>();
    let before = soaked(&remade);
    remade.remake_cells(|x, y| u8::from((x - 40.0).hypot(y - 30.0) < 20.0)).unwrap();
    assert!(before > 1.0 && (soaked(&remade) / before - 1.0).abs() < 2e-3, "{} {before}", soaked(&remade));
}

/// A dam breaks at the foot of a rough beach.
fn beach(x: f64, y: f64) -> f64 {
    0.04 * x + 0.02 * (0.8 * x).sin() * (0.7 * y).cos()
}

fn pool(x: f64, _: f64) -> f64 {
    if x < 40.0 { 3.5 } else { -10.0 }
}

const FOLLOWS: &str = "manning = 0.03\nadaptive = { finest_m = 0.4 }\n";

/// There are finer cells at the front of the water, the finest before it too, and none where it was some seconds ago.
#[test]
fn finer_cells_follow_a_front() {
    let mut flood = flood(&format!("{FOLLOWS}{WALLS}"), 5, beach, pool, [0.0; 2]);
    for second in 0..=9 {
        go(&mut flood, f64::from(second));
        let wet = || flood.wet_cells().filter(|cell| cell.depth > 0.01);
        let front = wet().map(|cell| cell.centroid[0]).fold(0.0, f64::max);
        let size = |from: f64, to: f64| {
            let within = wet().filter(|cell| (from..to).contains(&cell.centroid[0])).map(|cell| cell.area.sqrt());
            within.fold([f64::MAX, 0.0_f64], |[least, most], size| [least.min(size), most.max(size)])
        };
        if second > 0 {
            let widest = size(front - 2.0, 120.0)[1];
            assert!(widest < 0.55, "{second} s: {widest} m wide at the front, {front} m");
        }
        if second > 4 {
            let finest = size(0.0, front - 20.0)[0];
            assert!(finest > 1.0, "{second} s: {finest} m behind the front, {front} m");
        }
    }
    assert!((3..30).contains(&flood.remakes()), "{}", flood.remakes());
    for balance in flood.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-12, "{balance:?}");
    }
}

/// Water that spreads over level ground has finer cells at its end where fronts are asked for.
#[test]
fn fronts_over_level_ground_are_finer_where_asked() {
    let run = |fronts: bool| {
        let keys = format!("manning = 0.03\nadaptive = {{ finest_m = 0.4, fronts = {fronts} }}\n{WALLS}");
        let mut flood = flood(&keys, 5, |_, _| 0.0, |x, _| if x < 40.0 { 1.5 } else { -1.0 }, [0.0; 2]);
        go(&mut flood, 3.0);
        let front =
            flood.wet_cells().filter(|cell| cell.depth > 0.01).max_by(|a, b| a.centroid[0].total_cmp(&b.centroid[0]));
        front.unwrap().area.sqrt()
    };
    assert!(run(false) > 1.2 && run(true) < 0.55);
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
                go(&mut model, 4.0);
                assert!(model.remakes() > 1, "{}", model.remakes());
                assert!(model.ledger().balances[0].relative_error().abs() < 1e-12, "{:?}", model.ledger());
                model.save()
            })
        };
        let plain = run(1, &[]);
        assert!(plain == run(3, &[]), "{time_steps}");
        assert!(plain == run(2, &[1.3, 2.9]), "{time_steps}");
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
        ("scheme = \"sph-swe\"\nadaptive = { finest_m = 0.4 }", "is for scheme = \"voronoi\""),
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

/// What comes in by an inflow comes in at its position, and what a held level takes goes from its own, whatever becomes of the cells.
#[test]
fn inflows_and_held_levels_keep_their_positions() {
    let keys = format!(
        "{BY_HAND}{WALLS}[[flood.inflow]]\nname = \"spring\"\nat = [70, 40]\ndischarge_m3_per_s = 1\n\
         [[flood.stage]]\nname = \"lake\"\npolygon = [[10, 10], [22, 10], [22, 22], [10, 22]]\nlevel_m = 0.5\n"
    );
    let mut flood = flood(&keys, 6, |_, _| 0.0, |_, _| -1.0, [0.0; 2]);
    for (half, level) in [2, 1, 0, 2].into_iter().enumerate() {
        flood.remake_cells(move |x, y| if x < 20.0 || y > 38.0 { level } else { 0 }).unwrap();
        go(&mut flood, 0.5 * (half + 1) as f64);
    }
    let beside = |at: [f64; 2], reach: f64| move |[x, y]: [f64; 2]| (x - at[0]).hypot(y - at[1]) < reach;
    let [spring, lake] = [beside([70.0, 40.0], 15.0), beside([16.0, 16.0], 25.0)];
    let of = |is_in: &dyn Fn([f64; 2]) -> bool| {
        flood.wet_cells().filter(|cell| is_in(cell.centroid)).map(|cell| cell.area * cell.depth).sum::<f64>()
    };
    assert!((of(&spring) - 2.0).abs() < 0.1 && of(&lake) > 70.0, "{} {}", of(&spring), of(&lake));
    assert!((of(&|at| !spring(at) && !lake(at))).abs() < 1e-9);
    assert!(flood.sample(16.0, 16.0).depth > 0.45);
}
