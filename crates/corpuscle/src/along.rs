//! Who goes along with a run: takes rows of gauges and glances to the sinks, tells how far it is, and calls the model back when its state is to be
//! kept.

#[cfg(feature = "pictures")]
use crate::pictures::Glance;
use crate::schedule::Schedule;
use crate::{Error, Progress, Sink};
use corpuscle_model::{Companion, Passed};
use std::cell::RefCell;
use std::time::Instant;

/// Where this part of the run began, to measure its rate.
pub(crate) struct Meter {
    pub start: Instant,
    pub time: f64,
    pub particle_steps: u64,
    pub counted: &'static str,
}

impl Meter {
    fn progress(&self, passed: Passed, until: f64) -> Progress {
        let Passed { time, particles, particle_steps } = passed;
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

/// When the state was last kept, and how often it is to be, s of wall-clock time.
#[derive(Clone, Copy)]
pub(crate) struct Keeping {
    pub kept: Instant,
    pub every: f64,
}

impl Keeping {
    pub fn is_due(self) -> bool {
        self.kept.elapsed().as_secs_f64() >= self.every
    }
}

/// Goes along with the model from one frame or picture to the next.
pub(crate) struct Along<'a, 'sink> {
    pub sinks: &'a mut [&'sink mut dyn Sink],
    pub gauges: Schedule,
    pub pauses: Schedule,
    pub until: f64,
    pub meter: &'a Meter,
    pub on_progress: &'a mut dyn FnMut(&Progress),
    pub keeping: Keeping,
    pub glances: Glances<'a>,
    /// What a sink failed with.
    pub failed: Option<Error>,
}

/// When sinks want glances, of those that do, and up to when they had them, s.
#[cfg_attr(not(feature = "pictures"), expect(dead_code, reason = "without pictures nobody takes glances"))]
pub(crate) struct Glances<'a> {
    pub due: &'a [Option<Schedule>],
    pub seen: f64,
}

#[cfg(feature = "pictures")]
impl Glances<'_> {
    /// When a sink wants one next, s.
    pub fn next(&self) -> f64 {
        let after = |due: &Option<Schedule>| due.and_then(|due| due.after(self.seen));
        self.due.iter().filter_map(after).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(feature = "pictures")]
impl Along<'_, '_> {
    /// Gives a glance to those to whom it is due; gives when the next is.
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

/// The same to whoever may be shown glances meanwhile.
pub(crate) struct Going<'a, 'b, 'sink>(pub &'a RefCell<Along<'b, 'sink>>);

impl Companion for Going<'_, '_, '_> {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        self.0.borrow().gauges.after(time)
    }

    fn pause_after(&self, time: f64) -> Option<f64> {
        self.0.borrow().pauses.after(time)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        let along = &mut *self.0.borrow_mut();
        if along.failed.is_none() {
            along.failed = along.sinks.iter_mut().try_for_each(|sink| sink.gauges(time, row)).err();
        }
    }

    fn passed(&mut self, passed: Passed) -> bool {
        let along = &mut *self.0.borrow_mut();
        (along.on_progress)(&along.meter.progress(passed, along.until));
        along.failed.is_none() && !along.keeping.is_due()
    }
}
