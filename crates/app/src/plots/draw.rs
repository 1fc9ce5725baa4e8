//! A chart with `egui_plot`.

use corpuscle::model::{Chart, ChartAxis, ChartSeries, ChartStyle};
use corpuscle_drawing::text::short_number;
use corpuscle_drawing::ticks::step;
use egui::{Color32, Ui};
use egui_plot::{Bar, BarChart, GridInput, Legend, Line, LineStyle, Plot, PlotPoints, Points, uniform_grid_spacer};

/// Colours of series that have none of their own, in turn; theory is red.
const COLOURS: [Color32; 4] = [
    Color32::from_rgb(0x3d, 0x93, 0xd8),
    Color32::from_rgb(0xe0, 0x9a, 0x1a),
    Color32::from_rgb(0x2a, 0xa1, 0x6a),
    Color32::from_rgb(0x9b, 0x59, 0xb6),
];
const THEORY: Color32 = Color32::from_rgb(0xd6, 0x3a, 0x4a);

/// Draws a chart into the rest of a panel.
pub fn chart(ui: &mut Ui, id: impl std::hash::Hash + std::fmt::Debug, chart: &Chart) {
    let number = |mark: egui_plot::GridMark, _: &std::ops::RangeInclusive<f64>| short_number(mark.value);
    let log = [chart.x.logarithmic, chart.y.logarithmic];
    let mut plot = Plot::new(id)
        .height(ui.available_height())
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_drag(false)
        .show_background(false)
        .x_grid_spacer(uniform_grid_spacer(move |input| steps(&input, log[0])))
        .y_grid_spacer(uniform_grid_spacer(move |input| steps(&input, log[1])))
        .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.35))
        .x_axis_label(label(&chart.x))
        .x_axis_formatter(move |mark, range| if log[0] { power(mark.value) } else { number(mark, range) })
        .y_axis_formatter(move |mark, range| if log[1] { power(mark.value) } else { number(mark, range) });
    if let Some([low, high]) = nearly_constant(chart) {
        plot = plot.include_y(low).include_y(high);
    }
    if chart.series.len() > 1 {
        plot = plot.legend(Legend::default().background_alpha(0.0));
    }
    if chart.series.iter().any(|series| series.style == ChartStyle::Bars) {
        plot = plot.include_y(0.0);
    }
    plot.show(ui, |plot| {
        for (number, series) in chart.series.iter().enumerate() {
            let colour = colour(series, number);
            let name = series.name.clone();
            let points = || -> Vec<[f64; 2]> { series.points.iter().filter_map(|point| scaled(*point, log)).collect() };
            match series.style {
                ChartStyle::Bars => plot.bar_chart(BarChart::new(name, bars(series)).color(colour.gamma_multiply(0.7))),
                ChartStyle::Points => {
                    plot.points(Points::new(name, PlotPoints::from(points())).radius(2.2).color(colour))
                }
                ChartStyle::Line => plot.line(Line::new(name, PlotPoints::from(points())).width(1.8).color(colour)),
                ChartStyle::Dashes => {
                    let line = Line::new(name, PlotPoints::from(points())).width(1.8).color(THEORY);
                    plot.line(if series.points.len() > 60 { line } else { line.style(LineStyle::dashed_loose()) });
                }
            }
        }
    });
}

/// At most five steps of a grid across a plot, at round numbers 1, 2 or 5 times a power of ten (of a logarithm at whole ones), and bolder
/// ones at ten and a hundred times as many: powers of ten alone leave a plot of this size with one number or none.
fn steps(input: &GridInput, logarithmic: bool) -> [f64; 3] {
    let step = step((input.bounds.1 - input.bounds.0).max(f64::MIN_POSITIVE), 5);
    [1.0, 10.0, 100.0].map(|times| times * if logarithmic { step.max(1.0) } else { step })
}

/// A range round values that are equal but for rounding, so that rounding does not fill the plot.
fn nearly_constant(chart: &Chart) -> Option<[f64; 2]> {
    let values =
        || chart.series.iter().flat_map(|series| &series.points).map(|point| point[1]).filter(|y| y.is_finite());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let size = low.abs().max(high.abs());
    (high - low < 1e-3 * size).then_some([low - 0.05 * size, high + 0.05 * size])
}

fn bars(series: &ChartSeries) -> Vec<Bar> {
    let width = series.points.windows(2).map(|pair| pair[1][0] - pair[0][0]).fold(f64::INFINITY, f64::min);
    series.points.iter().map(|[x, y]| Bar::new(*x, *y).width(0.92 * width)).collect()
}

/// A point in plot coordinates: its logarithm along a logarithmic axis; none where that does not exist.
fn scaled(point: [f64; 2], log: [bool; 2]) -> Option<[f64; 2]> {
    let scaled = [0, 1].map(|axis| if log[axis] { point[axis].log10() } else { point[axis] });
    scaled.iter().all(|value| value.is_finite()).then_some(scaled)
}

/// A number by its logarithm.
fn power(logarithm: f64) -> String {
    short_number(10_f64.powf(logarithm))
}

fn label(axis: &ChartAxis) -> String {
    if axis.unit.is_empty() { axis.label.clone() } else { format!("{}, {}", axis.label, axis.unit) }
}

fn colour(series: &ChartSeries, number: usize) -> Color32 {
    let own = series.colour.as_deref().and_then(|colour| Color32::from_hex(colour).ok());
    own.unwrap_or(COLOURS[number % COLOURS.len()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_some_lines_at_round_numbers() {
        for (high, step) in [(0.0069, 0.002), (1.0, 0.2), (9.0, 2.0), (420.0, 100.0)] {
            let found = steps(&GridInput { bounds: (0.0, high), base_step_size: 1e-9 }, false)[0];
            assert!((found / step - 1.0).abs() < 1e-9, "{found} for {high}");
        }
        assert_eq!(steps(&GridInput { bounds: (-1.0, 1.0), base_step_size: 0.1 }, true)[0], 1.0);
    }
}
