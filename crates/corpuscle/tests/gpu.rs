//! Built-in floods and dew on the graphics card.
#![cfg(feature = "gpu")]

use corpuscle::Simulation;
use corpuscle::gpu::require_gpu;
use corpuscle::scene::{BUILTIN, Scene, builtin};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Time to go: some ten to fifty steps.
const TIMES: [(&str, f64); 8] = [
    ("flood/valley", 20.0),
    ("flood/dam-break", 1.0),
    ("flood/lake-at-rest", 0.5),
    ("flood/city", 1.5),
    ("flood/cloudburst", 200.0),
    ("flood/cuboid", 1.7),
    ("flood/cylinder", 1.7),
    ("flood/rough-terrain", 1.5),
];

fn open(name: &str) -> Simulation {
    let scene = Scene::parse(builtin(name).unwrap().text, name, &[]).unwrap();
    Simulation::open(scene, Path::new("")).unwrap()
}

/// A built-in scene at a time, computed on the processor and on the card.
fn both_at(name: &str, time: f64) -> [Simulation; 2] {
    let mut both = [open(name), open(name)];
    both[1].use_gpu().unwrap();
    assert_eq!(both[1].model().backend(), "gpu");
    for simulation in &mut both {
        simulation.model_mut().advance_to(time, &AtomicBool::new(false)).unwrap();
    }
    both
}

#[test]
fn built_in_floods_go_as_on_the_processor() {
    if require_gpu("built-in floods on the card").is_none() {
        return;
    }
    for (name, time) in TIMES {
        let both = both_at(name, time);
        let [host, card] = both.each_ref().map(Simulation::model);
        assert!(host.steps() >= 5 && host.steps().abs_diff(card.steps()) <= 1, "{name}: {} steps", host.steps());
        assert_eq!(host.particles(), card.particles(), "{name}");
        let columns = host.gauge_columns();
        for ((column, host), card) in columns.iter().zip(host.gauge_row()).zip(card.gauge_row()) {
            let scale = host.abs().max(1.0);
            assert!(
                (host - card).abs() < 1e-3 * scale,
                "{name}, {}.{}: {host} and {card}",
                column.gauge,
                column.quantity
            );
        }
    }
}

/// Time to go: some fifty steps and more, so that there are drops.
const DEW: [(&str, f64); 4] =
    [("dew/pane", 0.15), ("dew/lens", 0.1), ("dew/three-boundaries", 0.008), ("dew/glassware", 0.03)];

/// Drops on the processor beside air on the card are the same drops, so their numbers are the same too.
#[test]
fn built_in_dew_goes_as_on_the_processor() {
    if require_gpu("built-in dew on the card").is_none() {
        return;
    }
    for (name, time) in DEW {
        let both = both_at(name, time);
        let [host, card] = both.each_ref().map(Simulation::model);
        assert!(host.steps() >= 50 && host.steps() == card.steps(), "{name}: {} steps", host.steps());
        let columns = host.gauge_columns();
        for ((column, host), card) in columns.iter().zip(host.gauge_row()).zip(card.gauge_row()) {
            let is_near = (host - card).abs() <= 1e-4 * host.abs() || (host.is_nan() && card.is_nan());
            assert!(is_near, "{name}, {}.{}: {host} and {card}", column.gauge, column.quantity);
        }
        let errors = card.ledger().balances.into_iter().map(|balance| balance.relative_error().abs());
        assert!(errors.fold(0.0, f64::max) < 1e-6, "{name}");
    }
}

/// What the card cannot compute says so by name, and those that it can are in the lists above.
#[test]
fn the_other_built_in_scenes_are_refused() {
    if require_gpu("refusals by the card").is_none() {
        return;
    }
    let fetched = |text: &str| text.contains("[terrain.fetch]");
    let others = BUILTIN
        .iter()
        .filter(|scene| !TIMES.iter().chain(&DEW).any(|(name, _)| *name == scene.name) && !fetched(scene.text));
    for scene in others.filter(|scene| scene.name != "gas/million") {
        let error = open(scene.name).use_gpu().unwrap_err();
        assert!(error.is_refusal() && error.to_string().contains("--backend"), "{}: {error}", scene.name);
    }
}
