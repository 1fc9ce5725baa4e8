//! A film of a run while it runs.

use crate::pictures::{Moment, PictureSettings, Pictures};
use crate::{Error, Simulation, Sink};
use corpuscle_film::{Film, Format};
use corpuscle_model::Model;
use corpuscle_record::Summary;
use std::path::Path;

/// Pictures a second where there are enough of them.
const SMOOTH: f64 = 25.0;
/// The fewest pictures a second, however few there are.
const SLOWEST: f64 = 5.0;
/// How long a film of few pictures should last, s.
const LASTS: f64 = 10.0;

/// Pictures a second for a film of so many: 25, or fewer where it would be over in less than ten seconds, but at least 5.
pub fn film_rate(pictures: usize) -> f64 {
    (pictures as f64 / LASTS).floor().clamp(SLOWEST, SMOOTH)
}

/// A film that is drawn while a scene runs, evenly from its start to its end.
pub struct Filming {
    pictures: Pictures,
    /// None once it is finished.
    film: Option<Film>,
    period: f64,
}

impl Filming {
    /// Makes ready to film a scene, `seconds` long at 25 pictures a second, into the file that is named.
    ///
    /// # Errors
    /// Those of [`Pictures::open`] and [`Film::create`].
    pub fn open(simulation: &Simulation, file: &Path, settings: PictureSettings, seconds: f64) -> Result<Self, Error> {
        let pictures = Pictures::open(simulation, settings)?;
        let film = Film::create(file, Format::of(file), settings.size, SMOOTH)?;
        // The first picture is that of the start, the last that of the end.
        let steps = (SMOOTH * seconds).round().max(2.0) - 1.0;
        Ok(Self { pictures, film: Some(film), period: simulation.scene().run.until_s / steps })
    }

    /// The device that draws, by its name.
    pub fn device(&self) -> &str {
        self.pictures.device()
    }

    fn add(&mut self, model: &dyn Model) -> Result<(), Error> {
        let (frame, paths) = (model.frame(), model.paths());
        let image = self.pictures.draw(&Moment { frame: &frame, paths: &paths, container: model.container() })?;
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

    fn finish(&mut self, _model: &dyn Model, _summary: &mut Summary) -> Result<(), Error> {
        // Of a run that ended before its end there is a film up to there.
        Ok(self.film.take().map_or(Ok(()), Film::finish)?)
    }
}

#[cfg(test)]
mod tests {
    use super::film_rate;

    #[test]
    fn few_pictures_go_slowly() {
        assert_eq!([1, 41, 100, 250, 1000].map(film_rate), [5.0, 5.0, 10.0, 25.0, 25.0]);
    }
}
