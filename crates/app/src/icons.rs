//! Buttons with drawn icons, so that no icon font is needed.

use egui::{Color32, CornerRadius, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};

/// An icon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    /// Play.
    Play,
    /// Pause.
    Pause,
    /// One step.
    Step,
    /// Restart.
    Restart,
    /// Show all.
    Frame,
    /// View from above.
    Plan,
    /// A still.
    Still,
    /// A film.
    Film,
    /// The scenes.
    Gallery,
    /// The parameters.
    Sliders,
    /// The plots.
    Plot,
    /// The ruler.
    Ruler,
    /// The stopwatch.
    Stopwatch,
    /// Help.
    Help,
    /// Reset a value.
    Undo,
    /// Close.
    Close,
    /// Save to a file.
    Save,
}

/// A button with an icon, with `name` as its label and tooltip.
pub fn button(ui: &mut Ui, icon: Icon, name: &str, hint: &str) -> Response {
    sized(ui, icon, name, hint, 30.0, false)
}

/// The same that stays pressed while `on`.
pub fn toggle(ui: &mut Ui, icon: Icon, name: &str, hint: &str, on: bool) -> Response {
    sized(ui, icon, name, hint, 30.0, on)
}

/// The same of any size.
pub fn sized(ui: &mut Ui, icon: Icon, name: &str, hint: &str, size: f32, on: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(size), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), on, name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact_selectable(&response, false);
        let accent = ui.visuals().selection.bg_fill;
        let background = if on {
            accent.gamma_multiply(0.22)
        } else if response.hovered() || response.has_focus() {
            visuals.weak_bg_fill
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(rect, CornerRadius::same(7), background);
        let colour = if !ui.is_enabled() {
            ui.visuals().weak_text_color().gamma_multiply(0.5)
        } else if on {
            accent
        } else {
            visuals.text_color()
        };
        paint(ui, icon, rect.shrink(size * 0.23), colour);
    }
    let text = if hint.is_empty() { name.to_owned() } else { format!("{name} ({hint})") };
    response.on_hover_text(text)
}

/// Draws an icon.
pub fn paint(ui: &Ui, icon: Icon, rect: Rect, colour: Color32) {
    let at = |x: f32, y: f32| -> Pos2 { rect.min + rect.size() * vec2(x, y) };
    let line = Stroke::new((0.11 * rect.width()).max(1.3), colour);
    let painter = ui.painter();
    let fill = |points: Vec<Pos2>| painter.add(Shape::convex_polygon(points, colour, Stroke::new(1.0, colour)));
    let bar = |x0: f32, y0: f32, x1: f32, y1: f32| {
        painter.rect_filled(Rect::from_two_pos(at(x0, y0), at(x1, y1)), CornerRadius::same(1), colour);
    };
    let stroke = |points: &[(f32, f32)]| {
        painter.add(Shape::line(points.iter().map(|(x, y)| at(*x, *y)).collect(), line));
    };
    match icon {
        Icon::Play => {
            fill(vec![at(0.2, 0.05), at(0.95, 0.5), at(0.2, 0.95)]);
        }
        Icon::Pause => {
            bar(0.14, 0.08, 0.38, 0.92);
            bar(0.62, 0.08, 0.86, 0.92);
        }
        Icon::Step => {
            fill(vec![at(0.1, 0.1), at(0.68, 0.5), at(0.1, 0.9)]);
            bar(0.74, 0.1, 0.92, 0.9);
        }
        Icon::Restart | Icon::Undo => {
            let arc = |turn: f32| {
                let angle = (-60.0 + turn * 300.0_f32).to_radians();
                at(0.5 + 0.42 * angle.cos(), 0.54 + 0.42 * angle.sin())
            };
            painter.add(Shape::line((0..=24).map(|k| arc(k as f32 / 24.0)).collect(), line));
            let tip = arc(0.0);
            let size = 0.22 * rect.width();
            fill(vec![
                tip + vec2(-size, -0.9 * size),
                tip + vec2(0.7 * size, -0.2 * size),
                tip + vec2(-0.6 * size, size),
            ]);
        }
        Icon::Frame => {
            for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let inwards = |v: f32| if v == 0.0 { 0.3 } else { 0.7 };
                stroke(&[(inwards(x), y), (x, y), (x, inwards(y))]);
            }
        }
        Icon::Plan => {
            painter.rect_stroke(rect, CornerRadius::same(2), line, egui::StrokeKind::Middle);
            fill(vec![at(0.5, 0.2), at(0.72, 0.78), at(0.5, 0.62), at(0.28, 0.78)]);
        }
        Icon::Still => {
            let body = Rect::from_two_pos(at(-0.05, 0.2), at(1.05, 0.95));
            painter.rect_stroke(body, CornerRadius::same(3), line, egui::StrokeKind::Middle);
            painter.circle_stroke(at(0.5, 0.57), 0.2 * rect.width(), line);
            bar(0.32, 0.04, 0.68, 0.2);
        }
        Icon::Film => {
            painter.circle_stroke(rect.center(), 0.52 * rect.width(), line);
            painter.circle_filled(rect.center(), 0.26 * rect.width(), colour);
        }
        Icon::Gallery => {
            for (x, y) in [(0.0, 0.0), (0.58, 0.0), (0.0, 0.58), (0.58, 0.58)] {
                bar(x, y, x + 0.42, y + 0.42);
            }
        }
        Icon::Sliders => {
            for (y, knob) in [(0.15, 0.7), (0.5, 0.25), (0.85, 0.6)] {
                stroke(&[(0.0, y), (1.0, y)]);
                painter.circle_filled(at(knob, y), 0.14 * rect.width(), colour);
            }
        }
        Icon::Plot => {
            stroke(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)]);
            stroke(&[(0.15, 0.75), (0.4, 0.35), (0.62, 0.55), (0.95, 0.1)]);
        }
        Icon::Ruler => {
            painter.rect_stroke(
                Rect::from_two_pos(at(-0.05, 0.28), at(1.05, 0.72)),
                CornerRadius::same(1),
                line,
                egui::StrokeKind::Middle,
            );
            for (x, y) in [(0.22, 0.52), (0.5, 0.6), (0.78, 0.52)] {
                stroke(&[(x, 0.28), (x, y)]);
            }
        }
        Icon::Stopwatch => {
            painter.circle_stroke(at(0.5, 0.58), 0.42 * rect.width(), line);
            stroke(&[(0.5, 0.58), (0.68, 0.4)]);
            bar(0.38, -0.06, 0.62, 0.06);
        }
        Icon::Help => {
            let centre = rect.center();
            painter.circle_stroke(centre, 0.52 * rect.width(), line);
            let font = egui::FontId::proportional(0.8 * rect.height());
            painter.text(centre, egui::Align2::CENTER_CENTER, "?", font, colour);
        }
        Icon::Close => {
            stroke(&[(0.12, 0.12), (0.88, 0.88)]);
            stroke(&[(0.88, 0.12), (0.12, 0.88)]);
        }
        Icon::Save => {
            stroke(&[(0.5, 0.0), (0.5, 0.62)]);
            stroke(&[(0.22, 0.38), (0.5, 0.66), (0.78, 0.38)]);
            stroke(&[(0.0, 0.7), (0.0, 1.0), (1.0, 1.0), (1.0, 0.7)]);
        }
    }
}
