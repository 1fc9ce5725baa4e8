//! Pictures that take long to draw without a GPU, drawn by a thread of their own while the window stays live.

mod thread;

use crate::background_device::BackgroundDevice;
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use corpuscle::gpu::Image;
use corpuscle::pictures::{Quality, Scenery, Shown};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// A scene at one time, as it is to be drawn.
#[derive(Clone)]
pub struct RenderJob {
    /// What pictures need of the scene.
    pub scenery: Arc<Scenery>,
    /// The scene at one time.
    pub snapshot: Arc<Snapshot>,
    /// The camera and the partition.
    pub view_state: ViewState,
}

/// How the window's picture of a paused scene is drawn.
#[derive(Debug, Clone, Copy)]
pub struct PausedSettings {
    /// The quality.
    pub quality: Quality,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples each way in a pixel.
    pub samples: u32,
    /// Background of a drawing, linear light.
    pub paper: [f32; 3],
}

/// A picture that was drawn.
pub enum RenderResult {
    /// A still was saved, or could not be.
    Still(Result<PathBuf, String>),
    /// The window's picture of a paused scene, by the number of its request.
    Paused(u64, Result<Box<(Shown, Image)>, String>),
}

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
        let run = move || thread::run(&own, &sender, &wake, &device);
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
