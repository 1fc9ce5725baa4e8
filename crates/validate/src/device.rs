//! The backend and the size of cases of floods and dew.

use crate::Row;
use corpuscle_gpu::Gpu;
use corpuscle_model::ModelError;
use std::cell::{Cell, RefCell};

thread_local! {
    /// Reduction of the case that this thread runs: factor of its spacing, or of its simulated time.
    static COARSER: Cell<f64> = const { Cell::new(1.0) };

    /// The GPU that takes the steps of the case that this thread runs, if one does.
    static GPU: RefCell<Option<Gpu>> = const { RefCell::new(None) };
}

/// Runs `case` with the steps of all its models on a GPU.
pub(crate) fn on_gpu<T>(gpu: Option<Gpu>, case: impl FnOnce() -> T) -> T {
    let before = GPU.replace(gpu);
    let result = case();
    GPU.replace(before);
    result
}

/// Runs `case` reduced by `factor`, which it reads by [`sized`] or [`reduction`].
pub(crate) fn coarser<T>(factor: f64, case: impl FnOnce() -> T) -> T {
    let before = COARSER.replace(factor);
    let result = case();
    COARSER.set(before);
    result
}

/// Whether cases have their reduced size.
pub(crate) fn is_reduced() -> bool {
    COARSER.get() > 1.0
}

/// The variants of a case to run: at reduced size only the first, which is the smallest.
pub(crate) fn reduced<T>(all: &[T]) -> &[T] {
    if is_reduced() { &all[..1] } else { all }
}

/// Reduction of the case.
pub(crate) fn reduction() -> f64 {
    COARSER.get()
}

/// A distance of particles at the size of the case.
pub(crate) fn sized(spacing: f64) -> f64 {
    COARSER.get() * spacing
}

/// The GPU that takes the steps, if one does.
pub(crate) fn gpu() -> Option<Gpu> {
    GPU.with_borrow(Clone::clone)
}

/// Whether a GPU takes the steps.
pub(crate) fn is_gpu() -> bool {
    GPU.with_borrow(Option::is_some)
}

/// The bound of a measure that is exact but for rounding: of double precision on the CPU, or of single precision on the GPU.
pub(crate) fn rounding(double: f64, single: f64) -> f64 {
    if is_gpu() { single } else { double }
}

/// Refuses models that the GPU does not support.
pub(crate) fn refuse_on_gpu(what: &str) -> Result<(), ModelError> {
    if is_gpu() { Err(ModelError::Setup(format!("the GPU cannot yet compute {what}"))) } else { Ok(()) }
}

/// Rows of a case, or the row of its failure; a case that a GPU cannot compute is skipped.
pub(crate) fn rows(case: &'static str, result: Result<Vec<Row>, ModelError>) -> Vec<Row> {
    result.unwrap_or_else(|error| {
        vec![match &error {
            ModelError::Setup(why) if is_gpu() => Row::skipped(case, why),
            _ => Row::broken(case, &error.to_string()),
        }]
    })
}
