//! What pictures show of a model.

use super::{Moment, Shown, Studio};
use crate::Error;
use corpuscle_gpu::{Gpu, PassTiming};

/// What pictures show of one model.
pub trait Subject: Send {
    /// Draws a moment.
    ///
    /// # Errors
    /// [`Error::Render`] where something cannot be drawn.
    fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Shown, Error>;

    /// Whether particles are drawn from where they lie on the device ([`Moment::on_device`]).
    fn draws_from_device(&self) -> bool {
        false
    }

    /// Whether pictures show all that there is by a glance ([`corpuscle_model::Glance`]).
    fn shows_glances(&self) -> bool {
        true
    }

    /// The partition of a gas is gone from a time on, s.
    fn lift_partition(&mut self, _time: f64) {}

    /// Compute shaders draw the water of a flood from now on, in the place of raster units.
    fn splat(&mut self) {}

    /// Times the passes that draw water, from the next picture on.
    fn measure(&mut self, _gpu: &Gpu) {}

    /// What they have taken since, by name.
    fn taken(&self) -> Vec<(&'static str, PassTiming)> {
        Vec::new()
    }
}
