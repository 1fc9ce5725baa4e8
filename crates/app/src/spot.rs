//! A spot of the ground that was picked: its height, the water there, and a gauge.

use crate::icons::{self, Icon};
use crate::overlay::{self, Over};
use corpuscle::Sample;
use corpuscle::pictures::Shown;
use corpuscle::terrain::Terrain;
use corpuscle_drawing::text::number;
use egui::{Color32, Frame, Grid, Pos2, Rect, RichText, Stroke, Ui, vec2};

/// Places along each side of the ground that are looked at, and of each finer look.
const COARSE: u32 = 160;
const FINE: u32 = 12;
/// Finer looks: each is over the neighbourhood of the best place so far.
const LOOKS: u32 = 4;
const COLOUR: Color32 = Color32::from_rgb(0xf5, 0x9e, 0x0b);

/// A spot of the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Place and height in model coordinates, m.
    place: [f64; 3],
    /// True once there is a gauge.
    pub gauged: bool,
}

/// What is to be done with a spot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// It is to be put away.
    Away,
    /// A gauge is to be placed there.
    Gauge,
}

impl Spot {
    /// The spot under a place in the window; none where there is no ground.
    pub fn at(shown: &Shown, rect: Rect, terrain: &Terrain, pointer: Pos2) -> Option<Self> {
        let bounds = terrain.bounds();
        let [width, height] = bounds.size();
        let mut range = [[bounds.x_min, bounds.x_max], [bounds.y_min, bounds.y_max]];
        let mut place = nearest(shown, rect, terrain, pointer, range, COARSE)?;
        let mut step = [width, height].map(|side| side / f64::from(COARSE));
        for _ in 0..LOOKS {
            range = [0, 1].map(|axis| [place[axis] - step[axis], place[axis] + step[axis]]);
            place = nearest(shown, rect, terrain, pointer, range, FINE)?;
            step = step.map(|step| 2.0 * step / f64::from(FINE));
        }
        let seen = overlay::place(shown, rect, place)?;
        let inside = bounds.contains(place[0], place[1]);
        ((seen - pointer).length() < 3.0 && inside).then_some(Self { place, gauged: false })
    }

    /// The spot under a place.
    pub fn under(terrain: &Terrain, [x, y, _]: [f64; 3]) -> Self {
        Self { place: [x, y, terrain.height(x, y)], gauged: false }
    }

    /// Where it is, in model coordinates, m.
    pub fn at_model(&self) -> [f64; 2] {
        [self.place[0], self.place[1]]
    }

    /// Draws a cross over it.
    pub fn paint(&self, over: &Over<'_>) {
        let Some(at) = over.place(self.place) else { return };
        for arm in [vec2(8.0, 0.0), vec2(0.0, 8.0)] {
            over.painter.line_segment([at - arm, at + arm], Stroke::new(2.2, COLOUR));
        }
    }

    /// The card with its values; gives what is to be done.
    pub fn card(&self, ui: &mut Ui, terrain: &Terrain, water: Option<Sample>, live: bool) -> Option<Asked> {
        let mut asked = None;
        Frame::new().fill(ui.visuals().window_fill.gamma_multiply(0.94)).corner_radius(8).inner_margin(10).show(
            ui,
            |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new("Ground").color(COLOUR).strong());
                    if icons::sized(ui, Icon::Close, "Put the spot away", "Esc", 20.0, false).clicked() {
                        asked = Some(Asked::Away);
                    }
                });
                Grid::new("spot").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
                    let mut row = |name: &str, value: String| {
                        ui.label(RichText::new(name).small().weak());
                        ui.label(RichText::new(value).small());
                        ui.end_row();
                    };
                    let own = terrain.to_own(self.at_model());
                    row("place", own.map(number).join(",  "));
                    row("height", format!("{} m", number(self.place[2])));
                    if let Some(water) = water {
                        row("depth", format!("{} m", number(water.depth)));
                        row("level", format!("{} m", number(self.place[2] + water.depth)));
                        row("velocity", format!("{} m/s", water.velocity.map(at_rest).map(number).join(",  ")));
                        row("speed", format!("{} m/s", number(at_rest(water.speed()))));
                    }
                });
                let name = if self.gauged { "There is a gauge here" } else { "Place a gauge here" };
                let hint = "It measures from now on, is among the plots, and is saved with the scene.";
                if live && ui.add_enabled(!self.gauged, egui::Button::new(name)).on_hover_text(hint).clicked() {
                    asked = Some(Asked::Gauge);
                }
            },
        );
        asked
    }
}

/// Slower than this is rounding, m/s.
const REST: f64 = 1e-6;

fn at_rest(velocity: f64) -> f64 {
    if velocity.abs() < REST { 0.0 } else { velocity }
}

/// Of places over a part of the ground the one that is seen nearest to the pointer, of those next to it the nearest to the eye.
fn nearest(
    shown: &Shown,
    rect: Rect,
    terrain: &Terrain,
    pointer: Pos2,
    range: [[f64; 2]; 2],
    steps: u32,
) -> Option<[f64; 3]> {
    let eye: [f64; 3] = shown.camera.eye.into();
    let at = |axis: usize, step: u32| {
        range[axis][0] + (range[axis][1] - range[axis][0]) * f64::from(step) / f64::from(steps)
    };
    let mut all = Vec::new();
    for row in 0..=steps {
        for column in 0..=steps {
            let [x, y] = [at(0, column), at(1, row)];
            let place = [x, y, terrain.height(x, y)];
            let Some(seen) = overlay::place(shown, rect, place) else { continue };
            let far = (0..3).map(|axis| (place[axis] - eye[axis]).powi(2)).sum::<f64>();
            all.push(((seen - pointer).length(), far, place));
        }
    }
    let closest = all.iter().map(|(off, ..)| *off).fold(f32::INFINITY, f32::min);
    // Behind a ridge another place is seen as near; what is in front is meant.
    let beside = all.iter().filter(|(off, ..)| *off <= 1.5 * closest + 0.5);
    beside.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(.., place)| *place)
}
