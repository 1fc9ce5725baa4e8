//! Callbacks called while a model advances.

use crate::{Model, ModelError};
use std::sync::atomic::AtomicBool;

/// Progress of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelProgress {
    /// Simulated time, s.
    pub time: f64,
    /// Particles now.
    pub particles: usize,
    /// Particles moved so far, summed over the steps (gas: collisions).
    pub particle_steps: u64,
}

/// Callbacks called while a model advances: `gauges` with each row that falls due, and `progressed` with the progress, which may make the model return
/// early. A model that computes on a GPU need not download its whole state for them.
pub trait AdvanceObserver {
    /// The first time after `time`, s, at which the gauges are to be read; none where there is none. It is called for future times as well, before
    /// the rows until then are recorded.
    fn gauges_after(&self, time: f64) -> Option<f64>;

    /// The first time after `time`, s, by which a model should report its progress; none where it need not. A model that reports
    /// often anyway may ignore it.
    fn pause_after(&self, _time: f64) -> Option<f64> {
        None
    }

    /// Called with the row of gauges ([`Model::gauge_row`](crate::Model::gauge_row)) of a time, s.
    fn gauges(&mut self, time: f64, row: &[f64]);

    /// Called with the progress. After `false` the model returns as soon as its state is consistent.
    fn progressed(&mut self, progress: ModelProgress) -> bool;
}

/// No callbacks.
impl AdvanceObserver for () {
    fn gauges_after(&self, _time: f64) -> Option<f64> {
        None
    }

    fn gauges(&mut self, _time: f64, _row: &[f64]) {}

    fn progressed(&mut self, _progress: ModelProgress) -> bool {
        true
    }
}

/// [`Model::advance_with`] of a model whose state can be read at any time: it is advanced from one due time to the next.
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
        if !observer.progressed(ModelProgress { time: next, particles, particle_steps }) {
            break;
        }
    }
    Ok(())
}
