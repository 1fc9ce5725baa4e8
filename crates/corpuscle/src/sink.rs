//! Where what a run shows goes.

use crate::Error;
#[cfg(feature = "pictures")]
use crate::pictures::Glance;
#[cfg(feature = "pictures")]
use corpuscle_gpu::Gpu;
use corpuscle_model::Model;
use corpuscle_output::{Clock, Summary};

/// Takes what a run shows: a folder, a window, a test. Each call but that for gauges looks at the model at the time it shows now and takes
/// from it what it needs; an error ends the run.
pub trait Sink {
    /// A row of gauges is due: what [`Model::gauge_columns`] name, at a time, s.
    ///
    /// # Errors
    /// Where it cannot be taken.
    fn gauges(&mut self, _time: f64, _row: &[f64]) -> Result<(), Error> {
        Ok(())
    }

    /// A frame of particles, with maps, is due.
    ///
    /// # Errors
    /// Where it cannot be taken.
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
    /// Where it cannot be taken.
    fn picture(&mut self, _model: &dyn Model) -> Result<(), Error> {
        Ok(())
    }

    /// The device on which it draws, if a [`Glance`] of a model that steps there is all that it wants for pictures; none: it wants the model.
    #[cfg(feature = "pictures")]
    fn glances_on(&self) -> Option<&Gpu> {
        None
    }

    /// [`Sink::picture`] of a model whose particles do not come back for it. The picture of the start is one of the model.
    ///
    /// # Errors
    /// Where it cannot be taken.
    #[cfg(feature = "pictures")]
    fn glance(&mut self, _glance: &Glance) -> Result<(), Error> {
        Ok(())
    }

    /// The state should be kept, to resume from.
    ///
    /// # Errors
    /// Where it cannot be kept.
    fn checkpoint(&mut self, _model: &dyn Model, _clock: Clock) -> Result<(), Error> {
        Ok(())
    }

    /// The run has ended, for better or worse (`summary.status`). What the sink finds out may go into the summary.
    ///
    /// # Errors
    /// Where the end cannot be taken.
    fn finish(&mut self, _model: &dyn Model, _summary: &mut Summary) -> Result<(), Error> {
        Ok(())
    }
}
