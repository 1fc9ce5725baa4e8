//! Colour bars and scale bars.

use crate::colour::{Colour, hex};
use crate::svg::{Anchor, Svg};
use crate::text::{number, prefix};
use crate::ticks;

/// Parts of the bar of colours.
const SHADES: usize = 48;

/// Draws a bar of the colours of values from `low` to `high`, `width` wide from a position on; `colour` takes the fraction from low to high.
/// Returns its lower end.
pub fn value_bar(
    svg: &mut Svg,
    [low, high]: [f64; 2],
    colour: impl Fn(f64) -> Colour,
    [from, top]: [f64; 2],
    width: f64,
) -> f64 {
    let part = width / SHADES as f64;
    for shade in 0..SHADES {
        let colour = hex(colour((shade as f64 + 0.5) / SHADES as f64));
        let position = [from + shade as f64 * part, top];
        svg.styled_path(rectangle(position, [part + 0.5, 13.0]), true, "", &format!("fill:{colour}"));
    }
    let step = ticks::step(high - low, 5);
    for value in ticks::multiples(low, high, step) {
        let x = from + (value - low) / (high - low) * width;
        svg.line([x, top + 13.0], [x, top + 17.0], "axis");
        svg.text([x, top + 29.0], Anchor::Middle, "number", &label(value, step));
    }
    top + 32.0
}

/// A value beside a bar or an axis of a step.
pub fn label(value: f64, step: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) { number(value) } else { ticks::label(value, step) }
}

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

/// Width of a scale bar of a round length, CSS pixels; `scale` is in CSS pixels for a unit of length.
pub fn scale_bar_width(scale: f64) -> f64 {
    ticks::step(70.0 / scale, 1) * scale
}

/// Draws a scale bar of a round length, ending at `[right, top]`; `scale` is in CSS pixels for a unit of length.
pub fn scale_bar(svg: &mut Svg, scale: f64, unit: &str, [right, top]: [f64; 2]) {
    let width = scale_bar_width(scale);
    let length = width / scale;
    let y = top + 6.0;
    svg.path([[right - width, y - 4.0], [right - width, y + 4.0]], false, "edge");
    svg.path([[right, y - 4.0], [right, y + 4.0]], false, "edge");
    svg.line([right - width, y], [right, y], "edge");
    svg.text([right - 0.5 * width, y + 19.0], Anchor::Middle, "number", &length_label(length, unit));
}

/// A length with a prefix that suits it: `5 nm`; in reduced units the number alone.
pub fn length_label(length: f64, unit: &str) -> String {
    if unit.is_empty() {
        return label(length, length);
    }
    let (factor, prefix) = prefix(length);
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
