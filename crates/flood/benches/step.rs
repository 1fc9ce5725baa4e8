//! Time of one step of each scheme, with 12,000 particles in waves over an uneven bed.

use corpuscle_flood::{Filling, InitialWater, SphSweFlood, StartWater, VoronoiFlood};
use corpuscle_model::Model;
use corpuscle_scene::{Edge, Edges, Flood, Manning, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Side of the basin, m: with particles 1 m apart, 12,000 of them.
const SIDE: f64 = 109.5;

const BOUNDS: Bounds = Bounds { x_min: 0.0, x_max: SIDE, y_min: 0.0, y_max: SIDE };

fn terrain() -> Arc<Terrain> {
    Arc::new(Terrain::gridded(BOUNDS, 2.0, |x, y| 0.2 * (0.31 * x).sin() * (0.23 * y).cos()))
}

fn settings(scheme: Scheme) -> Flood {
    Flood {
        scheme,
        spacing_m: Some(1.0),
        spacing_depth_m: Some(1.0),
        manning: Manning::Number(0.03),
        edges: Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall },
        // Never again after the start: the step alone is measured.
        map_every_s: Some(1e9),
        ..Flood::default()
    }
}

fn level(x: f64) -> f64 {
    1.0 + 0.1 * (0.05 * x).sin()
}

fn velocity(y: f64) -> [f64; 2] {
    [(0.07 * y).sin(), 0.0]
}

fn voronoi() -> VoronoiFlood {
    let water = StartWater {
        filling: Filling::Level(Box::new(|x, _| level(x))),
        polygon: None,
        velocity: Box::new(|_, y| velocity(y)),
    };
    VoronoiFlood::with_water(&settings(Scheme::Voronoi), 1, Path::new("."), terrain(), &[water])
        .expect("the basin is sound")
}

fn sph_swe() -> SphSweFlood {
    let terrain = terrain();
    let bed = Arc::clone(&terrain);
    let water = InitialWater {
        depth: Box::new(move |x, y| level(x) - bed.height(x, y)),
        inside: Box::new(|_, _| true),
        within: BOUNDS,
        velocity: Box::new(|_, y| velocity(y)),
    };
    SphSweFlood::with_water(&settings(Scheme::SphSwe), 1, Path::new("."), terrain, &[water])
        .expect("the basin is sound")
}

/// Measures steps of a flood, whose next step is so long, s.
fn measure<M: Model>(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, mut flood: M, step: impl Fn(&M) -> f64) {
    let stop = AtomicBool::new(false);
    group.throughput(Throughput::Elements(Model::particles(&flood) as u64));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            // To the end of the coming step, and no farther.
            let next = flood.time() + step(&flood);
            flood.advance_to(next, &stop).expect("the water stays calm");
        });
    });
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.sample_size(20).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5));
    measure(&mut group, "voronoi-12k", voronoi(), VoronoiFlood::time_step);
    measure(&mut group, "sph-swe-12k", sph_swe(), SphSweFlood::time_step);
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
