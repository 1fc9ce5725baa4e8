//! A slider with its number beside it.

use egui::{DragValue, Slider, Ui, WidgetInfo};
use toml::Value;

/// Width of a number beside its slider, points.
const VALUE: f32 = 92.0;

/// True for a unit too long to be shown beside a number.
pub(super) fn is_long(unit: &str) -> bool {
    unit.chars().count() > 5
}

/// A slider with its number beside it; true where it was changed.
pub(super) fn slider(
    ui: &mut Ui,
    number: &mut f64,
    range: [f64; 2],
    logarithmic: bool,
    whole: bool,
    unit: &str,
    name: &str,
) -> bool {
    let before = *number;
    let range = [range[0].min(before), range[1].max(before)];
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - VALUE - 12.0).max(60.0);
        let mut slider = Slider::new(number, range[0]..=range[1]).logarithmic(logarithmic).show_value(false);
        if whole {
            slider = slider.integer();
        }
        let response = ui.add(slider);
        response.widget_info(|| WidgetInfo::slider(true, before, name));
        if response.changed() && !whole {
            *number = rounded(*number, range);
        }
        let speed = (range[1] - range[0]) / 400.0;
        let mut typed = DragValue::new(number).range(range[0]..=range[1]).speed(speed);
        if whole {
            typed = typed.fixed_decimals(0);
        } else {
            typed = typed.custom_formatter(|number, _| corpuscle_drawing::text::short_number(number));
        }
        if !unit.is_empty() && !is_long(unit) {
            typed = typed.suffix(format!(" {unit}"));
        }
        let typed = ui.add_sized([VALUE, 24.0], typed);
        typed.widget_info(|| WidgetInfo { label: Some(name.into()), ..WidgetInfo::drag_value(true, before) });
    });
    *number != before
}

/// A number rounded to the resolution of a slider.
pub(super) fn rounded(number: f64, range: [f64; 2]) -> f64 {
    let step = 10_f64.powf((number.abs().max(1e-3 * (range[1] - range[0]))).log10().floor() - 2.0);
    let rounded = (number / step).round() * step;
    // Without the rounding errors of binary numbers.
    format!("{rounded:.12e}").parse().unwrap_or(rounded)
}

/// A number as written in a scene, always with a decimal point.
pub(super) fn written(number: f64) -> String {
    Value::Float(number).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliders_give_round_numbers() {
        assert_eq!(rounded(0.123_456, [0.0, 1.0]), 0.123);
        assert_eq!(rounded(12_345.6, [0.0, 1e5]), 12_300.0);
        assert_eq!(rounded(0.0, [0.0, 1.0]), 0.0);
    }
}
