//! Built-in floods on the graphics card.
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

#[test]
fn built_in_floods_go_as_on_the_processor() {
    if require_gpu("built-in floods on the card").is_none() {
        return;
    }
    for (name, time) in TIMES {
        let (mut host, mut card) = (open(name), open(name));
        card.use_gpu().unwrap();
        assert_eq!(card.model().backend(), "gpu");
        for simulation in [&mut host, &mut card] {
            simulation.model_mut().advance_to(time, &AtomicBool::new(false)).unwrap();
        }
        let (host, card) = (host.model(), card.model());
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

/// What the card cannot compute says so by name, and those that it can are in the list above.
#[test]
fn the_other_built_in_scenes_are_refused() {
    if require_gpu("refusals by the card").is_none() {
        return;
    }
    let fetched = |text: &str| text.contains("[terrain.fetch]");
    let others =
        BUILTIN.iter().filter(|scene| !TIMES.iter().any(|(name, _)| *name == scene.name) && !fetched(scene.text));
    for scene in others.filter(|scene| scene.name != "gas/million") {
        let error = open(scene.name).use_gpu().unwrap_err();
        assert!(error.is_refusal() && error.to_string().contains("--backend"), "{}: {error}", scene.name);
    }
}
