//! Charts of one quantity over another, as a model gives them.

mod axis;

use super::chart::SPACE_OF_LETTER;
use super::svg::{Anchor, Figure, Svg};
use axis::Axis;
use corpuscle_model::{Chart, ChartSeries, ChartStyle};

const RIGHT: f64 = 16.0;
const BOTTOM: f64 = 44.0;

/// The drawing area of a chart.
struct Plot {
    x: Axis,
    y: Axis,
    left_top: [f64; 2],
    right_bottom: [f64; 2],
}

impl Plot {
    fn position(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([left, top], [right, bottom]) = (self.left_top, self.right_bottom);
        [left + self.x.part(x) * (right - left), bottom - self.y.part(y) * (bottom - top)]
    }

    /// The lower edge, or the position of 0 where that is within.
    fn base(&self) -> f64 {
        let [top, bottom] = [self.left_top[1], self.right_bottom[1]];
        let zero = bottom - self.y.part(0.0) * (bottom - top);
        if zero.is_finite() { zero.clamp(top, bottom) } else { bottom }
    }
}

/// A chart as a figure of the given size, CSS pixels.
pub(crate) fn plot(chart: &Chart, size: [f64; 2]) -> Figure {
    let mut svg = Svg::default();
    svg.text([0.0, 16.0], Anchor::Start, "title", &chart.title);
    svg.text([0.0, 34.0], Anchor::Start, "small", &chart.note);
    let note = if chart.note.is_empty() { 0.0 } else { 18.0 };
    let legend = draw_legend(&mut svg, chart, 36.0 + note, size[0]);
    let plot = lay_out(chart, legend + 24.0, size);
    svg.text([0.0, legend + 10.0], Anchor::Start, "small", &plot.y.label(&chart.y));
    draw_axes(&mut svg, &plot, chart);
    for (number, series) in chart.series.iter().enumerate() {
        draw_series(&mut svg, &plot, series, number, chart.x.logarithmic);
    }
    svg.finish(size, &format!("Chart: {} {}", chart.title, chart.note))
}

/// Names of the series, where there is more than one; gives the lower end.
fn draw_legend(svg: &mut Svg, chart: &Chart, top: f64, width: f64) -> f64 {
    if chart.series.len() < 2 {
        return top - 12.0;
    }
    let (mut x, mut baseline) = (0.0, top);
    for (number, series) in chart.series.iter().enumerate() {
        let wide = 38.0 + series.name.chars().count() as f64 * SPACE_OF_LETTER;
        if x > 0.0 && x + wide > width {
            (x, baseline) = (0.0, baseline + 17.0);
        }
        let y = baseline - 4.0;
        let (class, style) = class_and_style(series, number);
        match series.style {
            ChartStyle::Line | ChartStyle::Dashes => svg.styled_path([[x, y], [x + 18.0, y]], false, &class, &style),
            ChartStyle::Points => svg.styled_circle([x + 9.0, y], 3.2, &class, &style),
            ChartStyle::Bars => svg.styled_path(corners([x + 3.0, y - 5.0], [x + 15.0, y + 5.0]), true, &class, &style),
        }
        svg.text([x + 23.0, baseline], Anchor::Start, "text", &series.name);
        x += wide;
    }
    baseline + 8.0
}

/// Class and style of a series: its number's colour, or its own.
fn class_and_style(series: &ChartSeries, number: usize) -> (String, String) {
    let number = number % 6;
    let own = |property: &str| series.colour.as_ref().map(|colour| format!("{property}:{colour}"));
    match series.style {
        ChartStyle::Line => (format!("series s{number}"), own("stroke").unwrap_or_default()),
        ChartStyle::Dashes => (format!("series dashes s{number}"), own("stroke").unwrap_or_default()),
        ChartStyle::Points => (format!("mark a{number}"), own("fill").unwrap_or_default()),
        ChartStyle::Bars => (format!("bar-of-chart a{number}"), own("fill").unwrap_or_default()),
    }
}

fn corners([left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> [[f64; 2]; 4] {
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

fn lay_out(chart: &Chart, top: f64, [width, height]: [f64; 2]) -> Plot {
    let bars = chart.series.iter().any(|series| series.style == ChartStyle::Bars);
    let xs = |series: &ChartSeries| {
        let is_bars = series.style == ChartStyle::Bars;
        let of = move |point: &[f64; 2]| {
            if is_bars { bar(series, point[0], chart.x.logarithmic) } else { [point[0]; 2] }
        };
        series.points.iter().flat_map(of).collect::<Vec<_>>()
    };
    let shown = |value: &f64, logarithmic: bool| value.is_finite() && (!logarithmic || *value > 0.0);
    let x_range = range(chart.series.iter().flat_map(xs).filter(|x| shown(x, chart.x.logarithmic)));
    let ys = |series: &ChartSeries| {
        let error = |index: usize| series.errors.get(index).copied().filter(|error| error.is_finite()).unwrap_or(0.0);
        let of = |(index, point): (usize, &[f64; 2])| [point[1] - error(index), point[1] + error(index)];
        series.points.iter().enumerate().flat_map(of).collect::<Vec<_>>()
    };
    let y_range = range(chart.series.iter().flat_map(ys).filter(|y| shown(y, chart.y.logarithmic)));
    let y = Axis::of(&chart.y, y_range, bars, ((height - top - BOTTOM) / 34.0).max(2.0) as usize);
    let longest = y.ticks().iter().map(|(_, text)| text.chars().count()).max().unwrap_or(0);
    let left = (longest as f64 * SPACE_OF_LETTER + 14.0).max(34.0);
    let most = ((width - left) / 70.0).max(2.0) as usize;
    let from = if x_range[0] >= 0.0 && x_range[0] < 0.2 * x_range[1] { 0.0 } else { x_range[0] };
    let x = Axis::of(&chart.x, x_range, false, most).cut_to([from, x_range[1]], most);
    Plot { x, y, left_top: [left, top], right_bottom: [width - RIGHT, height - BOTTOM] }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// Where a bar begins and ends; on a logarithmic axis all are of one ratio.
fn bar(series: &ChartSeries, middle: f64, logarithmic: bool) -> [f64; 2] {
    let [first, second] = match series.points[..] {
        [first, second, ..] => [first[0], second[0]],
        _ if logarithmic => [1.0, 2.0],
        _ => [0.0, 1.0],
    };
    if logarithmic {
        let half = (second / first).sqrt();
        [middle / half, middle * half]
    } else {
        let half = 0.5 * (second - first);
        [middle - half, middle + half]
    }
}

fn draw_axes(svg: &mut Svg, plot: &Plot, chart: &Chart) {
    let ([left, top], [right, bottom]) = (plot.left_top, plot.right_bottom);
    for (value, text) in plot.y.ticks() {
        let y = bottom - plot.y.part(value) * (bottom - top);
        svg.line([left, y], [right, y], "grid");
        svg.text([left - 7.0, y + 4.0], Anchor::End, "number", &text);
    }
    for (value, text) in plot.x.ticks() {
        let x = left + plot.x.part(value) * (right - left);
        svg.line([x, bottom], [x, bottom + 4.0], "axis");
        svg.text([x, bottom + 17.0], Anchor::Middle, "number", &text);
    }
    svg.line([left, plot.base()], [right, plot.base()], "axis");
    svg.line([left, bottom], [right, bottom], "axis");
    svg.text([right, bottom + 35.0], Anchor::End, "small", &plot.x.label(&chart.x));
}

fn draw_series(svg: &mut Svg, plot: &Plot, series: &ChartSeries, number: usize, logarithmic: bool) {
    let (class, style) = class_and_style(series, number);
    match series.style {
        ChartStyle::Line | ChartStyle::Dashes => {
            svg.styled_path(series.points.iter().map(|point| plot.position(*point)), false, &class, &style);
        }
        ChartStyle::Points => {
            for position in series.points.iter().map(|point| plot.position(*point)).filter(on_page) {
                svg.styled_circle(position, if series.points.len() > 60 { 2.0 } else { 3.2 }, &class, &style);
            }
        }
        ChartStyle::Bars => draw_bars(svg, plot, series, logarithmic, (&class, &style)),
    }
    for (point, error) in series.points.iter().zip(&series.errors).filter(|(_, error)| **error > 0.0) {
        let [high, low] = [point[1] + error, point[1] - error].map(|y| plot.position([point[0], y]));
        if on_page(&high) {
            // Below the first value of a logarithmic axis the bar goes on to its end.
            let bottom = plot.right_bottom[1];
            svg.line(high, [high[0], if low[1].is_finite() { low[1].min(bottom) } else { bottom }], "error");
        }
    }
}

fn draw_bars(svg: &mut Svg, plot: &Plot, series: &ChartSeries, logarithmic: bool, (class, style): (&str, &str)) {
    for point in series.points.iter().filter(|point| point[1].is_finite() && point[1] != 0.0) {
        let [from, to] = bar(series, point[0], logarithmic);
        let [left, top] = plot.position([from, point[1]]);
        let [right, _] = plot.position([to, point[1]]);
        if !(left.is_finite() && right.is_finite() && top.is_finite()) {
            continue;
        }
        // A little space between bars.
        let gap = if right - left > 4.0 { 0.5 } else { 0.0 };
        svg.styled_path(corners([left + gap, top], [right - gap, plot.base()]), true, class, style);
    }
}

fn on_page(position: &[f64; 2]) -> bool {
    position.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::ChartAxis;

    fn series(style: ChartStyle, points: &[[f64; 2]]) -> ChartSeries {
        ChartSeries { name: "measured".into(), style, points: points.to_vec(), ..ChartSeries::default() }
    }

    fn chart(series: Vec<ChartSeries>) -> Chart {
        let y = ChartAxis { label: "Density".into(), ..ChartAxis::default() };
        Chart { name: "a".into(), title: "Speeds".into(), note: "p = 0.43".into(), y, series, ..Chart::default() }
    }

    #[test]
    fn bars_stand_on_zero_within_the_plot() {
        let bars = series(ChartStyle::Bars, &[[0.5, 3.0], [1.5, 5.0]]);
        let plot = lay_out(&chart(vec![bars]), 50.0, [400.0, 300.0]);
        assert_eq!(plot.base(), 300.0 - BOTTOM);
        let ends = [plot.position([0.0, 0.0])[0], plot.position([2.0, 0.0])[0]];
        assert_eq!(ends, [plot.left_top[0], plot.right_bottom[0]]);
    }

    #[test]
    fn charts_of_nothing_one_point_gaps_and_zeros_have_no_broken_numbers() {
        for style in [ChartStyle::Line, ChartStyle::Points, ChartStyle::Bars] {
            for points in
                [&[][..], &[[1.0, 2.0]], &[[0.0, f64::NAN], [1.0, 0.0], [2.0, 4.0]], &[[0.0, 0.0], [1.0, 0.0]]]
            {
                for logarithmic in [false, true] {
                    let mut chart = chart(vec![series(style, points), series(ChartStyle::Dashes, points)]);
                    (chart.x.logarithmic, chart.y.logarithmic) = (logarithmic, logarithmic);
                    chart.series[0].errors = vec![1.0; points.len()];
                    let text = plot(&chart, [300.0, 200.0]).inline();
                    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
                    assert!(text.contains("p = 0.43") && text.contains("measured"));
                }
            }
        }
    }
}
