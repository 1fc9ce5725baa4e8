//! Observers of steps on the GPU: it samples the gauges itself, and goes on.

use super::batch::BatchResult;
use super::frame_request::FrameRequest;
use super::model::failed;
use crate::sampling::Sample;
use crate::sph_swe::SphSweFlood;
use crate::sph_swe::gauges::Reading;
use crate::sph_swe::gauges::on_gpu::MOST_ROWS;
use corpuscle_model::{AdvanceObserver, ModelError, ModelProgress};
use std::sync::atomic::AtomicBool;

/// The observers of steps on the GPU.
#[derive(Default)]
pub(in crate::sph_swe) struct Observers<'a> {
    pub frame_request: Option<FrameRequest<'a>>,
    pub observer: Option<&'a mut dyn AdvanceObserver>,
    /// The time of the last row of gauges recorded, or of the start of the advance, s.
    pub gauged_until: f64,
    /// Whether the model is to return.
    pub call_back: bool,
}

impl<'a> Observers<'a> {
    /// With an observer alone.
    pub fn of(observer: &'a mut dyn AdvanceObserver) -> Self {
        Self { observer: Some(observer), ..Self::default() }
    }

    /// The time until which to advance from `now`, s, and the most steps, before the next frame or `until`.
    pub fn steps_to_frame(&self, now: f64, until: f64) -> (f64, u64) {
        match &self.frame_request {
            Some(frame_request) if frame_request.wanted > now => (until.min(frame_request.wanted), u64::MAX),
            Some(_) => (until, 1),
            None => (until, u64::MAX),
        }
    }

    /// Whether rows of gauges are to be taken.
    pub fn measure(&self) -> bool {
        self.observer.as_ref().is_some_and(|observer| observer.gauges_after(self.gauged_until).is_some())
    }

    /// The next rows of gauges up to a time, s.
    pub fn due(&self, until: f64) -> Vec<f64> {
        let Some(observer) = &self.observer else { return Vec::new() };
        let times =
            std::iter::successors(observer.gauges_after(self.gauged_until), |time| observer.gauges_after(*time));
        times.take_while(|time| *time <= until).take(MOST_ROWS).collect()
    }

    pub fn record_gauges(&mut self, time: f64, row: &[f64]) {
        self.gauged_until = time;
        if let Some(observer) = &mut self.observer {
            observer.gauges(time, row);
        }
    }

    pub fn report_progress(&mut self, progress: ModelProgress) {
        self.call_back = self.observer.as_mut().is_some_and(|observer| !observer.progressed(progress));
    }
}

impl SphSweFlood {
    /// [`Model::advance_with`](corpuscle_model::Model::advance_with) on the GPU. For a row of gauges nothing but the row comes back.
    pub(in crate::sph_swe) async fn advance_measured(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        mut observers: Observers<'_>,
    ) -> Result<(), ModelError> {
        self.advance_on_gpu(time, stop, &mut observers).await?;
        if self.shown < time {
            return Ok(());
        }
        // The next step ends later: these rows are sampled from the water as it is now.
        while let Some(&due) = observers.due(time).first() {
            self.shown = due;
            observers.record_gauges(due, &self.row(&self.reading()));
        }
        self.shown = time;
        observers.report_progress(ModelProgress {
            time,
            particles: self.state.particles.len(),
            particle_steps: self.state.particle_steps,
        });
        Ok(())
    }

    /// Uploads the positions of the gauges.
    pub(super) fn measure_on_gpu(&mut self) -> Result<(), ModelError> {
        let positions = self.gauge_positions();
        self.on_gpu.as_mut().map_or(Ok(()), |on_gpu| on_gpu.measure(&positions)).map_err(|error| failed(&error))
    }

    /// The values of the columns from a reading of the GPU, after `done` since the host's state.
    pub(super) fn row_of_gpu(&self, read: &Reading, done: &BatchResult) -> Vec<f64> {
        let held = |[x, y]: [f64; 2]| self.surroundings.obstacles.hold([x, y]);
        let samples = self.gauge_positions().into_iter().zip(&read.samples);
        let water = &self.state.water;
        self.row(&Reading {
            samples: samples
                .map(|(position, sample)| if held(position) { Sample::default() } else { *sample })
                .collect(),
            inflow: water.inflow.value() + done.inflow + read.inflow,
            outflow: water.outflow.value() + done.outflow + read.outflow,
            ..read.clone()
        })
    }
}
