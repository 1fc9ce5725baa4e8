//! A picked particle: its values, and its trajectory from then on.

use crate::icons::{self, Icon};
use crate::overlay::{self, Over};
use corpuscle::model::{Frame, ParticleSet, Values};
use corpuscle::pictures::Shown;
use corpuscle_drawing::text::number;
use egui::{Color32, Grid, Pos2, Rect, RichText, Stroke, Ui};

/// Largest distance of a click from a particle, points.
const REACH: f32 = 22.0;
/// Most points of a trajectory; beyond that every other one is dropped.
const MOST: usize = 2000;
const COLOUR: Color32 = Color32::from_rgb(0xe0, 0x3e, 0x8c);

/// A particle that was picked.
#[derive(Debug, Clone, PartialEq)]
pub struct Picked {
    /// Name of its set.
    set: String,
    /// Its id.
    id: u64,
    /// Its trajectory since it was picked.
    trajectory: Vec<[f64; 3]>,
    time: f64,
}

impl Picked {
    /// The particle at a position in the window: of those within reach the nearest to the camera.
    pub fn at(shown: &Shown, rect: Rect, frame: &Frame, pointer: Pos2) -> Option<Self> {
        let eye: [f64; 3] = shown.camera.eye.into();
        let mut best: Option<(f32, f64, Self)> = None;
        for set in &frame.sets {
            for (at, position) in set.position.iter().enumerate() {
                let Some(seen) = overlay::position(shown, rect, *position) else { continue };
                let off = (seen - pointer).length();
                if off > REACH {
                    continue;
                }
                let far = (0..3).map(|k| (position[k] - eye[k]).powi(2)).sum::<f64>();
                // Particles a few points apart are equally near; the one nearest to the camera is picked.
                let step = (off / 4.0).floor();
                if best.as_ref().is_none_or(|(other, away, _)| (step, far) < (*other, *away)) {
                    let picked = Self { set: set.name.clone(), id: set.id[at], trajectory: Vec::new(), time: f64::NAN };
                    best = Some((step, far, picked));
                }
            }
        }
        best.map(|(_, _, picked)| picked)
    }

    fn find<'a>(&self, frame: &'a Frame) -> Option<(&'a ParticleSet, usize)> {
        let set = frame.sets.iter().find(|set| set.name == self.set)?;
        Some((set, set.id.iter().position(|id| *id == self.id)?))
    }

    /// Its set and index in a frame.
    pub fn position(&self, frame: &Frame) -> Option<[f64; 3]> {
        self.find(frame).map(|(set, at)| set.position[at])
    }

    /// Adds the position of the particle in a frame to the trajectory.
    pub fn follow(&mut self, frame: &Frame) {
        let Some((set, at)) = self.find(frame) else { return };
        if frame.time == self.time {
            return;
        }
        if frame.time < self.time {
            self.trajectory.clear();
        }
        self.time = frame.time;
        self.trajectory.push(set.position[at]);
        if self.trajectory.len() > MOST {
            let mut number = 0;
            self.trajectory.retain(|_| {
                number += 1;
                number % 2 == 1
            });
        }
    }

    /// Draws its trajectory and a ring round it.
    pub fn paint(&self, over: &Over<'_>, frame: &Frame, box_size: f64) {
        let Some((set, at)) = self.find(frame) else { return };
        for pair in self.trajectory.windows(2) {
            // A crossing of a periodic side is not drawn across the box.
            let far = (0..3).map(|k| (pair[1][k] - pair[0][k]).abs()).fold(0.0, f64::max);
            if let (Some(from), Some(to)) = (over.position(pair[0]), over.position(pair[1]))
                && far < 0.5 * box_size
            {
                over.painter.line_segment([from, to], Stroke::new(1.8, COLOUR));
            }
        }
        overlay::ring(over, set.position[at], set.radius[at], COLOUR);
    }

    /// Shows the card with its values; true where it was closed.
    pub fn card(&self, ui: &mut Ui, frame: &Frame, units: bool) -> bool {
        let mut away = false;
        let unit = |unit: &'static str| if units { unit } else { "" };
        egui::Frame::new().fill(ui.visuals().window_fill.gamma_multiply(0.94)).corner_radius(8).inner_margin(10).show(
            ui,
            |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(format!("{} {}", self.set, self.id)).color(COLOUR).strong());
                    away = icons::sized(ui, Icon::Close, "Stop following", "Esc", 20.0, false).clicked();
                });
                let Some((set, at)) = self.find(frame) else {
                    ui.label(RichText::new("The particle no longer exists.").weak());
                    return;
                };
                Grid::new("picked").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
                    let mut row = |name: &str, value: String, unit: &str| {
                        ui.label(RichText::new(name).small().weak());
                        ui.label(RichText::new(format!("{value} {unit}")).small());
                        ui.end_row();
                    };
                    let vector = |of: [f64; 3]| of.map(number).join(",  ");
                    let speed = set.velocity[at].iter().map(|along| along * along).sum::<f64>().sqrt();
                    row("position", vector(set.position[at]), unit("m"));
                    row("velocity", vector(set.velocity[at]), unit("m/s"));
                    row("speed", number(speed), unit("m/s"));
                    row("mass", number(set.mass[at]), unit("kg"));
                    // The speed is shown for any particle already.
                    for column in set.columns.iter().filter(|column| column.name != "speed") {
                        let value = match &column.values {
                            Values::Scalar(values) => number(values[at]),
                            Values::Vector(values) => vector(values[at]),
                        };
                        row(&column.name.replace('_', " "), value, unit(column.unit));
                    }
                });
            },
        );
        away
    }
}
