//! Live changes of a flood.

mod common;

use corpuscle_flood::{FloodModel, LiveChange, SphSweFlood, VoronoiFlood};
use corpuscle_model::Model;
use std::sync::atomic::AtomicBool;

const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }

[flood]
scheme = "sph-swe"
spacing_m = 6
spacing_depth_m = 1
edges = { west = "wall", south = "wall", north = "wall" }

[[flood.water]]
depth_m = 0.5
polygon = [[100, 80], [200, 80], [200, 120], [100, 120]]

[[flood.inflow]]
name = "river"
at = [40, 100]
discharge_m3_per_s = 40

[[flood.inflow]]
name = "brook"
at = [60, 120]
discharge_m3_per_s = [[0, 0], [100, 40]]
"#;

/// A pool of 60 m by 30 m with walls round it.
const POOL: &str = r#"
run.until_s = 200
terrain.plane = { extent = { length_m = 60, width_m = 30, cell_m = 2 } }
[flood]
spacing_m = 2
manning = 0.1
water = [{ depth_m = 1 }]
edges = { west = "wall", south = "wall", north = "wall", east = "wall" }
"#;

fn open(text: &str, settings: &[(&str, &str)]) -> SphSweFlood {
    common::sph_swe(&common::scene_with(text, settings))
}

/// A flood of scheme voronoi.
fn open_cells(text: &str, settings: &[(&str, &str)]) -> VoronoiFlood {
    common::voronoi(&common::scene_with(text, settings))
}

fn go(flood: &mut dyn FloodModel, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// What came in so far, m3; the ledger must balance.
fn came(flood: &dyn FloodModel) -> f64 {
    let water = &flood.ledger().balances[0];
    assert!(water.relative_error().abs() < 1e-12, "{water:?}");
    water.inflow
}

#[test]
fn twice_the_discharge_brings_twice_the_water() {
    let mut flood = open(RIVER, &[("flood.inflow.1.discharge_m3_per_s", "0.0")]);
    go(&mut flood, 20.0);
    let first = came(&flood);
    assert!((first / 800.0 - 1.0).abs() < 0.1, "{first}");
    LiveChange::Discharge { inflow: 0, discharge: 80.0 }.change(&mut flood).unwrap();
    go(&mut flood, 40.0);
    let second = came(&flood) - first;
    assert!((second / 1600.0 - 1.0).abs() < 0.05, "{second}");
    LiveChange::Discharge { inflow: 0, discharge: 0.0 }.change(&mut flood).unwrap();
    let until_now = came(&flood);
    go(&mut flood, 60.0);
    // The residual volume, less than a particle of 36 m3, stays.
    assert_eq!(came(&flood), until_now);
}

#[test]
fn a_discharge_over_time_is_multiplied_now_and_later() {
    let brook = |times: &[f64]| {
        let mut flood = open(RIVER, &[("flood.inflow.0.discharge_m3_per_s", "0.0")]);
        go(&mut flood, 20.0);
        for &times in times {
            LiveChange::DischargeTimes { inflow: 1, times }.change(&mut flood).unwrap();
        }
        let before = came(&flood);
        go(&mut flood, 60.0);
        came(&flood) - before
    };
    // From 20 to 60 s by 0.4 m3/s each second: 640 m3.
    let (once, thrice) = (brook(&[]), brook(&[9.0, 3.0]));
    assert!((once - 640.0).abs() < 36.0 && (thrice - 1920.0).abs() < 36.0, "{once} {thrice}");
}

#[test]
fn it_rains_where_the_scene_has_no_rain() {
    for spacing in ["2.0", "4.0"] {
        let mut flood = open_cells(POOL, &[("flood.spacing_m", spacing)]);
        go(&mut flood, 10.0);
        let columns = flood.gauge_columns().len();
        LiveChange::Rain(360.0).change(&mut flood).unwrap();
        assert_eq!(flood.gauge_columns().len(), columns + 2);
        go(&mut flood, 40.0);
        // A tenth of a millimetre a second on 1800 m2.
        LiveChange::Rain(0.0).change(&mut flood).unwrap();
        go(&mut flood, 60.0);
        let rained = came(&flood);
        assert!((rained / 5.4 - 1.0).abs() < 0.01, "{rained}");
    }
}

#[test]
fn a_level_that_is_held_is_held_where_it_was_set() {
    let stage = [("flood.edges.east", "{ stage = 1.0 }")];
    let mut flood = open_cells(POOL, &stage);
    go(&mut flood, 20.0);
    LiveChange::EdgeLevel { side: 1, level: 1.4 }.change(&mut flood).unwrap();
    go(&mut flood, 200.0);
    came(&flood);
    let depth = flood.sample(20.0, 15.0).depth;
    assert!((depth - 1.4).abs() < 0.05, "{depth}");
    let text = format!(
        "{POOL}\n[[flood.stage]]\nname = \"lock\"\npolygon = [[40, 1], [59, 1], [59, 29], [40, 29]]\nlevel_m = 1.0\n"
    );
    let mut flood = open_cells(&text, &[]);
    LiveChange::Level { stage: 0, level: 1.3 }.change(&mut flood).unwrap();
    go(&mut flood, 200.0);
    came(&flood);
    let depth = flood.sample(50.0, 15.0).depth;
    assert!((depth - 1.3).abs() < 0.05, "{depth}");
}

#[test]
fn rougher_ground_slows_the_water() {
    let fastest = |n: Option<f64>| {
        let mut flood = open(RIVER, &[("flood.sph_swe.control_force", "false")]);
        go(&mut flood, 10.0);
        if let Some(n) = n {
            LiveChange::Manning(n).change(&mut flood).unwrap();
        }
        go(&mut flood, 20.0);
        came(&flood);
        flood.particles().iter().map(|particle| particle.speed() * particle.volume).sum::<f64>()
    };
    let (smooth, left, rough) = (fastest(Some(0.0)), fastest(None), fastest(Some(0.15)));
    assert!(smooth > 1.1 * left && left > 1.5 * rough, "{smooth} {left} {rough}");
}

#[test]
fn the_control_force_can_be_taken_away() {
    let at = |changes: &[LiveChange]| {
        let mut flood = open(RIVER, &[]);
        go(&mut flood, 5.0);
        changes.iter().for_each(|change| change.change(&mut flood).unwrap());
        go(&mut flood, 10.0);
        came(&flood);
        flood.save()
    };
    let with = at(&[]);
    assert!(at(&[LiveChange::ControlForce(false)]) != with);
    let mut free = open(RIVER, &[("flood.sph_swe.control_force", "false")]);
    go(&mut free, 5.0);
    let before = free.particles().to_vec();
    LiveChange::ControlForce(false).change(&mut free).unwrap();
    assert_eq!(free.particles(), before);
    let mut cells = open_cells(RIVER, &[("flood.scheme", "voronoi")]);
    assert!(LiveChange::ControlForce(false).change(&mut cells).is_err());
}

#[test]
fn a_flood_that_was_changed_goes_on_from_its_checkpoint_to_the_same_bits() {
    let mut flood = open(RIVER, &[]);
    go(&mut flood, 10.0);
    let untouched = flood.save();
    for change in [
        LiveChange::Discharge { inflow: 0, discharge: 15.0 },
        LiveChange::DischargeTimes { inflow: 1, times: 2.0 },
        LiveChange::ControlForce(false),
        LiveChange::Manning(0.01),
    ] {
        change.change(&mut flood).unwrap();
    }
    go(&mut flood, 15.0);
    let changed = flood.save();
    let mut again = open(RIVER, &[]);
    again.restore(&changed).unwrap();
    go(&mut flood, 25.0);
    go(&mut again, 25.0);
    assert!(flood.save() == again.save());
    // And back to before anything was changed.
    flood.restore(&untouched).unwrap();
    let mut left = open(RIVER, &[]);
    go(&mut flood, 20.0);
    go(&mut left, 20.0);
    assert!(flood.save() == left.save());
}

#[test]
fn a_gauge_that_is_placed_measures_what_one_of_the_scene_does() {
    let scene = format!("{RIVER}\n[[flood.gauge]]\nname = \"bridge\"\nat = [150, 100]\n");
    let (mut written, mut placed) = (open(&scene, &[]), open(RIVER, &[]));
    placed.place_gauge("bridge", [150.0, 100.0]).unwrap();
    assert!(placed.place_gauge("bridge", [10.0, 10.0]).is_err() && placed.place_gauge("moon", [-1.0, 0.0]).is_err());
    let mut again = open(RIVER, &[]);
    again.restore(&placed.save()).unwrap();
    for flood in [&mut written, &mut placed, &mut again] {
        go(flood, 10.0);
    }
    let [first, last, back] = [&written, &placed, &again].map(|flood| flood.gauge_row());
    assert!(first[0] > 0.1 && first[..4] == last[last.len() - 4..] && last == back, "{first:?} {last:?}");
    let columns = placed.gauge_columns();
    assert!(columns.len() == last.len() && columns[columns.len() - 4].header() == "bridge.depth_m");
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut flood = open(RIVER, &[]);
    let state = flood.save();
    let refused = [
        (LiveChange::Discharge { inflow: 2, discharge: 1.0 }, "inflow 2"),
        (LiveChange::Discharge { inflow: 0, discharge: -1.0 }, "0 or more"),
        (LiveChange::DischargeTimes { inflow: 0, times: f64::NAN }, "NaN"),
        (LiveChange::Rain(-1.0), "rain"),
        (LiveChange::Rain(1.0), "scheme voronoi"),
        (LiveChange::Level { stage: 0, level: 1.0 }, "scheme voronoi"),
        (LiveChange::EdgeLevel { side: 0, level: 1.0 }, "scheme voronoi"),
        (LiveChange::Manning(f64::INFINITY), "Manning"),
    ];
    for (change, word) in refused {
        let told = change.change(&mut flood).unwrap_err().to_string();
        assert!(told.contains(word), "{told}");
    }
    assert!(flood.save() == state);
    let mut chezy = open(RIVER, &[("flood.friction", "{ chezy = 40.0 }")]);
    assert!(LiveChange::Manning(0.05).change(&mut chezy).is_err());
    assert!(LiveChange::Rain(1.0).change(&mut 5_u8).is_err());
}
