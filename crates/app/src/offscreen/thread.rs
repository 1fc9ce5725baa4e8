//! The thread that draws.

use super::{PausedSettings, RenderJob, RenderResult, SharedQueue};
use crate::background_device::BackgroundDevice;
use crate::files;
use crate::snapshot::Wake;
use crate::view_state::moment;
use corpuscle::Error;
use corpuscle::gpu::Image;
use corpuscle::pictures::{PictureSettings, Pictures, Shown};
use corpuscle_render::RenderError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::sync::mpsc::Sender;

/// Size of a still, pixels.
const STILL_SIZE: [u32; 2] = [1920, 1080];
const FAULT: &str = "an internal error stopped the picture";

/// Draws what is requested until the queue is closed.
pub(super) fn run(shared: &SharedQueue, results: &Sender<RenderResult>, wake: &Wake, device: &BackgroundDevice) {
    let mut thread = Thread { device, scene: None };
    while let Some(request) = next(shared) {
        // The receiver is gone when the window closes.
        let _ = results.send(thread.render(request));
        wake();
    }
}

/// What is drawn next.
enum Request {
    Still(RenderJob, PathBuf, String),
    Paused(u64, RenderJob, PausedSettings),
}

/// Waits for the next request; none once the queue is closed. A still comes first: the user waits for it.
fn next(shared: &SharedQueue) -> Option<Request> {
    let mut queue = shared.queue();
    loop {
        if let Some((job, folder, name)) = queue.stills.pop_front() {
            return Some(Request::Still(job, folder, name));
        }
        if queue.closed {
            return None;
        }
        if let Some((number, job, settings)) = queue.paused.take() {
            return Some(Request::Paused(number, job, settings));
        }
        queue = shared.condvar.wait(queue).unwrap_or_else(PoisonError::into_inner);
    }
}

struct Thread<'a> {
    device: &'a BackgroundDevice,
    /// The scene that was drawn last, by its number, and its pictures.
    scene: Option<(u64, Pictures)>,
}

impl Thread<'_> {
    fn render(&mut self, request: Request) -> RenderResult {
        match request {
            Request::Still(job, folder, name) => {
                RenderResult::Still(self.guarded(|thread| thread.still(&job, &folder, &name)))
            }
            Request::Paused(number, job, settings) => {
                RenderResult::Paused(number, self.guarded(|thread| thread.paused(&job, &settings)))
            }
        }
    }

    /// Draws and turns a panic into an error, so that it does not end the thread.
    fn guarded<T>(&mut self, draw: impl FnOnce(&mut Self) -> Result<T, Error>) -> Result<T, String> {
        match catch_unwind(AssertUnwindSafe(|| draw(self))) {
            Ok(done) => done.map_err(|error| error.to_string()),
            Err(_) => {
                self.scene = None;
                Err(FAULT.into())
            }
        }
    }

    fn still(&mut self, job: &RenderJob, folder: &Path, name: &str) -> Result<PathBuf, Error> {
        let pictures = self.pictures(job, STILL_SIZE, 2)?;
        let image = job.view_state.still(pictures, &moment(&job.snapshot))?;
        files::picture(folder, name, &image)
    }

    fn paused(&mut self, job: &RenderJob, settings: &PausedSettings) -> Result<Box<(Shown, Image)>, Error> {
        let pictures = self.pictures(job, settings.size, settings.samples)?;
        job.view_state.lift(pictures);
        let shown =
            pictures.show(&moment(&job.snapshot), &job.view_state.camera_offset, settings.quality, settings.paper)?;
        Ok(Box::new((shown, pictures.read()?)))
    }

    /// What draws a scene, in this size.
    fn pictures(&mut self, job: &RenderJob, size: [u32; 2], samples: u32) -> Result<&mut Pictures, Error> {
        let number = job.snapshot.number;
        if self.scene.as_ref().is_none_or(|(open, _)| *open != number) {
            // The memory of the last one is free before the next takes its own.
            self.scene = None;
            let gpu = self.device.gpu().map_err(RenderError::from)?;
            let settings = PictureSettings { size, samples, ..PictureSettings::default() };
            self.scene = Some((number, Pictures::open_scenery(&gpu, &job.scenery, settings)?));
        }
        let (_, pictures) = self.scene.as_mut().expect("it was opened above");
        pictures.resize(size, samples)?;
        Ok(pictures)
    }
}
