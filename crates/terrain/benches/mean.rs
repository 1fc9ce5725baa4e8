//! Time of the mean height over one cell of a finite-volume scheme: called once per cell when a mesh is made.

use corpuscle_terrain::{Bounds, Terrain};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

const SIDE: f64 = 2000.0;

/// Hexagons of a size, m, all over the ground in no order, turned against its grid.
fn hexagons(size: f64) -> Vec<[[f64; 2]; 6]> {
    let middle = |i: u32, factor: u32| 50.0 + (SIDE - 100.0) * f64::from(i * factor % 4096) / 4096.0;
    let hexagon = |i: u32| {
        let [x, y] = [middle(i, 2_654), middle(i, 1_597)];
        [0, 1, 2, 3, 4, 5].map(|k| {
            let angle = 0.1 * f64::from(i) + f64::from(k) * std::f64::consts::FRAC_PI_3;
            [x + 0.5 * size * angle.cos(), y + 0.5 * size * angle.sin()]
        })
    };
    (0..4096).map(hexagon).collect()
}

fn mean_over(criterion: &mut Criterion) {
    let bounds = Bounds { x_min: 0.0, x_max: SIDE, y_min: 0.0, y_max: SIDE };
    let terrain = Terrain::gridded(bounds, 1.0, |x, y| 10.0 * (0.9 * x).sin() + (0.2 * x * y).cos());
    let mut group = criterion.benchmark_group("mean_over");
    group.throughput(Throughput::Elements(1));
    for size in [0.5, 2.0, 10.0, 50.0] {
        let hexagons = hexagons(size);
        let mut next = 0;
        group.bench_function(format!("{size} cells across"), |bencher| {
            bencher.iter(|| {
                next = (next + 1) % hexagons.len();
                terrain.mean_over(black_box(&hexagons[next]))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, mean_over);
criterion_main!(benches);
