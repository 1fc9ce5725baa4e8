//! What is in the window.

mod dropping;
mod keys;
mod listening;
mod open;
mod panels;
mod saving;
mod side;
mod source;

pub use source::{Source, Start};

use crate::background_device::BackgroundDevice;
use crate::gallery::Gallery;
use crate::offscreen::OffscreenRenderer;
use crate::physics::{Backend, Command, Opened, Physics, default_pace};
use crate::picture::Picture;
use crate::plots::Plots;
use crate::snapshot::{Snapshot, Wake};
use crate::touch::Hands;
use crate::{Screen, help, style};
use egui::{Context, Frame, Margin, Panel, Ui};
use open::{Open, parameters};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// The window and all that it shows.
pub struct Window {
    screen: Screen,
    physics: Physics,
    /// Draws what takes long.
    offscreen: OffscreenRenderer,
    gallery: Gallery,
    /// Which of scenes, parameters and plots are shown.
    panels: Panels,
    help: bool,
    /// What was done last, for a moment.
    notice: Option<(String, Instant)>,
    /// What was asked to be opened, until it is.
    awaited: Option<Awaited>,
    open: Option<Open>,
    /// What went wrong last.
    fault: Option<String>,
    clock: PictureClock,
    /// Where files are written.
    folder: PathBuf,
    /// Whether what is opened plays at once.
    plays: bool,
}

/// What is to be opened.
enum Awaited {
    Scene(Source),
    Run(PathBuf),
    /// What was dropped, until it is read.
    Dropped(Receiver<Result<Start, String>>),
}

/// Which panels are shown.
#[derive(Debug, Clone, Copy)]
struct Panels {
    scenes: bool,
    parameters: bool,
    plots: bool,
}

/// How long a notice is shown.
const NOTICE: Duration = Duration::from_secs(4);

/// Counts pictures.
#[derive(Default)]
struct PictureClock {
    times: VecDeque<Instant>,
}

impl PictureClock {
    /// Another picture; gives how many there are in a second.
    fn tick(&mut self) -> f64 {
        let now = Instant::now();
        self.times.push_back(now);
        while self.times.front().is_some_and(|first| now.duration_since(*first).as_secs_f64() > 1.0) {
            self.times.pop_front();
        }
        let first = self.times.front().copied().unwrap_or(now);
        (self.times.len() - 1) as f64 / now.duration_since(first).as_secs_f64().max(1e-3)
    }
}

impl Window {
    /// A window that begins so, and has scenes computed on a backend.
    ///
    /// # Errors
    /// Where the system gives no thread for the physics or for pictures that take long.
    pub fn new(context: &Context, screen: Screen, start: Start, backend: Backend) -> std::io::Result<Self> {
        style::set_up(context);
        let wake = context.clone();
        let wake: Wake = Arc::new(move || wake.request_repaint());
        let background = BackgroundDevice::beside(&screen.gpu);
        let physics = Physics::start(&screen.gpu, background.clone(), backend, wake.clone())?;
        let offscreen = OffscreenRenderer::start(background, wake)?;
        let mut window = Self {
            screen,
            physics,
            offscreen,
            gallery: Gallery::new(),
            panels: Panels { scenes: true, parameters: true, plots: true },
            help: false,
            notice: None,
            awaited: None,
            open: None,
            fault: None,
            clock: PictureClock::default(),
            folder: PathBuf::from("."),
            plays: true,
        };
        match start {
            Start::Welcome => {}
            Start::Scene(source) => window.open(source),
            Start::Run(folder) => window.open_run(folder),
        }
        Ok(window)
    }

    /// Writes files into another folder than the one that the program was started in.
    pub fn save_into(&mut self, folder: PathBuf) {
        self.folder = folder;
    }

    /// What is opened from now on waits at its start.
    pub fn wait_at_start(&mut self) {
        self.plays = false;
    }

    /// Opens a scene.
    pub fn open(&mut self, source: Source) {
        self.fault = None;
        match source.scene() {
            Ok(scene) => {
                self.physics.ask(Command::Open(Box::new(scene), source.folder.clone()));
                self.awaited = Some(Awaited::Scene(source));
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Opens the folder of a finished run.
    pub fn open_run(&mut self, folder: PathBuf) {
        self.fault = None;
        self.physics.ask(Command::OpenRun(folder.clone()));
        self.awaited = Some(Awaited::Run(folder));
    }

    /// The newest snapshot of what is open.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        self.open.as_ref()?.snapshot.clone()
    }

    /// What a gauge was measured at last, by its name as in files; none where there is none.
    pub fn gauge(&self, name: &str) -> Option<f64> {
        let snapshot = self.snapshot()?;
        let at = snapshot.measures.names.iter().position(|gauge| gauge == name)?;
        snapshot.measures.gauges.get(at).copied()
    }

    /// True where the picture has all there is to its look: without a GPU what moves is drawn simply.
    pub fn is_complete(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.picture.is_complete())
    }

    /// True until a scene that was asked for is open or refused.
    pub fn is_waiting(&self) -> bool {
        self.awaited.is_some()
    }

    /// What went wrong last, if anything did.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Lets the scene go on, or wait.
    pub fn play(&mut self, playing: bool) {
        if let Some(open) = &mut self.open {
            open.playing = playing;
            self.physics.ask(if playing { Command::Play } else { Command::Pause });
        }
    }

    fn take(&mut self, opened: Opened) {
        let Some(awaited) = self.awaited.take() else { return };
        let plots = Plots::new(&opened);
        let Opened { number, scene, pictures, scenery, terrain, end, computed_on, .. } = opened;
        let recorded = matches!(awaited, Awaited::Run(_));
        let source = match awaited {
            Awaited::Scene(source) => source,
            // What was opened before is no longer wanted.
            Awaited::Dropped(_) => {
                self.awaited = Some(awaited);
                return;
            }
            Awaited::Run(folder) => Source {
                name: folder.display().to_string(),
                text: scene.to_toml().unwrap_or_default(),
                folder,
                changes: Vec::new(),
            },
        };
        let before = self.open.take();
        let mut picture = Picture::new(self.screen.clone(), pictures, scenery);
        let mut times = 1.0;
        if let Some(before) = before.filter(|before| before.source.name == source.name) {
            // Who changes a scene wants to see it from where it was seen.
            (picture.camera_offset, picture.quality) = (before.picture.camera_offset, before.picture.quality);
            times = before.times;
        }
        self.physics.ask(Command::Pace(times * default_pace(end)));
        self.open = Some(Open {
            number,
            parameters: parameters(&source),
            plots,
            picked: None,
            clicked: None,
            terrain,
            spot: None,
            probed: None,
            filming: false,
            hands: Hands::default(),
            source,
            recorded,
            end,
            scene,
            picture,
            computed_on,
            snapshot: None,
            playing: false,
            times,
        });
        self.play(self.plays);
    }

    /// Shows everything.
    pub fn ui(&mut self, ui: &mut Ui) {
        self.take_dropped(ui.ctx());
        self.listen();
        self.keys(ui);
        let pictures = self.clock.tick();
        // Not while a hand moves the camera: it would be drawn twice.
        if let Some(open) = &mut self.open
            && let Some(snapshot) = open.snapshot.clone().filter(|snapshot| snapshot.playing)
            && !ui.input(|input| input.pointer.any_down())
        {
            open.picture.draw_ahead(&snapshot, ui.visuals());
        }
        if self.open.is_none() && self.awaited.is_none() {
            return self.first_page(ui);
        }
        let strip = Frame::new().inner_margin(Margin::symmetric(12, 6));
        let pressed =
            Panel::bottom("strip").frame(strip).exact_size(52.0).show(ui, |ui| self.strip(ui, pictures)).inner;
        let bar = Frame::new().inner_margin(Margin::symmetric(10, 5));
        Panel::top("bar").frame(bar).exact_size(44.0).show(ui, |ui| ui.horizontal_centered(|ui| self.toolbar(ui)));
        self.scenes(ui);
        self.parameters(ui);
        self.plots(ui);
        egui::CentralPanel::default().frame(Frame::new()).show(ui, |ui| self.middle(ui));
        if let Some(pressed) = pressed {
            self.press(pressed);
        }
        if self.help {
            self.help = !help::sheet(ui.ctx());
        }
    }
}
