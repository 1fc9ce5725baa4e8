//! Drawing of a model.

use super::{DrawContext, Moment, Shown};
use crate::Error;
use corpuscle_gpu::{Gpu, PassTiming};

/// A model that can be drawn.
pub trait Subject: Send {
    /// Draws a moment.
    ///
    /// # Errors
    /// [`Error::Render`] where something cannot be drawn.
    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error>;

    /// True where particles are drawn from GPU memory ([`Moment::on_device`]).
    fn draws_from_device(&self) -> bool {
        false
    }

    /// True where a glance ([`corpuscle_model::Glance`]) suffices for a picture.
    fn shows_glances(&self) -> bool {
        true
    }

    /// Draws no partition of a gas from a time on, s.
    fn lift_partition(&mut self, _time: f64) {}

    /// Draws the water of a flood by compute shaders from now on, instead of raster units.
    fn splat(&mut self) {}

    /// Times the passes that draw water, from the next picture on.
    fn measure(&mut self, _gpu: &Gpu) {}

    /// Times of the passes since, by name.
    fn taken(&self) -> Vec<(&'static str, PassTiming)> {
        Vec::new()
    }
}
