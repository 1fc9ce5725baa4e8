//! The panels: first page, toolbar, scenes, picture, and the strip below it.

use super::open::Open;
use super::{NOTICE, Window};
use crate::icons::{self, Icon};
use crate::physics::{Change, Command};
use crate::spot::SpotAction;
use crate::transport::{Pressed, Transport};
use corpuscle::models;
use egui::{Frame, Margin, Panel, RichText, ScrollArea, Ui, vec2};

impl Window {
    pub(super) fn first_page(&mut self, ui: &mut Ui) {
        let ground = Frame::new().inner_margin(Margin::symmetric(48, 0));
        let mut chosen = None;
        egui::CentralPanel::default().frame(ground).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.add_space(40.0);
                ui.label(RichText::new("Corpuscle").heading().size(30.0));
                ui.label(
                    RichText::new("Particle physics: watch a scene and change it while it runs.").size(15.0).weak(),
                );
                ui.add_space(6.0);
                self.show_fault(ui);
                // Leave room for the scroll bar.
                ui.set_max_width(ui.available_width() - 16.0);
                chosen = self.gallery.cards(ui);
                ui.add_space(40.0);
            });
        });
        if let Some(scene) = chosen {
            self.open(scene.into());
        }
    }

    pub(super) fn strip(&mut self, ui: &mut Ui, pictures: f64) -> Option<Pressed> {
        let open = self.open.as_ref()?;
        let snapshot = open.snapshot.as_deref();
        let Open { scene, end, recorded, playing, times, computed_on, .. } = open;
        let computed_on = computed_on.as_deref();
        let [recorded, playing] = [*recorded, *playing];
        Transport { scene, end: *end, recorded, snapshot, playing, times: *times, pictures, computed_on }.ui(ui)
    }

    pub(super) fn scenes(&mut self, ui: &mut Ui) {
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

    pub(super) fn middle(&mut self, ui: &mut Ui) {
        let whole = ui.max_rect();
        if let Some(open) = &mut self.open
            && let Some(snapshot) = open.snapshot.clone()
        {
            let response = open.picture.ui(ui, &snapshot, open.playing, &self.offscreen);
            self.physics.see(open.picture.view_state());
            open.pick(ui, &response, &snapshot);
            let spot = open.spot.map(|spot| spot.at_model());
            // A key, or its card, may have closed it.
            if spot != open.probed {
                open.probed = spot;
                self.physics.send(Command::Probe(spot));
            }
        }
        let mut inside = whole.shrink2(vec2(16.0, 12.0));
        // Cards lie below the key of colours.
        inside.min.y += self.open.as_ref().map_or(0.0, |open| open.picture.key_height());
        let mut over = ui.new_child(egui::UiBuilder::new().max_rect(inside));
        if self.pending.is_some() {
            over.horizontal(|ui| {
                ui.spinner();
                ui.label("Setting up the scene");
            });
        }
        self.show_fault(&mut over);
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
            && picked.card(
                &mut over,
                &snapshot.known,
                models::of(&open.scene).is_ok_and(|kind| kind.has_si_units(&open.scene)),
            )
        {
            open.picked = None;
        }
        self.spot_card(&mut over);
    }

    /// The card of the picked position on the terrain.
    fn spot_card(&mut self, ui: &mut Ui) {
        let Some(open) = &mut self.open else { return };
        let (Some(spot), Some(terrain)) = (&mut open.spot, &open.terrain) else { return };
        let water = open.snapshot.as_ref().and_then(|snapshot| snapshot.probed);
        match spot.card(ui, terrain, water, !open.recorded) {
            Some(SpotAction::Close) => open.spot = None,
            Some(SpotAction::PlaceGauge) => {
                spot.gauged = true;
                let at = spot.at_model();
                let name = open.parameters.add_gauge(terrain.to_own(at));
                let place: Change = Box::new(move |simulation| simulation.place_gauge(&name, at));
                self.physics.send(Command::Change(place));
            }
            None => {}
        }
    }

    pub(super) fn toolbar(&mut self, ui: &mut Ui) {
        let panels = &mut self.panels;
        if icons::toggle(ui, Icon::Gallery, "Scenes", "G", panels.scenes).clicked() {
            panels.scenes = !panels.scenes;
        }
        let (mut still, mut film, mut help) = (false, false, false);
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
                let name = if open.filming { "End the film" } else { "Record a film" };
                film = icons::toggle(ui, Icon::Film, name, "V", open.filming).clicked();
                still = icons::button(ui, Icon::Still, "Save a still", "S").clicked();
                if !open.is_flat()
                    && icons::toggle(ui, Icon::Plan, "From above", "T", open.picture.camera_offset.plan).clicked()
                {
                    open.picture.camera_offset.plan = !open.picture.camera_offset.plan;
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
        if film {
            self.film();
        }
        self.help |= help;
    }

    /// Shows the last error until it is closed.
    pub(super) fn show_fault(&mut self, ui: &mut Ui) {
        let Some(fault) = &self.fault else { return };
        let mut away = false;
        Frame::new()
            .fill(ui.visuals().window_fill)
            .stroke(egui::Stroke::new(1.0, ui.visuals().error_fg_color))
            .corner_radius(8)
            .inner_margin(Margin::symmetric(12, 8))
            .show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    away = icons::sized(ui, Icon::Close, "Close the message", "", 22.0, false).clicked();
                    ui.add(egui::Label::new(fault).wrap());
                });
            });
        if away {
            self.fault = None;
        }
    }
}
