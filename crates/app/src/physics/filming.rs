//! A film of what goes on, drawn in its thread: the physics waits for the pictures, the window does not.

use super::subject::Subject;
use crate::sight::Sight;
use corpuscle::Error;
use corpuscle::film::{Film, Format};
use corpuscle::gpu::Gpu;
use corpuscle::pictures::{Moment, PictureSettings, Pictures};
use std::path::{Path, PathBuf};

/// Size of its pictures, pixels, and how many there are in a second.
const SIZE: [u32; 2] = [1280, 720];
const RATE: f64 = 25.0;

/// A film that is being made.
pub(super) struct Filming {
    pictures: Pictures,
    film: Film,
    path: PathBuf,
    /// Simulated time between two pictures, and of the next, s.
    every: f64,
    pub next: f64,
}

impl Filming {
    /// Begins a film from now on; `pace` simulated seconds go by in a second of it.
    pub fn begin(gpu: &Gpu, subject: &Subject, path: &Path, pace: f64) -> Result<Self, Error> {
        let settings = PictureSettings { size: SIZE, ..PictureSettings::default() };
        let pictures = Pictures::open_on(gpu, subject.simulation(), settings)?;
        let film = Film::create(path, Format::of(path), SIZE, RATE)?;
        Ok(Self { pictures, film, path: path.to_owned(), every: pace / RATE, next: subject.time() })
    }

    /// Adds a picture, seen as it is seen in the window now, if one is due.
    pub fn look(&mut self, subject: &Subject, sight: &Sight) -> Result<(), Error> {
        if subject.time() < self.next {
            return Ok(());
        }
        let (frame, paths, container) = subject.look();
        let image = sight.still(&mut self.pictures, &Moment { frame: &frame, paths: &paths, container })?;
        self.film.add(&image.rgba)?;
        self.next = subject.time() + self.every;
        Ok(())
    }

    /// Puts the film in its place; gives its file.
    pub fn finish(self) -> Result<PathBuf, Error> {
        self.film.finish()?;
        Ok(self.path)
    }
}
