//! Scheme voronoi on a GPU comes to what the CPU comes to, within single precision.

use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{GpuModel, Model, ModelError};
use corpuscle_scene::{FloodScene, Scene};
use corpuscle_terrain::{Bounds, Terrain};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const WALLS: &str = "edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n";

fn parse(keys: &str) -> FloodScene {
    let text = format!(
        "run.until_s = 600\nterrain.plane.extent = {{ length_m = 66, width_m = 30, cell_m = 1 }}\n[flood]\nscheme = \"voronoi\"\n{keys}"
    );
    let mut scene = Scene::parse(&text, "test", &[]).unwrap();
    scene.resolve_defaults();
    scene.flood().unwrap().clone()
}

/// A basin of a size, m, on ground from a function.
fn basin(keys: &str, [length, width]: [f64; 2], ground: impl Fn(f64, f64) -> f64 + Sync) -> VoronoiFlood {
    let bounds = Bounds { x_min: 0.0, x_max: length, y_min: 0.0, y_max: width };
    let terrain = Arc::new(Terrain::gridded(bounds, 0.5, ground));
    VoronoiFlood::new(&parse(keys).flood, 1, Path::new("."), terrain).unwrap()
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// The same flood on the CPU and on the GPU at a time, s.
fn both(gpu: Gpu, time: f64, open: impl Fn() -> VoronoiFlood) -> [VoronoiFlood; 2] {
    let mut floods = [open(), open()];
    floods[1].use_gpu(gpu).unwrap();
    for flood in &mut floods {
        go(flood, time);
    }
    assert_eq!(floods.each_ref().map(|flood| flood.backend()), ["cpu", "gpu"]);
    floods
}

/// Depth and velocity of each particle by its number.
fn particles(flood: &VoronoiFlood) -> BTreeMap<u64, [f64; 3]> {
    let set = flood.frame().sets.remove(0);
    let corpuscle_model::Values::Scalar(depth) = &set.columns[0].values else { panic!("depth is a scalar") };
    let rows = set.id.iter().zip(depth).zip(&set.velocity);
    rows.map(|((id, depth), [u, v, _])| (*id, [*depth, *u, *v])).collect()
}

/// Sum of the differences of depth over that of the depths, and of discharge over that of the discharges.
fn differences([cpu, gpu]: &[VoronoiFlood; 2]) -> [f64; 2] {
    let (cpu, gpu) = (particles(cpu), particles(gpu));
    let dry = [0.0; 3];
    let (mut off, mut all) = ([0.0; 2], [0.0; 2]);
    for id in cpu.keys().chain(gpu.keys().filter(|id| !cpu.contains_key(id))) {
        let [a, b] = [&cpu, &gpu].map(|of| *of.get(id).unwrap_or(&dry));
        off[0] += (a[0] - b[0]).abs();
        off[1] += (a[0] * a[1] - b[0] * b[1]).hypot(a[0] * a[2] - b[0] * b[2]);
        all = [all[0] + a[0], all[1] + a[0] * a[1].hypot(a[2])];
    }
    [off[0] / all[0], off[1] / all[1]]
}

fn rms(flood: &VoronoiFlood) -> f64 {
    let (sum, volume) = flood.wet_cells().fold((0.0, 0.0), |(sum, volume), cell| {
        let [u, v] = cell.velocity;
        (sum + cell.area * cell.depth * (u * u + v * v), volume + cell.area * cell.depth)
    });
    f64::sqrt(sum / volume)
}

/// A quantity of the first gauge that has it.
fn value(flood: &VoronoiFlood, quantity: &str) -> f64 {
    flood.gauge_row()[flood.gauge_columns().iter().position(|column| column.quantity == quantity).unwrap()]
}

/// Blocks of 6 m at heights of 0 to 3 m, far above the datum.
fn blocks(x: f64, y: f64) -> f64 {
    let number = (y / 6.0) as usize * 11 + (x / 6.0) as usize;
    1000.0 + 3.0 * ((number * 7919 % 101) as f64 / 101.0)
}

#[track_caller]
fn agree(floods: &[VoronoiFlood; 2], depth: f64, discharge: f64) {
    let off = differences(floods);
    let balances = &floods[1].ledger().balances;
    let errors = [balances[0].relative_error(), balances[1].relative_error()];
    let cells = floods[1].wet_cells().count();
    eprintln!(
        "{cells} wet cells, {} steps, off {:.2e} {:.2e}, books {:.2e} {:.2e}",
        floods[1].steps(),
        off[0],
        off[1],
        errors[0],
        errors[1]
    );
    assert!(off[0] < depth && off[1] < discharge, "{off:?}");
    assert!(errors[0].abs() < 1e-12 && errors[1].abs() < 1e-5, "{balances:?}");
    assert!(floods[0].steps().abs_diff(floods[1].steps()) <= 1);
}

#[test]
fn a_lake_on_rough_ground_stays_at_rest() {
    let Some(gpu) = require_gpu("a lake on the GPU") else { return };
    let mut flood =
        basin(&format!("spacing_m = 2\nmanning = 0\n{WALLS}water = [{{ level_m = 1001.5 }}]"), [66.0, 30.0], blocks);
    flood.use_gpu(gpu).unwrap();
    let before = flood.ledger().balances[0].now;
    for k in 1..=5 {
        go(&mut flood, 20.0 * f64::from(k));
        eprintln!("rms {:.2e} m/s after {} steps", rms(&flood), flood.steps());
        assert!(rms(&flood) < 2e-6, "{}", rms(&flood));
    }
    assert!((flood.ledger().balances[0].now / before - 1.0).abs() < 1e-13);
}

fn dam(before: &str, keys: &str) -> String {
    format!(
        "spacing_m = 1.5\n{keys}{WALLS}water = [{{ depth_m = 2, polygon = [[0, 0], [25, 0], [25, 30], [0, 30]] }}{before}]"
    )
}

#[test]
fn a_dam_breaks_onto_water() {
    let Some(gpu) = require_gpu("a dam on the GPU") else { return };
    let before = ", { depth_m = 0.5, polygon = [[25, 0], [66, 0], [66, 30], [25, 30]] }";
    let open = || basin(&dam(before, "manning = 0\n"), [66.0, 30.0], |x, _| 0.2 * (0.3 * x).sin());
    agree(&both(gpu, 8.0, open), 2e-6, 2e-5);
}

/// Over tiles that are made as the water comes.
#[test]
fn a_dam_breaks_onto_dry_ground() {
    let Some(gpu) = require_gpu("a dam on the GPU") else { return };
    let open = || basin(&dam("", ""), [220.0, 30.0], |x, y| 0.2 * (0.3 * x).sin() * (0.2 * y).cos());
    assert!(open().cells() < 5000);
    let floods = both(gpu, 12.0, open);
    assert_eq!(floods[0].cells(), floods[1].cells());
    assert!(floods[1].cells() > open().cells());
    agree(&floods, 5e-7, 1e-6);
    let maps = floods.each_ref().map(|flood| flood.maps());
    for (cpu, gpu) in maps[0].iter().zip(&maps[1]) {
        let both = cpu.values.iter().zip(&gpu.values).filter(|(a, b)| !a.is_nan() && !b.is_nan());
        let (off, all) = both.fold((0.0, 0.0), |(off, all), (a, b)| (off + (a - b).abs(), all + a.abs()));
        // Of two speeds that are nearly as high another may be the highest.
        let bound = if cpu.name.starts_with("fastest") { 2e-3 } else { 2e-4 };
        assert!(off <= bound * all, "{}: {off} of {all}", cpu.name);
    }
}

/// Water runs down a slope and over an open edge, with friction, and at another over one of normal flow.
#[test]
fn water_leaves_over_open_edges() {
    let Some(gpu) = require_gpu("open edges on the GPU") else { return };
    let edges = "edges = { west = \"open\", east = { normal_depth = 0.002 }, south = \"wall\", north = \"open\" }\n";
    for friction in ["manning = 0.03\n", "friction = { chezy = 40 }\n"] {
        let keys = format!(
            "spacing_m = 2\n{friction}{edges}water = [{{ depth_m = 1, polygon = [[5, 5], [40, 5], [40, 25], [5, 25]] }}]"
        );
        let open = || basin(&keys, [66.0, 30.0], |x, y| 50.0 - 0.002 * x + 0.002 * y);
        let floods = both(gpu.clone(), 20.0, open);
        agree(&floods, 5e-7, 1e-6);
        let left = floods.each_ref().map(|flood| flood.ledger().balances[0].outflow);
        eprintln!("left {left:?}");
        assert!(left[0] > 50.0 && (left[1] / left[0] - 1.0).abs() < 1e-5);
        let energy = floods.each_ref().map(|flood| value(flood, "energy_out"));
        assert!((energy[1] / energy[0] - 1.0).abs() < 1e-5, "{energy:?}");
    }
}

/// Levels that are held and rise, waves given by level, by velocity and by both, a paddle: through sides, a part of one, and a line inside, over wet and dry
/// ground.
#[test]
fn levels_waves_and_paddles_work_at_sides() {
    let Some(gpu) = require_gpu("levels at sides on the GPU") else { return };
    let walls = "south = \"wall\", north = \"wall\"";
    let cases = [
        format!("edges = {{ west = {{ stage = [[0, 101], [3, 101.05]] }}, east = {{ stage = 101 }}, {walls} }}"),
        format!(
            "edges = {{ west = {{ stage = [[0, 101], [2, 101.5], [2, 101], [6, 100.6]] }}, east = \"open\", {walls} }}"
        ),
        // In faster than waves, over dry ground.
        format!(
            "edges = {{ west = {{ wave = {{ rest_level_m = 101, level_m = 102, velocity_m_per_s = 5 }} }}, east = \"wall\", {walls} }}"
        ),
        format!(
            "edges = {{ west = {{ wave = {{ rest_level_m = 101, level_m = [[0, 101], [4, 101.2], [8, 101]] }} }}, east = \"open\", {walls} }}"
        ),
        format!(
            "edges = {{ west = {{ wave = {{ rest_level_m = 101, velocity_m_per_s = [[0, 0], [4, 0.4], [8, 0]] }} }}, east = \"open\", {walls} }}"
        ),
        format!(
            "edges = {{ west = {{ paddle = [[0, 0], [3, 0.5], [5, 0.2], [5.5, 0.2], [12, 1]] }}, east = {{ stage = 101 }}, {walls} }}"
        ),
        "edge_line = [{ line = [[15.2, -1], [15.2, 31]], edge = { stage = [[0, 101], [3, 101.05]] } }]".to_owned(),
        "edge_part = [{ side = \"east\", from = 5, to = 12, edge = { stage = 100.6 } }]".to_owned(),
    ];
    for case in cases {
        for (water, until, bounds) in [
            ("level_m = 101", 12.0, [2e-6, 1e-5]),
            // Where the level jumps rounding decides in which step.
            ("level_m = 101, polygon = [[30, 0], [66, 0], [66, 30], [30, 30]]", 4.0, [2e-5, 1e-4]),
        ] {
            let keys = format!("spacing_m = 1.5\nmanning = 0.02\nwater = [{{ {water} }}]\n{case}");
            let open = || basin(&keys, [66.0, 30.0], |x, y| 100.0 + 0.2 * (0.3 * x).sin() * (0.2 * y).cos());
            let floods = both(gpu.clone(), until, open);
            eprintln!("{case}");
            agree(&floods, bounds[0], bounds[1]);
            let [cpu, gpu] = floods.each_ref().map(|flood| flood.ledger().balances[0].inflow);
            assert!((gpu - cpu).abs() <= 1e-5 * cpu.max(10.0), "{case}: {cpu} {gpu}");
        }
    }
}

/// A tank at rest between held levels and a wave of no height stays at rest.
#[test]
fn a_tank_at_rest_stays_at_rest_between_held_levels() {
    let Some(gpu) = require_gpu("a tank between held levels on the GPU") else { return };
    let keys = "spacing_m = 1.5\nmanning = 0\nwater = [{ level_m = 101 }]\n\
                edges = { west = { stage = 101 }, east = { wave = { rest_level_m = 101, level_m = 101 } }, south = { stage = 101 }, north = \"open\" }";
    let mut flood = basin(keys, [66.0, 30.0], |x, y| 100.0 + 0.5 * (0.9 * x).sin() * (0.7 * y).cos());
    flood.use_gpu(gpu).unwrap();
    go(&mut flood, 60.0);
    eprintln!("rms {:.2e} m/s after {} steps", rms(&flood), flood.steps());
    assert!(rms(&flood) < 2e-6, "{}", rms(&flood));
}

/// Discharges come in over sides, parts of them and lines, onto dry and wet ground, and go out by a rating.
#[test]
fn discharges_come_in_and_go_out_by_a_rating() {
    let Some(gpu) = require_gpu("discharges on the GPU") else { return };
    let parts = "edge_part = [{ side = \"west\", from = 10, to = 20, edge = { discharge = [[0, 0], [5, 6], [5, 3]] } }, \
                 { side = \"east\", from = 5, to = 12, edge = { rating = [[400, 0], [401, 4], [402, 9]] } }]\n";
    let line = "edge_line = [{ line = [[20, 25], [20, 5]], edge = { discharge = [[0, 1], [7, 3], [9, 0]] } }]\n";
    let fast = "edges = { west = { discharge = 60 }, east = { rating = [[400, 0], [400.2, 3]] }, south = \"wall\", north = \"wall\" }\n";
    for case in [parts, line, fast] {
        for water in ["level_m = 400.7", "level_m = 400.7, polygon = [[40, 0], [66, 0], [66, 30], [40, 30]]"] {
            let keys = format!("spacing_m = 1.5\nmanning = 0.03\nwater = [{{ {water} }}]\n{case}");
            let open = || basin(&keys, [66.0, 30.0], |x, y| 400.0 + 0.2 * (0.3 * x).sin() * (0.2 * y).cos());
            let floods = both(gpu.clone(), 15.0, open);
            eprintln!("{case}");
            agree(&floods, 5e-7, 2e-5);
            let books = floods.each_ref().map(|flood| {
                let balance = &flood.ledger().balances[0];
                [balance.inflow, balance.outflow]
            });
            for k in 0..2 {
                assert!((books[1][k] - books[0][k]).abs() <= 1e-5 * books[0][k].max(1.0), "{case}: {books:?}");
            }
        }
    }
}

/// Sheets on a slope that goes on beyond joined sides, from uneven to normal flow.
#[test]
fn sheets_run_at_the_velocity_of_normal_flow() {
    let Some(gpu) = require_gpu("sheets on the GPU") else { return };
    let edges = "edges = { west = \"periodic\", east = \"periodic\", south = \"periodic\", north = \"periodic\" }\n";
    let keys = format!("spacing_m = 2\nmanning = 0.03\n{edges}water = [{{ depth_m = 0.02 }}]");
    let mut flood = basin(&keys, [60.0, 24.0], |x, _| 500.0 - 0.05 * x);
    flood.use_gpu(gpu).unwrap();
    go(&mut flood, 40.0);
    let normal = 0.02_f64.powf(2.0 / 3.0) * f64::sqrt(0.05) / 0.03;
    let sums = flood.wet_cells().fold([0.0; 2], |[sum, volume], cell| {
        let own = cell.area * cell.depth;
        [sum + own * cell.velocity[0], volume + own]
    });
    let off = sums[0] / sums[1] / normal - 1.0;
    assert!(off.abs() < 0.01, "{off}");
}

#[test]
fn the_same_run_comes_to_the_same_bits_and_goes_on_from_a_checkpoint() {
    let Some(gpu) = require_gpu("a repeated run on the GPU") else { return };
    let open = || {
        let mut flood = basin(&dam("", ""), [120.0, 30.0], |x, y| 0.2 * (0.3 * x).sin() * (0.2 * y).cos());
        flood.use_gpu(gpu.clone()).unwrap();
        flood
    };
    let mut whole = open();
    go(&mut whole, 5.0);
    let mut looked_at = open();
    (1..=25).for_each(|k| go(&mut looked_at, 0.2 * f64::from(k)));
    assert!(whole.save() == looked_at.save());
    let mut resumed = open();
    go(&mut looked_at, 8.0);
    resumed.restore(&whole.save()).unwrap();
    go(&mut resumed, 8.0);
    assert!(particles(&resumed) == particles(&looked_at));
}

/// Two sources, one that jumps and one with a velocity, rain that begins and ends, and infiltration by each law.
#[test]
fn water_comes_and_goes_beside_its_motion() {
    let Some(gpu) = require_gpu("inflow, rain and infiltration on the GPU") else { return };
    let rain = "rain = { intensity_mm_per_h = [[0, 0], [3, 600], [45, 600], [45, 0]] }\n";
    let source = "name = \"a\", at = [10, 10], discharge_m3_per_s = [[0, 1], [8, 2], [8, 0.5], [100, 0.5]]";
    let jet = "name = \"jet\", line = [[20, 15], [20, 25]], velocity_m_per_s = [1, 0], discharge_m3_per_s = 2";
    let cases = [
        format!("inflow = [{{ {source} }}, {{ {jet} }}]\nwater = [{{ depth_m = 0.05 }}]"),
        rain.to_owned(),
        format!("{rain}infiltration.green-ampt = {{ conductivity_mm_per_h = 50, suction_m = 0.1, deficit = 0.3 }}"),
        format!("{rain}infiltration.horton = {{ first_mm_per_h = 400, last_mm_per_h = 50, decay_per_h = 30 }}"),
        format!("{rain}infiltration.constant.rate_mm_per_h = 60"),
    ];
    for case in cases {
        let keys = format!(
            "spacing_m = 2\nmanning = 0.03\nwet_depth_m = 0.002\n\
             edges = {{ west = \"wall\", east = \"open\", south = \"wall\", north = \"wall\" }}\n{case}"
        );
        let open = || basin(&keys, [66.0, 30.0], |x, y| 300.0 - 0.03 * x + 0.2 * (0.3 * y).sin());
        // Several draughts of the ground, and no longer than it is wet all over.
        let until = match case.as_str() {
            case if case.contains("infiltration") => 44.0,
            case if case.contains("rain") => 60.0,
            _ => 20.0,
        };
        let floods = both(gpu.clone(), until, open);
        agree(&floods, 5e-6, 5e-6);
        for quantity in ["stored", "total_inflow", "total_rain", "total_infiltration", "energy_in"] {
            if floods[0].gauge_columns().iter().any(|column| column.quantity == quantity) {
                let [cpu, gpu] = floods.each_ref().map(|flood| value(flood, quantity));
                assert!((gpu - cpu).abs() <= 5e-6 * cpu, "{quantity}: {cpu} {gpu}");
            }
        }
    }
}

/// Outflows, held levels, culverts, weirs and ratings, on patches of several cells and of one, some of which overlap.
#[test]
fn totals_are_those_of_the_time_shown() {
    let Some(gpu) = require_gpu("totals on the GPU") else { return };
    let keys = format!(
        "spacing_m = 3\n{WALLS}rain.intensity_mm_per_h = 36\ninflow = [{{ name = \"a\", at = [50, 15], discharge_m3_per_s = 0.01 }}]"
    );
    let open = || basin(&keys, [66.0, 30.0], |x, _| 0.01 * x);
    for time in [0.37, 2.9, 7.3] {
        let floods = both(gpu.clone(), time, open);
        for quantity in ["total_rain", "total_inflow", "stored", "energy", "energy_in", "dissipated"] {
            let [cpu, gpu] = floods.each_ref().map(|flood| value(flood, quantity));
            let least = if quantity == "dissipated" { value(&floods[0], "energy_in") } else { cpu };
            assert!((gpu - cpu).abs() < 2e-4 * least.abs(), "{quantity} {gpu} {cpu} at {time}");
        }
    }
}

#[test]
fn structures_lead_water() {
    let Some(gpu) = require_gpu("structures on the GPU") else { return };
    let outflow = "outflow = [{ name = \"drain\", polygon = [[5, 5], [15, 5], [15, 15], [5, 15]], rating = [[200, 0], [201, 3], [203, 10]] }]\n";
    let held = "stage = [{ name = \"lake\", polygon = [[45, 10], [60, 10], [60, 20], [45, 20]], level_m = [[0, 201.2], [5, 201.6]] }]\n";
    let culvert = "{ name = \"culvert\", from = [20, 15], to = [50, 15], law = { culvert = { diameter_m = 0.8, floor_m = [200.1, 200.7], barrels = 2 } } }";
    let weir = "{ name = \"weir\", from = [50, 25], to = [20, 5], law = { weir = { crest_m = 200.9, width_m = 2 } } }";
    let rating = "{ name = \"pump\", from = [50, 5], to = [10, 25], both_ways = false, law = { rating = [[-5, 0.4], [0, 0.3], [5, 0.1]] } }";
    let inflow = "inflow = [{ name = \"in\", at = [50, 15], discharge_m3_per_s = 1 }]\n";
    let links = |links: &[&str]| format!("link = [{}]\n", links.join(", "));
    let all = format!("{outflow}{held}{inflow}{}", links(&[culvert, weir, rating]));
    let cases = [outflow.to_owned(), held.to_owned(), links(&[culvert]), links(&[weir]), links(&[rating]), all];
    for case in cases {
        let keys = format!(
            "spacing_m = 1.5\nmanning = 0.03\n{case}{WALLS}water = [{{ level_m = 201.2, polygon = [[35, 0], [66, 0], [66, 30], [35, 30]] }}, \
             {{ level_m = 200.6, polygon = [[0, 0], [30, 0], [30, 30], [0, 30]] }}]"
        );
        let hill =
            |x: f64, y: f64| 200.0 + 0.2 * (0.3 * x).sin() * (0.2 * y).cos() + (3.0 - 0.4 * (x - 32.0).abs()).max(0.0);
        let open = || basin(&keys, [66.0, 30.0], hill);
        let floods = both(gpu.clone(), 12.0, open);
        eprintln!("{case}");
        agree(&floods, 2e-6, 2e-5);
        let columns = floods[0].gauge_columns();
        let rows = floods.each_ref().map(|flood| flood.gauge_row());
        let mut discharges = 0;
        for (k, column) in columns.iter().enumerate().filter(|(_, column)| column.quantity == "discharge") {
            let [cpu, gpu] = rows.each_ref().map(|row| row[k]);
            eprintln!("{} {cpu} {gpu}", column.gauge);
            assert!(cpu.abs() > 0.01 && (gpu - cpu).abs() < 1e-4 * cpu.abs(), "{}: {cpu} {gpu}", column.gauge);
            discharges += 1;
        }
        let names = ["drain", "culvert\"", "weir\"", "pump"];
        assert_eq!(discharges, names.iter().filter(|name| case.contains(**name)).count());
        for quantity in ["total_inflow", "total_outflow", "energy_in", "energy_out"] {
            if columns.iter().any(|column| column.quantity == quantity) {
                let [cpu, gpu] = floods.each_ref().map(|flood| value(flood, quantity));
                assert!((gpu - cpu).abs() <= 1e-4 * cpu.abs().max(1.0), "{quantity}: {cpu} {gpu}");
            }
        }
    }
}

/// Water flows over levees: free, drowned, and back; one crosses cells of all sizes at a slant, with a corner.
#[test]
fn water_flows_over_crests() {
    let Some(gpu) = require_gpu("crests on the GPU") else { return };
    let levee = "obstacle = [{ name = \"levee\", line = [[25, -1], [30, 12], [27, 31]], height_m = 0.6 }]\n";
    for before in ["", ", { depth_m = 0.9, polygon = [[33, 0], [66, 0], [66, 30], [33, 30]] }"] {
        let open = || basin(&dam(before, levee), [66.0, 30.0], |_, _| 70.0);
        let floods = both(gpu.clone(), 10.0, open);
        agree(&floods, 5e-7, 5e-6);
        let over = floods.each_ref().map(|flood| {
            let far = flood.wet_cells().filter(|cell| cell.centroid[0] > 33.0);
            far.map(|cell| cell.area * cell.depth).sum::<f64>()
        });
        assert!(over[0] > 5.0 && (over[1] / over[0] - 1.0).abs() < 1e-4, "{over:?}");
    }
}

/// Ground with waves shorter than the cells, whose heights count: water runs over it, comes in over sides, by rain and from structures, and goes out.
#[test]
fn heights_within_cells_count() {
    let Some(gpu) = require_gpu("heights within cells on the GPU") else { return };
    let sides = "edges = { west = { discharge = 4 }, east = { rating = [[399, 0], [402, 9]] }, south = { stage = 400.2 }, north = \"open\" }\n";
    let works = "stage = [{ name = \"lake\", polygon = [[45, 10], [60, 10], [60, 20], [45, 20]], level_m = 400.3 }]\n\
                 link = [{ name = \"weir\", from = [50, 25], to = [20, 5], law = { weir = { crest_m = 399.9, width_m = 2 } } }]\n\
                 obstacle = [{ name = \"levee\", line = [[25, -1], [30, 12], [27, 31]], height_m = 0.3 }]\n\
                 rain.intensity_mm_per_h = 200\n";
    let ground = |x: f64, y: f64| 400.0 + 0.5 * (2.1 * x).sin() * (1.7 * y).cos();
    for case in [WALLS.to_owned(), sides.to_owned(), format!("{sides}{works}")] {
        let keys = format!(
            "spacing_m = 2\nmanning = 0.03\nstorage = \"level-volume\"\n{case}water = [{{ level_m = 400.1 }}, {{ level_m = 400.4, polygon = [[0, 0], [20, 0], [20, 30], [0, 30]] }}]"
        );
        let floods = both(gpu.clone(), 10.0, || basin(&keys, [66.0, 30.0], ground));
        eprintln!("{case}");
        agree(&floods, 5e-7, 2e-6);
        let [cpu, gpu] = floods.each_ref().map(|flood| value(flood, "energy_in"));
        assert!((gpu - cpu).abs() <= 1e-3 * cpu.abs().max(1.0), "{cpu} {gpu}");
    }
}

/// A lake over such ground stays at rest.
#[test]
fn a_lake_on_ground_with_heights_within_cells_stays_at_rest() {
    let Some(gpu) = require_gpu("a lake over heights within cells on the GPU") else { return };
    let keys =
        format!("spacing_m = 2\nmanning = 0\nstorage = \"level-volume\"\n{WALLS}water = [{{ level_m = 1001.5 }}]");
    let mut flood = basin(&keys, [66.0, 30.0], |x, y| blocks(x, y) + 0.5 * (2.1 * x).sin() * (1.7 * y).cos());
    flood.use_gpu(gpu).unwrap();
    go(&mut flood, 60.0);
    eprintln!("rms {:.2e} m/s after {} steps", rms(&flood), flood.steps());
    assert!(rms(&flood) < 5e-6, "{}", rms(&flood));
}

/// Water in the air falls on the CPU, and the GPU goes on with it from the ground.
#[test]
fn blocks_of_water_fall() {
    let Some(gpu) = require_gpu("a falling block and the GPU") else { return };
    let keys = format!(
        "spacing_m = 1.5\nmanning = 0.03\n{WALLS}water = [{{ depth_m = 0.3 }}, {{ block = {{ from = [20, 10], to = [30, 20], height_m = 2, layers = 2 }} }}]"
    );
    let floods = both(gpu, 6.0, || basin(&keys, [66.0, 30.0], |x, _| 100.0 + 0.2 * (0.3 * x).sin()));
    agree(&floods, 2e-6, 2e-5);
}

/// Cells follow the water.
#[test]
fn cells_follow_the_water() {
    let Some(gpu) = require_gpu("adaptive cells on the GPU") else { return };
    let keys = "adaptive = { finest_m = 0.8 }\n";
    let before = ", { depth_m = 0.2, polygon = [[25, 0], [66, 0], [66, 30], [25, 30]] }";
    let open = || basin(&dam(before, keys), [66.0, 30.0], |x, _| 30.0 + 0.2 * (0.3 * x).sin());
    let floods = both(gpu, 20.0, open);
    let remakes = floods.each_ref().map(VoronoiFlood::remakes);
    assert!(remakes[0] > 3 && remakes[0] == remakes[1], "{remakes:?}");
    assert_eq!(floods[0].cells(), floods[1].cells());
    agree(&floods, 5e-6, 5e-5);
}

/// A dam breaks against houses: the water goes round them and pushes them.
#[test]
fn water_pushes_obstacles() {
    let Some(gpu) = require_gpu("obstacles on the GPU") else { return };
    let houses = "obstacle = [{ name = \"a\", polygon = [[30, 5], [38, 6], [37, 14], [29, 13]] }, { name = \"b\", polygon = [[45, 15], [55, 15], [50, 25]] }]\n";
    let open = || basin(&dam("", houses), [66.0, 30.0], |_, _| 20.0);
    let floods = both(gpu, 6.0, open);
    agree(&floods, 5e-7, 2e-6);
    let columns = floods[0].gauge_columns();
    let rows = floods.each_ref().map(|flood| flood.gauge_row());
    let pushes = columns.iter().enumerate().filter(|(_, column)| ["a", "b"].contains(&column.gauge.as_str()));
    for (k, column) in pushes {
        let [cpu, gpu] = rows.each_ref().map(|row| row[k]);
        // Of the thrust on one side of a house, N, and its impulse, N s.
        let scale = if column.quantity.starts_with("impulse") { 5e5 } else { 1e5 };
        assert!((gpu - cpu).abs() < 2e-4 * scale, "{} {}: {cpu} {gpu}", column.gauge, column.quantity);
    }
}

/// A shallow plain with a deep hole, rough all over: cells in the hole need a quarter of the steps of others.
fn hole(x: f64, y: f64) -> f64 {
    let rough = 0.25 * (1.1 * x + 2.0).sin() * (0.9 * y + 4.0).sin();
    rough - 20.0 * (-((x - 40.0).powi(2) + (y - 27.0).powi(2)) / 20.0).exp()
}

/// Water over the plain and the hole, with steps that are `"local"` or `"global"`.
fn over_a_hole(time_steps: &str, keys: &str, level: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> VoronoiFlood {
    let bounds = Bounds { x_min: 0.0, x_max: 120.0, y_min: 0.0, y_max: 60.0 };
    let velocity = Box::new(|_, _| [0.0; 2]);
    let water = StartWater { filling: Filling::Level(Box::new(level)), polygon: None, velocity };
    let flood = parse(&format!("spacing_m = 1.3\ntime_steps = \"{time_steps}\"\n{keys}")).flood;
    let terrain = Arc::new(Terrain::gridded(bounds, 0.5, hole));
    VoronoiFlood::with_water(&flood, 1, Path::new("."), terrain, &[water]).unwrap()
}

fn step_at_middle(x: f64, _: f64) -> f64 {
    if x < 60.0 { 0.9 } else { 0.3 }
}

/// The flood took fewer than half of the steps that it takes where all cells take the same.
#[track_caller]
fn assert_local(flood: &VoronoiFlood, keys: &str) {
    let mut global = over_a_hole("global", keys, step_at_middle);
    go(&mut global, flood.time());
    assert!(2 * flood.steps() < global.steps(), "{} of {} steps", flood.steps(), global.steps());
}

/// Particle by particle, and in the maps, whose records are taken where a cell's own step ends.
#[test]
fn cells_take_steps_of_their_own() {
    let Some(gpu) = require_gpu("local time steps on the GPU") else { return };
    let keys = format!("manning = 0.03\n{WALLS}");
    for time in [0.3, 3.0, 12.0] {
        let floods = both(gpu.clone(), time, || over_a_hole("local", &keys, step_at_middle));
        agree(&floods, 1e-6, 1e-5);
        assert_local(&floods[1], &keys);
        for (cpu, gpu) in floods[0].maps().iter().zip(floods[1].maps()) {
            let pairs = cpu.values.iter().zip(&gpu.values).filter(|(a, b)| !a.is_nan() && !b.is_nan());
            let (off, all) =
                pairs.fold((0.0, 0.0), |(off, all), (a, b)| (off + f64::from((a - b).abs()), all + f64::from(a.abs())));
            eprintln!("{} at {time} s: off {:.1e}", cpu.name, off / all);
            assert!(off <= 1e-4 * all, "{}: {off} of {all}", cpu.name);
        }
    }
}

/// With all that acts on the water: an inflow, rain that soaks in, an obstacle, a held level, an open side and heights within cells.
#[test]
fn what_acts_on_water_does_so_where_steps_differ() {
    let Some(gpu) = require_gpu("local time steps beside all else") else { return };
    let keys = "manning = 0.03\nstorage = \"level-volume\"\n\
                edges = { west = \"wall\", east = { stage = [[0, 0.3], [60, 0.6]] }, south = \"wall\", north = \"open\" }\n\
                rain.intensity_mm_per_h = 500\ninfiltration = { constant = { rate_mm_per_h = 100.0 } }\n\
                inflow = [{ name = \"spring\", at = [10, 20], discharge_m3_per_s = 5 }]\n\
                obstacle = [{ name = \"house\", polygon = [[80, 28], [86, 30], [84, 38], [78, 36]] }]\n";
    let floods = both(gpu, 3.0, || over_a_hole("local", keys, step_at_middle));
    agree(&floods, 5e-6, 5e-5);
    assert_local(&floods[1], keys);
}

/// Onto dry ground, where films drain: no cell gives more than it has, and water arrives when it does on the CPU.
#[test]
fn films_drain_where_steps_differ() {
    let Some(gpu) = require_gpu("films with local time steps on the GPU") else { return };
    let keys = format!("manning = 0.02\n{WALLS}");
    let dam = |x: f64, _: f64| if x < 60.0 { 0.9 } else { -0.15 };
    let floods = both(gpu, 4.0, || over_a_hole("local", &keys, dam));
    agree(&floods, 1e-6, 1e-5);
    assert!(floods[1].wet_cells().all(|cell| cell.depth > 0.0));
    let [cpu, gpu] = floods.each_ref().map(|flood| flood.maps().swap_remove(3).values);
    let arrived: Vec<_> = cpu.iter().zip(&gpu).filter(|(a, b)| **a > 0.0 && !b.is_nan()).collect();
    let off = arrived.iter().map(|(a, b)| f64::from((*a - *b).abs())).sum::<f64>() / arrived.len() as f64;
    eprintln!("{} arrivals, {off:.1e} s off", arrived.len());
    assert!(arrived.len() > 500 && off < 1e-3, "{} {off}", arrived.len());
}

#[test]
fn a_lake_stays_at_rest_where_steps_differ() {
    let Some(gpu) = require_gpu("a lake with local time steps on the GPU") else { return };
    let mut flood = over_a_hole("local", &format!("manning = 0\n{WALLS}"), |_, _| 0.1);
    flood.use_gpu(gpu).unwrap();
    go(&mut flood, 10.0);
    assert!(rms(&flood) < 1e-5, "{:e}", rms(&flood));
    assert!(flood.ledger().balances[0].relative_error().abs() < 1e-12);
}

/// A state that comes back from the GPU goes on on the CPU, and there again.
#[test]
fn a_flood_with_steps_of_cells_goes_on_elsewhere() {
    let Some(gpu) = require_gpu("local time steps that go on elsewhere") else { return };
    let keys = format!("manning = 0.03\n{WALLS}");
    let open = || over_a_hole("local", &keys, step_at_middle);
    let mut floods = [open(), open()];
    floods[1].use_gpu(gpu).unwrap();
    go(&mut floods[1], 1.0);
    let mut back = open();
    back.restore(&floods[1].save()).unwrap();
    go(&mut back, 2.0);
    floods[1].restore(&back.save()).unwrap();
    for flood in &mut floods {
        go(flood, 3.0);
    }
    let off = differences(&floods);
    assert!(off[0] < 1e-4 && off[1] < 1e-3, "{off:?}");
    assert!(floods[1].ledger().balances[0].relative_error().abs() < 1e-12);
    assert_local(&floods[1], &keys);
}

#[test]
fn what_the_gpu_does_not_compute_is_refused_by_name() {
    let Some(gpu) = require_gpu("refusals of the GPU") else { return };
    let mut flood = basin(&dam("", ""), [66.0, 30.0], |_, _| 0.0);
    flood.use_gpu(gpu).unwrap();
    let Err(ModelError::Setup(text)) = flood.rain(Box::new(|_, _, _| 1e-5)) else {
        panic!("rain by a function is taken")
    };
    assert!(text.contains("rain by a function"), "{text}");
}
