//! Parameters at the right, and plots below.

use super::Window;
use crate::files;
use crate::gas_controls::{self, GasAction};
use crate::parameters::Changed;
use crate::physics::Command;
use crate::transport::Pressed;
use egui::{Frame, Margin, Panel, ScrollArea, Ui};

impl Window {
    pub(super) fn parameters(&mut self, ui: &mut Ui) {
        let Some(open) = self.open.as_mut().filter(|open| self.panels.parameters && !open.recorded) else { return };
        let panel = match self.is_narrow {
            true => Self::sheet(ui),
            false => Panel::right("parameters").default_size(286.0).size_range(230.0..=420.0),
        };
        let panel = panel.frame(Frame::new().inner_margin(Margin::symmetric(14, 8)));
        let (mut restart, mut save) = (false, false);
        panel.show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let waiting = open.parameters.waiting(ui);
                restart = matches!(waiting, Some(Changed::Restart));
                if let Some(gas) = open.scene.gas() {
                    match gas_controls::ui(ui, gas, &mut open.gas_controls, open.snapshot.as_deref()) {
                        Some(GasAction::Heated(change)) => {
                            open.plots.forget_speeds();
                            self.physics.send(Command::Change(change));
                        }
                        Some(GasAction::Lifted(change)) => {
                            open.picture.lift_partition(open.snapshot.as_ref().map_or(0.0, |now| now.frame.time));
                            self.physics.send(Command::Change(change));
                        }
                        Some(GasAction::Changed(change)) => self.physics.send(Command::Change(change)),
                        None => {}
                    }
                }
                for changed in open.parameters.ui(ui, &open.scene) {
                    match changed {
                        Changed::Live(change) => self.physics.send(Command::Change(change)),
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

    pub(super) fn plots(&mut self, ui: &mut Ui) {
        let Some(open) = self.open.as_mut().filter(|_| self.panels.plots) else { return };
        let Some(snapshot) = open.snapshot.clone() else { return };
        let panel = match self.is_narrow {
            true => Self::sheet(ui),
            false => Panel::bottom("plots").resizable(true).default_size(214.0).size_range(140.0..=480.0),
        };
        let panel = panel.frame(Frame::new().inner_margin(Margin::symmetric(12, 8)));
        let table = panel.show(ui, |ui| open.plots.ui(ui, &snapshot)).inner;
        if let Some((name, text)) = table {
            let name = format!("{}-{name}", open.source.name);
            let done = files::text(&self.folder, &name, "csv", &text).map_err(|error| error.to_string());
            self.wrote(done);
        }
    }
}
