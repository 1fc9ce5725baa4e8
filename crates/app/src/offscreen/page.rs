//! In a browser the device draws what is requested as it comes to it, and nobody waits.

use super::drawing::{Drawing, STILL_SIZE};
use super::{PausedSettings, RenderJob, RenderResult};
use crate::background_device::BackgroundDevice;
use crate::files;
use crate::snapshot::Wake;
use crate::view_state::moment;
use corpuscle::Error;
use corpuscle::gpu::Image;
use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use wasm_bindgen_futures::spawn_local;

/// Draws on the window's device.
pub struct OffscreenRenderer {
    drawing: RefCell<Drawing>,
    results: Rc<RefCell<Vec<RenderResult>>>,
    requests: RefCell<u64>,
    wake: Wake,
}

impl OffscreenRenderer {
    /// Draws nothing yet.
    ///
    /// # Errors
    /// None; elsewhere a thread is started.
    pub fn start(device: BackgroundDevice, wake: Wake) -> std::io::Result<Self> {
        let drawing = RefCell::new(Drawing::new(device));
        Ok(Self { drawing, results: Rc::default(), requests: RefCell::new(0), wake })
    }

    /// Requests a still, named after a scene.
    pub fn still(&self, job: RenderJob, folder: PathBuf, name: String) {
        let read = |drawing: &mut Drawing| {
            let pictures = drawing.pictures(&job, STILL_SIZE, 2)?;
            job.view_state.lift(pictures);
            pictures.still_later(&moment(&job.snapshot), &job.view_state.camera_offset)
        };
        let save = move |image: Result<Image, Error>| {
            let saved = image.and_then(|image| files::picture(&folder, &name, &image));
            RenderResult::Still(saved.map_err(|error| error.to_string()))
        };
        self.draw(read, save);
    }

    /// Requests the window's picture of a paused scene and returns the number of the request.
    pub fn draw_paused(&self, job: RenderJob, settings: PausedSettings) -> u64 {
        let number = self.requests.replace_with(|requests| *requests + 1) + 1;
        let shown = Rc::new(RefCell::new(None));
        let read = {
            let shown = shown.clone();
            move |drawing: &mut Drawing| {
                let (what, pictures) = drawing.paused(&job, &settings)?;
                *shown.borrow_mut() = Some(what);
                Ok(pictures.read_later())
            }
        };
        let take = move |image: Result<Image, Error>| {
            let shown = shown.borrow_mut().take();
            let drawn = image.map(|image| shown.map(|shown| Box::new((shown, image))));
            let drawn = drawn.map_err(|error| error.to_string());
            RenderResult::Paused(number, drawn.and_then(|drawn| drawn.ok_or_else(|| "nothing was drawn".into())))
        };
        self.draw(read, take);
        number
    }

    /// The pictures drawn since the last call, oldest first.
    pub fn results(&self) -> Vec<RenderResult> {
        self.results.take()
    }

    /// Has the device draw, and takes the picture once it is there.
    fn draw<F: Future<Output = Result<Image, Error>> + 'static>(
        &self,
        read: impl FnOnce(&mut Drawing) -> Result<F, Error>,
        take: impl FnOnce(Result<Image, Error>) -> RenderResult + 'static,
    ) {
        let reading = read(&mut self.drawing.borrow_mut());
        let (results, wake) = (self.results.clone(), self.wake.clone());
        spawn_local(async move {
            let image = match reading {
                Ok(reading) => reading.await,
                Err(error) => Err(error),
            };
            results.borrow_mut().push(take(image));
            wake();
        });
    }
}
