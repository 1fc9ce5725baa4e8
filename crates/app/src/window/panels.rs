//! The panels: first page, toolbar, scenes, picture, and the strip below it.

use super::open::Open;
use super::{NOTICE, SHEET, Window};
use crate::icons::{self, Icon};
use crate::physics::{Change, Command};
use crate::spot::SpotAction;
use crate::transport::{self, Pressed, Transport};
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Align, Frame, Layout, Margin, Panel, PopupCloseBehavior, RichText, ScrollArea, Ui, vec2};

impl Window {
    pub(super) fn first_page(&mut self, ui: &mut Ui) {
        let ground = Frame::new().inner_margin(Margin::symmetric(if self.is_narrow { 16 } else { 48 }, 0));
        let mut chosen = None;
        egui::CentralPanel::default().frame(ground).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.add_space(40.0);
                ui.label(RichText::new("Corpuscle").heading().size(30.0));
                ui.label(
                    RichText::new("Particle physics: watch a scene and change it while it runs.").size(15.0).weak(),
                );
                ui.add_space(6.0);
                self.open_button(ui);
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
        let is_narrow = self.is_narrow;
        Transport { scene, end: *end, recorded, snapshot, playing, times: *times, pictures, computed_on, is_narrow }
            .ui(ui)
    }

    pub(super) fn scenes(&mut self, ui: &mut Ui) {
        if !self.panels.scenes {
            return;
        }
        let name = self.open.as_ref().map_or("", |open| &open.source.name).to_owned();
        let panel = match self.is_narrow {
            true => Self::sheet(ui),
            false => Panel::left("scenes").default_size(232.0).size_range(180.0..=360.0),
        };
        let panel = panel.frame(Frame::new().inner_margin(Margin::symmetric(8, 8)));
        let chosen = panel.show(ui, |ui| self.gallery.list(ui, &name)).inner;
        if let Some(scene) = chosen {
            self.open(scene.into());
            self.panels.scenes &= !self.is_narrow;
        }
    }

    /// The panel below the picture of a narrow window.
    pub(super) fn sheet(ui: &Ui) -> Panel {
        Panel::bottom("sheet").exact_size((SHEET * ui.ctx().content_rect().height()).round())
    }

    pub(super) fn middle(&mut self, ui: &mut Ui) {
        let whole = ui.max_rect();
        if let Some(open) = &mut self.open
            && let Some(snapshot) = open.snapshot.clone()
        {
            let response = open.picture.ui(ui, &snapshot, open.playing, &self.offscreen);
            self.physics.see(open.picture.view_state());
            open.pick(ui, &response, &snapshot);
            open.measure(ui, response.rect);
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
            && picked.card(&mut over, &snapshot.known, open.has_units())
        {
            open.picked = None;
        }
        self.spot_card(&mut over);
        if let Some(open) = &mut self.open {
            open.stopwatch_card(&mut over);
        }
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
                self.physics.send(Command::Change(Change::Gauge { name, at }));
            }
            None => {}
        }
    }

    pub(super) fn toolbar(&mut self, ui: &mut Ui) {
        let is_narrow = self.is_narrow;
        if icons::toggle(ui, Icon::Gallery, "Scenes", "G", self.panels.scenes).clicked() {
            self.panels.toggle(|panels| &mut panels.scenes, is_narrow);
        }
        // From the right, so that the title has what is left.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if is_narrow {
                self.more(ui);
            }
            self.toolbar_panels(ui);
            if !is_narrow {
                ui.separator();
                self.open_button(ui);
                self.toolbar_film(ui);
            }
            let draws = self.open.as_ref().is_some_and(|open| !open.picture.is_sketch());
            if draws && icons::button(ui, Icon::Still, "Save a still", "S").clicked() {
                self.save_still();
            }
            let Some(open) = &mut self.open else { return };
            if !is_narrow {
                open.toolbar_camera(ui);
                open.toolbar_instruments(ui);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let title = egui::Label::new(RichText::new(&open.scene.title).heading()).truncate();
                ui.add(title).on_hover_text(open.scene.description.trim());
            });
        });
    }

    /// The menu of what a narrow window has no room for.
    fn more(&mut self, ui: &mut Ui) {
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("More").config(config).ui(ui, |ui| {
            self.open_button(ui);
            let mut times = None;
            if let Some(open) = &mut self.open {
                times = transport::speed(ui, open.times);
                ui.horizontal(|ui| {
                    open.toolbar_view(ui);
                    open.toolbar_instruments(ui);
                });
                open.qualities(ui);
            }
            if let Some(times) = times {
                self.press(Pressed::Pace(times));
            }
            if ui.button("Help").clicked() {
                self.help = true;
                ui.close();
            }
        });
    }

    /// Help, parameters and plots.
    fn toolbar_panels(&mut self, ui: &mut Ui) {
        if !self.is_narrow {
            self.help |= icons::button(ui, Icon::Help, "Help", "F1").clicked();
        }
        let has_parameters = self.open.as_ref().is_some_and(|open| !open.recorded);
        if has_parameters && icons::toggle(ui, Icon::Sliders, "Parameters", "P", self.panels.parameters).clicked() {
            self.panels.toggle(|panels| &mut panels.parameters, self.is_narrow);
        }
        if icons::toggle(ui, Icon::Plot, "Plots", "L", self.panels.plots).clicked() {
            self.panels.toggle(|panels| &mut panels.plots, self.is_narrow);
        }
    }

    fn toolbar_film(&mut self, ui: &mut Ui) {
        let Some(filming) = self.open.as_ref().map(|open| open.filming).filter(|_| cfg!(feature = "film")) else {
            return;
        };
        let name = if filming { "End the film" } else { "Record a film" };
        if icons::toggle(ui, Icon::Film, name, "V", filming).clicked() {
            self.film();
        }
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
