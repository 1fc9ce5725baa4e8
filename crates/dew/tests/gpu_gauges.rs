//! Gauges of air on the GPU show what they show where the air is brought back for them.

mod common;

use common::{built_in, on_gpu};
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{AdvanceObserver, Model, ModelProgress};
use std::sync::atomic::AtomicBool;

/// Takes rows at multiples of a period; air is called back once, after so many.
struct Notes {
    period: f64,
    call_back_at: usize,
    rows: Vec<(f64, Vec<f64>)>,
}

impl AdvanceObserver for Notes {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        let next = (time / self.period + 1e-9).floor() + 1.0;
        Some(next * self.period)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        self.rows.push((time, row.to_vec()));
    }

    fn progressed(&mut self, progress: ModelProgress) -> bool {
        assert!(progress.particles > 0 && progress.time > 0.0);
        self.rows.len() != self.call_back_at
    }
}

fn compare(name: &str, gpu: &Gpu, period: f64, rows: usize) {
    let [mut measured, mut plain] = [(); 2].map(|()| on_gpu(built_in(name, &[]), gpu));
    let until = period * rows as f64;
    let mut notes = Notes { period, call_back_at: rows / 2, rows: Vec::new() };
    let stop = AtomicBool::new(false);
    measured.advance_with(until, &stop, &mut notes).unwrap();
    assert_eq!(notes.rows.len(), rows / 2, "{name}");
    measured.advance_with(until, &stop, &mut notes).unwrap();
    assert_eq!((notes.rows.len(), measured.time()), (rows, until), "{name}");
    let columns = measured.gauge_columns();
    for (time, row) in &notes.rows {
        plain.advance_to(*time, &stop).unwrap();
        for ((column, one), other) in columns.iter().zip(row).zip(plain.gauge_row()) {
            let is_same = (one - other).abs() <= 1e-6 * other.abs() || one.is_nan() && other.is_nan();
            assert!(is_same, "{name}, {time} s, {}.{}: {one} and {other}", column.gauge, column.quantity);
        }
    }
    assert!(measured.steps() == plain.steps() && measured.air() == plain.air(), "{name}");
}

/// Drops, air that comes and goes, and gauges that tell how near air comes to walls.
#[test]
fn rows_read_on_the_gpu_are_those_of_the_air_that_comes_back() {
    let Some(gpu) = require_gpu("gauges of air on the GPU") else { return };
    compare("dew/pane", &gpu, 0.0061, 8);
    compare("dew/glassware", &gpu, 0.0007, 4);
    compare("dew/three-boundaries", &gpu, 0.0003, 4);
}
