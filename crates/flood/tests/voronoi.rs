//! What scheme voronoi promises to whoever runs it.

mod common;

use corpuscle_flood::{LiveChange, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }

[flood]
scheme = "voronoi"
spacing_m = 5

[flood.edges]
west = "wall"
south = "wall"
north = { stage = 7 }

[[flood.water]]
depth_m = 0.5
polygon = [[100, 80], [200, 80], [200, 120], [100, 120]]

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

[[flood.finer]]
line = [[150, 100], [150, 40]]
within_m = 6
spacing_m = 2.5

[flood.rain]
intensity_mm_per_h = 90

[flood.infiltration.horton]
first_mm_per_h = 40
last_mm_per_h = 5
decay_per_h = 3

[[flood.gauge]]
name = "bridge"
at = [150, 100]

[[flood.section]]
name = "bridge line"
line = [[150, 180], [150, 20]]
"#;

fn river() -> VoronoiFlood {
    common::voronoi(&common::scene(RIVER))
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// A basin of 66 m by 30 m on ground from a function, with walls all round and what `keys` add.
fn basin(keys: &str, seed: u64, ground: impl Fn(f64, f64) -> f64 + Sync) -> Result<VoronoiFlood, ModelError> {
    let text = format!(
        "run.until_s = 600\nterrain.plane.extent = {{ length_m = 66, width_m = 30, cell_m = 1 }}\n[flood]\nscheme = \"voronoi\"\n{keys}"
    );
    let scene = common::scene(&text);
    let bounds = Bounds { x_min: 0.0, x_max: 66.0, y_min: 0.0, y_max: 30.0 };
    VoronoiFlood::new(&scene.flood, seed, Path::new("."), Arc::new(Terrain::gridded(bounds, 0.5, ground)))
}

const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";

fn rms(flood: &VoronoiFlood) -> f64 {
    let (sum, volume) = flood.wet_cells().fold((0.0, 0.0), |(sum, volume), cell| {
        let [u, v] = cell.velocity;
        (sum + cell.area * cell.depth * (u * u + v * v), volume + cell.area * cell.depth)
    });
    f64::sqrt(sum / volume)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let with = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut flood = river();
            go(&mut flood, 20.0);
            flood.save()
        })
    };
    assert!(with(1) == with(3));
}

#[test]
fn output_never_changes_the_solution() {
    let [mut once, mut often] = [(); 2].map(|()| river());
    go(&mut once, 20.0);
    for k in 1..=200 {
        go(&mut often, f64::from(k) * 0.1);
        let _ = (often.gauge_row(), often.frame());
    }
    assert!(once.save() == often.save());
    assert_eq!(once.gauge_row(), often.gauge_row());
}

#[test]
fn a_restored_run_goes_on_to_the_same_bits() {
    let mut whole = river();
    let mut saved = Vec::new();
    for time in [3.3, 12.3, 16.0] {
        go(&mut whole, time);
        saved.push(whole.save());
    }
    go(&mut whole, 25.0);
    for state in saved {
        let scene = common::scene(RIVER);
        let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
        let mut resumed = VoronoiFlood::to_restore(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap();
        resumed.restore(&state).unwrap();
        go(&mut resumed, 25.0);
        assert!(resumed.save() == whole.save());
        assert_eq!(resumed.frame(), whole.frame());
        assert!(bits(&resumed) == bits(&whole));
    }
}

/// The values of all maps, not-a-number among them.
fn bits(flood: &VoronoiFlood) -> Vec<u32> {
    flood.maps().iter().flat_map(|map| map.values.iter().map(|value| value.to_bits())).collect()
}

#[test]
fn damaged_checkpoints_are_refused() {
    let mut flood = river();
    go(&mut flood, 2.0);
    let saved = flood.save();
    for cut in [0, 1, saved.len() / 2, saved.len() - 1] {
        assert!(river().restore(&saved[..cut]).is_err());
    }
    let other = basin(&format!("spacing_m = 2\n{WALLS}water = [{{ level_m = 1 }}]"), 1, |_, _| 0.0).unwrap();
    assert!(river().restore(&other.save()).is_err());
}

/// With everything on: inflow, outflow, a culvert, a held side, an open side, rain and infiltration.
#[test]
fn water_and_momentum_balance_with_everything_on() {
    let mut flood = river();
    for k in 1..=6 {
        go(&mut flood, f64::from(k) * 10.0);
        let ledger = flood.ledger();
        let [water, momentum] = [&ledger.balances[0], &ledger.balances[1]];
        assert!(water.relative_error().abs() < 1e-13, "{water:?}");
        assert!(momentum.relative_error().abs() < 1e-9, "{momentum:?}");
    }
    let columns = flood.gauge_columns();
    let row = flood.gauge_row();
    let of = |quantity| row[columns.iter().position(|column| column.quantity == quantity).unwrap()];
    assert!(of("total_rain") > 80.0 && of("total_infiltration") > 10.0 && of("total_outflow") > 10.0);
    assert!(row.iter().all(|value| value.is_finite()));
    // The map of it, on cells of 5 m by 5 m, holds as much.
    let maps = flood.maps();
    let map = maps.iter().find(|map| map.name == "infiltration").unwrap();
    let soaked = map.values.iter().map(|depth| 25.0 * f64::from(*depth)).sum::<f64>();
    assert!((soaked / of("total_infiltration") - 1.0).abs() < 0.02, "{soaked} {}", of("total_infiltration"));
}

/// Ground with waves shorter than the cells: what stands below a level is what the ground leaves room for, and none of it is lost on its way.
#[test]
fn cells_with_heights_hold_what_is_below_the_level() {
    let ground = |x: f64, y: f64| 0.3 * (2.5 * x).sin() * (2.0 * y).sin();
    let stored = |storage: &str| {
        let keys = format!("spacing_m = 2.3\nstorage = \"{storage}\"\n{WALLS}water = [{{ level_m = -0.1 }}]");
        let mut flood = basin(&keys, 5, ground).unwrap();
        let volume: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth).sum();
        go(&mut flood, 20.0);
        assert!(flood.ledger().balances[0].relative_error().abs() < 1e-13);
        volume
    };
    let terrain = Terrain::gridded(Bounds { x_min: 0.0, x_max: 66.0, y_min: 0.0, y_max: 30.0 }, 0.5, ground);
    let count = 1000;
    let depths = (0..count * count).map(|k| {
        let [x, y] = [(k % count, 66.0), (k / count, 30.0)].map(|(k, size)| (k as f64 + 0.5) / count as f64 * size);
        (-0.1 - terrain.height(x, y)).max(0.0)
    });
    let exact = 66.0 * 30.0 * depths.sum::<f64>() / (count * count) as f64;
    assert!((stored("level-volume") / exact - 1.0).abs() < 0.01, "{} {exact}", stored("level-volume"));
    assert!(stored("mean") < 0.1 * exact, "{}", stored("mean"));
}

/// Of the same water both ways to count energy, the second without what cancels out, come down alike, however cells hold it.
#[test]
fn energy_above_a_lake_falls_as_energy_does() {
    for storage in ["mean", "level-volume"] {
        let keys = format!(
            "spacing_m = 2.3\nstorage = \"{storage}\"\n{WALLS}water = [{{ level_m = 1.1, polygon = [[0, 0], [25, 0], [25, 30], [0, 30]] }}]"
        );
        let mut flood = basin(&keys, 6, |x, y| 0.3 * (2.5 * x).sin() * (2.0 * y).sin()).unwrap();
        let energy = |flood: &VoronoiFlood| [flood.energy(0.0).iter().sum::<f64>(), flood.energy_above_lake(0.1)];
        let before = energy(&flood);
        go(&mut flood, 8.0);
        let after = energy(&flood);
        let [lost, seen] = [0, 1].map(|way| before[way] - after[way]);
        assert!(
            lost > 0.1 * before[1] && (lost - seen).abs() < 1e-9 * before[1],
            "{storage}: {lost} {seen} {before:?}"
        );
    }
}

#[test]
fn what_came_in_is_the_hydrograph_to_the_last_drop() {
    let keys = format!(
        "spacing_m = 1.5\n{WALLS}inflow = [{{ name = \"a\", at = [20, 15], discharge_m3_per_s = [[0, 1], [7, 3], [9, 0]] }}]"
    );
    let mut flood = basin(&keys, 3, |x, _| 0.01 * x).unwrap();
    go(&mut flood, 20.0);
    let balance = flood.ledger().balances[0].clone();
    assert!((balance.inflow - (7.0 * 2.0 + 2.0 * 1.5)).abs() < 1e-11, "{balance:?}");
    assert!(balance.relative_error().abs() < 1e-13);
}

/// Gauges of all water are of the time that is asked for, within a step too: thin water takes steps of seconds.
#[test]
fn totals_are_those_of_the_time_shown() {
    let keys = format!(
        "spacing_m = 3\n{WALLS}rain.intensity_mm_per_h = 36\ninflow = [{{ name = \"a\", at = [50, 15], discharge_m3_per_s = 0.01 }}]"
    );
    let mut flood = basin(&keys, 3, |x, _| 0.01 * x).unwrap();
    let (rain, inflow, area) = (36.0 / 3.6e6, 0.01, 66.0 * 30.0);
    let of = |flood: &VoronoiFlood, quantity: &str| {
        flood.gauge_row()[flood.gauge_columns().iter().position(|column| column.quantity == quantity).unwrap()]
    };
    for time in [0.1, 0.37, 1.0, 2.9, 7.3, 7.4, 25.0] {
        go(&mut flood, time);
        let exact = [rain * area * time, (rain * area + inflow) * time, (rain * area + inflow) * time];
        let found = ["total_rain", "total_inflow", "stored"].map(|quantity| of(&flood, quantity));
        for (found, exact) in found.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact} at {time}");
        }
        let [energy, came, went, dissipated] =
            ["energy", "energy_in", "energy_out", "dissipated"].map(|quantity| of(&flood, quantity));
        assert!((came - went - energy - dissipated).abs() < 1e-9 * came && dissipated > -1e-6 * came, "at {time}");
    }
    assert!(flood.time_step() > 0.2, "too short a step for this test: {}", flood.time_step());
}

#[test]
fn ground_has_been_under_water_until_the_time_shown() {
    let mut flood = basin(&format!("spacing_m = 3\n{WALLS}water = [{{ level_m = 0.3 }}]"), 3, |x, _| 0.01 * x).unwrap();
    for time in [3.31, 7.0] {
        go(&mut flood, time);
        let duration = flood.maps().into_iter().find(|map| map.name == "duration_s").unwrap().values;
        let wet: Vec<f32> = duration.into_iter().filter(|value| value.is_finite()).collect();
        assert!(wet.len() > 500 && wet.iter().all(|value| (f64::from(*value) - time).abs() < 1e-4), "{time}");
    }
}

/// Rough ground, islands, three seeds, both ways to store: a lake held at its level at one side, open at another, stays as it is.
#[test]
fn a_lake_at_rest_stays_at_rest_at_every_kind_of_side() {
    let sides = [(1, "{ stage = 1.0 }"), (2, "\"open\""), (3, "{ wave = { rest_level_m = 1.0, level_m = 1.0 } }")];
    for ((seed, east), storage) in sides.into_iter().flat_map(|side| ["mean", "level-volume"].map(|of| (side, of))) {
        let keys = format!(
            "spacing_m = 1.1\nstorage = \"{storage}\"\nwater = [{{ level_m = 1.0 }}]\nedges = {{ west = \"wall\", east = {east}, south = \"open\", north = \"wall\" }}"
        );
        let mut flood = basin(&keys, seed, |x, y| 0.8 * (0.9 * x).sin() * (1.3 * y).cos() + 0.3).unwrap();
        let before = flood.save();
        go(&mut flood, 60.0);
        assert!(rms(&flood) < 1e-13, "{east}: {}", rms(&flood));
        assert!(flood.wet_cells().all(|cell| (cell.level - 1.0).abs() < 1e-9));
        assert!(before != flood.save());
        // The rounding error of the thrusts is next to nothing.
        let momentum = flood.ledger().balances[1].relative_error();
        assert!(momentum.abs() < 1e-4, "{momentum}");
    }
}

/// A tank at rest whose east side is held at a level that rises by 5 cm and stays: the wave that comes in is as high as that.
#[test]
fn a_held_level_brings_its_wave_in_full() {
    let keys = "spacing_m = 0.7\nmanning = 0\nwater = [{ level_m = 1.0 }]\n\
                edges = { west = \"wall\", east = { stage = [[0, 1], [3, 1.05]] }, south = \"wall\", north = \"wall\" }\n\
                gauge = [{ name = \"mid\", at = [40, 15] }]";
    let mut flood = basin(keys, 4, |_, _| 0.0).unwrap();
    go(&mut flood, 14.0);
    let level = flood.gauge_row()[1];
    assert!((level - 1.05).abs() < 5e-4, "{level}");
}

/// A hump in the middle of a tank sends waves out through held and open sides: what comes back is next to nothing.
#[test]
fn waves_leave_through_held_and_open_sides() {
    for side in ["{ stage = 1.0 }", "{ wave = { rest_level_m = 1.0, level_m = 1.0 } }"] {
        let keys = format!(
            "spacing_m = 0.8\nmanning = 0\nwater = [{{ level_m = 1.0 }}, {{ depth_m = 0.05, polygon = [[28, -1], [38, -1], [38, 31], [28, 31]] }}]\n\
             edges = {{ west = {side}, east = {side}, south = \"wall\", north = \"wall\" }}"
        );
        let mut flood = basin(&keys, 5, |_, _| 0.0).unwrap();
        go(&mut flood, 40.0);
        let worst = flood.wet_cells().map(|cell| (cell.depth - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 1.5e-3, "{side}: {worst}");
    }
}

/// Steady flow down a rough slope, in by a discharge and out at normal depth: Manning's depth all along, and exactly the hydrograph's volume.
#[test]
fn normal_flow_comes_in_by_a_discharge_and_leaves_at_normal_depth() {
    let (slope, n, q) = (0.005_f64, 0.03_f64, 0.5_f64);
    let keys = format!(
        "spacing_m = 1.5\nmanning = {n}\nedges = {{ west = {{ discharge = {} }}, east = {{ normal_depth = {slope} }}, south = \"wall\", north = \"wall\" }}",
        q * 30.0
    );
    let mut flood = basin(&keys, 6, move |x, _| -slope * x).unwrap();
    go(&mut flood, 400.0);
    let depth = (q * n / slope.sqrt()).powf(0.6);
    for cell in flood.wet_cells().filter(|cell| (8.0..58.0).contains(&cell.centroid[0])) {
        assert!((cell.depth / depth - 1.0).abs() < 0.01, "{cell:?} {depth}");
        // Gauges and maps see the same.
        let sample = flood.sample(cell.centroid[0] + 0.3, cell.centroid[1] - 0.2);
        assert!((sample.depth / depth - 1.0).abs() < 0.015, "{cell:?} {sample:?}");
    }
    let balance = flood.ledger().balances[0].clone();
    assert!((balance.inflow / (q * 30.0 * 400.0) - 1.0).abs() < 1e-3 && balance.relative_error().abs() < 1e-12);
}

#[test]
fn parts_of_a_side_have_rules_of_their_own() {
    let keys = "spacing_m = 1.5\nedges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n\
                edge_part = [{ side = \"west\", from = 10, to = 20, edge = { discharge = 2 } }, \
                { side = \"east\", from = 5, to = 12, edge = { rating = [[0, 0], [1, 4]] } }]";
    let mut flood = basin(keys, 7, |_, _| 0.0).unwrap();
    go(&mut flood, 1500.0);
    let balance = flood.ledger().balances[0].clone();
    assert!((balance.inflow - 3000.0).abs() < 5.0, "{balance:?}");
    // Steady: the level at which the rating gives what comes in.
    let level = flood.wet_cells().map(|cell| cell.area * cell.depth).sum::<f64>() / (66.0 * 30.0);
    assert!((level - 0.5).abs() < 0.02, "{level}");
}

#[test]
fn changes_while_it_runs_hold_and_are_restored() {
    let mut flood = river();
    go(&mut flood, 5.0);
    flood.change(LiveChange::Discharge { inflow: 0, discharge: 0.0 }).unwrap();
    flood.change(LiveChange::RainTimes(2.0)).unwrap();
    flood.change(LiveChange::EdgeLevel { side: 3, level: 7.5 }).unwrap();
    flood.change(LiveChange::Manning(0.08)).unwrap();
    flood.place_gauge("here", [100.0, 100.0]).unwrap();
    assert!(
        flood.change(LiveChange::Manning(-1.0)).is_err()
            && flood.change(LiveChange::Level { stage: 9, level: 1.0 }).is_err()
    );
    let before = flood.ledger().balances[0].inflow;
    go(&mut flood, 8.0);
    let saved = flood.save();
    let came = flood.ledger().balances[0].inflow - before;
    let rain = 2.0 * 0.09 / 3600.0 * 300.0 * 200.0 * 3.0;
    assert!(came > 0.9 * rain && came < 60.0, "{came} {rain}");
    go(&mut flood, 12.0);
    let mut resumed = river();
    resumed.restore(&saved).unwrap();
    go(&mut resumed, 12.0);
    assert!(flood.save() == resumed.save());
    assert_eq!(flood.gauge_columns().len(), resumed.gauge_columns().len());
}

#[test]
fn bad_positions_are_refused_in_words() {
    let outside = basin(
        &format!("spacing_m = 2\n{WALLS}inflow = [{{ name = \"far\", at = [200, 15], discharge_m3_per_s = 1 }}]"),
        1,
        |_, _| 0.0,
    );
    assert!(outside.err().unwrap().to_string().contains("'far'"));
    let absurd = basin(&format!("spacing_m = 0.0001\n{WALLS}water = [{{ depth_m = 1 }}]"), 1, |_, _| 0.0);
    assert!(absurd.err().unwrap().to_string().contains("spacing_m"));
    let part =
        |from: f64, to: f64| format!("{{ side = \"west\", from = {from}, to = {to}, edge = {{ discharge = 2 }} }}");
    let told = |parts: &str| {
        basin(&format!("spacing_m = 2\n{WALLS}edge_part = [{parts}]"), 1, |_, _| 0.0)
            .err()
            .map(|error| error.to_string())
    };
    let beside = told(&part(5000.0, 6000.0)).unwrap();
    assert!(beside.contains("flood.edge_part.0 from 5000 to 6000") && beside.contains("from 0 to 30"), "{beside}");
    let twice = told(&format!("{}, {}", part(0.0, 10.0), part(9.0, 20.0))).unwrap();
    assert!(twice.contains("flood.edge_part.1 overlaps flood.edge_part.0"), "{twice}");
    assert_eq!(told(&format!("{}, {}", part(-5.0, 10.0), part(10.0, 20.0))), None);
}

/// Water stands only where it was put, and only its surroundings have cells.
#[test]
fn a_gauge_in_an_obstacle_is_told() {
    let at = |at: &str, height: &str| {
        let keys = format!(
            "spacing_m = 3\nwater = [{{ level_m = 1 }}]\nobstacle = [{{ name = \"house\", circle = {{ centre = [20, 15], radius_m = 5 }}{height} }}]\n\
             gauge = [{{ name = \"here\", at = {at} }}]"
        );
        basin(&keys, 1, |_, _| 0.0).unwrap().warnings()
    };
    let told = at("[21, 15]", "");
    assert!(told.iter().any(|warning| warning.contains("'here'") && warning.contains("'house'")), "{told:?}");
    // A roof over which water may go, and a gauge beside the house.
    for (position, height) in [("[21, 15]", ", height_m = 0.5"), ("[26, 15]", "")] {
        assert!(at(position, height).iter().all(|warning| !warning.contains("'here'")));
    }
}

#[test]
fn dry_land_has_no_cells() {
    let text = "run.until_s = 60\nterrain.plane.extent = { length_m = 20000, width_m = 20000, cell_m = 100 }\n[flood]\n\
                scheme = \"voronoi\"\nspacing_m = 10\nwater = [{ depth_m = 1, polygon = [[9000, 9000], [9300, 9000], [9300, 9300], [9000, 9300]] }]";
    let mut flood = common::voronoi(&common::scene(text));
    assert!(flood.cells() < 20_000, "{}", flood.cells());
    let before = flood.cells();
    go(&mut flood, 200.0);
    assert!(flood.cells() > before);
    assert!(flood.ledger().balances[0].relative_error().abs() < 1e-13);
    assert!((flood.ledger().balances[0].initial / 90_000.0 - 1.0).abs() < 1e-12);
}

/// A pool that falls apart on a slope: the highest level is the ground and the highest depth on it, velocities at the end are those of the gauges, and
/// the velocity at the highest speed is as fast as that.
#[test]
fn maps_of_levels_and_velocities_agree_with_those_of_depth_and_speed() {
    let water = "water = [{ depth_m = 1.0, polygon = [[20, 5], [40, 5], [40, 25], [20, 25]] }]";
    let mut flood = basin(&format!("spacing_m = 1.5\n{WALLS}{water}"), 1, |x, y| 0.05 * x + 0.02 * y).unwrap();
    go(&mut flood, 6.0);
    let maps = flood.maps();
    let of = |name: &str| &maps.iter().find(|map| map.name == name).unwrap().values;
    let [depth, level, speed] = ["max_depth", "max_level", "max_speed"].map(of);
    let fastest = ["fastest_east", "fastest_north"].map(of);
    let at_end = ["velocity_east", "velocity_north"].map(of);
    let (mut wet, mut uphill) = (0, 0);
    for cell in (0..depth.len()).filter(|cell| !depth[*cell].is_nan()) {
        let [x, y] = [0.5 * (cell % 132) as f64 + 0.25, 29.75 - 0.5 * (cell / 132) as f64];
        assert!((f64::from(level[cell] - depth[cell]) - 0.05 * x - 0.02 * y).abs() < 1e-4);
        assert!((fastest[0][cell].hypot(fastest[1][cell]) - speed[cell]).abs() < 1e-6);
        let sample = flood.sample(x, y);
        if sample.depth > 0.01 {
            (0..2).for_each(|axis| assert_eq!(at_end[axis][cell], sample.velocity[axis] as f32));
            wet += 1;
        } else {
            assert!(at_end[0][cell].is_nan());
        }
        uphill += usize::from(x > 42.0 && fastest[0][cell] > 0.5);
    }
    assert!(wet > 1000 && uphill > 50, "{wet} {uphill}");
}

/// A surface and a velocity by expressions are those that functions give; a pair of rasters gives the velocity too.
#[test]
fn water_starts_by_expressions_and_rasters() {
    let folder = tempfile::tempdir().unwrap();
    for (name, value) in [("u.asc", "0.25"), ("v.asc", "-0.5")] {
        let rows = format!("{value} {value} {value}\n").repeat(3);
        let text = format!("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 22\n{rows}");
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let terrain =
        Arc::new(Terrain::gridded(Bounds { x_min: 0.0, x_max: 66.0, y_min: 0.0, y_max: 30.0 }, 0.5, |x, _| 0.01 * x));
    let open = |keys: &str| {
        let scene = common::scene(&format!(
            "run.until_s = 1\nterrain.plane.extent = {{ length_m = 66, width_m = 30, cell_m = 1 }}\n[flood]\nscheme = \"voronoi\"\nspacing_m = 1.5\n{WALLS}water = [{{ {keys} }}]"
        ));
        VoronoiFlood::new(&scene.flood, 1, folder.path(), Arc::clone(&terrain))
    };
    let flood =
        open("level_m = \"2 + 0.01 * x - 1e-3 * y^2\", velocity_m_per_s = [\"0.1 * (y > 15)\", \"-x / 100\"]").unwrap();
    let wet: Vec<_> = flood.wet_cells().collect();
    assert!(wet.len() > 500);
    for cell in wet {
        let [x, y] = cell.centroid;
        let level = 2.0 + 0.01 * x - 1e-3 * y * y;
        assert!((cell.level - level).abs() < 1e-3, "{cell:?} {level}");
        assert!((cell.velocity[1] + x / 100.0).abs() < 1e-9, "{cell:?}");
        if (y - 15.0).abs() > 2.0 {
            assert!((cell.velocity[0] - if y > 15.0 { 0.1 } else { 0.0 }).abs() < 1e-12, "{cell:?}");
        }
    }
    let flood = open("depth_m = \"max(0, 1 - hypot(x - 30, y - 15) / 10)\", velocity_m_per_s = { east = \"u.asc\", north = \"v.asc\" }").unwrap();
    let volume: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth).sum();
    assert!((volume / (std::f64::consts::PI * 100.0 / 3.0) - 1.0).abs() < 0.01, "{volume}");
    assert!(
        flood.wet_cells().all(|cell| (cell.velocity[0] - 0.25).abs() < 1e-12 && (cell.velocity[1] + 0.5).abs() < 1e-12)
    );
    let refused = open("level_m = \"sqrt(x - 20)\"").map(|_| ()).unwrap_err().to_string();
    for word in ["flood.water.0.level_m = \"sqrt(x - 20)\"", "not a finite number at [0.25", "max(0, ...)"] {
        assert!(refused.contains(word), "{refused}");
    }
    assert!(open("level_m = \"sqrt(x - 20)\", polygon = [[21, 1], [60, 1], [60, 29]]").is_ok());
    let missing =
        open("level_m = 1, velocity_m_per_s = { east = \"u.asc\", north = \"w.asc\" }").map(|_| ()).unwrap_err();
    assert!(missing.to_string().contains("w.asc"), "{missing}");
    // Strickler's k, and a mark that the file does not name.
    for (name, value) in [("k.asc", "30"), ("marked.asc", "-1")] {
        let rows = format!("0.03 {value} 0.03\n").repeat(3);
        let text = format!("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 22\n{rows}");
        std::fs::write(folder.path().join(name), text).unwrap();
        let refused = open(&format!(
            "level_m = 1 }}]\nmanning = {{ raster = \"{name}\" }}\ninflow = [{{ name = \"a\", at = [5, 5], discharge_m3_per_s = 0"
        ));
        let refused = refused.map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains(name) && refused.contains("no Manning's n"), "{refused}");
    }
    let beside = open("level_m = 1 }]\nfiner = [{ polygon = [[500, 5], [510, 5], [510, 9]], spacing_m = 0.5")
        .map(|_| ())
        .unwrap_err();
    assert!(beside.to_string().contains("flood.finer.0 lies outside the terrain"), "{beside}");
}

/// Linear theory of wavemakers in shallow water: the height of the wave is k times depth times stroke (Dean & Dalrymple 1991, section 6.2). What the
/// wall sweeps in and out again is booked.
#[test]
fn a_paddle_makes_the_waves_of_linear_theory() {
    let (depth, period, stroke) = (1.0_f64, 8.0_f64, 0.02_f64);
    let rows: Vec<[f64; 2]> = (0..=640)
        .map(|k| f64::from(k) * 0.05)
        .map(|time| [time, 0.5 * stroke * (1.0 - (std::f64::consts::TAU * time / period).cos())])
        .collect();
    let keys = format!(
        "spacing_m = 0.5\nmanning = 0\nwater = [{{ level_m = {depth} }}]\nedges = {{ west = {{ paddle = {rows:?} }}, east = \"open\", south = \"wall\", north = \"wall\" }}"
    );
    let mut flood = basin(&keys, 2, |_, _| 0.0).unwrap();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    // The front is at the far end after 21 s.
    for k in 0..=160 {
        let time = 16.0 + f64::from(k) * 0.1;
        go(&mut flood, time);
        let level = flood.sample(15.0, 15.0).depth;
        (low, high) = (low.min(level), high.max(level));
        let row = flood.ledger().balances[0].clone();
        assert!(row.relative_error().abs() < 1e-13, "{row:?}");
    }
    let number = std::f64::consts::TAU / period / (9.81 * depth).sqrt();
    let height = number * depth * stroke;
    assert!(((high - low) / height - 1.0).abs() < 0.03, "{} {height}", high - low);
    // At rest again after four periods, the wall is where it was: to second order as much went out as came in.
    let water = &flood.ledger().balances[0];
    assert!(water.inflow > 3.0 * 0.02 * 30.0 && flood.gauge_row().iter().all(|value| value.is_finite()));
}

/// A wall that moves in by 0.3 m in 20 s and stays: the tank holds what it swept, width times depth times displacement, and a little more as the
/// water rises before it.
#[test]
fn what_a_paddle_sweeps_is_booked() {
    let keys = "spacing_m = 1\nwater = [{ level_m = 1 }]\nedges = { west = { paddle = [[0, 0], [20, 0.3]] }, east = \"wall\", south = \"wall\", north = \"wall\" }";
    let mut flood = basin(keys, 1, |_, _| 0.0).unwrap();
    go(&mut flood, 60.0);
    let water = flood.ledger().balances[0].clone();
    assert!(
        (water.inflow - water.outflow) / (0.3 * 30.0) > 1.0 && (water.inflow - water.outflow) / (0.3 * 30.0) < 1.02,
        "{water:?}"
    );
    let jumps = "spacing_m = 1\nedges.west.paddle = { csv = \"missing.csv\" }";
    assert!(basin(jumps, 1, |_, _| 0.0).map(|_| ()).unwrap_err().to_string().contains("missing.csv"));
    let leaves = "spacing_m = 1\nedges.west.paddle = [[0, 0], [20, 300]]";
    let refusal = basin(leaves, 1, |_, _| 0.0).map(|_| ()).unwrap_err().to_string();
    assert!(refusal.contains("moves 300 m to and fro"), "{refusal}");
}

/// A block of water that falls: as much as written, whatever the spacing of the cells comes to, and all of it on the ground in the end.
#[test]
fn a_falling_block_holds_what_it_says() {
    for spacing in [1.0, 0.8, 1.3] {
        let keys = format!(
            "spacing_m = {spacing}\nspacing_depth_m = 0.5\n{WALLS}water = [{{ block = {{ from = [20, 8], to = [{}, {}], height_m = 2, layers = 3 }} }}]",
            20.0 + 10.0 * spacing,
            8.0 + 12.0 * spacing
        );
        let mut flood = basin(&keys, 5, |x, y| 0.1 * (x * 0.3).sin() + 0.05 * y).unwrap();
        let volume = 10.0 * 12.0 * 3.0 * spacing * spacing * 0.5;
        go(&mut flood, 3.0);
        let balance = flood.ledger().balances[0].clone();
        assert!((balance.initial / volume - 1.0).abs() < 1e-12, "{} {volume}", balance.initial);
        let landed: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth).sum();
        assert!((landed / volume - 1.0).abs() < 1e-12, "{landed} {volume}");
    }
}

/// Films so thin that momentum is taken off them: checked once more by a resumed run, they would lose some again.
#[test]
fn a_restored_run_has_the_same_films() {
    let keys = format!(
        "spacing_m = 1.5\nmanning = 0.0\n{WALLS}water = [{{ level_m = 1.0, polygon = [[0, 0], [20, 0], [20, 30], [0, 30]] }}]"
    );
    let ground = |x: f64, y: f64| 0.02 * x + 0.05 * (0.7 * x).sin() * (0.6 * y).cos();
    let mut flood = basin(&keys, 2, ground).unwrap();
    go(&mut flood, 4.0);
    assert!(flood.wet_cells().any(|cell| cell.depth > 1e-11 && cell.depth < 1e-6 && cell.velocity != [0.0; 2]));
    let mut resumed = basin(&keys, 2, ground).unwrap();
    resumed.restore(&flood.save()).unwrap();
    for model in [&mut flood, &mut resumed] {
        go(model, 6.0);
    }
    assert!(flood.save() == resumed.save());
}
