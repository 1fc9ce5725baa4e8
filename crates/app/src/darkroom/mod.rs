//! Pictures that take long without a graphics card, drawn in a thread of their own while the window goes on.

mod device;
mod thread;

pub use device::SlowDevice;

use crate::physics::{Snapshot, Wake};
use crate::sight::Sight;
use corpuscle::gpu::Image;
use corpuscle::pictures::{Look, Scenery, Shown};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// What is to be drawn.
#[derive(Clone)]
pub struct Sitting {
    /// What pictures need of the scene.
    pub scenery: Arc<Scenery>,
    /// The scene at one time.
    pub snapshot: Arc<Snapshot>,
    /// How it is seen.
    pub sight: Sight,
}

/// How what rests is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Finish {
    /// How much work it may be.
    pub look: Look,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples each way in a pixel.
    pub samples: u32,
    /// What a drawing lies on, linear light.
    pub paper: [f32; 3],
}

/// A picture that is there.
pub enum Print {
    /// A still was saved, or could not be.
    Still(Result<PathBuf, String>),
    /// What rests, by its number.
    Rest(u64, Result<Box<(Shown, Image)>, String>),
}

/// What waits to be drawn.
#[derive(Default)]
struct Tray {
    /// Stills, each with its folder and the name of its scene.
    stills: VecDeque<(Sitting, PathBuf, String)>,
    /// The newest wish for a picture of what rests, with its number.
    rest: Option<(u64, Sitting, Finish)>,
    /// How many of these there were.
    rests: u64,
    /// True where nothing more is to be drawn.
    closed: bool,
}

/// The tray, and a bell that tells of what was put into it.
#[derive(Default)]
struct Counter {
    tray: Mutex<Tray>,
    bell: Condvar,
}

impl Counter {
    fn tray(&self) -> MutexGuard<'_, Tray> {
        self.tray.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put<T>(&self, change: impl FnOnce(&mut Tray) -> T) -> T {
        let put = change(&mut self.tray());
        self.bell.notify_one();
        put
    }
}

/// The thread that draws, seen from outside. Dropping it waits for the picture that is being drawn, and for stills that were asked for.
pub struct Darkroom {
    counter: Arc<Counter>,
    prints: Receiver<Print>,
    thread: Option<JoinHandle<()>>,
}

impl Darkroom {
    /// Starts the thread.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(device: SlowDevice, wake: Wake) -> std::io::Result<Self> {
        let (tell, prints) = channel();
        let counter = Arc::<Counter>::default();
        let own = counter.clone();
        let run = move || thread::run(&own, &tell, &wake, &device);
        let thread = std::thread::Builder::new().name("darkroom".into()).spawn(run)?;
        Ok(Self { counter, prints, thread: Some(thread) })
    }

    /// Asks for a still in a folder, named after a scene.
    pub fn still(&self, sitting: Sitting, folder: PathBuf, name: String) {
        self.counter.put(|tray| tray.stills.push_back((sitting, folder, name)));
    }

    /// Asks for a picture of what rests, in place of one that was asked for and is not begun; gives its number.
    pub fn rest(&self, sitting: Sitting, finish: Finish) -> u64 {
        self.counter.put(|tray| {
            tray.rests += 1;
            tray.rest = Some((tray.rests, sitting, finish));
            tray.rests
        })
    }

    /// The pictures that are there since, the oldest first.
    pub fn prints(&self) -> Vec<Print> {
        self.prints.try_iter().collect()
    }
}

impl Drop for Darkroom {
    fn drop(&mut self) {
        self.counter.put(|tray| (tray.rest, tray.closed) = (None, true));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
