//! Several processes give what one gives, bit for bit. Threads stand for processes.

mod common;

use corpuscle_flood::{Filling, LiveChange, StartWater, VoronoiFlood};
use corpuscle_model::{Frame, Ledger, Map, Model, ModelError};
use corpuscle_processes::{Processes, on_threads};
use corpuscle_scene::FloodScene;
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A river from an inflow down a valley, with a held level, structures, rain and infiltration.
const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }

[flood]
spacing_m = 2
edges = { west = "wall", south = "wall", north = { stage = 7 } }
water = [{ depth_m = 0.5, polygon = [[100, 80], [200, 80], [200, 120], [100, 120]] }]
finer = [{ line = [[150, 100], [150, 40]], within_m = 6, spacing_m = 1 }]
rain.intensity_mm_per_h = 90
infiltration.horton = { first_mm_per_h = 40, last_mm_per_h = 5, decay_per_h = 3 }

[[flood.inflow]]
name = "river"
at = [40, 100]
discharge_m3_per_s = [[0, 20], [60, 60]]

[[flood.outflow]]
name = "drain"
at = [250, 100]
rating = [[0, 0], [20, 30]]

[[flood.link]]
name = "pipe"
from = [150, 100]
to = [150, 40]
law = { culvert = { diameter_m = 0.8 } }

[[flood.gauge]]
name = "here"
at = [160, 100]

[[flood.section]]
name = "across"
line = [[180, 20], [180, 180]]
"#;

/// A dam breaks above a town with roofs under rain and a wall that is overtopped.
const TOWN: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 200, width_m = 120, cell_m = 2 }, slope_east = -0.01 }

[flood]
spacing_m = 1.2
manning = 0.03
edges = { west = "wall", south = "wall", north = "wall" }
water = [{ level_m = 2.5, polygon = [[0, 0], [50, 0], [50, 120], [0, 120]] }]
rain.intensity_mm_per_h = 200
obstacle = [
    { name = "a", polygon = [[80, 20], [110, 25], [105, 60], [78, 50]], height_m = 8 },
    { name = "b", polygon = [[90, 70], [120, 75], [118, 100], [88, 95]] },
    { name = "levee", line = [[60, 1], [62.3, 64], [61, 119]], crest_m = 1.1 },
]

[[flood.section]]
name = "below"
line = [[150, 0], [150, 120]]
"#;

/// Waves round joined sides.
const JOINED: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 0.9
water = [{ level_m = "1.2 + 0.4 * exp(-((x - 3)^2 + (y - 78)^2) / 50)", velocity_m_per_s = [1, 0.5] }]
edges = { west = "periodic", east = "periodic", south = "periodic", north = "periodic" }
"#;

/// Water that comes in by a discharge and leaves by a rating and at normal depth, over a bumpy slope whose cells store by level.
const SLOPE: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 0.9
storage = "level-volume"
edges = { west = { discharge = 30 }, east = { rating = [[-5, 0], [0, 0], [2, 20]] }, south = { normal_depth = 0.01 }, north = "wall" }
"#;

/// A thin sheet that drains from steep bumps: cells lack the water for their outflow.
const THIN: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 0.7
manning = 0
water = [{ depth_m = "0.03 + 0.03 * sin(1.7 * x) * sin(1.3 * y)" }]
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
"#;

/// A dam breaks over bumps, with cells that follow the front, and water falls onto dry and wet ground.
const ADAPTIVE: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 1.5
adaptive = { finest_m = 0.75, every_steps = 8 }
edges = { west = "wall", east = "open", south = "wall", north = { stage = -0.5 } }
rain.intensity_mm_per_h = 100
infiltration.horton = { first_mm_per_h = 40, last_mm_per_h = 5, decay_per_h = 3 }

[[flood.water]]
level_m = 1.5
polygon = [[0, 0], [40, 0], [40, 80], [0, 80]]

[[flood.water]]
block = { from = [30, 20], to = [70, 60], height_m = 3, layers = 2 }
"#;

/// Waves over bumps, where cells beside finer ones take longer steps than these.
const LOCAL: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 1.3
time_steps = "local"
rain.intensity_mm_per_h = 200
water = [{ level_m = "1 + 0.3 * exp(-((x - 50)^2 + (y - 40)^2) / 100)" }]
finer = [{ polygon = [[40, 30], [60, 35], [55, 50]], within_m = 1, spacing_m = 0.3 }]
edges = { west = "wall", east = "open", south = "wall", north = { stage = 1 } }
"#;

/// Local time steps where the water moves from one process to others, for more steps than lie between two checks of the load.
const DRAINING: &str = r#"
run.until_s = 60
terrain.plane.extent = { length_m = 100, width_m = 80, cell_m = 1 }

[flood]
spacing_m = 1.5
time_steps = "local"
infiltration.horton = { first_mm_per_h = 40, last_mm_per_h = 5, decay_per_h = 3 }
water = [{ level_m = 1.5, polygon = [[0, 0], [30, 0], [30, 80], [0, 80]] }]
finer = [{ polygon = [[40, 30], [60, 35], [55, 50]], within_m = 1, spacing_m = 0.4 }]
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
"#;

fn steep(x: f64, y: f64) -> f64 {
    2.0 * (0.9 * x).sin() * (0.7 * y).cos() - 0.2 * x
}

fn bumps(x: f64, y: f64) -> f64 {
    0.3 * (0.21 * x).sin() * (0.17 * y).cos() - 0.01 * x
}

fn scene(text: &str) -> (FloodScene, Arc<Terrain>) {
    let scene = common::scene(text);
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 80.0 };
    let terrain = match text {
        THIN => Arc::new(Terrain::gridded(bounds, 0.5, steep)),
        JOINED | SLOPE | ADAPTIVE | LOCAL | DRAINING => Arc::new(Terrain::gridded(bounds, 0.5, bumps)),
        _ => common::terrain(&scene),
    };
    (scene, terrain)
}

/// All that is seen of a flood.
#[derive(Debug, PartialEq)]
struct Seen {
    frames: Vec<Frame>,
    rows: Vec<Vec<u64>>,
    maps: Vec<(&'static str, Vec<u32>)>,
    ledger: Ledger,
    particles: usize,
    particle_steps: u64,
    warnings: Vec<String>,
    states: Vec<Vec<u8>>,
}

fn look(flood: &mut VoronoiFlood, times: &[f64]) -> Seen {
    let (mut frames, mut rows, mut states) = (Vec::new(), Vec::new(), Vec::new());
    for time in times {
        flood.advance_to(*time, &AtomicBool::new(false)).unwrap();
        frames.push(flood.frame());
        rows.push(flood.gauge_row().into_iter().map(f64::to_bits).collect());
        states.push(flood.save());
    }
    let bits = |map: Map| (map.name, map.values.into_iter().map(f32::to_bits).collect());
    Seen {
        frames,
        rows,
        maps: flood.maps().into_iter().map(bits).collect(),
        ledger: flood.ledger(),
        particles: flood.particles(),
        particle_steps: flood.particle_steps(),
        warnings: flood.warnings(),
        states,
    }
}

/// What the first of some processes, each with some threads, makes of a flood that each opens; the others follow.
fn on_opened<T: Send>(
    processes: usize,
    threads_each: usize,
    open: impl Fn(&Processes) -> Result<VoronoiFlood, ModelError> + Sync,
    first: impl Fn(Result<VoronoiFlood, ModelError>) -> T + Sync,
) -> T {
    let run = |process: Processes| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads_each).build().unwrap();
        pool.install(|| {
            let opened = open(&process);
            if process.is_first() {
                return Some(first(opened));
            }
            if let Ok(mut flood) = opened {
                process.follow(&mut flood);
            }
            None
        })
    };
    on_threads(processes, run).unwrap()
}

/// The same for the flood of a scene.
fn on<T: Send>(
    processes: usize,
    threads_each: usize,
    text: &str,
    first: impl Fn(Result<VoronoiFlood, ModelError>) -> T + Sync,
) -> T {
    let open = |processes: &Processes| {
        let (scene, terrain) = scene(text);
        VoronoiFlood::new_on(processes, &scene.flood, 1, Path::new("."), terrain)
    };
    on_opened(processes, threads_each, open, first)
}

fn alone(text: &str, times: &[f64]) -> Seen {
    on(1, 2, text, |flood| look(&mut flood.unwrap(), times))
}

/// Compares what some processes make of a flood with what one does, part by part.
fn compare(text: &str, times: &[f64], counts: &[usize]) {
    let one = alone(text, times);
    assert!(
        one.frames.iter().all(|frame| frame.sets[0].id.len() > 300) && one.ledger.balances[0].relative_error() < 1e-12
    );
    for (number, count) in counts.iter().enumerate() {
        let several = on(*count, 1 + number % 2, text, |flood| look(&mut flood.unwrap(), times));
        assert_eq!(several.particle_steps, one.particle_steps, "{count} processes");
        for (k, frame) in one.frames.iter().enumerate() {
            assert!(several.frames[k] == *frame, "frame {k} of {count} processes");
        }
        assert_eq!(several.rows, one.rows, "{count} processes");
        assert!(several.maps == one.maps, "maps of {count} processes");
        assert_eq!(several.ledger, one.ledger, "{count} processes");
        assert!(several == one, "{count} processes");
    }
}

#[test]
fn a_river_has_the_same_bits() {
    compare(RIVER, &[4.0, 12.3], &[2, 3, 4]);
}

#[test]
fn a_town_has_the_same_bits() {
    compare(TOWN, &[1.0, 8.0], &[2, 3]);
}

#[test]
fn joined_sides_have_the_same_bits() {
    compare(JOINED, &[5.0], &[2, 4]);
}

#[test]
fn a_slope_has_the_same_bits() {
    compare(SLOPE, &[3.0, 9.0], &[2, 3]);
}

#[test]
fn a_sheet_that_drains_has_the_same_bits() {
    compare(THIN, &[1.0, 4.0], &[2, 3, 4]);
}

#[test]
fn cells_that_follow_the_water_have_the_same_bits() {
    let refined = on(3, 1, ADAPTIVE, |flood| {
        let mut flood = flood.unwrap();
        flood.advance_to(3.0, &AtomicBool::new(false)).unwrap();
        flood.remakes()
    });
    assert!(refined > 2, "{refined}");
    compare(ADAPTIVE, &[0.5, 3.0], &[2, 3, 4]);
}

#[test]
fn local_time_steps_have_the_same_bits() {
    compare(LOCAL, &[2.0, 5.0], &[2, 3, 4]);
    let steps = on(1, 2, DRAINING, |flood| {
        let mut flood = flood.unwrap();
        flood.advance_to(12.0, &AtomicBool::new(false)).unwrap();
        flood.steps()
    });
    assert!(steps > 64, "{steps}");
    compare(DRAINING, &[6.0, 12.0], &[3]);
}

/// Processes without any cells take part too.
#[test]
fn more_processes_than_tiles_have_the_same_bits() {
    for steps in ["global", "local"] {
        let text = LOCAL.replace("length_m = 100, width_m = 80", "length_m = 40, width_m = 30");
        let text =
            text.replace("x - 50", "x - 20").replace("y - 40", "y - 15").replace("\"local\"", &format!("\"{steps}\""));
        let text = text.replace("[[40, 30], [60, 35], [55, 50]]", "[[15, 10], [22, 12], [20, 20]]");
        compare(&text, &[1.0, 2.0], &[3, 5]);
    }
}

/// Saved by three, restored by two and by one, which go on to what one process makes of it.
#[test]
fn a_state_is_restored_by_another_number_of_processes() {
    for (text, times) in [(RIVER, [4.0, 8.0]), (ADAPTIVE, [0.7, 1.5]), (DRAINING, [2.0, 4.0])] {
        let one = alone(text, &times);
        let saved = on(3, 1, text, |flood| look(&mut flood.unwrap(), &times[..1]).states.remove(0));
        assert!(saved == one.states[0]);
        for count in [1, 2, 4] {
            let resumed = on(count, 1, text, |flood| {
                let mut flood = flood.unwrap();
                flood.restore(&saved).unwrap();
                assert!(flood.save() == saved, "{count} processes");
                look(&mut flood, &times[1..])
            });
            assert!(resumed.states[0] == one.states[1], "{count} processes");
            assert!(resumed.frames[0] == one.frames[1] && resumed.rows[0] == one.rows[1] && resumed.maps == one.maps);
        }
    }
}

/// A damaged state is refused by all, and so are changes while it runs.
#[test]
fn what_cannot_be_is_refused() {
    let error = on(3, 1, RIVER, |flood| flood.unwrap().restore(&[1, 2, 3]).unwrap_err().to_string());
    assert!(error.contains("damaged"), "{error}");
    let error = on(2, 1, RIVER, |flood| flood.unwrap().change(LiveChange::Rain(10.0)).unwrap_err().to_string());
    assert!(error.contains("several processes"), "{error}");
}

/// Water so fast in one position that its square is no number: all end with the same error, and show the water as it was before.
#[test]
fn a_breakdown_in_one_process_ends_all() {
    let broken = |count: usize| {
        let open = |processes: &Processes| {
            let (scene, terrain) = scene(JOINED);
            let water = StartWater {
                filling: Filling::Depth(Box::new(|_, _| 1.0)),
                polygon: None,
                velocity: Box::new(|x, y| [if (x - 80.0).hypot(y - 20.0) < 2.0 { 1e200 } else { 0.0 }, 0.0]),
            };
            VoronoiFlood::with_water_on(processes, &scene.flood, 1, Path::new("."), terrain, &[water])
        };
        on_opened(count, 1, open, |flood| {
            let mut flood = flood.unwrap();
            let error = flood.advance_to(5.0, &AtomicBool::new(false)).unwrap_err().to_string();
            (error, flood.frame(), flood.gauge_row().len())
        })
    };
    let one = broken(1);
    assert!(one.0.contains("no longer a number") && !one.1.sets[0].id.is_empty(), "{}", one.0);
    for count in [2, 4] {
        assert!(broken(count) == one, "{count} processes");
    }
}
