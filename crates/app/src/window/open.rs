//! The scene that is open.

use crate::Source;
use crate::gas_controls::GasControls;
use crate::icons::{self, Icon};
use crate::instruments::Instruments;
use crate::overlay::Over;
use crate::parameters::Parameters;
use crate::pick::Picked;
use crate::picture::{Picture, QualitySetting};
use crate::plots::Plots;
use crate::snapshot::Snapshot;
use crate::spot::Spot;
use corpuscle::model::Frame;
use corpuscle::models;
use corpuscle::scene::Scene;
use corpuscle::terrain::Terrain;
use corpuscle_drawing::text;
use egui::{Pos2, Rect, Ui};
use std::sync::Arc;

/// The scene that is open.
pub(super) struct Open {
    pub(super) number: u64,
    pub(super) source: Source,
    /// True for a finished run.
    pub(super) recorded: bool,
    /// End time, s.
    pub(super) end: f64,
    pub(super) scene: Scene,
    pub(super) picture: Picture,
    pub(super) parameters: Parameters,
    pub(super) plots: Plots,
    pub(super) picked: Option<Picked>,
    /// Position of the last click and the particles known then, until newer particles have come from the GPU.
    pub(super) clicked: Option<(Pos2, Arc<Frame>)>,
    /// The terrain.
    pub(super) terrain: Option<Arc<Terrain>>,
    pub(super) spot: Option<Spot>,
    /// The position at which the physics samples the water.
    pub(super) probed: Option<[f64; 2]>,
    /// Ruler and stopwatch.
    pub(super) instruments: Instruments,
    /// State of the controls of a gas.
    pub(super) gas_controls: GasControls,
    /// The backend, and why it was chosen.
    pub(super) computed_on: Option<String>,
    /// True while a film is recorded.
    pub(super) filming: bool,
    pub(super) snapshot: Option<Arc<Snapshot>>,
    pub(super) playing: bool,
    /// The pace, as a multiple of the default pace of the scene.
    pub(super) times: f64,
}

/// Settings of the quality, with their names and explanations.
pub(super) const QUALITIES: [(QualitySetting, &str, &str); 3] = [
    (QualitySetting::Auto, "Automatic", "Full with a GPU; without one full at rest, simple in motion"),
    (QualitySetting::Simple, "Simple", "Without shadows, water as particles: fast"),
    (QualitySetting::Full, "Full", "With shadows and realistic water: slow without a GPU"),
];

/// The parameters of a scene as it is written.
pub(super) fn parameters(source: &Source) -> Parameters {
    match (Scene::parse(&source.text, &source.name, &[]), source.scene()) {
        (Ok(written), Ok(now)) => Parameters::new(&written, &now, source.changes.clone()),
        _ => Parameters::none(),
    }
}

impl Open {
    /// True for a gas in the plane.
    pub(super) fn is_flat(&self) -> bool {
        self.scene.gas().is_some_and(|gas| gas.dimensions() == 2)
    }

    /// Quality, view from above, and the whole scene, for the toolbar.
    pub(super) fn toolbar_camera(&mut self, ui: &mut Ui) {
        self.toolbar_view(ui);
        if !self.picture.is_sketch() {
            self.quality(ui);
        }
    }

    /// View from above, and the whole scene.
    pub(super) fn toolbar_view(&mut self, ui: &mut Ui) {
        let is_flat = self.is_flat();
        let offset = &mut self.picture.camera_offset;
        if !is_flat && icons::toggle(ui, Icon::Plan, "From above", "T", offset.plan).clicked() {
            offset.plan = !offset.plan;
        }
        if icons::button(ui, Icon::Frame, "Show all", "F").clicked() {
            self.picture.reset();
        }
    }

    /// The qualities of the picture, for a menu.
    pub(super) fn qualities(&mut self, ui: &mut Ui) {
        if self.picture.is_sketch() {
            return;
        }
        ui.label("Quality");
        for (quality, name, hint) in QUALITIES {
            ui.selectable_value(&mut self.picture.quality, quality, name).on_hover_text(hint);
        }
    }

    /// Ruler and stopwatch, for the toolbar.
    pub(super) fn toolbar_instruments(&mut self, ui: &mut Ui) {
        if icons::toggle(ui, Icon::Ruler, "Ruler", "M", self.instruments.ruler.is_some()).clicked() {
            self.instruments.toggle_ruler();
        }
        if icons::toggle(ui, Icon::Stopwatch, "Stopwatch", "W", self.instruments.stopwatch.is_some()).clicked() {
            self.instruments.toggle_stopwatch();
        }
    }

    /// True where quantities have SI units.
    pub(super) fn has_units(&self) -> bool {
        models::of(&self.scene).is_ok_and(|kind| kind.has_si_units(&self.scene))
    }

    /// Shows the ruler in the picture that fills a rectangle. Its ends lie on the ground of a flood, elsewhere in a plane that faces the camera.
    pub(super) fn measure(&mut self, ui: &Ui, rect: Rect) {
        let unit = if self.has_units() { "m" } else { "" };
        let (Some(ruler), Some(shown)) = (&mut self.instruments.ruler, self.picture.shown()) else { return };
        let painter = ui.painter_at(rect);
        let over = Over { shown, rect, painter: &painter, dark: ui.visuals().dark_mode };
        let below = |at: Pos2| match &self.terrain {
            // Beside the terrain the nearest of its positions is taken.
            Some(terrain) => Spot::at(shown, rect, terrain, at)
                .or_else(|| Some(Spot::within(terrain, self.picture.below(rect, at)?)))
                .map(|spot| spot.position()),
            None => self.picture.below(rect, at),
        };
        ruler.ui(ui, &over, &below, unit);
    }

    /// Shows the card of the stopwatch, where it is taken.
    pub(super) fn stopwatch_card(&mut self, ui: &mut Ui) {
        let has_units = self.has_units();
        let words = |time: f64| match has_units {
            true if time == 0.0 || time >= 0.1 => format!("{} s", text::number(time)),
            true => text::any_time(time),
            false => text::number(time),
        };
        let (Some(watch), Some(snapshot)) = (&mut self.instruments.stopwatch, &self.snapshot) else { return };
        if watch.card(ui, snapshot, &words) {
            self.instruments.stopwatch = None;
        }
    }

    fn quality(&mut self, ui: &mut Ui) {
        let now =
            QUALITIES.iter().find(|(quality, ..)| *quality == self.picture.quality).map_or("", |(_, name, _)| *name);
        let combo = egui::ComboBox::from_id_salt("quality").selected_text(format!("Quality: {}", now.to_lowercase()));
        let shown = combo.show_ui(ui, |ui| {
            for (quality, name, hint) in QUALITIES {
                ui.selectable_value(&mut self.picture.quality, quality, name).on_hover_text(hint);
            }
        });
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "Quality"));
    }

    /// Picks the particle or position that was clicked, and marks it.
    pub(super) fn pick(&mut self, ui: &Ui, response: &egui::Response, snapshot: &Snapshot) {
        if response.clicked() {
            self.clicked = response.interact_pointer_pos().map(|at| (at, snapshot.known.clone()));
        }
        // The known particles may be older than the picture: a click waits for newer ones.
        let newer = |(_, before): &(Pos2, Arc<Frame>)| {
            snapshot.known.time == snapshot.frame.time || !Arc::ptr_eq(before, &snapshot.known)
        };
        if let Some((pointer, _)) = self.clicked.take_if(|clicked| newer(clicked)) {
            self.pick_at(pointer, response.rect, &snapshot.known);
        }
        let Some(shown) = self.picture.shown() else { return };
        let painter = ui.painter_at(response.rect);
        let over = Over { shown, rect: response.rect, painter: &painter, dark: ui.visuals().dark_mode };
        if let Some(spot) = &self.spot {
            spot.paint(&over);
        }
        if let Some(picked) = &self.picked {
            picked.paint(&over, &snapshot.known, (shown.stage.to - shown.stage.from).max_element());
        }
    }

    fn pick_at(&mut self, pointer: Pos2, rect: Rect, known: &Frame) {
        let Some(shown) = self.picture.shown() else { return };
        self.picked = Picked::at(shown, rect, known, pointer);
        let position = self.picked.as_ref().and_then(|picked| picked.position(known));
        self.spot = self.terrain.as_ref().and_then(|terrain| match position {
            // A click on water picks the position on the bed below it.
            Some(position) => Some(Spot::under(terrain, position)),
            None => Spot::at(shown, rect, terrain, pointer),
        });
        if let Some(picked) = &mut self.picked {
            picked.follow(known);
        }
    }
}
