//! The scene that is open.

use super::Source;
use crate::overlay::Over;
use crate::parameters::Parameters;
use crate::pick::Picked;
use crate::picture::{Picture, QualitySetting};
use crate::plots::Plots;
use crate::snapshot::Snapshot;
use crate::spot::Spot;
use crate::touch::Hands;
use corpuscle::model::Frame;
use corpuscle::scene::Scene;
use corpuscle::terrain::Terrain;
use egui::{Pos2, Rect, Ui};
use std::sync::Arc;

/// The scene that is open.
pub(super) struct Open {
    pub(super) number: u64,
    pub(super) source: Source,
    /// True for a finished run.
    pub(super) recorded: bool,
    /// Where it ends, s.
    pub(super) end: f64,
    pub(super) scene: Scene,
    pub(super) picture: Picture,
    pub(super) parameters: Parameters,
    pub(super) plots: Plots,
    pub(super) picked: Option<Picked>,
    /// Where the picture was clicked on, and the particles that were known then, until it is known what is there.
    pub(super) clicked: Option<(Pos2, Arc<Frame>)>,
    /// The ground, and the spot of it that was picked.
    pub(super) terrain: Option<Arc<Terrain>>,
    pub(super) spot: Option<Spot>,
    /// The place that the physics was asked to tell of.
    pub(super) probed: Option<[f64; 2]>,
    /// What hands hold of a gas.
    pub(super) hands: Hands,
    /// Where it is computed, and why there.
    pub(super) computed_on: Option<String>,
    /// True while a film is made.
    pub(super) filming: bool,
    pub(super) snapshot: Option<Arc<Snapshot>>,
    pub(super) playing: bool,
    /// The pace, as a multiple of the scene's own.
    pub(super) times: f64,
}

/// Looks: how they are called, and what they mean.
pub(super) const QUALITIES: [(QualitySetting, &str, &str); 3] = [
    (QualitySetting::Auto, "Automatic", "Full on a GPU; without one full where it stands still, simple where it moves"),
    (QualitySetting::Simple, "Simple", "Without shadows, water as its particles: quick"),
    (QualitySetting::Full, "Full", "Shadows, and water that looks like water: slow without a GPU"),
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

    pub(super) fn quality(&mut self, ui: &mut Ui) {
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

    /// Picks what was clicked on, and draws what is picked.
    pub(super) fn pick(&mut self, ui: &Ui, response: &egui::Response, snapshot: &Snapshot) {
        if response.clicked() {
            self.clicked = response.interact_pointer_pos().map(|at| (at, snapshot.known.clone()));
        }
        // Where particles were is not where they are: a click waits until they come.
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
        let place = self.picked.as_ref().and_then(|picked| picked.place(known));
        self.spot = self.terrain.as_ref().and_then(|terrain| match place {
            // Who clicks on water means the place below it.
            Some(place) => Some(Spot::under(terrain, place)),
            None => Spot::at(shown, rect, terrain, pointer),
        });
        if let Some(picked) = &mut self.picked {
            picked.follow(known);
        }
    }
}
