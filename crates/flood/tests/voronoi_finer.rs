//! Finer cells in parts of the terrain change no promise of scheme voronoi, and what they are finer for.

use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Scene;
use corpuscle_terrain::{Bounds, Terrain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const BOUNDS: Bounds = Bounds { x_min: 0.0, x_max: 60.0, y_min: 0.0, y_max: 36.0 };
const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";
const JOINED: &str =
    "edges = { west = \"periodic\", east = \"periodic\", south = \"periodic\", north = \"periodic\" }\n";

/// A flood over [`BOUNDS`] without friction.
fn flood(
    keys: &str,
    seed: u64,
    ground: impl Fn(f64, f64) -> f64 + Sync,
    level: impl Fn(f64, f64) -> f64 + Send + Sync + 'static,
) -> Result<VoronoiFlood, ModelError> {
    let text = format!(
        "run.until_s = 100\nterrain.plane.extent = {{ length_m = 60, width_m = 36, cell_m = 1 }}\n[flood]\nscheme = \"voronoi\"\nmanning = 0\n{keys}"
    );
    let mut scene = Scene::parse(&text, "test", &[]).map_err(|error| ModelError::Setup(error.to_string()))?;
    scene.resolve_defaults();
    let terrain = Arc::new(Terrain::gridded(BOUNDS, 0.5, ground));
    let water =
        StartWater { filling: Filling::Level(Box::new(level)), polygon: None, velocity: Box::new(|_, _| [0.0; 2]) };
    VoronoiFlood::with_water(&scene.flood().unwrap().flood, seed, Path::new("."), terrain, &[water])
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Parts anywhere: a circle, a line, the ground along a building and a wall of no thickness.
fn parts(random: &mut ChaCha8Rng) -> String {
    let mut position = || [random.random_range(0.0..60.0), random.random_range(0.0..36.0)];
    let [centre, from, to, wall, building] = [(); 5].map(|()| position());
    let [x, y] = building.map(|x: f64| x.min(30.0));
    format!(
        "[[flood.obstacle]]\nname = \"house\"\npolygon = [[{x}, {y}], [{}, {}], [{}, {}]]\n\
         [[flood.obstacle]]\nname = \"wall\"\nline = [{wall:?}, {to:?}]\n\
         [[flood.finer]]\nspacing_m = 0.4\ncircle = {{ centre = {centre:?}, radius_m = 4 }}\n\
         [[flood.finer]]\nspacing_m = 0.8\nline = [{from:?}, {to:?}]\nwithin_m = 2\n\
         [[flood.finer]]\nspacing_m = 0.2\nwalls = true\nwithin_m = 0.3\n",
        x + 7.1,
        y + 1.3,
        x + 2.2,
        y + 5.9
    )
}

/// Rough ground with islands, three seeds: all ground is covered, and a lake stays as it is.
#[test]
fn a_lake_over_cells_of_five_sizes_stays_at_rest() {
    for seed in 1..=3 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let heights: Vec<f64> = (0..61 * 37).map(|_| random.random_range(0.0..2.3)).collect();
        let ground = move |x: f64, y: f64| heights[(y as usize).min(36) * 61 + (x as usize).min(60)];
        let keys = format!("spacing_m = 1.6\n{WALLS}{}", parts(&mut random));
        let mut flood = flood(&keys, seed, ground, |_, _| 2.0).unwrap();
        let house = 0.5 * (7.1 * 5.9 - 1.3 * 2.2);
        let size: Vec<f64> = flood.wet_cells().map(|cell| cell.area.sqrt()).collect();
        assert!(size.iter().any(|size| *size < 0.25) && size.iter().any(|size| *size > 1.4), "{}", size.len());
        let dry = 60.0 * 36.0 - house - flood.wet_cells().map(|cell| cell.area).sum::<f64>();
        assert!((0.0..200.0).contains(&dry), "{dry}");
        go(&mut flood, 10.0);
        let fastest = flood.wet_cells().map(|cell| cell.velocity[0].hypot(cell.velocity[1])).fold(0.0, f64::max);
        assert!(flood.steps() > 200 && fastest < 1e-10, "{} {fastest:e} m/s", flood.steps());
        assert!(flood.wet_cells().all(|cell| (cell.level - 2.0).abs() < 1e-10));
    }
}

/// A flat box with joined sides, and a part that lies across them: waves keep water and momentum to rounding.
#[test]
fn water_and_momentum_are_kept_across_sizes() {
    let keys = format!(
        "spacing_m = 1.6\n{JOINED}[[flood.finer]]\nspacing_m = 0.4\ncircle = {{ centre = [58, 2], radius_m = 6 }}\n"
    );
    let level = |x: f64, y: f64| 1.0 + 0.2 * (PI * x / 15.0).sin() * (PI * y / 9.0).cos();
    let mut flood = flood(&keys, 7, |_, _| 0.0, level).unwrap();
    go(&mut flood, 30.0);
    let ledger = flood.ledger();
    assert!(ledger.balances[0].relative_error().abs() < 1e-13, "{:?}", ledger.balances[0]);
    let sum = |axis: usize| flood.wet_cells().map(|cell| cell.area * cell.depth * cell.velocity[axis]).sum::<f64>();
    let all: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth * cell.velocity[0].abs()).sum();
    assert!(all > 10.0 && (0..2).all(|axis| sum(axis).abs() < 1e-12 * all), "{} {} of {all}", sum(0), sum(1));
}

/// A standing wave in a tank, of which a part has finer cells: there it is nearer to what cells as fine everywhere give, and no farther elsewhere.
#[test]
fn finer_cells_make_a_wave_better() {
    let level = |x: f64, _: f64| 1.0 + 0.02 * (PI * x / 6.0).cos();
    let run = |keys: &str| {
        let mut flood = flood(&format!("{WALLS}{keys}"), 3, |_, _| 0.0, level).unwrap();
        go(&mut flood, 8.0);
        flood
    };
    let [coarse, fine] = ["spacing_m = 1.2", "spacing_m = 0.3"].map(run);
    let graded =
        run("spacing_m = 1.2\nfiner = [{ spacing_m = 0.3, polygon = [[24, -1], [61, -1], [61, 37], [24, 37]] }]");
    let error = |of: &VoronoiFlood, [from, to]: [f64; 2]| {
        let positions = (0..400).map(|k| (from + (k % 20) as f64 / 20.0 * (to - from), 3.0 + (k / 20) as f64 * 1.5));
        (positions.map(|(x, y)| (of.sample(x, y).depth - fine.sample(x, y).depth).powi(2)).sum::<f64>() / 400.0).sqrt()
    };
    let [inside, outside] = [[45.0, 58.0], [2.0, 14.0]];
    let [coarse_inside, coarse_outside] = [inside, outside].map(|part| error(&coarse, part));
    let [graded_inside, graded_outside] = [inside, outside].map(|part| error(&graded, part));
    assert!(graded_inside < 0.2 * coarse_inside, "{graded_inside} {coarse_inside}");
    assert!(graded_outside < 1.1 * coarse_outside, "{graded_outside} {coarse_outside}");
}

/// A billion cells are refused before they are made.
#[test]
fn too_many_cells_are_told() {
    let text = "run.until_s = 1\nterrain.plane.extent = { length_m = 1e5, width_m = 1e5, cell_m = 500 }\n[flood]\nscheme = \"voronoi\"\nspacing_m = 100\n\
                water = [{ depth_m = 1 }]\nfiner = [{ spacing_m = 2, circle = { centre = [5e4, 5e4], radius_m = 4e4 } }]";
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    let error = VoronoiFlood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain))
        .err()
        .map_or(String::new(), |e| e.to_string());
    assert!(error.contains("more than the 1e8 that fit in memory") && error.contains("particles"), "{error}");
}

#[test]
fn what_cannot_be_finer_is_told() {
    for (keys, told) in [
        ("spacing_m = 2\nfiner = [{ spacing_m = 3, walls = true, within_m = 1 }]", "no [[flood.obstacle]]"),
        (
            "spacing_m = 2\nfiner = [{ spacing_m = 3, line = [[1, 1], [9, 9]], within_m = 1 }]",
            "smaller than flood.spacing_m = 2",
        ),
        ("spacing_m = 2\nfiner = [{ spacing_m = 1, line = [[1, 1], [9, 9]] }]", "flood.finer.0.within_m"),
        ("spacing_m = 2\nfiner = [{ spacing_m = 1, within_m = 5 }]", "exactly one of"),
        ("spacing_m = 200\nfiner = [{ spacing_m = 1, polygon = [[1, 1], [9, 9], [1, 9]] }]", "64 times"),
        ("finer = [{ spacing_m = 90, polygon = [[1, 1], [9, 9], [1, 9]] }]", "flood.finer.0.spacing_m is 90"),
        ("spacing_m = 2\nfiner = [{ spacing_m = 1, file = \"none.geojson\" }]", "none.geojson"),
    ] {
        let error = flood(keys, 1, |_, _| 0.0, |_, _| 1.0).err().map_or(String::new(), |error| error.to_string());
        assert!(error.contains(told), "{keys}: {error}");
    }
}
