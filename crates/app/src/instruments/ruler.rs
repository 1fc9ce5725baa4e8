//! A ruler between two points of the world that the pointer drags.

use crate::overlay::Over;
use corpuscle_drawing::text::number;
use egui::{Align2, Color32, FontId, Pos2, Rect, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};
use glam::DVec3;

const COLOUR: Color32 = Color32::from_rgb(0x7a, 0x3e, 0xc8);
/// Size of an end for the pointer, points.
const GRIP: f32 = 26.0;
/// Where the ends lie at first: parts of the width of the picture, at half of its height.
const ENDS: [f32; 2] = [0.38, 0.62];
/// Names of the ends.
const NAMES: [&str; 2] = ["Ruler, first end", "Ruler, second end"];

/// A ruler.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ruler {
    /// Its ends, m; none until it was first shown.
    ends: Option<[[f64; 3]; 2]>,
}

/// Gives the point of the world, m, that lies under a position of the window; none where there is none.
pub type Below<'a> = &'a dyn Fn(Pos2) -> Option<[f64; 3]>;

impl Ruler {
    /// Its length, m; none before it was shown.
    pub fn length(&self) -> Option<f64> {
        self.ends.map(|[from, to]| (DVec3::from(to) - DVec3::from(from)).length())
    }

    /// Draws it over a picture, and lets the pointer drag its ends; lengths have a unit.
    pub fn ui(&mut self, ui: &Ui, over: &Over<'_>, below: Below<'_>, unit: &str) {
        let at_first = |part: f32| below(Pos2::new(over.rect.left() + part * over.rect.width(), over.rect.center().y));
        if self.ends.is_none()
            && let [Some(from), Some(to)] = ENDS.map(at_first)
        {
            self.ends = Some([from, to]);
        }
        let Some(ends) = &mut self.ends else { return };
        for (end, name) in ends.iter_mut().zip(NAMES) {
            let Some(at) = over.position(*end) else { continue };
            let grip = Rect::from_center_size(at, Vec2::splat(GRIP)).intersect(over.rect);
            let response = ui.interact(grip, ui.scope_id().with(name), Sense::drag()).on_hover_text("Drag");
            response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name));
            let moved = response.drag_delta();
            if moved != Vec2::ZERO {
                *end = below(at + moved).unwrap_or(*end);
            }
        }
        self.paint(over, unit);
    }

    fn paint(&self, over: &Over<'_>, unit: &str) {
        let (Some(ends), Some(length)) = (self.ends, self.length()) else { return };
        let [Some(from), Some(to)] = ends.map(|end| over.position(end)) else { return };
        let stroke = Stroke::new(2.2, COLOUR);
        over.painter.line_segment([from, to], stroke);
        let along = (to - from).normalized();
        let across = vec2(-along.y, along.x);
        for end in [from, to] {
            over.painter.line_segment([end - 9.0 * across, end + 9.0 * across], stroke);
            over.painter.circle(end, 5.0, Color32::WHITE, stroke);
        }
        let text = format!("{} {unit}", number(length));
        let font = FontId::proportional(13.5);
        let size = over.painter.layout_no_wrap(text.clone(), font.clone(), COLOUR).size() + vec2(12.0, 6.0);
        let label = Rect::from_center_size(from + 0.5 * (to - from) - vec2(0.0, 20.0), size);
        over.painter.rect_filled(label, 5, Color32::from_rgba_unmultiplied(255, 255, 255, 225));
        over.painter.text(label.center(), Align2::CENTER_CENTER, text.trim_end(), font, COLOUR);
    }
}
