//! A picked position on the terrain: its bed elevation, the water there, and a gauge.

use crate::icons::{self, Icon};
use crate::overlay::{self, Over};
use corpuscle::Sample;
use corpuscle::pictures::Shown;
use corpuscle::terrain::Terrain;
use corpuscle_drawing::text::number;
use egui::{Color32, Frame, Grid, Pos2, Rect, RichText, Stroke, Ui, vec2};

/// Positions per side of the first search over the terrain, and of each refinement.
const COARSE_STEPS: u32 = 160;
const FINE_STEPS: u32 = 12;
/// Refinements of the search, each over the neighbourhood of the best position so far.
const REFINEMENTS: u32 = 4;
const COLOUR: Color32 = Color32::from_rgb(0xf5, 0x9e, 0x0b);

/// A picked position on the terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Position and bed elevation in model coordinates, m.
    position: [f64; 3],
    /// True once there is a gauge.
    pub gauged: bool,
}

/// An action of the card of a spot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpotAction {
    /// Close the card.
    Close,
    /// Place a gauge there.
    PlaceGauge,
}

impl Spot {
    /// The spot at a position in the window; none where there is no terrain.
    pub fn at(shown: &Shown, rect: Rect, terrain: &Terrain, pointer: Pos2) -> Option<Self> {
        let bounds = terrain.bounds();
        let [width, height] = bounds.size();
        let mut range = [[bounds.x_min, bounds.x_max], [bounds.y_min, bounds.y_max]];
        let mut position = nearest(shown, rect, terrain, pointer, range, COARSE_STEPS)?;
        let mut step = [width, height].map(|side| side / f64::from(COARSE_STEPS));
        for _ in 0..REFINEMENTS {
            range = [0, 1].map(|axis| [position[axis] - step[axis], position[axis] + step[axis]]);
            position = nearest(shown, rect, terrain, pointer, range, FINE_STEPS)?;
            step = step.map(|step| 2.0 * step / f64::from(FINE_STEPS));
        }
        let seen = overlay::position(shown, rect, position)?;
        let inside = bounds.contains(position[0], position[1]);
        ((seen - pointer).length() < 3.0 && inside).then_some(Self { position, gauged: false })
    }

    /// The spot below a position.
    pub fn under(terrain: &Terrain, [x, y, _]: [f64; 3]) -> Self {
        Self { position: [x, y, terrain.height(x, y)], gauged: false }
    }

    /// The spot of the terrain that is nearest to a position.
    pub fn within(terrain: &Terrain, [x, y, z]: [f64; 3]) -> Self {
        let bounds = terrain.bounds();
        Self::under(terrain, [x.clamp(bounds.x_min, bounds.x_max), y.clamp(bounds.y_min, bounds.y_max), z])
    }

    /// Position and bed elevation, in model coordinates, m.
    pub fn position(&self) -> [f64; 3] {
        self.position
    }

    /// Where it is, in model coordinates, m.
    pub fn at_model(&self) -> [f64; 2] {
        [self.position[0], self.position[1]]
    }

    /// Draws a cross over it.
    pub fn paint(&self, over: &Over<'_>) {
        let Some(at) = over.position(self.position) else { return };
        for arm in [vec2(8.0, 0.0), vec2(0.0, 8.0)] {
            over.painter.line_segment([at - arm, at + arm], Stroke::new(2.2, COLOUR));
        }
    }

    /// Shows the card with its values; returns the action chosen.
    pub fn card(&self, ui: &mut Ui, terrain: &Terrain, water: Option<Sample>, live: bool) -> Option<SpotAction> {
        let mut action = None;
        Frame::new().fill(ui.visuals().window_fill.gamma_multiply(0.94)).corner_radius(8).inner_margin(10).show(
            ui,
            |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new("Terrain").color(COLOUR).strong());
                    if icons::sized(ui, Icon::Close, "Close the position", "Esc", 20.0, false).clicked() {
                        action = Some(SpotAction::Close);
                    }
                });
                Grid::new("spot").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
                    let mut row = |name: &str, value: String| {
                        ui.label(RichText::new(name).small().weak());
                        ui.label(RichText::new(value).small());
                        ui.end_row();
                    };
                    let own = terrain.to_own(self.at_model());
                    row("position", own.map(number).join(",  "));
                    row("bed elevation", format!("{} m", number(self.position[2])));
                    if let Some(water) = water {
                        row("depth", format!("{} m", number(water.depth)));
                        row("level", format!("{} m", number(self.position[2] + water.depth)));
                        row("velocity", format!("{} m/s", water.velocity.map(at_rest).map(number).join(",  ")));
                        row("speed", format!("{} m/s", number(at_rest(water.speed()))));
                    }
                });
                let name = if self.gauged { "There is a gauge here" } else { "Place a gauge here" };
                let hint = "Records from now on; it appears in the plots and is saved with the scene.";
                if live && ui.add_enabled(!self.gauged, egui::Button::new(name)).on_hover_text(hint).clicked() {
                    action = Some(SpotAction::PlaceGauge);
                }
            },
        );
        action
    }
}

/// Velocities below this are shown as 0, m/s: rounding.
const REST: f64 = 1e-6;

fn at_rest(velocity: f64) -> f64 {
    if velocity.abs() < REST { 0.0 } else { velocity }
}

/// The position on a part of the terrain that appears nearest to the pointer; of those equally near the one nearest to the camera.
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
            let position = [x, y, terrain.height(x, y)];
            let Some(seen) = overlay::position(shown, rect, position) else { continue };
            let far = (0..3).map(|axis| (position[axis] - eye[axis]).powi(2)).sum::<f64>();
            all.push(((seen - pointer).length(), far, position));
        }
    }
    let closest = all.iter().map(|(off, ..)| *off).fold(f32::INFINITY, f32::min);
    // A position behind a ridge may appear as near; the one in front is picked.
    let beside = all.iter().filter(|(off, ..)| *off <= 1.5 * closest + 0.5);
    beside.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(.., position)| *position)
}
