//! The scenes that come with the program, each with a picture and a sentence.

use crate::style::STRONG;
use corpuscle::scene::{Builtin, Scene, kinds, scenes};
use egui::text::LayoutJob;
use egui::{
    Color32, ColorImage, CornerRadius, FontFamily, FontId, Galley, Rect, Response, RichText, Role, ScrollArea, Sense,
    TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use std::sync::Arc;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;

/// Size of a picture in the list, points.
const SMALL: Vec2 = vec2(72.0, 44.0);

/// A scene in the gallery.
pub struct Entry {
    /// The built-in scene.
    pub scene: Builtin,
    /// Its title.
    pub title: String,
    /// The first sentence of its description.
    pub sentence: String,
    texture: Option<TextureHandle>,
}

/// The scenes.
pub struct Gallery {
    entries: Vec<Entry>,
    /// The scene that the list was last scrolled to.
    scrolled_to: String,
}

/// The models that have scenes: names in files, and headings in the list.
fn models() -> impl Iterator<Item = (&'static str, String)> {
    kinds().into_iter().filter(|kind| !kind.scenes.is_empty()).map(|kind| {
        let (first, rest) = kind.name.split_at(1);
        (kind.name, first.to_uppercase() + rest)
    })
}

impl Gallery {
    /// All scenes.
    pub fn new() -> Self {
        let entry = |scene: Builtin| {
            let read = Scene::parse(scene.text, scene.name, &[]);
            let (title, description) = read.map_or_else(|_| Default::default(), |read| (read.title, read.description));
            Entry { scene, title, sentence: first_sentence(&description), texture: None }
        };
        Self { entries: scenes().map(entry).collect(), scrolled_to: String::new() }
    }

    /// The scenes of a model.
    fn of<'a>(&'a mut self, model: &'a str) -> impl Iterator<Item = &'a mut Entry> {
        self.entries.iter_mut().filter(move |entry| entry.scene.name.split('/').next() == Some(model))
    }

    /// Shows the list at the side; returns the scene chosen.
    pub fn list(&mut self, ui: &mut Ui, open: &str) -> Option<Builtin> {
        let mut chosen = None;
        let is_new = self.scrolled_to != open;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (model, name) in models() {
                ui.add_space(6.0);
                ui.label(RichText::new(name).small().weak());
                for entry in self.of(model) {
                    let row = entry.row(ui, entry.scene.name == open);
                    if is_new && entry.scene.name == open {
                        row.scroll_to_me(None);
                    }
                    if row.clicked() {
                        chosen = Some(entry.scene);
                    }
                }
            }
            ui.add_space(10.0);
        });
        if is_new {
            open.clone_into(&mut self.scrolled_to);
        }
        chosen
    }

    /// Shows the cards of the first page; returns the scene chosen.
    pub fn cards(&mut self, ui: &mut Ui) -> Option<Builtin> {
        let mut chosen = None;
        let gap = 14.0;
        let columns = ((ui.available_width() + gap) / (216.0 + gap)).floor().clamp(1.0, 6.0);
        let width = (ui.available_width() - gap * (columns - 1.0)) / columns;
        for (model, name) in models() {
            ui.add_space(18.0);
            ui.label(RichText::new(name).text_style(egui::TextStyle::Name(STRONG.into())).size(15.0));
            ui.add_space(4.0);
            let mut entries: Vec<_> = self.of(model).collect();
            for row in entries.chunks_mut(columns as usize) {
                ui.horizontal_top(|ui| {
                    ui.spacing_mut().item_spacing.x = gap;
                    for entry in row {
                        if entry.card(ui, width).clicked() {
                            chosen = Some(entry.scene);
                        }
                    }
                });
                ui.add_space(gap - 7.0);
            }
        }
        chosen
    }
}

impl Entry {
    fn texture(&mut self, ui: &Ui) -> &TextureHandle {
        self.texture.get_or_insert_with(|| {
            let image = picture(self.scene.name).unwrap_or_else(|| ColorImage::filled([1, 1], Color32::GRAY));
            ui.ctx().load_texture(self.scene.name, image, TextureOptions::LINEAR)
        })
    }

    /// One row of the list.
    fn row(&mut self, ui: &mut Ui, open: bool) -> Response {
        let size = vec2(ui.available_width(), SMALL.y + 12.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, open, &self.title));
        if ui.is_rect_visible(rect) {
            self.background(ui, rect, &response, open);
            let image = Rect::from_min_size(rect.min + Vec2::splat(6.0), SMALL);
            let id = self.texture(ui).id();
            rounded(ui, image, id, 5);
            let text = Rect::from_min_max(pos2(image.right() + 10.0, rect.top()), rect.max - vec2(6.0, 0.0));
            let words = lines(ui, &self.title, FontId::proportional(13.0), ui.visuals().text_color(), text.width(), 2);
            ui.painter().galley(pos2(text.left(), text.center().y - 0.5 * words.size().y), words, Color32::PLACEHOLDER);
        }
        response.on_hover_text(&self.sentence)
    }

    /// One card of the first page.
    fn card(&mut self, ui: &mut Ui, width: f32) -> Response {
        let tall = width * 132.0 / 216.0;
        let (rect, response) = ui.allocate_exact_size(vec2(width, tall + 84.0), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &self.title));
        if ui.is_rect_visible(rect) {
            self.background(ui, rect, &response, false);
            let image = Rect::from_min_size(rect.min, vec2(width, tall));
            let id = self.texture(ui).id();
            rounded(ui, image, id, 9);
            let text = Rect::from_min_max(image.left_bottom() + vec2(10.0, 8.0), rect.max - vec2(10.0, 4.0));
            let (strong, plain) = (FontId::new(13.5, FontFamily::Name(STRONG.into())), FontId::proportional(12.0));
            let title = lines(ui, &self.title, strong, ui.visuals().text_color(), text.width(), 1);
            let below = text.min + vec2(0.0, title.size().y + 3.0);
            let sentence = lines(ui, &self.sentence, plain, ui.visuals().weak_text_color(), text.width(), 3);
            ui.painter().galley(text.min, title, Color32::PLACEHOLDER);
            ui.painter().galley(below, sentence, Color32::PLACEHOLDER);
        }
        response
    }

    fn background(&self, ui: &Ui, rect: Rect, response: &Response, open: bool) {
        let visuals = ui.visuals();
        let background = if open {
            visuals.selection.bg_fill.gamma_multiply(0.18)
        } else if response.hovered() || response.has_focus() {
            visuals.widgets.inactive.bg_fill
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(rect, CornerRadius::same(9), background);
    }
}

/// Lays out a text in lines of a width, so many at most.
fn lines(ui: &Ui, words: &str, font: FontId, colour: Color32, width: f32, most: usize) -> Arc<Galley> {
    let mut job = LayoutJob::simple(words.into(), font, colour, width);
    job.wrap.max_rows = most;
    ui.painter().layout_job(job)
}

/// An image with round corners.
fn rounded(ui: &Ui, rect: Rect, texture: egui::TextureId, radius: u8) {
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let shape = egui::epaint::RectShape::filled(rect, CornerRadius::same(radius), Color32::WHITE);
    ui.painter().add(shape.with_texture(texture, whole));
}

/// Up to the first full stop, on one line.
fn first_sentence(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let end = line.match_indices(". ").map(|(at, _)| at).find(|at| !line[..*at].ends_with("e.g"));
    end.map_or(line.clone(), |at| line[..=at].to_owned())
}

macro_rules! pictures {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_bytes!(concat!("../gallery/", $name, ".jpg")))),*]
    };
}

/// The pictures of the guide's gallery, at a small size.
const PICTURES: &[(&str, &[u8])] = pictures![
    "flood-valley",
    "flood-rough-terrain",
    "flood-cuboid",
    "flood-cylinder",
    "flood-cloudburst",
    "flood-dam-break",
    "flood-lake-at-rest",
    "flood-city",
    "flood-iowa-river",
    "flood-chishui",
    "gas-maxwell",
    "gas-paper-2000",
    "gas-piston",
    "gas-mixing",
    "gas-brownian",
    "gas-free-expansion",
    "gas-granular",
    "gas-effusion",
    "gas-atmosphere",
    "gas-argon",
    "gas-million",
    "dew-pane",
    "dew-lens",
    "dew-windscreen",
    "dew-glassware",
    "dew-three-boundaries",
    "dew-breath",
];

/// The picture of a built-in scene.
fn picture(name: &str) -> Option<ColorImage> {
    let file = name.replace('/', "-");
    let (_, bytes) = PICTURES.iter().find(|(known, _)| *known == file)?;
    let mut decoder = JpegDecoder::new(ZCursor::new(bytes));
    let pixels = decoder.decode().ok()?;
    let (width, height) = decoder.dimensions()?;
    Some(ColorImage::from_rgb([width, height], &pixels))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_picture_a_title_and_a_sentence() {
        for entry in Gallery::new().entries {
            assert!(picture(entry.scene.name).is_some_and(|image| image.size == [216, 132]), "{}", entry.scene.name);
            assert!(!entry.title.is_empty() && entry.sentence.len() > 20, "{}", entry.scene.name);
        }
    }

    #[test]
    fn a_sentence_ends_at_its_full_stop() {
        assert_eq!(first_sentence("\nAir at 20.5 °C comes\nin. Then it rains."), "Air at 20.5 °C comes in.");
    }
}
