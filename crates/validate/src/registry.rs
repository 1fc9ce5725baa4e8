//! All cases and benches: those of the models here, and those that a program adds.

use crate::{Bench, Case, dew, flood, gas, gpu_copy};
use std::sync::{PoisonError, RwLock};

static ADDED_CASES: RwLock<Vec<Case>> = RwLock::new(Vec::new());

static ADDED_BENCHES: RwLock<Vec<Bench>> = RwLock::new(Vec::new());

/// All cases.
pub fn cases() -> Vec<Case> {
    let added = ADDED_CASES.read().unwrap_or_else(PoisonError::into_inner);
    [flood::CASES, gas::CASES, dew::CASES, &added].concat()
}

/// All benches.
pub fn benches() -> Vec<Bench> {
    let added = ADDED_BENCHES.read().unwrap_or_else(PoisonError::into_inner);
    [flood::bench::BENCHES, gas::bench::BENCHES, dew::bench::BENCHES, gpu_copy::BENCHES, &added].concat()
}

/// Registers a case, in this process. Nothing changes where one of its name exists.
pub fn register_case(case: Case) {
    if cases().iter().all(|known| known.name != case.name) {
        ADDED_CASES.write().unwrap_or_else(PoisonError::into_inner).push(case);
    }
}

/// Registers a bench, in this process. Nothing changes where one of its name exists.
pub fn register_bench(bench: Bench) {
    if benches().iter().all(|known| known.name != bench.name) {
        ADDED_BENCHES.write().unwrap_or_else(PoisonError::into_inner).push(bench);
    }
}
