//! Time of one look at the ground: called once per particle and step.

use corpuscle_scene::Valley;
use corpuscle_terrain::Terrain;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

/// Positions all over the terrain, in no order, as those of particles after a while.
fn positions(terrain: &Terrain) -> Vec<[f64; 2]> {
    let [length, width] = terrain.bounds().size();
    (0..4096_u32)
        .map(|i| [f64::from(i * 2_654 % 4096), f64::from(i * 1_597 % 4096)])
        .map(|[a, b]| [a / 4096.0 * length, b / 4096.0 * width])
        .collect()
}

fn height_and_slope(criterion: &mut Criterion) {
    let terrain = Terrain::open(&corpuscle_scene::Terrain::Valley(Valley::default()), 1, Path::new(".")).unwrap();
    let positions = positions(&terrain);
    let mut next = 0;
    criterion.bench_function("height_and_slope", |bencher| {
        bencher.iter(|| {
            next = (next + 1) % positions.len();
            let [x, y] = positions[next];
            terrain.height_and_slope(black_box(x), black_box(y))
        });
    });
}

criterion_group!(benches, height_and_slope);
criterion_main!(benches);
