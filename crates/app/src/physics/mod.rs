//! The physics in its own thread: it takes commands, advances in slices of wall-clock time, and publishes what it shows.

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

/// Seconds in which a scene is seen from start to end, if it can be computed so fast.
const WHOLE: f64 = 40.0;

/// The pace of what ends at a time, s: simulated seconds in a second, if nobody says otherwise; a round number.
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

/// Where steps are taken.
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

/// What the physics is asked to do.
pub enum Command {
    /// Set a scene up, at its start, and wait. Relative paths are taken from the folder.
    Open(Box<Scene>, PathBuf),
    /// Show a finished run from its folder, at its start, and wait.
    OpenRun(PathBuf),
    /// Show another time of a finished run, s.
    Seek(f64),
    /// Go on.
    Play,
    /// Wait.
    Pause,
    /// Go on by this much, s, and wait.
    Step(f64),
    /// Go on at this pace, simulated seconds in a second, where that is possible.
    Pace(f64),
    /// Tell of the water at a place from now on, in model coordinates; none: no longer.
    Probe(Option<[f64; 2]>),
    /// Film what goes on from now on into a file, as it is seen ([`Physics::see`]).
    Film(PathBuf),
    /// End the film.
    EndFilm,
    /// Change something while it runs.
    Change(Change),
}

/// What the physics tells.
pub enum Event {
    /// A scene stands at its start.
    Opened(Box<Opened>),
    /// A scene could not be set up.
    Refused(String),
    /// What was to change while it runs could not.
    NotChanged(String),
    /// A film was put in its place, or could not be.
    Filmed(Result<PathBuf, String>),
    /// It came to the scene's end, and waits.
    Ended,
    /// It broke down, and waits; what it showed last is sound.
    Fault(String),
}

/// A scene that stands at its start.
pub struct Opened {
    /// Its number: snapshots of it carry the same.
    pub number: u64,
    /// The scene with all defaults filled in.
    pub scene: Scene,
    /// Draws it.
    pub pictures: Pictures,
    /// Draws it elsewhere.
    pub scenery: Scenery,
    /// Names of its gauges, as in files.
    pub gauges: Vec<String>,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// Where it is computed, and why there, in words; none of a finished run.
    pub computed_on: Option<String>,
    /// Of a finished run its gauges: times, s, and rows of values.
    pub history: Option<Vec<(f64, Vec<f64>)>>,
    /// Its ground, where it has one.
    pub terrain: Option<Arc<Terrain>>,
    /// Where it ends, s.
    pub end: f64,
}

/// What is shared between the thread and whoever shows it.
struct Shared {
    newest: Mutex<Option<Arc<Snapshot>>>,
    /// How it is seen, for films.
    view_state: Mutex<ViewState>,
    /// Whether a single particle is followed.
    follows: AtomicBool,
    /// Breaks off what is being computed, so that a command is taken.
    stop: AtomicBool,
    wake: Wake,
}

/// What it draws and computes on.
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

/// The physics, seen from outside. Dropping it ends its thread.
pub struct Physics {
    commands: Option<Sender<Command>>,
    events: Receiver<Event>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Physics {
    /// Starts the thread; pictures are made for a device, which may take the steps too, and films drawn on one that may take long.
    ///
    /// # Errors
    /// Where the system gives no thread.
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

    /// Asks for something. Never waits.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // Before the command can be taken: it must not break itself off.
            self.shared.stop.store(true, Ordering::Relaxed);
            // A thread that is gone has told why.
            let _ = commands.send(command);
        }
    }

    /// It is seen so from now on. Never waits.
    pub fn see(&self, view_state: ViewState) {
        *self.shared.view_state.lock().unwrap_or_else(PoisonError::into_inner) = view_state;
    }

    /// A single particle is followed from now on, or none: all of them come to the host again and again. Never waits.
    pub fn follow(&self, follows: bool) {
        self.shared.follows.store(follows, Ordering::Relaxed);
    }

    /// What it told since, the oldest first.
    pub fn events(&self) -> Vec<Event> {
        self.events.try_iter().collect()
    }

    /// The newest that it shows.
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
