//! What is in the window.

use crate::gallery::Gallery;
use crate::help;
use crate::icons::{self, Icon};
use crate::overlay::Over;
use crate::parameters::{Changed, Parameters};
use crate::physics::{Command, Event, Opened, Physics, Snapshot, default_pace};
use crate::pick::Picked;
use crate::picture::{Picture, Quality};
use crate::plots::Plots;
use crate::touch::{self, Touched};
use crate::transport::{Pressed, Transport};
use crate::{Screen, files, style};
use corpuscle::scene::{Builtin, Scene, SceneError, Units};
use egui::{Context, Frame, Key, Margin, Panel, RichText, ScrollArea, Ui, vec2};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the window begins with.
#[derive(Debug, Clone)]
pub enum Start {
    /// The first page.
    Welcome,
    /// A scene.
    Scene(Source),
    /// The folder of a finished run.
    Run(PathBuf),
}

/// A scene as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// What it is called: `gas/maxwell`, or its file.
    pub name: String,
    /// Its text.
    pub text: String,
    /// The folder that its relative paths start from.
    pub folder: PathBuf,
    /// What was changed in it: paths of values, and the values.
    pub changes: Vec<(String, String)>,
}

impl Source {
    /// The scene with its changes.
    ///
    /// # Errors
    /// Where the text or a change is refused.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let written = Scene::parse(&self.text, &self.name, &[])?;
        if self.changes.is_empty() {
            return Ok(written);
        }
        // What has a default is written out, so that every value has its place.
        let mut whole = written;
        whole.resolve_defaults();
        Scene::parse(&whole.to_toml()?, &self.name, &self.changes)
    }
}

impl From<Builtin> for Source {
    fn from(scene: Builtin) -> Self {
        Self { name: scene.name.into(), text: scene.text.into(), folder: PathBuf::from("."), changes: Vec::new() }
    }
}

/// The window and all that it shows.
pub struct Window {
    screen: Screen,
    physics: Physics,
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
}

/// What is to be opened.
enum Awaited {
    Scene(Source),
    Run(PathBuf),
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

/// The scene that is open.
struct Open {
    number: u64,
    source: Source,
    /// True for a finished run.
    recorded: bool,
    /// Where it ends, s.
    end: f64,
    scene: Scene,
    picture: Picture,
    parameters: Parameters,
    plots: Plots,
    picked: Option<Picked>,
    /// True once the partition of a gas is gone.
    lifted: bool,
    snapshot: Option<Arc<Snapshot>>,
    playing: bool,
    /// The pace, as a multiple of the scene's own.
    times: f64,
}

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
    /// A window that begins so.
    ///
    /// # Errors
    /// Where the system gives no thread for the physics.
    pub fn new(context: &Context, screen: Screen, start: Start) -> std::io::Result<Self> {
        style::set_up(context);
        let wake = context.clone();
        let physics = Physics::start(&screen.gpu, Arc::new(move || wake.request_repaint()))?;
        let mut window = Self {
            screen,
            physics,
            gallery: Gallery::new(),
            panels: Panels { scenes: true, parameters: true, plots: true },
            help: false,
            notice: None,
            awaited: None,
            open: None,
            fault: None,
            clock: PictureClock::default(),
        };
        match start {
            Start::Welcome => {}
            Start::Scene(source) => window.open(source),
            Start::Run(folder) => window.open_run(folder),
        }
        Ok(window)
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

    /// Takes what the physics told.
    fn listen(&mut self) {
        for event in self.physics.events() {
            match event {
                Event::Opened(opened) => self.take(*opened),
                Event::Refused(what) => {
                    self.awaited = None;
                    self.fault = Some(what);
                }
                Event::NotChanged(what) => self.fault = Some(what),
                Event::Ended => self.stopped(),
                Event::Fault(what) => {
                    self.fault = Some(what);
                    self.stopped();
                }
            }
        }
        let newest = self.physics.newest();
        if let (Some(open), Some(newest)) = (&mut self.open, newest)
            && newest.number == open.number
        {
            open.plots.take(&newest);
            if let Some(picked) = &mut open.picked {
                picked.follow(&newest.frame);
            }
            open.snapshot = Some(newest);
        }
    }

    fn stopped(&mut self) {
        if let Some(open) = &mut self.open {
            open.playing = false;
        }
    }

    fn take(&mut self, opened: Opened) {
        let Some(awaited) = self.awaited.take() else { return };
        let plots = Plots::new(&opened);
        let Opened { number, scene, pictures, end, .. } = opened;
        let recorded = matches!(awaited, Awaited::Run(_));
        let source = match awaited {
            Awaited::Scene(source) => source,
            Awaited::Run(folder) => Source {
                name: folder.display().to_string(),
                text: scene.to_toml().unwrap_or_default(),
                folder,
                changes: Vec::new(),
            },
        };
        let before = self.open.take();
        let mut picture = Picture::new(self.screen.clone(), pictures);
        let mut times = 1.0;
        if let Some(before) = before.filter(|before| before.source.name == source.name) {
            // Who changes a scene wants to see it from where it was seen.
            (picture.hand, picture.quality) = (before.picture.hand, before.picture.quality);
            times = before.times;
        }
        self.physics.ask(Command::Pace(times * default_pace(end)));
        self.open = Some(Open {
            number,
            parameters: parameters(&source),
            plots,
            picked: None,
            lifted: false,
            source,
            recorded,
            end,
            scene,
            picture,
            snapshot: None,
            playing: false,
            times,
        });
        self.play(true);
    }

    /// Shows everything.
    pub fn ui(&mut self, ui: &mut Ui) {
        self.listen();
        self.keys(ui);
        let pictures = self.clock.tick();
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

    fn first_page(&mut self, ui: &mut Ui) {
        let ground = Frame::new().inner_margin(Margin::symmetric(48, 0));
        let mut chosen = None;
        egui::CentralPanel::default().frame(ground).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.add_space(40.0);
                ui.label(RichText::new("Corpuscle").heading().size(30.0));
                ui.label(RichText::new("Particle physics to look at and to touch while it runs.").size(15.0).weak());
                ui.add_space(6.0);
                self.told_fault(ui);
                // Beside the bar that scrolls.
                ui.set_max_width(ui.available_width() - 16.0);
                chosen = self.gallery.cards(ui);
                ui.add_space(40.0);
            });
        });
        if let Some(scene) = chosen {
            self.open(scene.into());
        }
    }

    fn strip(&mut self, ui: &mut Ui, pictures: f64) -> Option<Pressed> {
        let open = self.open.as_ref()?;
        let snapshot = open.snapshot.as_deref();
        let Open { scene, end, recorded, playing, times, .. } = open;
        Transport { scene, end: *end, recorded: *recorded, snapshot, playing: *playing, times: *times, pictures }.ui(ui)
    }

    fn parameters(&mut self, ui: &mut Ui) {
        let Some(open) = self.open.as_mut().filter(|open| self.panels.parameters && !open.recorded) else { return };
        let frame = Frame::new().inner_margin(Margin::symmetric(14, 8));
        let panel = Panel::right("parameters").frame(frame).default_size(286.0).size_range(230.0..=420.0);
        let (mut restart, mut save) = (false, false);
        panel.show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let waiting = open.parameters.waiting(ui);
                restart = matches!(waiting, Some(Changed::Restart));
                if let Some(gas) = open.scene.gas() {
                    match touch::ui(ui, gas, open.lifted) {
                        Some(Touched::Heated(change)) => {
                            open.plots.forget_speeds();
                            self.physics.ask(Command::Change(change));
                        }
                        Some(Touched::Lifted(change)) => {
                            open.lifted = true;
                            open.picture.lift_partition(open.snapshot.as_ref().map_or(0.0, |now| now.frame.time));
                            self.physics.ask(Command::Change(change));
                        }
                        None => {}
                    }
                }
                for changed in open.parameters.ui(ui) {
                    match changed {
                        Changed::Live(change) => self.physics.ask(Command::Change(change)),
                        Changed::Restart => restart = true,
                    }
                }
                ui.add_space(14.0);
                save = ui.button("Save the scene as changed").clicked();
                ui.add_space(10.0);
            });
        });
        if restart {
            self.press(Pressed::Restart);
        }
        if save {
            self.save_scene();
        }
    }

    fn plots(&mut self, ui: &mut Ui) {
        let Some(open) = self.open.as_mut().filter(|_| self.panels.plots) else { return };
        let Some(snapshot) = open.snapshot.clone() else { return };
        let frame = Frame::new().inner_margin(Margin::symmetric(12, 8));
        let panel = Panel::bottom("plots").frame(frame).resizable(true).default_size(214.0).size_range(140.0..=480.0);
        let table = panel.show(ui, |ui| open.plots.ui(ui, &snapshot)).inner;
        if let Some((name, text)) = table {
            let name = format!("{}-{name}", open.source.name);
            let done = files::text(&PathBuf::from("."), &name, "csv", &text).map_err(|error| error.to_string());
            self.wrote(done);
        }
    }

    /// Says where something was written, or why not.
    fn wrote(&mut self, done: Result<PathBuf, String>) {
        match done {
            Ok(path) => self.notice = Some((format!("Saved as {}", path.display()), Instant::now())),
            Err(error) => self.fault = Some(format!("It could not be saved: {error}")),
        }
    }

    fn save_scene(&mut self) {
        let Some(open) = &self.open else { return };
        let changes = open.parameters.changes().to_vec();
        let changed = Source { changes, ..open.source.clone() }.scene();
        let text = changed.map_err(|error| error.to_string()).and_then(|mut scene| {
            scene.resolve_paths(&open.source.folder);
            scene.to_toml().map_err(|error| error.to_string())
        });
        let name = format!("{}-changed", open.source.name.trim_end_matches(".toml"));
        let done = text
            .and_then(|text| files::text(&PathBuf::from("."), &name, "toml", &text).map_err(|error| error.to_string()));
        self.wrote(done);
    }

    fn save_still(&mut self) {
        let Some(open) = &mut self.open else { return };
        let Some(snapshot) = open.snapshot.clone() else { return };
        let still = open.picture.still(&snapshot);
        let done = still.and_then(|image| files::picture(&PathBuf::from("."), &open.source.name, &image));
        self.wrote(done.map_err(|error| error.to_string()));
    }

    fn scenes(&mut self, ui: &mut Ui) {
        if !self.panels.scenes {
            return;
        }
        let name = self.open.as_ref().map_or("", |open| &open.source.name).to_owned();
        let frame = Frame::new().inner_margin(Margin::symmetric(8, 8));
        let panel = Panel::left("scenes").frame(frame).default_size(232.0).size_range(180.0..=360.0);
        let chosen = panel.show(ui, |ui| self.gallery.list(ui, &name)).inner;
        if let Some(scene) = chosen {
            self.open(scene.into());
        }
    }

    fn middle(&mut self, ui: &mut Ui) {
        let whole = ui.max_rect();
        if let Some(open) = &mut self.open
            && let Some(snapshot) = open.snapshot.clone()
        {
            let response = open.picture.ui(ui, &snapshot, open.playing);
            open.pick(ui, &response, &snapshot);
        }
        let inside = whole.shrink2(vec2(16.0, 12.0));
        let mut over = ui.new_child(egui::UiBuilder::new().max_rect(inside));
        if self.awaited.is_some() {
            over.horizontal(|ui| {
                ui.spinner();
                ui.label("Setting the scene up");
            });
        }
        self.told_fault(&mut over);
        if let Some((notice, _)) = self.notice.as_ref().filter(|(_, since)| since.elapsed() < NOTICE) {
            Frame::new()
                .fill(over.visuals().window_fill)
                .corner_radius(8)
                .inner_margin(Margin::symmetric(12, 8))
                .show(&mut over, |ui| ui.label(notice));
            ui.ctx().request_repaint_after(NOTICE);
        }
        if let Some(open) = &mut self.open
            && let (Some(picked), Some(snapshot)) = (&open.picked, &open.snapshot)
            && picked.card(&mut over, &snapshot.frame, open.scene.gas().is_none_or(|gas| gas.units == Units::Si))
        {
            open.picked = None;
        }
    }

    fn toolbar(&mut self, ui: &mut Ui) {
        let panels = &mut self.panels;
        if icons::toggle(ui, Icon::Gallery, "Scenes", "G", panels.scenes).clicked() {
            panels.scenes = !panels.scenes;
        }
        let (mut still, mut help) = (false, false);
        if let Some(open) = &mut self.open {
            ui.label(RichText::new(&open.scene.title).heading()).on_hover_text(open.scene.description.trim());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                help = icons::button(ui, Icon::Help, "Help", "F1").clicked();
                if !open.recorded && icons::toggle(ui, Icon::Sliders, "Parameters", "P", panels.parameters).clicked() {
                    panels.parameters = !panels.parameters;
                }
                if icons::toggle(ui, Icon::Plot, "Plots", "L", panels.plots).clicked() {
                    panels.plots = !panels.plots;
                }
                ui.separator();
                still = icons::button(ui, Icon::Still, "Save a still", "S").clicked();
                if !open.is_flat() && icons::toggle(ui, Icon::Plan, "From above", "T", open.picture.hand.plan).clicked()
                {
                    open.picture.hand.plan = !open.picture.hand.plan;
                }
                if icons::button(ui, Icon::Frame, "Show all", "F").clicked() {
                    open.picture.reset();
                }
                open.quality(ui);
            });
        }
        if still {
            self.save_still();
        }
        self.help |= help;
    }

    /// What went wrong, until it is put away.
    fn told_fault(&mut self, ui: &mut Ui) {
        let Some(fault) = &self.fault else { return };
        let mut away = false;
        Frame::new()
            .fill(ui.visuals().window_fill)
            .stroke(egui::Stroke::new(1.0, ui.visuals().error_fg_color))
            .corner_radius(8)
            .inner_margin(Margin::symmetric(12, 8))
            .show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    away = icons::sized(ui, Icon::Close, "Put the message away", "", 22.0, false).clicked();
                    ui.add(egui::Label::new(fault).wrap());
                });
            });
        if away {
            self.fault = None;
        }
    }

    fn keys(&mut self, ui: &Ui) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = |key: Key| ui.input(|input| input.key_pressed(key) && input.modifiers.is_none());
        let keys = [(Key::Space, Pressed::Play), (Key::ArrowRight, Pressed::Step), (Key::R, Pressed::Restart)];
        for (key, what) in keys {
            if pressed(key) {
                self.press(what);
            }
        }
        if pressed(Key::G) {
            self.panels.scenes = !self.panels.scenes;
        }
        if pressed(Key::P) {
            self.panels.parameters = !self.panels.parameters;
        }
        if pressed(Key::L) {
            self.panels.plots = !self.panels.plots;
        }
        if pressed(Key::S) {
            self.save_still();
        }
        let asks = ui.input(|input| input.key_pressed(Key::F1) || input.key_pressed(Key::Questionmark));
        self.help |= asks;
        let Some(open) = &mut self.open else { return };
        if pressed(Key::F) {
            open.picture.reset();
        }
        if pressed(Key::T) && !open.is_flat() {
            open.picture.hand.plan = !open.picture.hand.plan;
        }
        if pressed(Key::Escape) {
            open.picked = None;
        }
        for (key, (quality, ..)) in [Key::Num1, Key::Num2, Key::Num3].into_iter().zip(QUALITIES) {
            if pressed(key) {
                open.picture.quality = quality;
            }
        }
    }

    fn press(&mut self, pressed: Pressed) {
        let Some(open) = &mut self.open else { return };
        match pressed {
            Pressed::Play => {
                let playing = !open.playing;
                self.play(playing);
            }
            Pressed::Step => {
                open.playing = false;
                self.physics.ask(Command::Step(open.times * default_pace(open.end) / 30.0));
            }
            Pressed::Restart if open.recorded => self.physics.ask(Command::Seek(0.0)),
            Pressed::Restart => {
                let changes = open.parameters.changes().to_vec();
                let source = Source { changes, ..open.source.clone() };
                self.open(source);
            }
            Pressed::Seek(time) => self.physics.ask(Command::Seek(time)),
            Pressed::Pace(times) => {
                open.times = times;
                self.physics.ask(Command::Pace(times * default_pace(open.end)));
            }
        }
    }
}

/// Looks: how they are called, and what they mean.
const QUALITIES: [(Quality, &str, &str); 3] = [
    (
        Quality::Auto,
        "By itself",
        "Full on a graphics card; without one full where it stands still, simple where it moves",
    ),
    (Quality::Simple, "Simple", "Without shadows, water as its particles: quick"),
    (Quality::Full, "Full", "Shadows, and water that looks like water: slow without a graphics card"),
];

/// The parameters of a scene as it is written.
fn parameters(source: &Source) -> Parameters {
    let written = Scene::parse(&source.text, &source.name, &[]);
    written.map_or_else(|_| Parameters::none(), |written| Parameters::new(&written, source.changes.clone()))
}

impl Open {
    /// True for a gas in the plane.
    fn is_flat(&self) -> bool {
        self.scene.gas().is_some_and(|gas| gas.dimensions() == 2)
    }

    fn quality(&mut self, ui: &mut Ui) {
        let now =
            QUALITIES.iter().find(|(quality, ..)| *quality == self.picture.quality).map_or("", |(_, name, _)| *name);
        let combo = egui::ComboBox::from_id_salt("look").selected_text(format!("Look: {}", now.to_lowercase()));
        let shown = combo.show_ui(ui, |ui| {
            for (quality, name, hint) in QUALITIES {
                ui.selectable_value(&mut self.picture.quality, quality, name).on_hover_text(hint);
            }
        });
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "Look"));
    }

    /// Picks what was clicked on, and draws what is picked.
    fn pick(&mut self, ui: &Ui, response: &egui::Response, snapshot: &Snapshot) {
        let Some(shown) = self.picture.shown() else { return };
        if response.clicked()
            && let Some(pointer) = response.interact_pointer_pos()
        {
            self.picked = Picked::at(shown, response.rect, &snapshot.frame, pointer);
            if let Some(picked) = &mut self.picked {
                picked.follow(&snapshot.frame);
            }
        }
        if let Some(picked) = &self.picked {
            let painter = ui.painter_at(response.rect);
            let over = Over { shown, rect: response.rect, painter: &painter, dark: ui.visuals().dark_mode };
            picked.paint(&over, &snapshot.frame, (shown.stage.to - shown.stage.from).max_element());
        }
    }
}
