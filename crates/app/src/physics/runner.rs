//! What runs a scene: takes commands, advances in slices of wall-clock time, and publishes snapshots.

use super::filming::Filming;
use super::gpu_advance::{self, Fault};
use super::pace::Pace;
use super::subject::Subject;
use super::{Backend, Command, Devices, Event, Opened, Shared, default_pace};
use crate::snapshot::{Measures, Snapshot};
use corpuscle::gpu::Gpu;
use corpuscle::model::Frame;
use corpuscle::pictures::{PictureSettings, Pictures, Scenery};
use corpuscle::scene::Scene;
use corpuscle::{Cpu, Error, Sample, Simulation};
use corpuscle_render::RenderError;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;
use web_time::Instant;

/// Pictures in a second at most.
pub(super) const PICTURES: f64 = 60.0;
/// Time between two measurements at least, and how many times longer than one takes.
pub(super) const MEASURE: Duration = Duration::from_millis(120);
const MEASURE_SHARE: u32 = 10;
/// Initial size of pictures; the window resizes them.
const SMALL: [u32; 2] = [16, 16];

/// Runs one scene after another.
pub(super) struct Runner {
    events: Sender<Event>,
    shared: Arc<Shared>,
    /// Of scenes that are opened from now on.
    pub(super) backend: Backend,
    /// The devices that draw and compute; none where it is drawn elsewhere.
    devices: Option<Devices>,
    /// The device that may take steps; beside a CPU of one core it is opened for the first scene that may take it.
    stepping: Option<Gpu>,
    pub(super) cpu: Cpu,
    /// Scenes opened so far.
    number: u64,
    running: Option<Running>,
}

/// The scene that is open.
pub(super) struct Running {
    pub subject: Subject,
    playing: bool,
    /// Time of the next pause, s.
    pub until: f64,
    pub pace: Pace,
    /// When the last slice began.
    began: Instant,
    pub measured: Arc<Measures>,
    /// When it may be measured again.
    pub measure_at: Instant,
    pub rate: Rate,
    /// Position at which the water is sampled.
    pub probe: Option<[f64; 2]>,
    pub filming: Option<Filming>,
    /// The water there, and all particles, as last read back.
    pub probed: Option<Sample>,
    pub known: Arc<Frame>,
}

/// Rate of work.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rate {
    /// Work done at the last update, and when that was.
    noted: (u64, Instant),
    pub now: f64,
}

impl Rate {
    /// Updates the rate with the work done so far.
    pub fn note(&mut self, work: u64) {
        let (before, when) = self.noted;
        let since = when.elapsed().as_secs_f64();
        // While particles come back from a GPU no work is done.
        if since > 0.5 && work > before || since > 2.0 {
            self.now = work.saturating_sub(before) as f64 / since;
            self.noted = (work, Instant::now());
        }
    }
}

impl Runner {
    /// Without a scene.
    pub fn new(events: Sender<Event>, shared: Arc<Shared>, backend: Backend, devices: Option<Devices>) -> Self {
        let stepping = devices.as_ref().map(|devices| devices.gpu.clone());
        Self { events, shared, backend, devices, stepping, cpu: Cpu::AllCores, number: 0, running: None }
    }

    /// How long to wait for a command before the next slice; none while paused.
    pub fn time_left(&self) -> Option<Duration> {
        let running = self.running.as_ref().filter(|running| running.playing)?;
        Some(Duration::from_secs_f64(1.0 / PICTURES).saturating_sub(running.began.elapsed()))
    }

    fn send(&self, event: Event) {
        // The receiver is gone when the window closes.
        let _ = self.events.send(event);
        (self.shared.wake)();
    }

    /// The scene broke down by an internal error.
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "in a browser a panic ends the worker"))]
    pub fn broken(&mut self) {
        self.running = None;
        self.send(Event::Broken("an internal error stopped the scene; open it again".into()));
    }

    /// Does what a command says. To be awaited to its end.
    pub async fn take(&mut self, command: Command) {
        let command = match command {
            Command::Open(scene, folder) => {
                return self.open(async |runner| runner.live(*scene, &folder).await).await;
            }
            Command::OpenRun(folder) => return self.open(async |_| Subject::recorded(&folder)).await,
            command => command,
        };
        let Some(running) = &mut self.running else { return };
        match command {
            Command::Open(..) | Command::OpenRun(..) => {}
            Command::Seek(time) => {
                if let Err(error) = running.subject.seek(time) {
                    self.send(Event::Fault(error.to_string()));
                }
            }
            Command::Play => {
                running.until = running.subject.next_end();
                (running.playing, running.began) = (true, Instant::now());
            }
            Command::Pause => running.wait(),
            Command::Probe(position) => running.probe = position,
            Command::Film(path) => self.film(&path),
            Command::EndFilm => self.end_film(),
            Command::Pace(pace) => running.pace.requested = pace,
            Command::Step(by) => self.step(by).await,
            Command::Change(change) => match running.subject.change(change) {
                Ok(()) => running.measure_at = Instant::now(),
                Err(error) => self.send(Event::NotChanged(error.to_string())),
            },
        }
        self.publish();
    }

    /// Opens a scene at its start, on the device where it is to take the steps.
    async fn live(&mut self, scene: Scene, folder: &Path) -> Result<Subject, Error> {
        let simulation = Simulation::open(scene, folder)?;
        let may_take_gpu = match self.backend {
            Backend::Cpu => false,
            Backend::Auto => simulation.why_on_cpu(self.cpu).is_none(),
            Backend::Gpu => simulation.model().on_gpu().is_some(),
        };
        if may_take_gpu && self.cpu == Cpu::OneCore {
            self.open_device().await;
        }
        Subject::live(simulation, self.backend, (self.stepping.as_ref(), self.cpu))
    }

    /// Opens the device that may take steps, if there is one and none is open; one that was lost is opened again.
    async fn open_device(&mut self) {
        self.stepping = self.stepping.take().filter(|gpu| gpu.check().is_ok());
        if self.stepping.is_none() {
            self.stepping = Gpu::open_async().await.ok();
        }
    }

    async fn open(&mut self, subject: impl AsyncFnOnce(&mut Self) -> Result<Subject, Error>) {
        self.end_film();
        self.running = None;
        self.number += 1;
        match subject(self).await.and_then(|subject| self.put(subject)) {
            Ok(opened) => {
                self.publish();
                self.send(Event::Opened(Box::new(opened)));
            }
            Err(error) => self.send(Event::Refused(error.to_string())),
        }
    }

    /// Sets up the opened scene.
    fn put(&mut self, subject: Subject) -> Result<Opened, Error> {
        let simulation = subject.simulation();
        let scenery = Scenery::of(simulation);
        let pictures = self.devices.as_ref().map(|devices| open_pictures(&devices.gpu, &scenery)).transpose()?;
        let scene = simulation.scene().clone();
        let now = Instant::now();
        let (gauges, warnings) = (subject.gauge_names(), simulation.warnings());
        let (history, computed_on) = (subject.history(), subject.computed_on());
        let end = subject.end();
        self.running = Some(Running {
            playing: false,
            until: end,
            pace: Pace::new(default_pace(end)),
            began: now,
            measured: Arc::default(),
            measure_at: now,
            rate: Rate { noted: (subject.work(), now), now: 0.0 },
            probe: None,
            filming: None,
            probed: None,
            known: Arc::new(Frame { time: 0.0, sets: Vec::new() }),
            subject,
        });
        Ok(Opened { number: self.number, scene, pictures, scenery, gauges, warnings, computed_on, history, end })
    }

    fn film(&mut self, path: &Path) {
        let Some(running) = &mut self.running else { return };
        let Some(devices) = &self.devices else { return };
        let gpu = devices.background.gpu().map_err(|error| Error::from(RenderError::from(error)));
        match gpu.and_then(|gpu| Filming::begin(&gpu, &running.subject, path, running.pace.requested)) {
            Ok(filming) => {
                running.filming = Some(filming);
                self.add_film_picture();
            }
            Err(error) => self.send(Event::Filmed(Err(error.to_string()))),
        }
    }

    async fn step(&mut self, by: f64) {
        let Some(running) = &mut self.running else { return };
        running.wait();
        let to = running.subject.time() + by;
        if let Err(error) = running.subject.advance_to(to, &self.shared.stop).await {
            self.send(Event::Fault(error.to_string()));
        }
        self.add_film_picture();
    }

    /// Advances for a slice of wall-clock time. To be awaited to its end.
    pub async fn slice(&mut self) {
        let Some(running) = &mut self.running else { return };
        let begun = Instant::now();
        let devices = self.devices.as_ref();
        if devices.is_some_and(|devices| running.subject.drawn_in_place(&devices.gpu).is_some()) {
            running.began = begun;
            return self.advance_on_gpu();
        }
        let from = running.subject.time();
        let to = (from + running.pace.next(running.began.elapsed())).min(running.until);
        // The pictures of a film are due at fixed times.
        let to = running.filming.as_ref().map_or(to, |filming| to.min(filming.next.max(from)));
        let whole = running.began.elapsed();
        running.began = begun;
        let gone = running.subject.advance_to(to, &self.shared.stop).await;
        let now = running.subject.time();
        running.pace.went(now - from, begun.elapsed(), whole.max(begun.elapsed()));
        self.add_film_picture();
        self.went(gone);
    }

    /// Advances on the GPU that draws, until a command arrives or the particles are needed.
    fn advance_on_gpu(&mut self) {
        let (Some(running), Some(devices)) = (&mut self.running, &self.devices) else { return };
        match gpu_advance::advance(running, &self.shared, &devices.gpu, self.number) {
            Err(Fault::OfModel(error)) => self.went(Err(error)),
            Err(Fault::OfFilm(error)) => {
                running.filming = None;
                self.send(Event::Filmed(Err(error.to_string())));
                self.went(Ok(()));
            }
            Ok(recalled) => {
                self.went(Ok(()));
                if let (Some(recalled), Some(running)) = (recalled, &mut self.running) {
                    running.measure_at = Instant::now() + MEASURE.max(recalled.elapsed() * MEASURE_SHARE);
                }
            }
        }
    }

    /// Publishes the result of a slice, and pauses at the end or after an error.
    fn went(&mut self, gone: Result<(), Error>) {
        let Some(running) = &mut self.running else { return };
        let event = match gone {
            Err(error) => Some(Event::Fault(error.to_string())),
            Ok(()) if running.subject.time() >= running.until => Some(Event::Ended),
            Ok(()) => None,
        };
        if event.is_some() {
            running.wait();
        }
        self.publish();
        if let Some(event) = event {
            self.send(event);
        }
    }

    /// Adds a picture to the film, where one is recorded and a picture is due.
    fn add_film_picture(&mut self) {
        let Some(running) = &mut self.running else { return };
        let Some(filming) = &mut running.filming else { return };
        let view_state = self.shared.view_state();
        if let Err(error) = filming.add_if_due(&running.subject, &view_state) {
            running.filming = None;
            self.send(Event::Filmed(Err(error.to_string())));
        }
    }

    /// Ends the film, if one is recorded.
    pub fn end_film(&mut self) {
        let filming = self.running.as_mut().and_then(|running| running.filming.take());
        if let Some(filming) = filming {
            self.send(Event::Filmed(filming.finish().map_err(|error| error.to_string())));
        }
    }

    /// Publishes a snapshot.
    fn publish(&mut self) {
        let Some(running) = &mut self.running else { return };
        match running.snapshot(self.number, self.devices.as_ref().map(|devices| &devices.gpu)) {
            Ok(snapshot) => self.shared.publish(snapshot),
            Err(error) => self.send(Event::Fault(error.to_string())),
        }
    }
}

/// The pictures of a scene, of a size that the window sets.
///
/// # Errors
/// Those of [`Pictures::open_scenery`].
pub(crate) fn open_pictures(gpu: &Gpu, scenery: &Scenery) -> Result<Pictures, Error> {
    let settings = PictureSettings { size: SMALL, samples: 1, ..PictureSettings::default() };
    Pictures::open_scenery(gpu, scenery, settings)
}

impl Running {
    fn wait(&mut self) {
        self.playing = false;
        self.pace.rest();
        // A paused scene shows its newest measurements.
        self.measure_at = Instant::now();
    }

    fn snapshot(&mut self, number: u64, gpu: Option<&Gpu>) -> Result<Snapshot, Error> {
        let now = Instant::now();
        if now >= self.measure_at {
            self.measured = Arc::new(self.subject.measures());
            self.measure_at = now + MEASURE.max(now.elapsed() * MEASURE_SHARE);
        }
        self.rate.note(self.subject.work());
        let (frame, paths, container) = self.subject.current();
        self.known = Arc::new(frame);
        self.probed = self.probe.and_then(|position| self.subject.water_at(position));
        Ok(Snapshot {
            number,
            particles: self.subject.particles(),
            frame: self.known.clone(),
            on_device: gpu.map_or(Ok(None), |gpu| self.subject.on_device(gpu))?,
            known: self.known.clone(),
            paths,
            container,
            playing: self.playing,
            pace: self.pace.real,
            behind: self.playing && self.pace.is_behind(),
            rate: if self.playing { self.rate.now } else { 0.0 },
            probed: self.probed,
            measures: self.measured.clone(),
        })
    }
}
