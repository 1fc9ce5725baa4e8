//! A film of a run while it runs.

use crate::pictures::{Glance, PictureSettings, Pictures};
use crate::{Error, Simulation, Sink};
use corpuscle_gpu::{Gpu, Image};
use corpuscle_model::Model;
use corpuscle_output::Summary;
use corpuscle_video::{Film, Format};
use std::path::Path;

/// Pictures a second.
const SMOOTH: f64 = 25.0;
/// A film that is drawn while a scene runs, evenly from its start to its end.
pub struct Filming {
    pictures: Pictures,
    /// None once it is finished.
    film: Option<Film>,
    period: f64,
}

impl Filming {
    /// Opens a film of a scene, `seconds` long at 25 pictures per second, into a file.
    ///
    /// # Errors
    /// Those of [`Pictures::open`] and [`Film::create`].
    pub fn open(simulation: &Simulation, file: &Path, settings: PictureSettings, seconds: f64) -> Result<Self, Error> {
        let size = settings.size;
        let pictures = Pictures::open(simulation, settings)?;
        let film = Film::create(file, Format::of(file), size, SMOOTH)?;
        // The first picture is that of the start, the last that of the end.
        let steps = (SMOOTH * seconds).round().max(2.0) - 1.0;
        Ok(Self { pictures, film: Some(film), period: simulation.scene().run.until_s / steps })
    }

    /// The device that draws, by its name.
    pub fn device(&self) -> &str {
        self.pictures.device()
    }

    fn add(&mut self, model: &dyn Model) -> Result<(), Error> {
        let image = self.pictures.draw_model(model)?;
        self.keep(&image)
    }

    fn keep(&mut self, image: &Image) -> Result<(), Error> {
        Ok(self.film.as_mut().map_or(Ok(()), |film| film.add(&image.rgba))?)
    }
}

impl Sink for Filming {
    fn picture_period(&self) -> Option<f64> {
        Some(self.period)
    }

    fn picture(&mut self, model: &dyn Model) -> Result<(), Error> {
        self.add(model)
    }

    fn glances_on(&self) -> Option<&Gpu> {
        self.pictures.show_glances().then(|| self.pictures.gpu())
    }

    fn glance(&mut self, glance: &Glance) -> Result<(), Error> {
        let image = self.pictures.draw_glance(glance)?;
        self.keep(&image)
    }

    fn finish(&mut self, _model: &dyn Model, _summary: &mut Summary) -> Result<(), Error> {
        // A run that was interrupted has a film up to there.
        Ok(self.film.take().map_or(Ok(()), Film::finish)?)
    }
}
