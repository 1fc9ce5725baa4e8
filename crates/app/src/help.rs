//! The list of keys.

use egui::{Context, Grid, Modal, RichText};

/// The key of films.
const FILM: &str = "V";

/// Keys and pointer actions, each with its effect.
const ROWS: [(&str, &str); 19] = [
    ("Space", "play and pause"),
    ("Right arrow", "one step"),
    ("R", "restart with the parameters as set"),
    ("F, or double click", "show everything"),
    ("T", "view from above, and back (not for two-dimensional gases)"),
    ("1, 2, 3", "quality: automatic, simple, full"),
    ("S", "save a still of 1920 x 1080 pixels"),
    (FILM, "start and end a film"),
    ("G", "scenes"),
    ("P", "parameters"),
    ("L", "plots"),
    ("M", "ruler: drag its ends"),
    ("W", "stopwatch of simulated time"),
    ("Drag", "rotate; pan a two-dimensional gas"),
    ("Drag with the right button, or Shift", "pan"),
    ("Wheel", "zoom"),
    ("Two fingers", "pan and zoom"),
    ("Click", "pick a particle or a position on the terrain, show its values and trajectory; Esc releases it"),
    ("F1 or ?", "this list"),
];

/// Shows the list; true where it was closed.
pub fn list(context: &Context) -> bool {
    let modal = Modal::new(egui::Id::unique("help")).show(context, |ui| {
        ui.set_width(520.0);
        ui.label(RichText::new("Keys and pointer").heading());
        ui.add_space(8.0);
        Grid::new("keys").num_columns(2).spacing([24.0, 7.0]).show(ui, |ui| {
            for (key, what) in ROWS.into_iter().filter(|(key, _)| cfg!(feature = "film") || *key != FILM) {
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
