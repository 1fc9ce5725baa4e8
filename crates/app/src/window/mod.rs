//! The content of the window.

mod dropping;
mod keys;
mod listening;
mod open;
mod panels;
mod saving;
mod side;

use crate::background_device::BackgroundDevice;
use crate::gallery::Gallery;
use crate::gas_controls::GasControls;
use crate::instruments::{Instruments, Stopwatch};
use crate::offscreen::OffscreenRenderer;
use crate::physics::{Backend, Command, Opened, Physics, default_pace};
use crate::picture::Picture;
use crate::plots::Plots;
use crate::snapshot::{Snapshot, Wake};
use crate::transport::PACES;
use crate::{Screen, Source, Start, help, link, style};
use corpuscle::pictures::CameraOffset;
use dropping::ChosenFiles;
use egui::{Context, Frame, Margin, Panel, Ui};
use open::{Open, parameters};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;
use web_time::Instant;

/// The window and all that it shows.
pub struct Window {
    /// Where pictures are drawn; none where they are sketched.
    screen: Option<Screen>,
    physics: Physics,
    /// Draws pictures that take long.
    offscreen: OffscreenRenderer,
    gallery: Gallery,
    /// Visibility of the panels.
    panels: Panels,
    help: bool,
    /// The last notice, and when it was shown.
    notice: Option<(String, Instant)>,
    /// The scene or run being opened.
    pending: Option<Pending>,
    open: Option<Open>,
    /// The last error.
    fault: Option<String>,
    clock: PictureClock,
    /// Folder of the files written.
    folder: PathBuf,
    /// The pace of scenes as they are opened, over their own.
    speed: f64,
    /// Whether a scene plays as soon as it is open.
    plays: bool,
    /// How the picture is shown alone, where it is.
    embedded: Option<Embedded>,
    /// True where the window is narrow.
    is_narrow: bool,
    /// Files that were chosen to be opened.
    chosen: ChosenFiles,
}

/// A picture that is shown alone.
#[derive(Debug, Clone, Copy)]
pub struct Embedded {
    /// Whether the strip with play, step, speed and time is shown below it.
    pub has_strip: bool,
}

/// A scene or run being opened.
enum Pending {
    Scene(Source),
    Run(PathBuf),
    /// A dropped file that is being read.
    Dropped(Receiver<Result<Start, String>>),
}

/// Which panels are shown.
#[derive(Debug, Clone, Copy)]
struct Panels {
    scenes: bool,
    parameters: bool,
    plots: bool,
}

impl Panels {
    /// Shows a panel or hides it; in a narrow window it is alone.
    fn toggle(&mut self, which: fn(&mut Self) -> &mut bool, is_narrow: bool) {
        let shown = !*which(self);
        if is_narrow {
            *self = Self { scenes: false, parameters: false, plots: false };
        }
        *which(self) = shown;
    }
}

/// Width of a window in points below which it is narrow, as on a phone: one panel at a time lies below the picture.
const NARROW: f32 = 640.0;
/// Height of that panel over the height of the window.
const SHEET: f32 = 0.42;

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
    /// A window that opens `start` first and computes scenes on `backend`. Without a screen pictures are discs and maps, drawn with the
    /// window's own shapes.
    ///
    /// # Errors
    /// Where the threads of the physics or of the pictures cannot be started.
    pub fn new(context: &Context, screen: Option<Screen>, start: Start, backend: Backend) -> std::io::Result<Self> {
        style::set_up(context);
        let wake = context.clone();
        let wake: Wake = Arc::new(move || wake.request_repaint());
        let gpu = screen.as_ref().map(|screen| &screen.gpu);
        let background = BackgroundDevice::beside(gpu);
        let physics = Physics::start(gpu, background.clone(), backend, wake.clone())?;
        let offscreen = OffscreenRenderer::start(background, wake)?;
        let mut window = Self {
            screen,
            physics,
            offscreen,
            gallery: Gallery::new(),
            panels: Panels { scenes: true, parameters: true, plots: true },
            help: false,
            notice: None,
            pending: None,
            open: None,
            fault: None,
            clock: PictureClock::default(),
            folder: PathBuf::from("."),
            speed: 1.0,
            plays: true,
            embedded: None,
            is_narrow: false,
            chosen: ChosenFiles::default(),
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

    /// Scenes opened from now on are paused at their start.
    pub fn wait_at_start(&mut self) {
        self.plays = false;
    }

    /// Scenes opened from now on play so many times as fast as by default, within the range of the window's control.
    pub fn set_speed(&mut self, times: f64) {
        if times.is_finite() {
            self.speed = times.clamp(PACES[0], PACES[1]);
        }
    }

    /// Opens a scene.
    pub fn open(&mut self, source: Source) {
        self.fault = None;
        match source.scene() {
            Ok(scene) => {
                self.physics.send(Command::Open(Box::new(scene), source.folder.clone()));
                self.pending = Some(Pending::Scene(source));
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Opens the folder of a finished run.
    pub fn open_run(&mut self, folder: PathBuf) {
        self.fault = None;
        self.physics.send(Command::OpenRun(folder.clone()));
        self.pending = Some(Pending::Run(folder));
    }

    /// The newest snapshot of the open scene.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        self.open.as_ref()?.snapshot.clone()
    }

    /// Last value of a gauge, by its name as in files.
    pub fn gauge(&self, name: &str) -> Option<f64> {
        let snapshot = self.snapshot()?;
        let at = snapshot.measures.names.iter().position(|gauge| gauge == name)?;
        snapshot.measures.gauges.get(at).copied()
    }

    /// True where the picture has full quality: without a GPU it is simple in motion.
    pub fn is_complete(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.picture.is_complete())
    }

    /// True where a scene or run is open.
    pub fn has_scene(&self) -> bool {
        self.open.is_some()
    }

    /// True while a scene or run is being opened.
    pub fn is_waiting(&self) -> bool {
        self.pending.is_some()
    }

    /// How the user moved the camera.
    pub fn camera_offset(&self) -> Option<CameraOffset> {
        Some(self.open.as_ref()?.picture.camera_offset)
    }

    /// What takes the steps and why, as text; none without a scene that is computed.
    pub fn computed_on(&self) -> Option<&str> {
        self.open.as_ref()?.computed_on.as_deref()
    }

    /// The length of the ruler in the picture, m; none where it is put away.
    pub fn ruler_length(&self) -> Option<f64> {
        self.open.as_ref()?.instruments.ruler.as_ref()?.length()
    }

    /// The time that the stopwatch shows, s; none where it is put away.
    pub fn stopwatch_time(&self) -> Option<f64> {
        let open = self.open.as_ref()?;
        Some(open.instruments.stopwatch.as_ref()?.time(open.snapshot.as_ref()?))
    }

    /// The last error, if any.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Shows an error until the user closes it.
    pub fn show_error(&mut self, what: String) {
        self.fault = Some(what);
    }

    /// Shows a notice for a while.
    pub fn notify(&mut self, what: String) {
        self.notice = Some((what, Instant::now()));
    }

    /// Shows the picture alone, as within another page.
    pub fn embed(&mut self, embedded: Embedded) {
        self.embedded = Some(embedded);
        self.panels = Panels { scenes: false, parameters: false, plots: false };
    }

    /// The link to the scene as it is shown, with its changes ([`crate::link`]); none for a run, or a scene that is not built in.
    pub fn link(&self) -> Option<String> {
        let open = self.open.as_ref().filter(|open| !open.recorded)?;
        link::to(&open.source, open.parameters.changes())
    }

    /// Plays or pauses the scene.
    pub fn play(&mut self, playing: bool) {
        if let Some(open) = &mut self.open {
            open.playing = playing;
            self.physics.send(if playing { Command::Play } else { Command::Pause });
        }
    }

    fn take(&mut self, opened: Opened) {
        let Some(pending) = self.pending.take() else { return };
        let plots = Plots::new(&opened);
        let Opened { number, scene, pictures, scenery, end, computed_on, .. } = opened;
        let terrain = scenery.shared_terrain();
        let mut picture = match Picture::open(self.screen.as_ref(), pictures, scenery) {
            Ok(picture) => picture,
            Err(error) => {
                self.fault = Some(error.to_string());
                return;
            }
        };
        let recorded = matches!(pending, Pending::Run(_));
        let source = match pending {
            Pending::Scene(source) => source,
            // The scene opened before is dropped.
            Pending::Dropped(_) => {
                self.pending = Some(pending);
                return;
            }
            Pending::Run(folder) => Source {
                name: folder.display().to_string(),
                text: scene.to_toml().unwrap_or_default(),
                folder,
                changes: Vec::new(),
            },
        };
        self.free_dropped(&source);
        let before = self.open.take();
        let (mut times, mut instruments) = (self.speed, Instruments::default());
        if let Some(before) = before.filter(|before| before.source.name == source.name) {
            // A scene restarted with changes keeps its camera and its ruler; the stopwatch begins again.
            instruments = before.instruments;
            instruments.stopwatch = instruments.stopwatch.map(|_| Stopwatch::default());
            (picture.camera_offset, picture.quality) = (before.picture.camera_offset, before.picture.quality);
            times = before.times;
        }
        self.physics.send(Command::Pace(times * default_pace(end)));
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
            instruments,
            gas_controls: GasControls::default(),
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

    /// Fits the panels to the width of the window.
    fn fit(&mut self, ui: &Ui) {
        let is_narrow = ui.max_rect().width() < NARROW;
        if is_narrow && !self.is_narrow {
            self.panels = Panels { scenes: false, parameters: false, plots: self.embedded.is_none() };
        }
        self.is_narrow = is_narrow;
    }

    /// Shows the whole window.
    pub fn ui(&mut self, ui: &mut Ui) {
        self.take_dropped(ui.ctx());
        self.fit(ui);
        self.listen();
        self.keys(ui);
        let pictures = self.clock.tick();
        // Not while the user moves the camera: it would be drawn twice.
        if let Some(open) = &mut self.open
            && let Some(snapshot) = open.snapshot.clone().filter(|snapshot| snapshot.playing)
            && !ui.input(|input| input.pointer.any_down())
        {
            open.picture.draw_ahead(&snapshot, ui.visuals());
        }
        if self.open.is_none() && self.pending.is_none() {
            return self.first_page(ui);
        }
        let strip = Frame::new().inner_margin(Margin::symmetric(12, 6));
        let has_strip = self.embedded.is_none_or(|embedded| embedded.has_strip);
        let mut show_strip =
            || Panel::bottom("strip").frame(strip).exact_size(52.0).show(ui, |ui| self.strip(ui, pictures)).inner;
        let pressed = has_strip.then(&mut show_strip).flatten();
        if self.embedded.is_none() {
            let bar = Frame::new().inner_margin(Margin::symmetric(10, 5));
            Panel::top("bar").frame(bar).exact_size(44.0).show(ui, |ui| ui.horizontal_centered(|ui| self.toolbar(ui)));
        }
        self.scenes(ui);
        self.parameters(ui);
        self.plots(ui);
        egui::CentralPanel::default().frame(Frame::new()).show(ui, |ui| self.middle(ui));
        if let Some(pressed) = pressed {
            self.press(pressed);
        }
        if self.help {
            self.help = !help::list(ui.ctx());
        }
    }
}
