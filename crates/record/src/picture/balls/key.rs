//! What the picture's colours, lines and lengths mean.

use super::colour::{hex, of_speed};
use super::{Balls, Key, Side};
use crate::picture::svg::{Anchor, Svg};
use crate::picture::text::number;
use crate::picture::ticks;

const SPACE_OF_LETTER: f64 = 6.8;

/// Parts of the bar of speeds.
const SHADES: usize = 48;

/// Prefixes of units, from large to small.
const PREFIXES: [(f64, &str); 5] = [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];

impl Balls {
    /// Draws the key from `left_top` on; gives its lower end.
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

    /// The lines that are in the picture, in words.
    fn draw_marks(&self, svg: &mut Svg, [left, top]: [f64; 2]) -> f64 {
        let has = |side: Side| self.sides.iter().take(self.dimensions).flatten().any(|found| *found == side);
        let mut x = left;
        let mut mark = |svg: &mut Svg, class: &str, text: &str| {
            svg.line([x, top], [x + 22.0, top], class);
            svg.text([x + 29.0, top + 4.0], Anchor::Start, "small", text);
            x += 47.0 + text.chars().count() as f64 * SPACE_OF_LETTER;
        };
        if !self.way.is_empty() {
            mark(svg, "way", "way of one ball");
        }
        if has(Side::Open) {
            mark(svg, "wall-open", "periodic: what leaves comes in opposite");
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
    value_bar(svg, most, [from, top], 300.0)
}

/// A bar of the colours from 0 to `most`, `width` wide from a place on; gives its lower end.
pub(crate) fn value_bar(svg: &mut Svg, most: f64, [from, top]: [f64; 2], width: f64) -> f64 {
    let part = width / SHADES as f64;
    for shade in 0..SHADES {
        let colour = hex(of_speed((shade as f64 + 0.5) / SHADES as f64));
        let place = [from + shade as f64 * part, top];
        svg.styled_path(rectangle(place, [part + 0.5, 13.0]), true, "", &format!("fill:{colour}"));
    }
    let step = ticks::step(most, 5);
    for value in ticks::multiples(0.0, most, step) {
        let x = from + value / most * width;
        svg.line([x, top + 13.0], [x, top + 17.0], "axis");
        svg.text([x, top + 29.0], Anchor::Middle, "number", &label(value, step));
    }
    top + 32.0
}

fn label(value: f64, step: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) { number(value) } else { ticks::label(value, step) }
}

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

/// A bar of a round length, ending at `[right, top]`; `scale` is in CSS pixels for a unit of length.
pub(crate) fn scale_bar(svg: &mut Svg, scale: f64, unit: &str, [right, top]: [f64; 2]) {
    let length = ticks::step(70.0 / scale, 1);
    let width = length * scale;
    let y = top + 6.0;
    svg.path([[right - width, y - 4.0], [right - width, y + 4.0]], false, "edge");
    svg.path([[right, y - 4.0], [right, y + 4.0]], false, "edge");
    svg.line([right - width, y], [right, y], "edge");
    svg.text([right - 0.5 * width, y + 19.0], Anchor::Middle, "number", &length_label(length, unit));
}

/// A length with a prefix that suits it: `5 nm`; in reduced units the number alone.
fn length_label(length: f64, unit: &str) -> String {
    if unit.is_empty() {
        return label(length, length);
    }
    let (factor, prefix) = PREFIXES.into_iter().find(|(factor, _)| length >= factor * 0.999).unwrap_or(PREFIXES[4]);
    format!("{} {prefix}{unit}", ticks::label(length / factor, length / factor))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_a_prefix_that_suits_them() {
        assert_eq!(length_label(5e-9, "m"), "5 nm");
        assert_eq!(length_label(2e-10, "m"), "200 pm");
        assert_eq!(length_label(20.0, "m"), "20 m");
        assert_eq!(length_label(100.0, ""), "100");
    }
}
