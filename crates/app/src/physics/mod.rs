//! The physics: it takes commands, advances in slices of wall-clock time, and publishes snapshots; in its own thread, in a browser in a
//! worker.

#[cfg(feature = "film")]
mod filming;
#[cfg(not(feature = "film"))]
#[path = "no_films.rs"]
mod filming;
mod gpu_advance;
#[cfg(any(test, target_arch = "wasm32"))]
mod message;
mod pace;
mod runner;
mod scene_text;
mod subject;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
#[cfg(target_arch = "wasm32")]
mod worker;

use crate::background_device::BackgroundDevice;
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use corpuscle::gpu::Gpu;
pub use corpuscle::parameters::Change;
use corpuscle::pictures::{Pictures, Scenery};
use corpuscle::scene::Scene;
pub(crate) use runner::open_pictures;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};
#[cfg(not(target_arch = "wasm32"))]
pub use thread::Physics;
#[cfg(target_arch = "wasm32")]
pub(crate) use worker::FileHolder;
#[cfg(target_arch = "wasm32")]
pub use worker::{Physics, serve};

/// Duration of a whole scene at the default pace, s.
const WHOLE: f64 = 40.0;

/// The default pace of a scene that ends at a time, s: simulated seconds per second, a round number.
pub fn default_pace(end: f64) -> f64 {
    round(end.max(f64::MIN_POSITIVE) / WHOLE)
}

/// The nearest of 1, 2 and 5 times a power of ten.
pub(crate) fn round(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    let far = |step: &f64| (step / value).ln().abs();
    steps.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(value)
}

/// The backend of the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Backend {
    /// On the device that draws the window (in a browser on the worker's), where that is a GPU and the scene is large enough.
    #[default]
    Auto,
    /// On the CPU.
    Cpu,
    /// On that device, whatever it is; a gas on the CPU all the same.
    Gpu,
}

/// A command to the physics.
#[derive(Serialize, Deserialize)]
pub enum Command {
    /// Open a scene and pause at its start. Relative paths are taken from the folder.
    Open(#[serde(with = "scene_text")] Box<Scene>, PathBuf),
    /// Open a finished run from its folder and pause at its start.
    OpenRun(PathBuf),
    /// Show another time of a finished run, s.
    Seek(f64),
    /// Play.
    Play,
    /// Pause.
    Pause,
    /// Advance by this much, s, and pause.
    Step(f64),
    /// Set the pace, simulated seconds per second.
    Pace(f64),
    /// Sample the water at this position in model coordinates from now on; none ends it.
    Probe(Option<[f64; 2]>),
    /// Start a film into a file, with the camera of [`Physics::see`].
    Film(PathBuf),
    /// End the film.
    EndFilm,
    /// Make a live change.
    Change(Change),
}

/// An event of the physics.
pub enum Event {
    /// A scene is open at its start.
    Opened(Box<Opened>),
    /// A scene could not be opened.
    Refused(String),
    /// A live change was refused.
    NotChanged(String),
    /// A film was written, or could not be.
    Filmed(Result<PathBuf, String>),
    /// The scene reached its end, and is paused.
    Ended,
    /// The scene broke down, and is paused; the last snapshot is valid.
    Fault(String),
    /// An internal error ended the scene, or its opening; another can be opened.
    Broken(String),
}

/// A scene that is open at its start.
pub struct Opened {
    /// Its number: snapshots of it carry the same.
    pub number: u64,
    /// The scene with all defaults filled in.
    pub scene: Scene,
    /// Its pictures; none where the physics has no device that draws.
    pub pictures: Option<Pictures>,
    /// What pictures in another thread need of it.
    pub scenery: Scenery,
    /// Names of its gauges, as in files.
    pub gauges: Vec<String>,
    /// Warnings to the user.
    pub warnings: Vec<String>,
    /// The backend and why it was chosen, as text; none for a finished run.
    pub computed_on: Option<String>,
    /// Of a finished run its gauges: times, s, and rows of values.
    pub history: Option<Vec<(f64, Vec<f64>)>>,
    /// End time, s.
    pub end: f64,
}

/// State shared by the physics thread and the window.
struct Shared {
    newest: Mutex<Option<Arc<Snapshot>>>,
    /// The camera, for films.
    view_state: Mutex<ViewState>,
    /// True while a particle is followed.
    follows: AtomicBool,
    /// Ends the current slice, so that a command is taken.
    stop: AtomicBool,
    wake: Wake,
}

/// The devices that draw and compute.
struct Devices {
    /// The window's.
    gpu: Gpu,
    background: BackgroundDevice,
}

impl Shared {
    fn new(wake: Wake) -> Self {
        let [follows, stop] = [(); 2].map(|()| AtomicBool::new(false));
        Self { newest: Mutex::default(), view_state: Mutex::default(), follows, stop, wake }
    }

    fn newest(&self) -> Option<Arc<Snapshot>> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn publish(&self, snapshot: Snapshot) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(snapshot));
        (self.wake)();
    }

    fn view_state(&self) -> ViewState {
        *self.view_state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
