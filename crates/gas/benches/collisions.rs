//! Time of a thousand collisions or so, in fluids of ten thousand balls.

use corpuscle_gas::Setup;
use corpuscle_model::Model;
use criterion::{Criterion, criterion_group, criterion_main};
use std::sync::atomic::AtomicBool;

/// `step` is the time in which a fluid of this packing has a thousand collisions.
fn fluid<const D: usize>(criterion: &mut Criterion, packing: f64, step: f64) {
    let mut gas = Setup::<D>::fluid(10_000, packing).build().expect("the packing exists");
    let stop = AtomicBool::new(false);
    criterion.bench_function(&format!("{D}d, packing {packing}"), |bencher| {
        bencher.iter(|| gas.advance_to(gas.time() + step, &stop).expect("the gas goes on"));
    });
}

/// Collision rates of a ball by Enskog: 2.3995, 12.311, 10.102 and 37.78; two balls are in each collision.
fn fluids(criterion: &mut Criterion) {
    let step = |rate: f64| 1000.0 / (0.5 * rate * 10_000.0);
    fluid::<2>(criterion, 0.30, step(2.3995));
    fluid::<2>(criterion, 0.60, step(12.311));
    fluid::<3>(criterion, 0.30, step(10.102));
    fluid::<3>(criterion, 0.49, step(37.78));
}

criterion_group!(collisions, fluids);
criterion_main!(collisions);
