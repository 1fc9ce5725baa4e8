//! Time of one step of each scheme, with 12,000 particles in waves over ground with a relief of its own.

use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::Model;
use corpuscle_scene::{Edge, Edges, Flood as Settings, Manning, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Side of the basin, m: with particles 1 m apart, 12,000 of them.
const SIDE: f64 = 109.5;

/// A basin of water about a metre deep, with friction and waves.
fn basin(scheme: Scheme) -> Flood {
    let bounds = Bounds { x_min: 0.0, x_max: SIDE, y_min: 0.0, y_max: SIDE };
    let terrain = Arc::new(Terrain::gridded(bounds, 2.0, |x, y| 0.2 * (0.31 * x).sin() * (0.23 * y).cos()));
    let settings = Settings {
        scheme,
        spacing_m: Some(1.0),
        spacing_depth_m: Some(1.0),
        manning: Manning::Number(0.03),
        edges: Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall },
        // Never again after the start: the step alone is measured.
        map_every_s: Some(1e9),
        ..Settings::default()
    };
    let ground = Arc::clone(&terrain);
    let water = InitialWater {
        depth: Box::new(move |x, y| 1.0 + 0.1 * (0.05 * x).sin() - ground.height(x, y)),
        inside: Box::new(|_, _| true),
        within: bounds,
        velocity: Box::new(|_, y| [(0.07 * y).sin(), 0.0]),
    };
    Flood::with_water(&settings, 1, Path::new("."), terrain, &[water]).expect("the basin is sound")
}

fn step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.sample_size(20).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5));
    for (name, scheme) in [("balanced-12k", Scheme::Balanced), ("sph-swe-12k", Scheme::SphSwe)] {
        let mut flood = basin(scheme);
        let stop = AtomicBool::new(false);
        group.throughput(Throughput::Elements(flood.particles().len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                // To the end of the coming step, and no farther.
                let next = flood.time() + flood.time_step();
                flood.advance_to(next, &stop).expect("the water stays calm");
            });
        });
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
