//! The style of the window: fonts, colours, spacing.

use egui::{
    Color32, Context, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Stroke, TextStyle, Theme,
};
use std::sync::Arc;

/// Name of the bold font.
pub const STRONG: &str = "strong";

/// The accent colour, in light and in dark.
const ACCENT: [Color32; 2] = [Color32::from_rgb(0x1a, 0x66, 0xc2), Color32::from_rgb(0x5b, 0xa6, 0xf2)];
/// Backgrounds of panels, of sunken areas, and of controls.
const PANEL: [Color32; 2] = [Color32::from_rgb(0xf6, 0xf7, 0xf9), Color32::from_rgb(0x1c, 0x1f, 0x24)];
const DEEP: [Color32; 2] = [Color32::WHITE, Color32::from_rgb(0x14, 0x16, 0x1a)];
const CONTROL: [Color32; 2] = [Color32::from_rgb(0xe7, 0xea, 0xee), Color32::from_rgb(0x2c, 0x31, 0x38)];
const HOVERED: [Color32; 2] = [Color32::from_rgb(0xdb, 0xe0, 0xe6), Color32::from_rgb(0x39, 0x3f, 0x48)];
const PRESSED: [Color32; 2] = [Color32::from_rgb(0xcb, 0xd2, 0xda), Color32::from_rgb(0x47, 0x4f, 0x5a)];
const LINE: [Color32; 2] = [Color32::from_rgb(0xdc, 0xe0, 0xe5), Color32::from_rgb(0x30, 0x35, 0x3d)];
const TEXT: [Color32; 2] = [Color32::from_rgb(0x22, 0x2a, 0x33), Color32::from_rgb(0xe3, 0xe7, 0xec)];
const QUIET: [Color32; 2] = [Color32::from_rgb(0x5d, 0x68, 0x74), Color32::from_rgb(0x9a, 0xa4, 0xaf)];

/// Sets fonts and both themes; the system chooses the theme.
pub fn set_up(context: &Context) {
    context.set_fonts(fonts());
    // Where the system does not say: light shows better on a wall.
    context.options_mut(|options| options.fallback_theme = Theme::Light);
    for (number, theme) in [Theme::Light, Theme::Dark].into_iter().enumerate() {
        context.style_mut_of(theme, |style| set_theme(style, number));
    }
}

/// The accent colour.
pub fn accent(visuals: &egui::Visuals) -> Color32 {
    visuals.selection.bg_fill
}

/// Background of a drawing: as bytes, and as linear light.
pub fn paper(visuals: &egui::Visuals) -> (Color32, [f32; 3]) {
    let colour = visuals.extreme_bg_color;
    (colour, corpuscle_render::linear([colour.r(), colour.g(), colour.b()]))
}

fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let mut add = |name: &str, data: &'static [u8], families: &[FontFamily]| {
        fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(data)));
        for family in families {
            fonts.families.entry(family.clone()).or_default().push(name.into());
        }
    };
    add("Inter", corpuscle_drawing::fonts::REGULAR, &[FontFamily::Proportional, FontFamily::Monospace]);
    add("Inter SemiBold", corpuscle_drawing::fonts::SEMI_BOLD, &[FontFamily::Name(STRONG.into())]);
    fonts
}

fn set_theme(style: &mut egui::Style, number: usize) {
    let size = |size: f32| FontId::new(size, FontFamily::Proportional);
    let strong = |size: f32| FontId::new(size, FontFamily::Name(STRONG.into()));
    style.text_styles = [
        (TextStyle::Small, size(11.5)),
        (TextStyle::Body, size(13.5)),
        (TextStyle::Monospace, size(13.0)),
        (TextStyle::Button, size(13.5)),
        (TextStyle::Heading, strong(17.0)),
        (TextStyle::Name(STRONG.into()), strong(13.5)),
    ]
    .into();
    style.spacing.item_spacing = egui::vec2(8.0, 7.0);
    style.spacing.button_padding = egui::vec2(10.0, 5.0);
    style.spacing.interact_size.y = 26.0;
    style.spacing.slider_width = 130.0;
    style.spacing.slider_rail_height = 4.0;
    style.spacing.window_margin = Margin::same(16);
    style.spacing.combo_width = 80.0;
    let visuals = &mut style.visuals;
    *visuals = if number == 0 { egui::Visuals::light() } else { egui::Visuals::dark() };
    visuals.panel_fill = PANEL[number];
    visuals.window_fill = PANEL[number];
    visuals.extreme_bg_color = DEEP[number];
    visuals.faint_bg_color = CONTROL[number];
    visuals.text_edit_bg_color = Some(DEEP[number]);
    visuals.window_stroke = Stroke::new(1.0, LINE[number]);
    visuals.weak_text_color = Some(QUIET[number]);
    visuals.hyperlink_color = ACCENT[number];
    visuals.selection.bg_fill = ACCENT[number];
    visuals.selection.stroke = Stroke::new(1.0, if number == 0 { Color32::WHITE } else { Color32::BLACK });
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = egui::style::HandleShape::Circle;
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(8);
    let widgets = &mut visuals.widgets;
    let grounds = [CONTROL[number], HOVERED[number], PRESSED[number], HOVERED[number]];
    let states = [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active, &mut widgets.open];
    for (state, ground) in states.into_iter().zip(grounds) {
        (state.bg_fill, state.weak_bg_fill) = (ground, ground);
        state.bg_stroke = Stroke::NONE;
        state.fg_stroke = Stroke::new(1.4, TEXT[number]);
        state.corner_radius = CornerRadius::same(6);
        state.expansion = 0.0;
    }
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT[number]);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE[number]);
    widgets.noninteractive.corner_radius = CornerRadius::same(6);
}
