//! What a hand does to a gas while it goes on.

use crate::physics::Change;
use corpuscle::GasByHand as ByHand;
use corpuscle::scene::Gas;
use egui::{Button, RichText, Ui};

/// How many times its energy a gas has after it was heated once.
const WARMER: f64 = 1.15;

/// What was done.
pub enum Touched {
    /// It was heated or cooled.
    Heated(Change),
    /// The partition was lifted.
    Lifted(Change),
}

/// Buttons for a gas; `lifted` is true once its partition is gone.
pub fn ui(ui: &mut Ui, gas: &Gas, lifted: bool) -> Option<Touched> {
    let mut touched = None;
    ui.add_space(8.0);
    ui.label(RichText::new("By hand").text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
    ui.horizontal(|ui| {
        let wide = 0.5 * (ui.available_width() - 8.0);
        let heat = |factor: f64| Touched::Heated(by_hand(ByHand::Heat(factor)));
        let hint = "All velocities shrink: 13 % less energy. What is taken away is booked as outflow of energy.";
        if ui.add_sized([wide, 28.0], Button::new("Cool")).on_hover_text(hint).clicked() {
            touched = Some(heat(1.0 / WARMER));
        }
        let hint = "All velocities grow: 15 % more energy. What is given is booked as inflow of energy.";
        if ui.add_sized([wide, 28.0], Button::new("Heat")).on_hover_text(hint).clicked() {
            touched = Some(heat(WARMER));
        }
    });
    if gas.partition.is_some() {
        ui.add_enabled_ui(!lifted, |ui| {
            let wide = [ui.available_width(), 28.0];
            let name = if lifted { "The partition is lifted" } else { "Lift the partition" };
            if ui.add_sized(wide, Button::new(name)).clicked() {
                touched = Some(Touched::Lifted(by_hand(ByHand::LiftPartition)));
            }
        });
    }
    touched
}

fn by_hand(change: ByHand) -> Change {
    Box::new(move |simulation| simulation.change_by_hand(change))
}
