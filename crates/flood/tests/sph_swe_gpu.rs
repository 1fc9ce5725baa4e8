//! Scheme sph-swe on a GPU does what it does on the CPU.

mod common;

use corpuscle_flood::{LiveChange, Particle, SphSweFlood};
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{Balance, GpuModel, Model, ModelError};
use corpuscle_scene::{Scene, builtin};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A dam breaks in a channel that goes round: walls, periodic sides, friction, deep and shallow water.
const DAM: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 120, width_m = 20, cell_m = 2 }, slope_east = 0.01 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 4
manning = 0.02
edges = { west = "wall", east = "wall", south = "periodic", north = "periodic" }
[[flood.water]]
depth_m = 4
polygon = [[0, 0], [60, 0], [60, 20], [0, 20]]
[[flood.water]]
depth_m = 0.5
polygon = [[60, 0], [120, 0], [120, 20], [60, 20]]
"#;

/// Water that runs down a slope without end.
const SLOPE: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 30, width_m = 20, cell_m = 2 }, slope_east = -0.05, slope_north = 0.02 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
manning = 0.03
edges = { west = "periodic", east = "periodic", south = "periodic", north = "periodic" }
water = [{ depth_m = 1, velocity_m_per_s = [1, 0] }]
"#;

/// Water that runs over rough ground and out of the scene.
const VALLEY: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }
[flood]
scheme = "sph-swe"
spacing_m = 3
spacing_depth_m = 1
friction.chezy = 40
[[flood.water]]
depth_m = 1.5
polygon = [[100, 60], [300, 60], [300, 140], [100, 140]]
"#;

/// A river runs into a valley over dry ground.
const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }
[flood]
scheme = "sph-swe"
spacing_m = 3
spacing_depth_m = 1
manning = 0.03
[[flood.water]]
depth_m = 0.5
polygon = [[100, 80], [200, 80], [200, 120], [100, 120]]
[[flood.inflow]]
name = "river"
at = [40, 100]
discharge_m3_per_s = [[0, 40], [60, 200]]
"#;

/// A dam breaks before two houses, one of them round, in water deep enough for the scheme's pressure.
const HOUSES: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 80, width_m = 30, cell_m = 2 }, slope_east = -0.01 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 2
manning = 0.02
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
[[flood.water]]
depth_m = 2
polygon = [[0, 0], [30, 0], [30, 30], [0, 30]]
[[flood.water]]
depth_m = 1.4
polygon = [[30, 0], [80, 0], [80, 30], [30, 30]]
velocity_m_per_s = [0.5, 0.2]
[[flood.obstacle]]
name = "house"
polygon = [[36, 8], [42, 10], [40, 18], [34, 16]]
[[flood.obstacle]]
name = "tower"
circle = { centre = [38, 23], radius_m = 2 }
"#;

/// Water runs round a house on rough hills, with friction, between walls and a side that is open.
const HILLS: &str = r#"
run.until_s = 60
terrain.rough-hills = { extent = { length_m = 60, width_m = 40, cell_m = 1 }, relief_m = 6, hill_size_m = 30 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
manning = 0.02
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
water = [{ depth_m = 1, velocity_m_per_s = [1, 0.5] }]
[[flood.obstacle]]
name = "house"
polygon = [[30, 15], [36, 17], [34, 25], [28, 23]]
"#;

/// A block falls into a pool and beside it.
const FALL: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 40, width_m = 30, cell_m = 1 }, slope_east = -0.03 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
manning = 0.03
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
[[flood.water]]
depth_m = 0.6
polygon = [[0, 0], [20, 0], [20, 30], [0, 30]]
[[flood.water]]
block = { from = [10, 8], to = [30, 22], height_m = 0.7, layers = 2 }
velocity_m_per_s = [1, -0.5]
"#;

fn open(text: &str) -> SphSweFlood {
    common::sph_swe(&common::scene(text))
}

fn on_gpu(text: &str, gpu: &Gpu) -> SphSweFlood {
    common::on_gpu::on_gpu(open(text), gpu)
}

fn step(flood: &mut SphSweFlood, count: usize) {
    for _ in 0..count {
        // A little more than a step, lest rounding take it for less.
        flood.advance_to(flood.time() + 1.000_001 * flood.time_step(), &AtomicBool::new(false)).unwrap();
    }
}

fn go(flood: &mut SphSweFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

fn by_id(flood: &SphSweFlood) -> Vec<Particle> {
    let mut particles = flood.particles().to_vec();
    particles.sort_unstable_by_key(|particle| particle.id);
    particles
}

/// Largest differences over all particles: position, m; velocity, m/s; depth, m.
fn differences(a: &SphSweFlood, b: &SphSweFlood) -> [f64; 3] {
    let (a, b) = (by_id(a), by_id(b));
    assert_eq!(a.len(), b.len(), "particles");
    let mut most = [0.0_f64; 3];
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((a.id, a.outside), (b.id, b.outside));
        let apart = [(a.x - b.x).hypot(a.y - b.y), (a.u - b.u).hypot(a.v - b.v), (a.depth - b.depth).abs()];
        most = [0, 1, 2].map(|k| most[k].max(apart[k]));
    }
    most
}

/// Root mean square of the difference of two maps of depth where either is wet, m.
fn apart_on_the_map(a: &SphSweFlood, b: &SphSweFlood) -> f64 {
    let depths = |flood: &SphSweFlood| flood.maps().into_iter().find(|map| map.name == "depth").unwrap().values;
    let pairs =
        depths(a).into_iter().zip(depths(b)).map(|(a, b)| [a, b].map(|depth| if depth.is_nan() { 0.0 } else { depth }));
    let wet: Vec<f64> =
        pairs.filter(|depths| depths.iter().any(|depth| *depth > 0.0)).map(|[a, b]| f64::from(a - b).powi(2)).collect();
    (wet.iter().sum::<f64>() / wet.len() as f64).sqrt()
}

#[test]
fn particle_by_particle_as_on_the_cpu() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    for (name, text) in [
        ("dam", DAM),
        ("slope", SLOPE),
        ("valley", VALLEY),
        ("river", RIVER),
        ("houses", HOUSES),
        ("hills", HILLS),
        ("fall", FALL),
    ] {
        let (mut host, mut device) = (open(text), on_gpu(text, &gpu));
        for (steps, most) in [(1, 3e-5), (9, 1e-4)] {
            step(&mut host, steps);
            step(&mut device, steps);
            let apart = differences(&host, &device);
            assert!(apart.iter().all(|apart| *apart < most), "{name} after {} steps: {apart:?}", host.steps());
            assert!((device.time_step() / host.time_step() - 1.0).abs() < 1e-4);
        }
    }
}

/// In the open, at walls and round houses.
#[test]
fn every_kernel_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("kernels of scheme sph-swe on the GPU") else { return };
    for name in ["mueller", "cubic-spline", "wendland-c2"] {
        for text in [DAM, HOUSES] {
            let text = format!("{text}\n[flood.sph_swe]\nkernel = \"{name}\"\n");
            let (mut host, mut device) = (open(&text), on_gpu(&text, &gpu));
            step(&mut host, 10);
            step(&mut device, 10);
            let apart = differences(&host, &device);
            assert!(apart.iter().all(|apart| *apart < 1e-4), "{name}: {apart:?}");
        }
    }
}

/// Roughness from a raster and by kinds of ground, whose cells are no particle's.
#[test]
fn rough_ground_slows_as_on_the_cpu() {
    let Some(gpu) = require_gpu("roughness on the GPU") else { return };
    let folder = tempfile::tempdir().unwrap();
    let raster = |name: &str, value: fn(usize) -> f64| {
        let rows: Vec<String> = (0..7)
            .map(|row| (0..9).map(|column| value(row * 9 + column).to_string()).collect::<Vec<_>>().join(" "))
            .collect();
        let head = "ncols 9\nnrows 7\nxllcorner -3\nyllcorner -4\ncellsize 4.5\nNODATA_value -9999\n";
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{head}{}\n", rows.join("\n"))).unwrap();
        path.display().to_string()
    };
    let numbers = raster("n.asc", |cell| 0.01 + 0.09 * (cell % 5) as f64);
    let classes = raster("classes.asc", |cell| (cell % 3) as f64);
    let land_use = format!(
        "manning = 0.01\n[flood.land_use]\nraster = \"{classes}\"\n[[flood.land_use.class]]\ncode = 1\nmanning = 0.2\n\
         [[flood.land_use.class]]\ncode = 2\nmanning = 0.05\n"
    );
    for keys in [format!("manning = {{ raster = \"{numbers}\" }}\n"), land_use] {
        let text = SLOPE.replace("manning = 0.03\n", "").replace("[1, 0] }]", "[1, 0] }]\n") + &keys;
        let (mut host, mut device) = (open(&text), on_gpu(&text, &gpu));
        step(&mut host, 10);
        step(&mut device, 10);
        let apart = differences(&host, &device);
        assert!(apart.iter().all(|apart| *apart < 1e-4), "{keys}: {apart:?}");
    }
}

/// After many steps particles that stood at a threshold have gone their own ways; the water as a whole has not. Times are no multiples of a step, lest rounding
/// take one more.
#[test]
fn totals_and_maps_as_on_the_cpu() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    // On steeper hills this scheme heaps the water up to 20 m, and rounding decides where.
    let gentle = HILLS.replace("relief_m = 6", "relief_m = 1");
    for (name, text, end) in [
        ("dam", DAM, 7.99),
        ("valley", VALLEY, 7.99),
        ("river", RIVER, 7.99),
        ("hills", &gentle, 1.99),
        ("fall", FALL, 3.99),
    ] {
        let (mut host, mut device) = (open(text), on_gpu(text, &gpu));
        go(&mut host, end);
        go(&mut device, end);
        assert_eq!(device.time(), end);
        assert!(device.steps().abs_diff(host.steps()) <= 1 && device.steps() > 30, "{name}: {} steps", device.steps());
        assert!(apart_on_the_map(&host, &device) < 2e-3, "{name}: {}", apart_on_the_map(&host, &device));
        let [host, device] = [host, device].map(|flood| flood.ledger().balances);
        for (host, device) in host.iter().zip(&device) {
            let scale = host.initial.abs() + host.inflow.abs() + host.outflow.abs();
            for (host, device) in [(host.outflow, device.outflow), (host.now, device.now)] {
                assert!((host - device).abs() < 2e-3 * scale, "{name}, {host} against {device}");
            }
            let errors = [host, device].map(Balance::relative_error);
            assert!(errors[1].abs() < 1e-6, "{name}, {}: {errors:?} {host:?} {device:?}", device.quantity);
        }
    }
}

/// The force on a house, its sum over time, and what is put back to its walls.
#[test]
fn houses_are_pushed_as_on_the_cpu() {
    let Some(gpu) = require_gpu("houses on the GPU") else { return };
    let (mut host, mut device) = (open(HOUSES), on_gpu(HOUSES, &gpu));
    for time in [0.5, 1.01] {
        go(&mut host, time);
        go(&mut device, time);
    }
    let columns = host.gauge_columns();
    let rows = [&host, &device].map(SphSweFlood::gauge_row);
    let pushes = columns
        .iter()
        .enumerate()
        .filter(|(_, column)| column.quantity.starts_with("force") || column.quantity.starts_with("impulse"));
    let pushes: Vec<_> = pushes.collect();
    assert_eq!(pushes.len(), 8);
    let largest = |quantity: &str| {
        let of_it = pushes.iter().filter(|(_, column)| column.quantity.starts_with(quantity));
        of_it.map(|(number, _)| rows[0][*number].abs()).fold(0.0, f64::max)
    };
    for (number, column) in &pushes {
        let scale = largest(&column.quantity[..5]);
        let [host, device] = [rows[0][*number], rows[1][*number]];
        assert!(
            scale > 1e3 && (host - device).abs() < 2e-3 * scale,
            "{} {}: {host} against {device}",
            column.gauge,
            column.quantity
        );
    }
    assert!(host.put_back().abs_diff(device.put_back()) <= 2, "{} against {}", host.put_back(), device.put_back());
    let in_tower = |particle: &&Particle| (particle.x - 38.0).hypot(particle.y - 23.0) < 1.99;
    assert_eq!(device.particles().iter().filter(in_tower).count(), 0);
    // Handed over anew, impulses go on.
    let mut again = on_gpu(HOUSES, &gpu);
    again.restore(&device.save()).unwrap();
    let before = again.gauge_row();
    go(&mut again, 1.31);
    let (number, _) = pushes.iter().find(|(_, column)| column.quantity == "impulse_east").unwrap();
    assert!(again.gauge_row()[*number] > before[*number] && before[*number] == rows[1][*number]);
}

/// How often something looks changes nothing but the rounding of the time asked for.
#[test]
fn when_it_is_looked_at_does_not_matter() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    for text in [DAM, RIVER] {
        let (mut once, mut often) = (on_gpu(text, &gpu), on_gpu(text, &gpu));
        go(&mut once, 6.0);
        (1..=20).for_each(|k| go(&mut often, 0.3 * f64::from(k)));
        assert_eq!(by_id(&once), by_id(&often));
    }
}

#[test]
fn a_state_goes_from_gpu_to_cpu_and_back() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    let mut first = on_gpu(DAM, &gpu);
    go(&mut first, 1.0);
    let saved = first.save();
    let mut host = open(DAM);
    host.restore(&saved).unwrap();
    let mut device = on_gpu(DAM, &gpu);
    device.restore(&saved).unwrap();
    assert_eq!(by_id(&host), by_id(&device));
    go(&mut host, 2.0);
    go(&mut device, 2.0);
    assert!(differences(&host, &device).iter().all(|apart| *apart < 1e-3));
}

#[test]
fn no_particle_and_one_particle_go_too() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    for (depth, polygon, count) in
        [("1e-9", "[[1, 1], [2, 1], [2, 2], [1, 2]]", 0), ("1", "[[6, 6], [7, 6], [7, 7], [6, 7]]", 1)]
    {
        let text = format!(
            "run.until_s = 9\nterrain.plane = {{ extent = {{ length_m = 40, width_m = 30, cell_m = 1 }}, slope_east = -0.1 }}\n\
             [flood]\nscheme = \"sph-swe\"\nspacing_m = 1\nspacing_depth_m = 1\nwater = [{{ depth_m = {depth}, polygon = {polygon} }}]"
        );
        let (mut host, mut device) = (open(&text), on_gpu(&text, &gpu));
        assert_eq!(host.particles().len(), count, "{text}");
        go(&mut host, 2.99);
        go(&mut device, 2.99);
        assert_eq!(device.time(), 2.99);
        let apart = differences(&host, &device);
        assert!(apart.iter().all(|apart| *apart < 1e-4), "{apart:?} {:?} {:?}", host.particles(), device.particles());
    }
}

#[test]
fn a_lost_gpu_ends_with_an_error_and_the_state_of_before() {
    let Some(gpu) = require_gpu("scheme sph-swe on the GPU") else { return };
    let mut flood = on_gpu(DAM, &gpu);
    go(&mut flood, 1.0);
    let before = by_id(&flood);
    gpu.device.destroy();
    let error = flood.advance_to(2.0, &AtomicBool::new(false)).unwrap_err();
    assert!(matches!(error, ModelError::Device(_)) && error.to_string().contains(&gpu.name), "{error}");
    let mut host = open(DAM);
    host.restore(&flood.save()).unwrap();
    assert_eq!(by_id(&host), before);
    go(&mut host, 2.0);
}

#[test]
fn live_changes_act_on_the_gpu() {
    let Some(gpu) = require_gpu("live changes on the GPU") else { return };
    let (mut host, mut device) = (open(RIVER), on_gpu(RIVER, &gpu));
    for flood in [&mut host, &mut device] {
        go(flood, 0.99);
        LiveChange::Discharge { inflow: 0, discharge: 300.0 }.change(flood).unwrap();
        LiveChange::Manning(0.1).change(flood).unwrap();
        go(flood, 6.99);
    }
    let [host, gpu] = [&host, &device].map(|flood| flood.ledger().balances[0].inflow);
    // 40 to 43 m3/s for one second, then six of 300 m3/s, in particles of 9 m3.
    assert!((host - 1841.0).abs() < 10.0 && (gpu - host).abs() < 1.0, "{host} {gpu}");
}

/// Water ten million times as viscous as the scene has it, far more than its time step can resolve: its velocities come to be no
/// numbers.
#[test]
fn water_whose_velocities_are_no_numbers_breaks_down_with_an_error() {
    let Some(gpu) = require_gpu("a breakdown on the GPU") else { return };
    let viscous = [("flood.sph_swe.viscosity".to_owned(), "1e6".to_owned())];
    let mut scene = Scene::parse(builtin("flood/cuboid").unwrap().text, "flood/cuboid", &viscous).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Arc::new(Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap());
    let mut both = [(); 2].map(|()| SphSweFlood::new(&scene.flood, 1, Path::new("."), Arc::clone(&terrain)).unwrap());
    both[1].use_gpu(gpu).unwrap();
    // Which of its numbers is none first depends on the device.
    for flood in &mut both {
        let error = flood.advance_to(20.0, &AtomicBool::new(false)).unwrap_err();
        assert!(matches!(error, ModelError::Breakdown { .. }), "{error}");
    }
}

#[test]
fn forms_of_the_cpu_alone_are_refused() {
    let Some(gpu) = require_gpu("what the GPU does not compute") else { return };
    let text = HILLS.replace("manning = 0.02", "manning = 0.02\nsph_swe.smoothing = \"rate\"");
    let mut flood = open(&text);
    let error = flood.use_gpu(gpu).unwrap_err();
    assert!(matches!(error, ModelError::Setup(_)), "{error}");
    assert!(error.to_string().contains("flood.sph_swe.smoothing = \"rate\""), "{error}");
    assert_eq!((flood.backend(), flood.steps()), ("cpu", 0));
    go(&mut flood, 0.1);
}
