//! The legend of the picture: colours, lines and scale bar.

use super::{Balls, Key, Side};
use crate::picture::bars::{scale_bar, value_bar};
use crate::picture::colour::{hex, of_part};
use crate::picture::svg::{Anchor, Svg};

const SPACE_OF_LETTER: f64 = 6.8;

impl Balls {
    /// Draws the legend from `left_top` on; returns its lower end.
    pub(super) fn draw_key(&self, svg: &mut Svg, [left, top]: [f64; 2], width: f64, scale: Option<f64>) -> f64 {
        let end = match &self.key {
            Key::Kinds(kinds) => draw_kinds(svg, kinds, [left, top], 0.7 * width),
            Key::Speed { most, unit } => draw_speeds(svg, *most, unit, [left, top]),
        };
        if let Some(scale) = scale {
            scale_bar(svg, scale, self.unit, [width - 8.0, top]);
        }
        self.draw_marks(svg, [left, end + 12.0])
    }

    /// The legend of the lines in the picture.
    fn draw_marks(&self, svg: &mut Svg, [left, top]: [f64; 2]) -> f64 {
        let has = |side: Side| self.sides.iter().take(self.dimensions).flatten().any(|found| *found == side);
        let mut x = left;
        let mut mark = |svg: &mut Svg, class: &str, text: &str| {
            svg.line([x, top], [x + 22.0, top], class);
            svg.text([x + 29.0, top + 4.0], Anchor::Start, "small", text);
            x += 47.0 + text.chars().count() as f64 * SPACE_OF_LETTER;
        };
        if !self.trajectory.is_empty() {
            mark(svg, "trajectory", "trajectory of one ball");
        }
        if has(Side::Open) {
            mark(svg, "wall-open", "periodic side");
        }
        if has(Side::Hot) {
            mark(svg, "wall-hot", "wall at a temperature");
        }
        if x > left { top + 14.0 } else { top - 4.0 }
    }
}

fn draw_kinds(svg: &mut Svg, kinds: &[(String, super::Colour)], [left, top]: [f64; 2], width: f64) -> f64 {
    let (mut x, mut y) = (left, top + 8.0);
    for (name, colour) in kinds {
        let wide = 34.0 + name.chars().count() as f64 * SPACE_OF_LETTER;
        if x > left && x + wide > left + width {
            (x, y) = (left, y + 20.0);
        }
        svg.circles([([x + 7.0, y], 6.0)], &hex(*colour), "balls");
        svg.text([x + 19.0, y + 4.0], Anchor::Start, "text", name);
        x += wide;
    }
    y + 12.0
}

fn draw_speeds(svg: &mut Svg, most: f64, unit: &str, [left, top]: [f64; 2]) -> f64 {
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    svg.text([left, top + 12.0], Anchor::Start, "text", &format!("Speed{unit}"));
    let from = left + 40.0 + unit.chars().count() as f64 * SPACE_OF_LETTER + 12.0;
    value_bar(svg, [0.0, most], of_part, [from, top], 300.0)
}
