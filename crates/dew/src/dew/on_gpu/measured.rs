//! Gauges of humid air whose steps the GPU takes: the air stays there, and only their values are downloaded.

use super::{Dew, FrameRequest, GpuError};
use corpuscle_model::{AdvanceObserver, Model, ModelError, ModelProgress};
use std::sync::atomic::AtomicBool;

impl Dew {
    /// [`Model::advance_with`] on the GPU, with frames on request. Where gauges measure the distance of the air from walls, all of it is downloaded for them.
    pub(crate) async fn advance_measured(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        mut frame_request: Option<FrameRequest<'_>>,
    ) -> Result<(), ModelError> {
        self.advance_and_download(async |dew| {
            while dew.shown < time {
                dew.show_to(&mut frame_request)?;
                let now = dew.shown;
                let gauges = observer.gauges_after(now);
                let wanted = frame_request.as_ref().map(|frame_request| frame_request.wanted);
                let next = [gauges, observer.pause_after(now), wanted].into_iter().flatten().fold(time, f64::min);
                let broken = dew.go_on_gpu(next, stop).await?;
                if broken.is_some() || dew.shown < next {
                    return Ok(broken);
                }
                if gauges == Some(next) {
                    observer.gauges(next, &dew.row_of_gpu().await?);
                }
                let particles =
                    dew.gpu_solver.as_ref().map_or(0, |solver| solver.filling()[0]) + dew.solids().particles.len();
                if !observer.progressed(ModelProgress {
                    time: next,
                    particles,
                    particle_steps: dew.state.particle_steps,
                }) {
                    break;
                }
            }
            dew.show_to(&mut frame_request)?;
            Ok(None)
        })
        .await
    }

    pub(super) async fn row_of_gpu(&mut self) -> Result<Vec<f64>, GpuError> {
        if self.layers.iter().any(Option::is_some) {
            self.download_from_gpu().await?;
            return Ok(self.gauge_row());
        }
        let Some(solver) = &self.gpu_solver else { return Ok(self.gauge_row()) };
        let totals = solver.measure(&mut self.state).await?;
        Ok(self.measured(&totals))
    }
}
