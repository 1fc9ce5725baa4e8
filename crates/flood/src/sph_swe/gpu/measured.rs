//! Gauges of a flood whose steps a GPU takes: it reads them itself, and goes on.

use super::gauges::MOST_ROWS;
use super::model::failed;
use super::span::Progress;
use super::watch::Watch;
use crate::sampling::Sample;
use crate::sph_swe::SphSweFlood;
use crate::sph_swe::measured::Reading;
use corpuscle_model::{Companion, ModelError, Passed};
use std::sync::atomic::AtomicBool;

/// Who goes along while the GPU takes steps.
#[derive(Default)]
pub(in crate::sph_swe) struct Onlookers<'a> {
    pub watch: Option<Watch<'a>>,
    pub companion: Option<&'a mut dyn Companion>,
    /// The time of the last row of gauges that was taken, or from which they are to be, s.
    pub told: f64,
    /// Whether the companion wants the water back.
    pub call_back: bool,
}

impl<'a> Onlookers<'a> {
    /// A companion alone.
    pub fn of(companion: &'a mut dyn Companion) -> Self {
        Self { companion: Some(companion), ..Self::default() }
    }

    /// From `now` until when to go on, s, and how many steps at most, before somebody looks at the particles, or `until`.
    pub fn steps_to_look(&self, now: f64, until: f64) -> (f64, u64) {
        match &self.watch {
            Some(watch) if watch.wanted > now => (until.min(watch.wanted), u64::MAX),
            Some(_) => (until, 1),
            None => (until, u64::MAX),
        }
    }

    /// Whether rows of gauges are to be taken.
    pub fn measure(&self) -> bool {
        self.companion.as_ref().is_some_and(|companion| companion.gauges_after(self.told).is_some())
    }

    /// The next rows of gauges up to a time, s.
    pub fn due(&self, until: f64) -> Vec<f64> {
        let Some(companion) = &self.companion else { return Vec::new() };
        let times = std::iter::successors(companion.gauges_after(self.told), |time| companion.gauges_after(*time));
        times.take_while(|time| *time <= until).take(MOST_ROWS).collect()
    }

    pub fn tell(&mut self, time: f64, row: &[f64]) {
        self.told = time;
        if let Some(companion) = &mut self.companion {
            companion.gauges(time, row);
        }
    }

    pub fn pass(&mut self, passed: Passed) {
        self.call_back = self.companion.as_mut().is_some_and(|companion| !companion.passed(passed));
    }
}

impl SphSweFlood {
    /// [`Model::advance_with`](corpuscle_model::Model::advance_with) on the GPU. For a row of gauges nothing but the row comes back.
    pub(in crate::sph_swe) fn advance_measured(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        mut onlookers: Onlookers<'_>,
    ) -> Result<(), ModelError> {
        self.advance_on_gpu(time, stop, &mut onlookers)?;
        if self.shown < time {
            return Ok(());
        }
        // The next step ends later: these show the water as it stands here.
        while let Some(&due) = onlookers.due(time).first() {
            self.shown = due;
            onlookers.tell(due, &self.row(&self.reading()));
        }
        self.shown = time;
        onlookers.pass(Passed {
            time,
            particles: self.state.particles.len(),
            particle_steps: self.state.particle_steps,
        });
        Ok(())
    }

    /// Has the GPU look where gauges do.
    pub(super) fn measure_on_gpu(&mut self) -> Result<(), ModelError> {
        let places = self.gauge_places();
        self.on_gpu.as_mut().map_or(Ok(()), |on_gpu| on_gpu.measure(&places)).map_err(|error| failed(&error))
    }

    /// What goes in the columns of what the GPU has read, after `done` since the state that is here.
    pub(super) fn row_of_gpu(&self, read: &Reading, done: &Progress) -> Vec<f64> {
        let held = |[x, y]: [f64; 2]| self.surroundings.obstacles.hold([x, y]);
        let samples = self.gauge_places().into_iter().zip(&read.samples);
        let water = &self.state.water;
        self.row(&Reading {
            samples: samples.map(|(place, sample)| if held(place) { Sample::default() } else { *sample }).collect(),
            inflow: water.inflow.value() + done.inflow + read.inflow,
            outflow: water.outflow.value() + done.outflow + read.outflow,
            ..read.clone()
        })
    }
}
