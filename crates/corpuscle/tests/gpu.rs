//! Built-in floods and dew on the GPU do what they do on the CPU: particle by particle after one step and after ten,
//! gauges, ledger and maps after hundred.
#![cfg(feature = "gpu")]

use corpuscle::Simulation;
use corpuscle::gpu::require_gpu;
use corpuscle::model::{GaugeColumn, Map, Model, Values};
use corpuscle::scene::{Scene, builtin, scenes};
use corpuscle_dew::Dew;
use corpuscle_flood::{SphSweFlood, VoronoiFlood};
use std::any::Any;
use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Scenes of scheme sph-swe, the time from which they are compared (the water moves by then, or has just landed), and how far gauges may be apart after hundred
/// steps: more where water has just landed from 50 m.
const FLOODS: [(&str, f64, f64); 3] =
    [("flood/cuboid", 1.7, 1e-3), ("flood/cylinder", 1.7, 1e-3), ("flood/rough-terrain", 2.0, 1e-2)];

/// Scenes, the time from which they are compared, and a distance of particles, m, at which software in place of a GPU does hundred steps in seconds.
const DEW: [(&str, f64, &str); 6] = [
    ("dew/pane", 0.15, "0.003"),
    ("dew/lens", 0.1, "0.003"),
    ("dew/windscreen", 0.1, "0.0025"),
    ("dew/breath", 0.3, "0.0025"),
    ("dew/three-boundaries", 0.003, "0.00225"),
    ("dew/glassware", 0.01, "0.006"),
];

/// Looks and gauges are then due amid steps of scheme sph-swe: a step that ends just then may end a little later in single precision.
const UNEVEN: (&str, &str) = ("flood.sph_swe.time_step_s", "0.0199");

fn open(name: &str, overrides: &[(&str, &str)]) -> Simulation {
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    open_as_changed(name, &overrides)
}

/// Built-in scenes of scheme voronoi, the time from which they are compared, a spacing, m, at which software in place of a GPU does hundred steps in
/// seconds, and how far gauges may be apart after hundred steps.
const VORONOI: [(&str, f64, &str, f64); 5] = [
    ("flood/valley", 60.0, "5", 1e-4),
    ("flood/dam-break", 1.0, "1.5", 1e-4),
    ("flood/lake-at-rest", 0.5, "1.5", 1e-4),
    ("flood/city", 1.5, "3", 1e-4),
    ("flood/cloudburst", 700.0, "4", 1e-3),
];

fn open_as_changed(name: &str, overrides: &[(String, String)]) -> Simulation {
    let scene = Scene::parse(builtin(name).unwrap().text, name, overrides).unwrap();
    Simulation::open(scene, Path::new("")).unwrap()
}

/// A built-in scene computed on the CPU and on the GPU, both from the same state on.
fn both_from(name: &str, time: f64, overrides: &[(&str, &str)]) -> [Simulation; 2] {
    both_of(|| open(name, overrides), time)
}

fn both_of(open: impl Fn() -> Simulation, time: f64) -> [Simulation; 2] {
    let mut both = [open(), open()];
    both[0].model_mut().advance_to(time, &AtomicBool::new(false)).unwrap();
    both[1].use_gpu().unwrap();
    let state = both[0].model().save();
    both[1].model_mut().restore(&state).unwrap();
    assert_eq!(both[1].model().backend(), "gpu");
    both
}

fn time_step(model: &dyn Model) -> f64 {
    let model: &dyn Any = model;
    let of_flood = model.downcast_ref::<SphSweFlood>().map(SphSweFlood::time_step);
    let of_voronoi = model.downcast_ref::<VoronoiFlood>().map(VoronoiFlood::time_step);
    of_flood.or(of_voronoi).unwrap_or_else(|| model.downcast_ref::<Dew>().unwrap().time_step())
}

/// Takes as many steps on both, and shows both a little later.
fn step(both: &mut [Simulation; 2], steps: u64) {
    let stop = AtomicBool::new(false);
    let begun = both[0].model().steps();
    while both[0].model().steps() < begun + steps {
        let model = both[0].model_mut();
        let next = model.time() + time_step(model);
        model.advance_to(next, &stop).unwrap();
    }
    // The GPU has the time in single precision.
    let time = both[0].model().time() + 0.5 * time_step(both[0].model());
    both.iter_mut().for_each(|simulation| simulation.model_mut().advance_to(time, &stop).unwrap());
    // How long a step may be depends on the fastest particle of all, which rounding changes.
    let [host, device] = both.each_ref().map(|simulation| simulation.model().steps());
    assert!(host.abs_diff(device) <= steps / 50, "{host} and {device} steps");
}

/// How far particles are apart in each of the numbers that are told of them: all but two in a thousand, and the farthest. They have the same identities.
fn apart<const COUNT: usize>(mut both: [Vec<(u64, [f64; COUNT])>; 2]) -> [[f64; 2]; COUNT] {
    both.iter_mut().for_each(|particles| particles.sort_unstable_by_key(|(id, _)| *id));
    let [host, device] = &both;
    assert!(host.len() == device.len() && host.iter().zip(device).all(|((id, _), (same, _))| id == same));
    std::array::from_fn(|k| {
        let mut off: Vec<f64> =
            host.iter().zip(device).map(|((_, host), (_, device))| (host[k] - device[k]).abs()).collect();
        off.sort_unstable_by(f64::total_cmp);
        [off[off.len() * 998 / 1000], off[off.len() - 1]]
    })
}

/// Position, velocity and depth of each particle.
fn water(model: &dyn Model) -> Vec<(u64, [f64; 5])> {
    let model: &dyn Any = model;
    let particles = model.downcast_ref::<SphSweFlood>().unwrap().particles();
    particles.iter().map(|p| (p.id, [p.x, p.y, p.u, p.v, p.depth])).collect()
}

/// Position, velocity, temperature, vapour and fog of each particle.
fn air(model: &dyn Model) -> Vec<(u64, [f64; 9])> {
    let model: &dyn Any = model;
    let air = model.downcast_ref::<Dew>().unwrap().air().iter();
    air.map(|particle| {
        let ([x, y, z], [u, v, w]) = (particle.position, particle.velocity);
        (particle.id, [x, y, z, u, v, w, particle.temperature, particle.vapour, particle.fog])
    })
    .collect()
}

/// Gauges, and what the ledgers balance to.
fn assert_totals(name: &str, [host, device]: [&dyn Model; 2], bound: impl Fn(&GaugeColumn, f64) -> f64) {
    for ((column, host), device) in host.gauge_columns().iter().zip(host.gauge_row()).zip(device.gauge_row()) {
        let is_near = (host - device).abs() <= bound(column, host.abs()) || host.is_nan() && device.is_nan();
        assert!(is_near, "{name}, {}.{}: {host} and {device}", column.gauge, column.quantity);
    }
    for balance in device.ledger().balances {
        // In water at rest so little momentum is exchanged that its sum is rounding.
        let bound = if balance.quantity == "momentum" { 1e-5 } else { 1e-6 };
        let is_at_rest = balance.quantity == "momentum" && name == "flood/lake-at-rest";
        let error = balance.relative_error().abs();
        assert!(error < bound || is_at_rest, "{name}: {} {error}", balance.quantity);
    }
}

/// Root mean square over the cells, over the largest, and few cells that are wet in one of them only.
fn assert_map(name: &str, [host, device]: [&Map; 2], bound: f64) {
    let pairs = || host.values.iter().zip(&device.values);
    let flipped = pairs().filter(|(host, device)| host.is_nan() != device.is_nan()).count();
    let wet: Vec<_> = pairs().filter(|(host, device)| !host.is_nan() && !device.is_nan()).collect();
    let squares = wet.iter().map(|(host, device)| f64::from(*host - *device).powi(2)).sum::<f64>();
    let largest = wet.iter().map(|(host, _)| f64::from(**host)).fold(1.0, f64::max);
    let off = (squares / wet.len() as f64).sqrt() / largest;
    assert!(wet.len() > 100 && off < 5.0 * bound, "{name}, {}: {off} of {largest}", host.name);
    assert!(flipped <= wet.len() / 100, "{name}, {}: {flipped} of {} cells", host.name, wet.len());
}

/// Positions, m; velocities, m/s, and depths, m, where nothing is faster than 1 m/s or deeper than 1 m: after one step and after ten.
const WATER: [(u64, f64); 2] = [(1, 3e-5), (9, 1e-4)];

#[test]
fn built_in_floods_of_scheme_sph_swe_go_as_on_the_cpu() {
    if require_gpu("built-in floods of scheme sph-swe on the GPU").is_none() {
        return;
    }
    for (name, time, bound) in FLOODS {
        let mut both = both_from(name, time, &[UNEVEN]);
        let ground = both[0].terrain().unwrap().bounds().size();
        for (steps, near) in WATER {
            step(&mut both, steps);
            let told = both.each_ref().map(|simulation| water(simulation.model()));
            let largest = |k: usize| told[0].iter().map(|(_, told)| told[k].abs()).fold(1.0, f64::max);
            // Single precision tells positions on grounds wider than 500 m less finely.
            let size = (ground.into_iter().fold(0.0, f64::max) / 500.0).max(1.0);
            let (fastest, deepest) = (largest(2).hypot(largest(3)), largest(4));
            let scales = [size, size, fastest, fastest, deepest];
            for ([most, farthest], scale) in apart(told).into_iter().zip(scales) {
                // A wall puts a particle back, or does not.
                let is_near = most < near * scale && farthest < 20.0 * near * scale;
                assert!(is_near, "{name}, {steps} steps: {most}, {farthest} of {scale}");
            }
        }
        step(&mut both, 90);
        let both = both.each_ref().map(Simulation::model);
        assert_totals(name, both, |_, value| bound * value.max(1.0));
        let [host, device] = both.map(Model::maps);
        assert!(host.len() >= 6 && host.len() == device.len());
        host.iter().zip(&device).for_each(|(host, device)| assert_map(name, [host, device], bound));
    }
}

/// Velocity and depth of each cell that is a millimetre deep.
fn cells(model: &dyn Model) -> HashMap<u64, [f64; 3]> {
    let set = model.frame().sets.remove(0);
    let Values::Scalar(depth) = &set.columns[0].values else { panic!("depth is a scalar") };
    let rows = set.id.iter().zip(depth).zip(&set.velocity).filter(|((_, depth), _)| **depth > 1e-3);
    rows.map(|((id, depth), [u, v, _])| (*id, [*u, *v, *depth])).collect()
}

#[test]
fn built_in_floods_of_scheme_voronoi_go_as_on_the_cpu() {
    if require_gpu("built-in floods on the GPU").is_none() {
        return;
    }
    for (name, time, spacing, bound) in VORONOI {
        let spacing = [("flood.spacing_m".to_owned(), spacing.to_owned())];
        let mut both = both_of(|| open_as_changed(name, &spacing), time);
        for (steps, near) in WATER {
            step(&mut both, steps);
            let [cpu, gpu] = both.each_ref().map(|simulation| cells(simulation.model()));
            let largest = |k: usize| cpu.values().map(|cell| cell[k].abs()).fold(1.0, f64::max);
            let [fastest, deepest] = [largest(0).hypot(largest(1)), largest(2)];
            let pairs: Vec<_> = cpu.iter().filter_map(|(id, cell)| Some((cell, gpu.get(id)?))).collect();
            // At the depth from which cells are compared rounding decides.
            let counts = [cpu.len(), gpu.len(), pairs.len()];
            assert!(
                pairs.len() > 500 && cpu.len().max(gpu.len()) - pairs.len() <= pairs.len() / 200,
                "{name}: {counts:?}"
            );
            for (k, scale) in [fastest, fastest, deepest].into_iter().enumerate() {
                let mut off: Vec<f64> = pairs.iter().map(|(cpu, gpu)| (cpu[k] - gpu[k]).abs()).collect();
                off.sort_unstable_by(f64::total_cmp);
                let (most, farthest) = (off[off.len() * 998 / 1000], off[off.len() - 1]);
                eprintln!("{name}, {} steps, {k}: {most:.1e}, {farthest:.1e} of {scale:.1}", both[0].model().steps());
                assert!(
                    most < near * scale && farthest < 20.0 * near * scale,
                    "{name}, {steps} steps: {most}, {farthest} of {scale}"
                );
            }
        }
        step(&mut both, 90);
        let both = both.each_ref().map(Simulation::model);
        assert_totals(name, both, |_, value| bound * value.max(1.0));
        let [cpu, gpu] = both.map(Model::maps);
        assert!(cpu.len() >= 6 && cpu.len() == gpu.len());
        cpu.iter().zip(&gpu).for_each(|(cpu, gpu)| assert_map(name, [cpu, gpu], bound));
    }
}

/// Positions, m; velocities, m/s; temperature, K; vapour and fog, parts of the mass: after one step and after ten.
const AIR: [(u64, [f64; 4]); 2] = [(1, [3e-8, 3e-6, 1e-5, 1e-8]), (9, [1e-7, 2e-5, 1e-4, 1e-7])];

/// Drops on the CPU beside air on the GPU are the same drops; of hundreds one may have merged and the other not.
fn dew_goes_as_on_the_cpu(scenes: &[(&str, f64, &str)]) {
    if require_gpu("built-in dew on the GPU").is_none() {
        return;
    }
    // Those of drops and pairs, which are few, and fog that is only just there.
    let of_few = ["number", "drops", "covered_area", "covered_part", "mean_radius", "wall_pairs", "fog"];
    for &(name, time, spacing) in scenes {
        let mut both = both_from(name, time, &[("dew.spacing_m", spacing)]);
        for (steps, [position, velocity, temperature, part]) in AIR {
            step(&mut both, steps);
            let told = both.each_ref().map(|simulation| air(simulation.model()));
            let bounds = [position, position, position, velocity, velocity, velocity, temperature, part, part];
            for ([_, farthest], bound) in apart(told).into_iter().zip(bounds) {
                assert!(farthest < bound, "{name}, {steps} steps: {farthest}, not {bound}");
            }
        }
        step(&mut both, 90);
        // Less than 1e-15 kg of water is none.
        let bound = |column: &GaugeColumn, value: f64| {
            1e-15 + value * if of_few.contains(&column.quantity) { 5e-3 } else { 5e-4 }
        };
        assert_totals(name, both.each_ref().map(Simulation::model), bound);
    }
}

#[test]
fn the_pane_goes_as_on_the_cpu() {
    dew_goes_as_on_the_cpu(&DEW[..1]);
}

#[test]
#[ignore = "takes minutes without a GPU; cargo test --release --workspace --test gpu -- --ignored"]
fn all_built_in_dew_goes_as_on_the_cpu() {
    dew_goes_as_on_the_cpu(&DEW);
}

/// What the GPU cannot compute says so by name; what it can is in the lists above.
#[test]
fn the_other_built_in_scenes_are_refused() {
    if require_gpu("refusals by the GPU").is_none() {
        return;
    }
    let floods = FLOODS.iter().map(|flood| flood.0).chain(VORONOI.iter().map(|flood| flood.0));
    let compared: Vec<_> = floods.chain(DEW.iter().map(|dew| dew.0)).collect();
    let fetched = |text: &str| text.contains("[terrain.fetch]");
    let others = scenes().filter(|scene| !compared.contains(&scene.name) && !fetched(scene.text));
    for scene in others.filter(|scene| scene.name != "gas/million") {
        let error = open(scene.name, &[]).use_gpu().unwrap_err();
        assert!(error.is_refusal() && error.to_string().contains("--backend"), "{}: {error}", scene.name);
    }
    let rate = [("flood.scheme", "sph-swe"), ("flood.sph_swe.smoothing", "rate")];
    let rate = rate.map(|(path, value)| (path.to_owned(), value.to_owned()));
    let error = open_as_changed("flood/dam-break", &rate).use_gpu().unwrap_err();
    assert!(error.is_refusal() && error.to_string().contains("smoothing"), "{error}");
}
