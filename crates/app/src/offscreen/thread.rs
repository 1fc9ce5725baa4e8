//! The thread that draws.

use super::drawing::{Drawing, STILL_SIZE};
use super::{PausedSettings, RenderJob, RenderResult};
use crate::background_device::BackgroundDevice;
use crate::files;
use crate::snapshot::Wake;
use crate::view_state::moment;
use corpuscle::Error;
use corpuscle::gpu::Image;
use corpuscle::pictures::Shown;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

const FAULT: &str = "an internal error stopped the picture";

/// The pictures that wait to be drawn.
#[derive(Default)]
struct JobQueue {
    /// Stills, each with its folder and the name of its scene.
    stills: VecDeque<(RenderJob, PathBuf, String)>,
    /// The newest request for the window's picture, with its number.
    paused: Option<(u64, RenderJob, PausedSettings)>,
    /// The number of such requests so far.
    requests: u64,
    /// True once the window closes: only stills are drawn then.
    closed: bool,
}

/// The queue of the two threads, with the condition variable that wakes the one that draws.
#[derive(Default)]
struct SharedQueue {
    queue: Mutex<JobQueue>,
    condvar: Condvar,
}

impl SharedQueue {
    fn queue(&self) -> MutexGuard<'_, JobQueue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put<T>(&self, change: impl FnOnce(&mut JobQueue) -> T) -> T {
        let put = change(&mut self.queue());
        self.condvar.notify_one();
        put
    }
}

/// The handle of the thread that draws. Dropping it waits for the picture that is being drawn, and for the stills in the queue.
pub struct OffscreenRenderer {
    shared: Arc<SharedQueue>,
    results: Receiver<RenderResult>,
    thread: Option<JoinHandle<()>>,
}

impl OffscreenRenderer {
    /// Starts the thread.
    ///
    /// # Errors
    /// Where the thread cannot be started.
    pub fn start(device: BackgroundDevice, wake: Wake) -> std::io::Result<Self> {
        let (sender, results) = channel();
        let shared = Arc::<SharedQueue>::default();
        let own = shared.clone();
        let run = move || run(&own, &sender, &wake, device);
        let thread = std::thread::Builder::new().name("offscreen".into()).spawn(run)?;
        Ok(Self { shared, results, thread: Some(thread) })
    }

    /// Requests a still in a folder, named after a scene.
    pub fn still(&self, job: RenderJob, folder: PathBuf, name: String) {
        self.shared.put(|queue| queue.stills.push_back((job, folder, name)));
    }

    /// Requests the window's picture of a paused scene and returns the number of the request; it replaces an earlier one that is not begun.
    pub fn draw_paused(&self, job: RenderJob, settings: PausedSettings) -> u64 {
        self.shared.put(|queue| {
            queue.requests += 1;
            queue.paused = Some((queue.requests, job, settings));
            queue.requests
        })
    }

    /// The pictures drawn since the last call, oldest first.
    pub fn results(&self) -> Vec<RenderResult> {
        self.results.try_iter().collect()
    }
}

impl Drop for OffscreenRenderer {
    fn drop(&mut self) {
        self.shared.put(|queue| (queue.paused, queue.closed) = (None, true));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Draws what is requested until the queue is closed.
fn run(shared: &SharedQueue, results: &Sender<RenderResult>, wake: &Wake, device: BackgroundDevice) {
    let mut thread = Thread(Drawing::new(device));
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

/// The thread's own state.
struct Thread(Drawing);

impl Thread {
    fn render(&mut self, request: Request) -> RenderResult {
        match request {
            Request::Still(job, folder, name) => {
                RenderResult::Still(self.guarded(|drawing| still(drawing, &job, &folder, &name)))
            }
            Request::Paused(number, job, settings) => {
                RenderResult::Paused(number, self.guarded(|drawing| paused(drawing, &job, &settings)))
            }
        }
    }

    /// Draws and turns a panic into an error, so that it does not end the thread.
    fn guarded<T>(&mut self, draw: impl FnOnce(&mut Drawing) -> Result<T, Error>) -> Result<T, String> {
        match catch_unwind(AssertUnwindSafe(|| draw(&mut self.0))) {
            Ok(done) => done.map_err(|error| error.to_string()),
            Err(_) => {
                self.0.forget();
                Err(FAULT.into())
            }
        }
    }
}

fn still(drawing: &mut Drawing, job: &RenderJob, folder: &Path, name: &str) -> Result<PathBuf, Error> {
    let pictures = drawing.pictures(job, STILL_SIZE, 2)?;
    let image = job.view_state.still(pictures, &moment(&job.snapshot))?;
    files::picture(folder, name, &image)
}

fn paused(drawing: &mut Drawing, job: &RenderJob, settings: &PausedSettings) -> Result<Box<(Shown, Image)>, Error> {
    let (shown, pictures) = drawing.paused(job, settings)?;
    Ok(Box::new((shown, pictures.read()?)))
}
