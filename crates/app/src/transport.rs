//! The strip below the picture: play, pause, step, restart, pace, time bar and rates.

use crate::icons::{self, Icon};
use crate::snapshot::Snapshot;
use corpuscle::models;
use corpuscle::scene::Scene;
use corpuscle_drawing::text;
use egui::{Align, Color32, CornerRadius, Layout, Rect, RichText, Role, Sense, Slider, Ui, WidgetInfo, vec2};

/// Slowest and fastest pace, as multiples of the default pace.
pub(crate) const PACES: [f64; 2] = [0.02, 50.0];

/// An action of the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pressed {
    /// Play or pause.
    Play,
    /// One step.
    Step,
    /// Restart.
    Restart,
    /// A multiple of the default pace.
    Pace(f64),
    /// Another time of a finished run, s.
    Seek(f64),
}

/// The content of the strip.
pub struct Transport<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// End time, s.
    pub end: f64,
    /// True for a finished run, whose time can be chosen.
    pub recorded: bool,
    /// The newest snapshot.
    pub snapshot: Option<&'a Snapshot>,
    /// True while playing.
    pub playing: bool,
    /// The pace, as a multiple of the default pace of the scene.
    pub times: f64,
    /// Pictures in a second.
    pub pictures: f64,
    /// The backend and why it was chosen.
    pub computed_on: Option<&'a str>,
    /// True in a narrow window, which has no room for rates.
    pub is_narrow: bool,
}

impl Transport<'_> {
    /// Shows the strip; returns the action chosen.
    pub fn ui(&self, ui: &mut Ui) -> Option<Pressed> {
        let mut pressed = None;
        ui.horizontal_centered(|ui| {
            let (icon, name) = if self.playing { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
            let mut press = |hit: bool, what: Pressed| {
                if hit {
                    pressed = Some(what);
                }
            };
            press(icons::button(ui, Icon::Restart, "Restart", "R").clicked(), Pressed::Restart);
            press(icons::sized(ui, icon, name, "Space", 36.0, true).clicked(), Pressed::Play);
            press(icons::button(ui, Icon::Step, "One step", "right arrow").clicked(), Pressed::Step);
            if let Some(times) = (!self.is_narrow).then(|| speed(ui, self.times)).flatten() {
                pressed = Some(Pressed::Pace(times));
            }
            ui.add_space(6.0);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if !self.is_narrow {
                    self.numbers(ui);
                }
                if let Some(time) = self.bar(ui) {
                    pressed = Some(Pressed::Seek(time));
                }
            });
        });
        pressed
    }

    fn time(&self, time: f64) -> String {
        let has_units = models::of(self.scene).is_ok_and(|kind| kind.has_si_units(self.scene));
        if has_units { text::any_time(time) } else { text::short_number(time) }
    }

    fn numbers(&self, ui: &mut Ui) {
        let Some(snapshot) = self.snapshot else { return };
        let particles = text::number(snapshot.particles as f64);
        let (called, work) = models::of(self.scene).map_or(("", ""), |kind| (kind.particles(), kind.work()));
        let words = format!("{particles} {called}");
        let count = ui.label(RichText::new(words).small().weak());
        let hint = |response: egui::Response| match self.computed_on {
            Some(computed_on) => response.on_hover_text(computed_on),
            None => response,
        };
        hint(count);
        let rate = if snapshot.playing {
            format!("{:.0} pictures/s  ·  {} {work}/s", self.pictures, text::short_number(snapshot.rate))
        } else {
            String::new()
        };
        let quick = hint(ui.label(RichText::new(rate).small().weak()));
        if snapshot.behind {
            let hint = "This machine cannot compute the scene at this speed: it runs as fast as it can.";
            let mark = ui.label(RichText::new("as fast as it can").small().color(ui.visuals().warn_fg_color));
            mark.union(quick).on_hover_text(hint);
        }
    }

    /// Shows the time bar; returns the time chosen.
    fn bar(&self, ui: &mut Ui) -> Option<f64> {
        let now = self.snapshot.map_or(0.0, |snapshot| snapshot.frame.time);
        let end = self.end.max(now);
        let words = format!("{} / {}", self.time(now), self.time(end));
        ui.label(RichText::new(&words).small());
        let sense = if self.recorded { Sense::click_and_drag() } else { Sense::hover() };
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width().max(20.0), 20.0), sense);
        let kind = if self.recorded { Role::Slider } else { Role::ProgressIndicator };
        response.widget_info(|| WidgetInfo::labeled(kind, true, format!("Time {words}")));
        let part = if end > 0.0 { (now / end) as f32 } else { 0.0 };
        let rail = Rect::from_center_size(rect.center(), vec2(rect.width(), 5.0));
        ui.painter().rect_filled(rail, CornerRadius::same(3), ui.visuals().widgets.inactive.bg_fill);
        let done = rail.with_max_x(rail.left() + part * rail.width());
        ui.painter().rect_filled(done, CornerRadius::same(3), crate::style::accent(ui.visuals()));
        ui.painter().circle_filled(done.right_center(), 6.0, crate::style::accent(ui.visuals()));
        ui.painter().circle_filled(done.right_center(), 2.5, Color32::WHITE);
        let pointer = response.interact_pointer_pos().filter(|_| self.recorded)?;
        Some(f64::from(((pointer.x - rail.left()) / rail.width()).clamp(0.0, 1.0)) * end)
    }
}

/// Shows the slider of the speed, a multiple of the scene's default; returns the multiple chosen.
pub(crate) fn speed(ui: &mut Ui, now: f64) -> Option<f64> {
    ui.add_space(6.0);
    let mut times = now;
    let slider = Slider::new(&mut times, PACES[0]..=PACES[1])
        .logarithmic(true)
        .custom_formatter(|times, _| format!("{} x", text::short_number(times)))
        .custom_parser(|words| words.trim_end_matches(['x', ' ']).parse().ok());
    ui.spacing_mut().slider_width = 90.0;
    let slider = ui.add(slider).on_hover_text("Speed, as a multiple of the scene's default");
    slider.widget_info(|| WidgetInfo::slider(true, times, "Speed"));
    slider.changed().then_some(times)
}
