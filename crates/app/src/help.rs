//! The sheet of keys.

use egui::{Context, Grid, Modal, RichText};

/// What keys and the pointer do.
const ROWS: [(&str, &str); 16] = [
    ("Space", "play and pause"),
    ("Right arrow", "one step"),
    ("R", "restart, with the parameters as they are set"),
    ("F, or double click", "show all again"),
    ("T", "from above and back (not for flat gases)"),
    ("1, 2, 3", "quality: automatic, simple, full"),
    ("S", "save a still, as large as films are"),
    ("V", "record a film of what goes on, and end it"),
    ("G", "scenes"),
    ("P", "parameters"),
    ("L", "plots"),
    ("Drag", "turn; shift a flat picture"),
    ("Drag with the right button, or Shift", "shift"),
    ("Wheel", "nearer and farther"),
    ("Click", "pick a particle or a spot of ground, see its values, follow its way; Esc to end"),
    ("F1 or ?", "this sheet"),
];

/// Shows the sheet; true where it is to be put away.
pub fn sheet(context: &Context) -> bool {
    let modal = Modal::new(egui::Id::unique("help")).show(context, |ui| {
        ui.set_width(520.0);
        ui.label(RichText::new("Keys and pointer").heading());
        ui.add_space(8.0);
        Grid::new("keys").num_columns(2).spacing([24.0, 7.0]).show(ui, |ui| {
            for (key, what) in ROWS {
                ui.label(RichText::new(key).text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
                ui.label(what);
                ui.end_row();
            }
        });
        ui.add_space(10.0);
        ui.button("Close").clicked()
    });
    modal.inner || modal.should_close()
}
