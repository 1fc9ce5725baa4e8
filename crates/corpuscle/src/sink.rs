//! Sinks: receivers of the output of a run.

use crate::Error;
#[cfg(feature = "pictures")]
use corpuscle_gpu::Gpu;
#[cfg(feature = "pictures")]
use corpuscle_model::Glance;
use corpuscle_model::Model;
use corpuscle_output::{Clock, Summary};

/// A receiver of the output of a run: a folder, a film, a test. Each call but that for gauges reads from the model at its current time
/// what it needs; an error ends the run.
pub trait Sink {
    /// A row of gauges is due: what [`Model::gauge_columns`] name, at a time, s.
    ///
    /// # Errors
    /// Where it cannot be written.
    fn gauges(&mut self, _time: f64, _row: &[f64]) -> Result<(), Error> {
        Ok(())
    }

    /// A frame of particles, with maps, is due.
    ///
    /// # Errors
    /// Where it cannot be written.
    fn frame(&mut self, _model: &dyn Model) -> Result<(), Error> {
        Ok(())
    }

    /// How often [`Sink::picture`] is due, s; none for never.
    fn picture_period(&self) -> Option<f64> {
        None
    }

    /// A picture of a film is due: at the start, at multiples of the sink's own period, and at the end.
    ///
    /// # Errors
    /// Where it cannot be written.
    fn picture(&mut self, _model: &dyn Model) -> Result<(), Error> {
        Ok(())
    }

    /// The device on which it draws, if a [`Glance`] of a model that steps there suffices for its pictures; none where it needs the model.
    #[cfg(feature = "pictures")]
    fn glances_on(&self) -> Option<&Gpu> {
        None
    }

    /// [`Sink::picture`] of a model whose particles stay on the GPU. The picture of the start is one of the model.
    ///
    /// # Errors
    /// Where it cannot be written.
    #[cfg(feature = "pictures")]
    fn glance(&mut self, _glance: &Glance) -> Result<(), Error> {
        Ok(())
    }

    /// A checkpoint is due.
    ///
    /// # Errors
    /// Where it cannot be written.
    fn checkpoint(&mut self, _model: &dyn Model, _clock: Clock) -> Result<(), Error> {
        Ok(())
    }

    /// The run has ended, see `summary.status`. The sink may add results to the summary.
    ///
    /// # Errors
    /// Where the end cannot be written.
    fn finish(&mut self, _model: &dyn Model, _summary: &mut Summary) -> Result<(), Error> {
        Ok(())
    }
}
