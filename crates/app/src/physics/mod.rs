//! The physics in its own thread: it takes commands, advances in slices of wall-clock time, and publishes snapshots.

mod filming;
mod gpu_advance;
mod pace;
mod subject;
mod thread;

use crate::background_device::BackgroundDevice;
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use corpuscle::gpu::Gpu;
pub use corpuscle::parameters::Change;
use corpuscle::pictures::{Pictures, Scenery};
use corpuscle::scene::Scene;
use corpuscle::terrain::Terrain;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// On the device that draws the window, where that is a GPU and the scene is large enough.
    #[default]
    Auto,
    /// On the CPU.
    Cpu,
    /// On the device that draws the window, whatever it is; a gas on the CPU all the same.
    Gpu,
}

/// A command to the physics thread.
pub enum Command {
    /// Open a scene and pause at its start. Relative paths are taken from the folder.
    Open(Box<Scene>, PathBuf),
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

/// An event of the physics thread.
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
}

/// A scene that is open at its start.
pub struct Opened {
    /// Its number: snapshots of it carry the same.
    pub number: u64,
    /// The scene with all defaults filled in.
    pub scene: Scene,
    /// Its pictures.
    pub pictures: Pictures,
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
    /// Its terrain, if it has one.
    pub terrain: Option<Arc<Terrain>>,
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
#[derive(Clone, Copy)]
struct Devices<'a> {
    /// The window's.
    gpu: &'a Gpu,
    background: &'a BackgroundDevice,
    backend: Backend,
}

impl Shared {
    fn publish(&self, snapshot: Snapshot) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(snapshot));
        (self.wake)();
    }

    fn view_state(&self) -> ViewState {
        *self.view_state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The handle of the physics thread. Dropping it ends the thread.
pub struct Physics {
    commands: Option<Sender<Command>>,
    events: Receiver<Event>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Physics {
    /// Starts the thread: `gpu` draws pictures and may take the steps too, `background` draws films.
    ///
    /// # Errors
    /// Where the thread cannot be started.
    pub(crate) fn start(
        gpu: &Gpu,
        background: BackgroundDevice,
        backend: Backend,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let (commands, taken) = channel();
        let (sender, events) = channel();
        let (newest, view_state) = (Mutex::default(), Mutex::default());
        let [follows, stop] = [(); 2].map(|()| AtomicBool::new(false));
        let shared = Arc::new(Shared { newest, view_state, follows, stop, wake });
        let (gpu, own) = (gpu.clone(), shared.clone());
        let run = move || thread::run(&taken, &sender, &own, Devices { gpu: &gpu, background: &background, backend });
        let thread = std::thread::Builder::new().name("physics".into()).spawn(run)?;
        Ok(Self { commands: Some(commands), events, shared, thread: Some(thread) })
    }

    /// Sends a command. Never waits.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // Set before the command is sent, so that it does not end the command's own slice.
            self.shared.stop.store(true, Ordering::Relaxed);
            // A thread that has ended has sent an event.
            let _ = commands.send(command);
        }
    }

    /// Sets the camera of films. Never waits.
    pub fn see(&self, view_state: ViewState) {
        *self.shared.view_state.lock().unwrap_or_else(PoisonError::into_inner) = view_state;
    }

    /// Sets whether a particle is followed: the particles are then read back from the GPU regularly. Never waits.
    pub fn follow(&self, follows: bool) {
        self.shared.follows.store(follows, Ordering::Relaxed);
    }

    /// The events since the last call, the oldest first.
    pub fn events(&self) -> Vec<Event> {
        self.events.try_iter().collect()
    }

    /// The newest snapshot.
    pub fn newest(&self) -> Option<Arc<Snapshot>> {
        self.shared.newest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for Physics {
    fn drop(&mut self) {
        self.commands = None;
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
