//! Lines inside the terrain at which water comes or goes as at a side.

use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Scene;
use corpuscle_terrain::{Bounds, Terrain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";

/// A flood over 66 m by 30 m of ground, between walls.
fn flood(keys: &str, seed: u64, ground: impl Fn(f64, f64) -> f64 + Sync) -> Result<VoronoiFlood, ModelError> {
    let text = format!(
        "run.until_s = 600\nterrain.plane.extent = {{ length_m = 66, width_m = 30, cell_m = 1 }}\n[flood]\nscheme = \"voronoi\"\n{WALLS}{keys}"
    );
    let mut scene = Scene::parse(&text, "test", &[]).map_err(|error| ModelError::Setup(error.to_string()))?;
    scene.resolve_defaults();
    let bounds = Bounds { x_min: 0.0, x_max: 66.0, y_min: 0.0, y_max: 30.0 };
    let terrain = Arc::new(Terrain::gridded(bounds, 0.5, ground));
    VoronoiFlood::new(&scene.flood().unwrap().flood, seed, Path::new("."), terrain)
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Rough ground with islands, a line from side to side and one that ends inside, three seeds.
#[test]
fn a_lake_at_rest_stays_at_rest_at_lines() {
    for (seed, edge) in [
        (1, "{ stage = 1.0 }"),
        (2, "\"open\""),
        (3, "{ wave = { rest_level_m = 1.0, level_m = 1.0 } }"),
        (4, "\"wall\""),
    ] {
        let keys = format!(
            "spacing_m = 1.1\nwater = [{{ level_m = 1.0 }}]\nedge_line = [{{ line = [[20.3, -1], [25.1, 14.2], [17, 31]], edge = {edge} }}, {{ line = [[40, 10], [50, 16.7]], edge = {edge} }}]"
        );
        let mut flood = flood(&keys, seed, |x, y| 0.8 * (0.9 * x).sin() * (1.3 * y).cos() + 0.3).unwrap();
        go(&mut flood, 30.0);
        let fastest = flood.wet_cells().map(|cell| cell.velocity[0].hypot(cell.velocity[1])).fold(0.0, f64::max);
        assert!(fastest < 1e-12, "{edge}: {fastest}");
        assert!(flood.wet_cells().all(|cell| (cell.level - 1.0).abs() < 1e-9));
    }
}

/// Between two lines as near to each other as the cells are wide a cell has neighbours before and behind it only, nearly in one straight line: how the water
/// changes across it is then unknown, and small waves must not grow by it. Fifty strips of all directions and widths, seeds and conditions.
#[test]
fn waves_in_narrow_strips_between_lines_do_not_grow() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for number in 0..50 {
        let mut uniform = |from: f64, to: f64| random.random_range(from..to);
        let (angle, spacing) = (uniform(-0.7, 0.7), uniform(1.0, 2.0));
        let half = 0.5 * spacing * uniform(0.4, 2.5);
        let opening = uniform(-0.3, 0.3);
        let edges = [
            "{ discharge = 0 }",
            "{ stage = 1 }",
            "\"open\"",
            "{ wave = { rest_level_m = 1, level_m = 1 } }",
            "\"wall\"",
        ];
        let edge = edges[number % edges.len()];
        let at = |along: f64, side: f64| {
            let (sin, cos) = angle.sin_cos();
            let across = side * half * (1.0 + opening * along / 40.0);
            [33.0 + along * cos - across * sin, 15.0 + along * sin + across * cos]
        };
        let lines = [[at(-60.0, 1.0), at(60.0, 1.0)], [at(60.0, -1.0), at(-60.0, -1.0)]];
        let keys = format!(
            "spacing_m = {spacing}\nmanning = 0\nwater = [{{ level_m = 1, velocity_m_per_s = [\"0.01 * sin(1.3 * x + 0.7 * y)\", \"0.01 * cos(0.4 * x - y)\"] }}]\n\
             edge_line = [{{ line = {:?}, edge = {edge} }}, {{ line = {:?}, edge = {edge} }}]",
            lines[0], lines[1]
        );
        let mut flood = flood(&keys, number as u64, |_, _| 0.0).unwrap();
        go(&mut flood, 20.0);
        let fastest = flood.wet_cells().map(|cell| cell.velocity[0].hypot(cell.velocity[1])).fold(0.0, f64::max);
        assert!(fastest < 0.015, "strip {number}, {edge}: {fastest} m/s\n{keys}");
    }
}

/// What comes in over a line is its hydrograph, all of it on the right: dry ground on the left of a line from side to side stays dry, whichever way it runs.
#[test]
fn a_discharge_comes_in_on_the_right() {
    for (seed, line, is_right) in
        [(1, "[[30, -1], [36, 31]]", true), (2, "[[36, 31], [30, -1]]", false), (3, "[[-1, 12], [67, 20]]", true)]
    {
        let keys = format!(
            "spacing_m = 1.2\nedge_line = [{{ line = {line}, edge = {{ discharge = [[0, 1], [7, 3], [9, 0]] }} }}]"
        );
        let mut flood = flood(&keys, seed, |x, y| 0.01 * x - 0.02 * y).unwrap();
        go(&mut flood, 15.0);
        let balance = flood.ledger().balances[0].clone();
        assert!((balance.inflow - (7.0 * 2.0 + 2.0 * 1.5)).abs() < 1e-11, "{balance:?}");
        assert!(balance.relative_error().abs() < 1e-13, "{balance:?}");
        let right_of = |[x, y]: [f64; 2]| {
            if seed == 3 { y < 12.0 + 8.0 / 68.0 * (x + 1.0) } else { x > 30.0 + 6.0 / 32.0 * (y + 1.0) }
        };
        let wet: Vec<_> = flood.wet_cells().collect();
        assert!(wet.len() > 30 && wet.iter().all(|cell| right_of(cell.centroid) == is_right), "{line}");
    }
}

/// A level that rises by 5 cm at a line across a tank at rest: the wave that comes in is as high as that; behind the line nothing stirs.
#[test]
fn a_level_held_at_a_line_brings_its_wave_in_full() {
    let keys = "spacing_m = 0.7\nmanning = 0\nwater = [{ level_m = 1.0 }]\n\
                edge_line = [{ line = [[15.2, -1], [15.2, 31]], edge = { stage = [[0, 1], [3, 1.05]] } }]\n\
                gauge = [{ name = \"mid\", at = [40, 15] }, { name = \"behind\", at = [8, 15] }]";
    let mut flood = flood(keys, 4, |_, _| 0.0).unwrap();
    go(&mut flood, 14.0);
    let columns = flood.gauge_columns();
    let row = flood.gauge_row();
    let level =
        |name: &str| row[columns.iter().position(|column| column.gauge == name && column.quantity == "level").unwrap()];
    assert!((level("mid") - 1.05).abs() < 5e-4, "{}", level("mid"));
    assert!((level("behind") - 1.0).abs() < 1e-12, "{}", level("behind"));
}

/// In by one line and out by another at normal depth: Manning's depth between them.
#[test]
fn normal_flow_runs_from_line_to_line() {
    let (slope, n, q) = (0.005_f64, 0.03_f64, 0.5_f64);
    let keys = format!(
        "spacing_m = 1.5\nmanning = {n}\nedge_line = [{{ line = [[5, 31], [5, -1]], edge = \"wall\" }}, {{ line = [[9.3, -1], [9.3, 31]], edge = {{ discharge = {} }} }}, \
         {{ line = [[58.1, 31], [58.1, -1]], edge = {{ normal_depth = {slope} }} }}]",
        q * 30.0
    );
    let mut flood = flood(&keys, 6, move |x, _| -slope * x).unwrap();
    go(&mut flood, 400.0);
    let depth = (q * n / slope.sqrt()).powf(0.6);
    let wet: Vec<_> = flood.wet_cells().collect();
    assert!(wet.len() > 500 && wet.iter().all(|cell| (9.0..58.5).contains(&cell.centroid[0])));
    for cell in wet.iter().filter(|cell| (16.0..52.0).contains(&cell.centroid[0])) {
        assert!((cell.depth / depth - 1.0).abs() < 0.01, "{cell:?} {depth}");
    }
}

#[test]
fn lines_that_cannot_be_are_told() {
    for (keys, told) in [
        ("spacing_m = 2\nedge_line = [{ line = [[9, 9]], edge = \"open\" }]", "flood.edge_line.0.line"),
        ("spacing_m = 2\nedge_line = [{ line = [[9, 9], [20, 9]], edge = \"periodic\" }]", "joined to nothing"),
        ("spacing_m = 2\nedge_line = [{ line = [[9, 9], [9.1, 9]], edge = { stage = 1 } }]", "cuts no cell"),
        ("spacing_m = 2\nedge_line = [{ line = [[900, 9], [910, 9]], edge = { stage = 1 } }]", "outside the terrain"),
    ] {
        let error = flood(keys, 1, |_, _| 0.0).err().map_or(String::new(), |error| error.to_string());
        assert!(error.contains(told), "{keys}: {error}");
    }
}
