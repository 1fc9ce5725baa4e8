//! A stopwatch of simulated time. Where a gas counts the collisions of a followed ball, it counts those too.

use crate::icons::{self, Icon};
use crate::snapshot::Snapshot;
use corpuscle_drawing::text::short_number;
use egui::{Frame, Grid, RichText, Ui};

/// How the name of the gauge begins and ends that counts the collisions of a followed ball.
const COLLISIONS: [&str; 2] = ["ball ", ".collisions"];
/// Most laps that are shown.
const LAPS: usize = 8;

/// A state of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Moment {
    /// s.
    time: f64,
    /// When the followed ball's collisions were counted last, s, and how many there were; none where they are not.
    counted: Option<[f64; 2]>,
}

impl Moment {
    fn of(snapshot: &Snapshot) -> Self {
        let measures = &snapshot.measures;
        let [begin, end] = COLLISIONS;
        let at = measures.names.iter().position(|name| name.starts_with(begin) && name.ends_with(end));
        let collisions = at.and_then(|at| measures.gauges.get(at).copied());
        Self { time: snapshot.frame.time, counted: collisions.map(|collisions| [measures.time, collisions]) }
    }

    /// Both added, the other with a sign.
    fn and(self, sign: f64, other: Self) -> Self {
        let counted = self.counted.zip(other.counted);
        let counted = counted.map(|(own, other)| [0, 1].map(|at| own[at] + sign * other[at]));
        Self { time: self.time + sign * other.time, counted }
    }
}

/// A stopwatch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stopwatch {
    /// When it was started last; none while it stands.
    started: Option<Moment>,
    /// What it measured before that.
    before: Option<Moment>,
    /// Times at which a lap was taken, s, the newest last.
    laps: Vec<f64>,
}

impl Stopwatch {
    /// What it shows at a moment.
    fn shown(&self, now: Moment) -> Moment {
        let running = self.started.map(|started| now.and(-1.0, started));
        match (running, self.before) {
            (Some(running), Some(before)) => running.and(1.0, before),
            (one, other) => one.or(other).unwrap_or_else(|| now.and(-1.0, now)),
        }
    }

    /// The time that it shows at a snapshot, s.
    pub fn time(&self, snapshot: &Snapshot) -> f64 {
        self.shown(Moment::of(snapshot)).time
    }

    /// Starts it, or stops it.
    fn press(&mut self, now: Moment) {
        let shown = self.shown(now);
        (self.started, self.before) =
            if self.started.is_some() { (None, Some(shown)) } else { (Some(now), self.before) };
    }

    /// Shows its card; true where it was put away. `time` puts a time into words.
    pub fn card(&mut self, ui: &mut Ui, snapshot: &Snapshot, time: &dyn Fn(f64) -> String) -> bool {
        let now = Moment::of(snapshot);
        let mut away = false;
        let ground = ui.visuals().window_fill.gamma_multiply(0.94);
        Frame::new().fill(ground).corner_radius(8).inner_margin(10).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new("Stopwatch").strong());
                away = icons::sized(ui, Icon::Close, "Put the stopwatch away", "W", 20.0, false).clicked();
            });
            ui.label(RichText::new(time(self.shown(now).time)).heading());
            ui.horizontal(|ui| {
                if ui.button(if self.started.is_some() { "Stop" } else { "Start" }).clicked() {
                    self.press(now);
                }
                if ui.add_enabled(self.started.is_some(), egui::Button::new("Lap")).clicked() {
                    self.laps.push(self.shown(now).time);
                }
                if ui.button("Reset").clicked() {
                    *self = Self::default();
                }
            });
            self.rows(ui, self.shown(now), time);
        });
        away
    }

    /// The laps, and the collisions of the followed ball.
    fn rows(&self, ui: &mut Ui, shown: Moment, time: &dyn Fn(f64) -> String) {
        Grid::new("stopwatch").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
            let mut row = |name: String, value: String| {
                ui.label(RichText::new(name).small().weak());
                ui.label(RichText::new(value).small());
                ui.end_row();
            };
            if let Some([counted, collisions]) = shown.counted {
                row("collisions of the followed ball".into(), short_number(collisions));
                if collisions > 0.0 {
                    row("mean time between them".into(), time(counted / collisions));
                }
            }
            for (at, lap) in self.laps.iter().enumerate().skip(self.laps.len().saturating_sub(LAPS)) {
                let before = if at > 0 { self.laps[at - 1] } else { 0.0 };
                row(format!("lap {}", at + 1), time(lap - before));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: f64, collisions: f64) -> Moment {
        Moment { time, counted: Some([time, collisions]) }
    }

    #[test]
    fn it_adds_up_what_passes_while_it_runs() {
        let mut watch = Stopwatch::default();
        assert_eq!(watch.shown(at(3.0, 7.0)), at(0.0, 0.0));
        watch.press(at(3.0, 7.0));
        assert_eq!(watch.shown(at(4.5, 9.0)), at(1.5, 2.0));
        watch.press(at(5.0, 10.0));
        assert_eq!(watch.shown(at(8.0, 20.0)), at(2.0, 3.0));
        watch.press(at(10.0, 30.0));
        assert_eq!(watch.shown(at(11.0, 31.0)), at(3.0, 4.0));
        // What is not counted is not shown.
        assert_eq!(watch.shown(Moment { time: 11.0, counted: None }).counted, None);
    }
}
