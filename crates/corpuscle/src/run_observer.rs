//! The observer of a run: it passes rows of gauges and glances on to the sinks, reports the progress, and has the model return when a checkpoint is
//! due.

use crate::schedule::Schedule;
use crate::{Error, Progress, Sink};
#[cfg(feature = "pictures")]
use corpuscle_model::Glance;
use corpuscle_model::{AdvanceObserver, ModelProgress};
use std::cell::RefCell;
use web_time::Instant;

/// Start of this part of the run, to measure its rate.
pub(crate) struct Meter {
    pub start: Instant,
    pub time: f64,
    pub particle_steps: u64,
    pub counted: &'static str,
}

impl Meter {
    fn progress(&self, progress: ModelProgress, until: f64) -> Progress {
        let ModelProgress { time, particles, particle_steps } = progress;
        let wall = self.start.elapsed().as_secs_f64();
        let done = time - self.time;
        Progress {
            time,
            until,
            particles,
            particle_steps_per_s: (particle_steps - self.particle_steps) as f64 / wall,
            counted: self.counted,
            left_s: (done > 0.0).then(|| wall * (until - time) / done),
        }
    }
}

/// When the last checkpoint was made, and how often one is due, s of wall-clock time.
#[derive(Clone, Copy)]
pub(crate) struct CheckpointTimer {
    pub kept: Instant,
    pub every: f64,
}

impl CheckpointTimer {
    pub fn is_due(self) -> bool {
        self.kept.elapsed().as_secs_f64() >= self.every
    }
}

/// The observer of an advance from one frame or picture to the next.
pub(crate) struct RunObserver<'a, 'sink> {
    pub sinks: &'a mut [&'sink mut dyn Sink],
    pub gauges: Schedule,
    pub pauses: Schedule,
    pub until: f64,
    pub meter: &'a Meter,
    pub on_progress: &'a mut dyn FnMut(&Progress),
    pub checkpoints: CheckpointTimer,
    pub glances: Glances<'a>,
    /// The error of a sink.
    pub failed: Option<Error>,
}

/// For sinks that take glances: when each needs one next, and the time of the last, s.
#[cfg_attr(not(feature = "pictures"), expect(dead_code, reason = "without pictures no sink takes glances"))]
pub(crate) struct Glances<'a> {
    pub due: &'a [Option<Schedule>],
    pub seen: f64,
}

#[cfg(feature = "pictures")]
impl Glances<'_> {
    /// When a sink needs one next, s.
    pub fn next(&self) -> f64 {
        let after = |due: &Option<Schedule>| due.and_then(|due| due.after(self.seen));
        self.due.iter().filter_map(after).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(feature = "pictures")]
impl RunObserver<'_, '_> {
    /// Passes a glance to the sinks for which it is due; returns when the next is due, s.
    pub fn show(&mut self, glance: &Glance) -> f64 {
        let (seen, now) = (self.glances.seen, glance.frame.time);
        for (sink, due) in self.sinks.iter_mut().zip(self.glances.due) {
            let is_due = due.and_then(|due| due.after(seen)).is_some_and(|due| due <= now);
            if is_due && self.failed.is_none() {
                self.failed = sink.glance(glance).err();
            }
        }
        self.glances.seen = now;
        self.glances.next()
    }
}

/// The same, shared with the callback that takes glances.
pub(crate) struct SharedRunObserver<'a, 'b, 'sink>(pub &'a RefCell<RunObserver<'b, 'sink>>);

impl AdvanceObserver for SharedRunObserver<'_, '_, '_> {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        self.0.borrow().gauges.after(time)
    }

    fn pause_after(&self, time: f64) -> Option<f64> {
        self.0.borrow().pauses.after(time)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        let observer = &mut *self.0.borrow_mut();
        if observer.failed.is_none() {
            observer.failed = observer.sinks.iter_mut().try_for_each(|sink| sink.gauges(time, row)).err();
        }
    }

    fn progressed(&mut self, progress: ModelProgress) -> bool {
        let observer = &mut *self.0.borrow_mut();
        (observer.on_progress)(&observer.meter.progress(progress, observer.until));
        observer.failed.is_none() && !observer.checkpoints.is_due()
    }
}
