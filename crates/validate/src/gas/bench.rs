//! Rates of the gas model: collisions in a second of wall-clock time, on one thread, in fluids at rest with themselves.

use crate::{Bench, BenchOptions, Rate};
use corpuscle_gas::{Gas, Setup};
use corpuscle_model::{Model, ModelError};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A bench by its dimensions, packing, and number of balls in words and digits.
macro_rules! fluid {
    ($dimensions:literal, $packing:literal, $words:literal, $count:literal) => {
        Bench {
            name: concat!("gas/", $dimensions, "d-", $packing, "-", $words),
            about: "Equal balls in a periodic box, event-driven, after five collisions of each; dimensions, packing and \
                    number by name.",
            needs_gpu: false,
            is_shared: false,
            run: |options| {
                let name = concat!("gas/", $dimensions, "d-", $packing, "-", $words);
                rate::<$dimensions>(name, $count, $packing, options)
            },
        }
    };
}

pub(crate) const BENCHES: &[Bench] = &[
    fluid!(2, 0.30, "10k", 10_000),
    fluid!(2, 0.30, "100k", 100_000),
    fluid!(2, 0.30, "1m", 1_000_000),
    fluid!(2, 0.60, "10k", 10_000),
    fluid!(2, 0.60, "100k", 100_000),
    fluid!(2, 0.60, "1m", 1_000_000),
    fluid!(3, 0.30, "10k", 10_000),
    fluid!(3, 0.30, "100k", 100_000),
    fluid!(3, 0.30, "1m", 1_000_000),
    fluid!(3, 0.49, "10k", 10_000),
    fluid!(3, 0.49, "100k", 100_000),
    fluid!(3, 0.49, "1m", 1_000_000),
];

/// Collisions of two balls, over the number of balls, before the clock is started.
const SETTLED: u64 = 5;

/// Seconds of wall-clock time measured.
const MEASURED: f64 = 6.0;

fn rate<const D: usize>(name: &str, count: usize, packing: f64, options: &BenchOptions) -> Vec<Rate> {
    let seconds = if options.quick { 0.2 * MEASURED } else { MEASURED };
    measure::<D>(name, count, packing, seconds).into_iter().collect()
}

fn measure<const D: usize>(name: &str, count: usize, packing: f64, seconds: f64) -> Result<Rate, ModelError> {
    let mut gas = Setup::<D>::fluid(count, packing).build()?;
    // Short steps of time, so that an end is noticed.
    let step = 1e4 / count as f64 / 50.0;
    while gas.collisions() < SETTLED * count as u64 {
        ahead(&mut gas, step)?;
    }
    let (start, before) = (Instant::now(), gas.collisions());
    while start.elapsed().as_secs_f64() < seconds {
        ahead(&mut gas, step)?;
    }
    Ok(Rate {
        name: name.into(),
        particles: count,
        dimensions: D,
        packing: Some(packing),
        threads: 1,
        rate: (gas.collisions() - before) as f64 / start.elapsed().as_secs_f64(),
        rate_unit: "collisions_per_s".into(),
        processes: None,
        bytes_per_particle: gas.bytes() as f64 / count as f64,
        device: None,
        passes: Vec::new(),
    })
}

fn ahead<const D: usize>(gas: &mut Gas<D>, step: f64) -> Result<(), ModelError> {
    gas.advance_to(gas.time() + step, &AtomicBool::new(false))
}
