//! Callbacks called while a model advances.

use crate::{Model, ModelError};
use std::sync::atomic::AtomicBool;

/// How far a model has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelProgress {
    /// Simulated time, s.
    pub time: f64,
    /// Particles now.
    pub particles: usize,
    /// Particles moved so far, summed over the steps (gas: collisions).
    pub particle_steps: u64,
}

/// Callbacks while a model advances: `gauges` takes the rows that fall due, `passed` the progress, and may have the model return early. A model that computes on a GPU need not bring its whole state back for them.
pub trait AdvanceObserver {
    /// The first time after `time`, s, at which the gauges are to be read; none where there is none. It is asked for times to come as well, before
    /// the rows until then are taken.
    fn gauges_after(&self, time: f64) -> Option<f64>;

    /// The first time after `time`, s, by which a model should say how far it is; none where it need not. A model that says so
    /// often anyway may pass over it.
    fn pause_after(&self, _time: f64) -> Option<f64> {
        None
    }

    /// Takes the row of gauges ([`Model::gauge_row`](crate::Model::gauge_row)) of a time, s.
    fn gauges(&mut self, time: f64, row: &[f64]);

    /// Takes the progress. False has the model return as soon as its state is sound.
    fn passed(&mut self, passed: ModelProgress) -> bool;
}

/// No callbacks.
impl AdvanceObserver for () {
    fn gauges_after(&self, _time: f64) -> Option<f64> {
        None
    }

    fn gauges(&mut self, _time: f64, _row: &[f64]) {}

    fn passed(&mut self, _passed: ModelProgress) -> bool {
        true
    }
}

/// [`Model::advance_with`] of a model that can be looked at wherever it stands: it is advanced from one time that is due to the next.
///
/// # Errors
/// Those of [`Model::advance_to`].
pub fn advance_with<M: Model + ?Sized>(
    model: &mut M,
    time: f64,
    stop: &AtomicBool,
    observer: &mut dyn AdvanceObserver,
) -> Result<(), ModelError> {
    while model.time() < time {
        let now = model.time();
        let gauges = observer.gauges_after(now);
        let due = [gauges, observer.pause_after(now)];
        let next = due.into_iter().flatten().fold(time, f64::min);
        model.advance_to(next, stop)?;
        if model.time() < next {
            break;
        }
        if gauges == Some(next) {
            observer.gauges(next, &model.gauge_row());
        }
        let (particles, particle_steps) = (model.particles(), model.particle_steps());
        if !observer.passed(ModelProgress { time: next, particles, particle_steps }) {
            break;
        }
    }
    Ok(())
}
