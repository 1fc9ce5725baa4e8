//! A film of the scene in the window, drawn in the physics thread: the physics waits for the pictures, the window does not.

use super::subject::Subject;
use crate::view_state::ViewState;
use corpuscle::Error;
use corpuscle::gpu::Gpu;
use corpuscle::pictures::{Moment, PictureSettings, Pictures};
use corpuscle::video::{Film, Format};
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
    /// Starts a film; `pace` is its simulated seconds per second.
    pub fn begin(gpu: &Gpu, subject: &Subject, path: &Path, pace: f64) -> Result<Self, Error> {
        let settings = PictureSettings { size: SIZE, ..PictureSettings::default() };
        let pictures = Pictures::open_on(gpu, subject.simulation(), settings)?;
        let film = Film::create(path, Format::of(path), SIZE, RATE)?;
        Ok(Self { pictures, film, path: path.to_owned(), every: pace / RATE, next: subject.time() })
    }

    /// Adds a picture with the camera of the window, if one is due.
    pub fn add_if_due(&mut self, subject: &Subject, view_state: &ViewState) -> Result<(), Error> {
        if subject.time() < self.next {
            return Ok(());
        }
        let (frame, paths, container) = subject.current();
        self.add(&Moment { frame: &frame, on_device: None, paths: &paths, container }, view_state)
    }

    /// Adds a picture of a moment.
    pub fn add(&mut self, moment: &Moment<'_>, view_state: &ViewState) -> Result<(), Error> {
        let image = view_state.still(&mut self.pictures, moment)?;
        self.film.add(&image.rgba)?;
        self.next = moment.frame.time + self.every;
        Ok(())
    }

    /// Finishes the film; returns its path.
    pub fn finish(self) -> Result<PathBuf, Error> {
        self.film.finish()?;
        Ok(self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Backend;
    use corpuscle::gpu::require_gpu;
    use corpuscle::pictures::CameraOffset;
    use corpuscle::scene::{Scene, builtin};
    use corpuscle::{Cpu, Simulation};

    #[test]
    fn each_picture_is_seen_as_the_window_is_seen_then() {
        let Some(gpu) = require_gpu("a film that follows the view") else { return };
        let name = "gas/free-expansion";
        let scene = Scene::parse(builtin(name).unwrap().text, name, &[]).unwrap();
        let simulation = Simulation::open(scene, Path::new("")).unwrap();
        let subject = Subject::live(simulation, Backend::Cpu, (Some(&gpu), Cpu::AllCores)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let film = folder.path().join("film");
        let mut filming = Filming::begin(&gpu, &subject, &film, 1.0).unwrap();
        let near = ViewState { camera_offset: CameraOffset { zoom: 2.0, ..CameraOffset::default() }, lifted: None };
        let lifted = ViewState { lifted: Some(0.0), ..near };
        for view_state in [ViewState::default(), near, near, lifted] {
            filming.next = 0.0;
            filming.add_if_due(&subject, &view_state).unwrap();
        }
        let film = filming.finish().unwrap();
        let mut files: Vec<_> = std::fs::read_dir(film).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        let pictures: Vec<_> = files.iter().map(|file| std::fs::read(file).unwrap()).collect();
        assert_eq!(pictures.len(), 4);
        assert!(pictures[0] != pictures[1] && pictures[1] == pictures[2] && pictures[2] != pictures[3]);
    }
}
