//! Charts of quantities over time.

use super::svg::{Anchor, Figure, Svg};
use super::text::number;
use super::ticks::{self, TimeUnit};

/// More points than this are thinned out, keeping the extremes.
const MOST_POINTS: usize = 700;

/// A quantity over time.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    /// Name in the legend.
    pub name: String,
    /// Time, s, and value; not-a-number leaves a gap.
    pub points: Vec<[f64; 2]>,
    /// Number of its colour.
    pub colour: usize,
    /// True to tint the area below.
    pub filled: bool,
}

impl Series {
    /// Time, s, and value of the largest value, the first of equal ones; none where nothing was measured.
    pub(crate) fn peak(&self) -> Option<[f64; 2]> {
        let finite = self.points.iter().copied().filter(|point| point[1].is_finite());
        finite.reduce(|best, point| if point[1] > best[1] { point } else { best })
    }
}

/// Quantities of one unit over the time of a run.
#[derive(Debug, Clone)]
pub(crate) struct Chart {
    /// What is shown.
    pub title: String,
    /// A remark beside the title.
    pub remark: String,
    /// Quantity and unit along the vertical axis; may be empty.
    pub unit: String,
    /// Width and height, CSS pixels.
    pub size: [f64; 2],
    /// First and last time, s.
    pub span: [f64; 2],
    /// Unit of the time axis.
    pub time_unit: TimeUnit,
    /// True to name the time axis.
    pub time_named: bool,
    /// The lines.
    pub series: Vec<Series>,
    /// Time, s, up to which the lines are drawn in full, with a mark there; none for all of them.
    pub now: Option<f64>,
}

/// Space left of the plot at least.
const LEFT: f64 = 48.0;
const RIGHT: f64 = 14.0;
const BOTTOM: f64 = 34.0;
/// Width of a letter of a legend, about.
pub(super) const SPACE_OF_LETTER: f64 = 6.6;
/// Height of a step of the vertical axis at least.
const SPACE_OF_STEP: f64 = 23.0;
/// Steps below this have their power of ten written out.
const LEAST_PLAIN_STEP: f64 = 1e-4;

/// Where values lie on the page.
struct Axes {
    unit: TimeUnit,
    span: [f64; 2],
    range: [f64; 2],
    step: f64,
    left_top: [f64; 2],
    right_bottom: [f64; 2],
}

impl Axes {
    fn position(&self, [time, value]: [f64; 2]) -> [f64; 2] {
        let part = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        let ([left, top], [right, bottom]) = (self.left_top, self.right_bottom);
        [left + part(time, self.span) * (right - left), bottom - part(value, self.range) * (bottom - top)]
    }
}

impl Chart {
    /// The chart as a figure.
    pub(crate) fn figure(&self) -> Figure {
        let mut svg = Svg::default();
        svg.text([0.0, 16.0], Anchor::Start, "title", &self.title);
        svg.text([self.size[0] - RIGHT, 16.0], Anchor::End, "small", &self.remark);
        let top = self.draw_legend(&mut svg);
        let axes = self.axes(top);
        draw_axes(&mut svg, &axes, self.time_named);
        for series in &self.series {
            match self.now {
                Some(now) => draw_until(&mut svg, &axes, series, now),
                None => draw_series(&mut svg, &axes, series),
            }
        }
        if let ([only], None) = (self.series.as_slice(), self.now) {
            draw_peak(&mut svg, &axes, only);
        }
        svg.finish(self.size, &format!("Chart: {}, {}", self.title, self.unit))
    }

    /// Names of the lines, where there is more than one, and the unit. Gives the top of the plot.
    fn draw_legend(&self, svg: &mut Svg) -> f64 {
        let mut baseline = if self.title.is_empty() { 16.0 } else { 34.0 };
        svg.text([0.0, baseline], Anchor::Start, "small", &self.unit);
        if self.series.len() < 2 {
            return baseline + 12.0;
        }
        let start = 16.0 + self.unit.chars().count() as f64 * SPACE_OF_LETTER;
        let mut x = start;
        for series in &self.series {
            let width = 34.0 + series.name.chars().count() as f64 * SPACE_OF_LETTER;
            if x + width > self.size[0] && x > start {
                x = start;
                baseline += 17.0;
            }
            svg.line([x, baseline - 4.0], [x + 16.0, baseline - 4.0], &format!("series s{}", series.colour % 6));
            svg.text([x + 21.0, baseline], Anchor::Start, "text", &series.name);
            x += width;
        }
        baseline + 12.0
    }

    fn axes(&self, top: f64) -> Axes {
        let values = || self.series.iter().flat_map(|series| &series.points).map(|point| point[1]);
        let finite = || values().filter(|value| value.is_finite());
        let low = finite().fold(0.0, f64::min);
        let high = finite().fold(0.0, f64::max);
        let span = if high > low { high - low } else { 1.0 };
        let bottom = if self.time_named { BOTTOM } else { BOTTOM - 12.0 };
        let most = ((self.size[1] - top - bottom) / SPACE_OF_STEP).max(2.0) as usize;
        let step = ticks::step(span, most);
        // A value on a tick but for rounding needs no further step.
        let slack = 1e-9 * span / step;
        let range = [(low / step + slack).floor() * step, ((low + span) / step - slack).ceil() * step];
        let longest = range.map(|value| value_label(value, step).chars().count() as f64 * SPACE_OF_LETTER);
        let left = LEFT.max(longest[0].max(longest[1]) + 12.0);
        let [from, to] = self.span;
        Axes {
            unit: self.time_unit,
            span: [from, if to > from { to } else { from + 1.0 }],
            range,
            step,
            left_top: [left, top],
            right_bottom: [self.size[0] - RIGHT, self.size[1] - bottom],
        }
    }
}

fn draw_axes(svg: &mut Svg, axes: &Axes, time_named: bool) {
    let ([left, top], [right, bottom]) = (axes.left_top, axes.right_bottom);
    for value in ticks::multiples(axes.range[0], axes.range[1], axes.step) {
        let [_, y] = axes.position([axes.span[0], value]);
        svg.line([left, y], [right, y], if value == 0.0 { "axis" } else { "grid" });
        svg.text([left - 7.0, y + 4.0], Anchor::End, "number", &value_label(value, axes.step));
    }
    let seconds = axes.unit.seconds;
    let [from, to] = axes.span.map(|time| time / seconds);
    let step = axes.unit.step(to - from, ((right - left) / 62.0).max(2.0) as usize);
    let times = ticks::multiples(from, to, step);
    for time in &times {
        let [x, _] = axes.position([time * seconds, axes.range[0]]);
        svg.line([x, bottom], [x, bottom + 4.0], "axis");
        svg.text([x, bottom + 17.0], Anchor::Middle, "number", &ticks::label(*time, step));
    }
    svg.line([left, bottom], [right, bottom], "axis");
    if time_named {
        svg.text([right, bottom + 31.0], Anchor::End, "small", &time_label(axes.unit));
    }
    svg.line([left, top], [left, bottom], "grid");
}

/// The name of the time axis.
fn time_label(unit: TimeUnit) -> String {
    if unit.name.is_empty() { "time".into() } else { format!("time, {}", unit.name) }
}

/// A value on an axis, with thousands grouped.
fn value_label(value: f64, step: f64) -> String {
    let plain = value.abs() < 1000.0 && (step >= LEAST_PLAIN_STEP || value == 0.0);
    if plain { ticks::label(value, if value == 0.0 { 1.0 } else { step }) } else { number(value) }
}

fn draw_series(svg: &mut Svg, axes: &Axes, series: &Series) {
    let points = thinned(&series.points);
    let positions = || points.iter().map(|point| axes.position(*point));
    if series.filled {
        for run in points.split(|point| !point[1].is_finite()).filter(|run| run.len() > 1) {
            let base = |point: &[f64; 2]| axes.position([point[0], 0.0]);
            let edge = run.iter().map(|point| axes.position(*point));
            let outline = std::iter::once(base(&run[0])).chain(edge).chain([base(&run[run.len() - 1])]);
            svg.path(outline, true, &format!("area a{}", series.colour % 6));
        }
    }
    svg.path(positions(), false, &format!("series s{}", series.colour % 6));
    if let [only] = points.as_slice() {
        svg.circle(axes.position(*only), 3.0, &format!("peak s{}", series.colour % 6));
    }
}

/// Draws a series up to a time, s, with a mark there, and the rest of it pale.
fn draw_until(svg: &mut Svg, axes: &Axes, series: &Series, now: f64) {
    let class = format!("series s{}", series.colour % 6);
    let positions = thinned(&series.points).into_iter().map(|point| axes.position(point));
    svg.styled_path(positions, false, &class, "stroke-opacity:0.3");
    let so_far = series.points[..series.points.partition_point(|point| point[0] <= now)].to_vec();
    let last = so_far.last().copied().filter(|point| point[1].is_finite());
    draw_series(svg, axes, &Series { points: so_far, ..series.clone() });
    if let Some(last) = last {
        svg.circle(axes.position(last), 3.5, &format!("peak s{}", series.colour % 6));
    }
}

fn draw_peak(svg: &mut Svg, axes: &Axes, series: &Series) {
    let Some(peak) = series.peak().filter(|peak| peak[1] > 0.0) else { return };
    svg.circle(axes.position(peak), 3.2, &format!("peak s{}", series.colour % 6));
}

/// At most about [`MOST_POINTS`] points: of each stretch the first, lowest and highest, and the last of all.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 3);
    let mut kept = Vec::with_capacity(MOST_POINTS + 3);
    for (number, part) in points.chunks(stretch).enumerate() {
        let by_value = |a: &usize, b: &usize| part[*a][1].total_cmp(&part[*b][1]);
        let lowest = (0..part.len()).min_by(by_value).unwrap_or(0);
        let highest = (0..part.len()).max_by(by_value).unwrap_or(0);
        let last = if (number + 1) * stretch >= points.len() { part.len() - 1 } else { 0 };
        let mut chosen = [0, lowest, highest, last];
        chosen.sort_unstable();
        kept.extend(
            chosen
                .iter()
                .enumerate()
                .filter(|(at, index)| *at == 0 || chosen[at - 1] != **index)
                .map(|(_, index)| part[*index]),
        );
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        let series = Series { name: "G1".into(), points, colour: 0, filled: true };
        Chart {
            title: "Depth".into(),
            remark: String::new(),
            unit: "m".into(),
            size: [300.0, 160.0],
            span: [0.0, 3600.0],
            time_unit: TimeUnit::of(3600.0),
            time_named: true,
            series: vec![series],
            now: None,
        }
    }

    #[test]
    fn a_chart_until_now_keeps_its_axes_and_marks_the_time() {
        let points: Vec<[f64; 2]> = (0..=36).map(|i| [100.0 * f64::from(i), f64::from(i)]).collect();
        let whole = chart(points.clone());
        let until = |now| Chart { now: Some(now), ..chart(points.clone()) };
        assert_eq!(whole.axes(40.0).range, until(500.0).axes(40.0).range);
        let [early, late] = [500.0, 2500.0].map(|now| until(now).figure().inline());
        assert_ne!(early, late);
        assert!(early.contains("stroke-opacity") && early.matches("<circle").count() == 1, "{early}");
        assert!(!until(-1.0).figure().inline().contains("<circle"), "before the first row there is no value");
    }

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let mut points: Vec<[f64; 2]> = (0..10_000).map(|i| [i as f64, (i as f64 * 0.01).sin()]).collect();
        points[5003][1] = 9.0;
        let kept = thinned(&points);
        assert!(kept.len() < 1000);
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[9999]));
        assert!(kept.contains(&[5003.0, 9.0]));
        assert!(kept.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    }

    #[test]
    fn charts_of_nothing_one_point_and_gaps_have_no_broken_numbers() {
        for points in
            [vec![], vec![[0.0, 1.0]], vec![[0.0, f64::NAN], [1.0, 2.0], [2.0, f64::NAN]], vec![[0.0, 0.0]; 3]]
        {
            let text = chart(points).figure().inline();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }

    #[test]
    fn axes_end_near_the_values_and_tiny_values_have_labels() {
        for (largest, top) in [(9.97, 10.0), (4.48, 6.0), (12_000.0, 15_000.0), (6e-16, 6e-16)] {
            let axes = chart(vec![[0.0, 0.0], [3600.0, largest]]).axes(40.0);
            assert!((axes.range[1] / top - 1.0).abs() < 1e-9, "{largest}: {:?}", axes.range);
        }
        let text = chart(vec![[0.0, 0.0], [3600.0, 6e-16]]).figure().inline();
        assert!(text.contains("4.0\u{2009}×\u{2009}10⁻¹⁶") && !text.contains("0.0000"), "{text}");
    }

    #[test]
    fn values_lie_between_the_axes() {
        let axes = chart(vec![[0.0, -1.0], [3600.0, 3.7]]).axes(40.0);
        assert!(axes.range[0] <= -1.0 && axes.range[1] >= 3.7);
        assert_eq!(axes.position([0.0, axes.range[0]]), [LEFT, 160.0 - BOTTOM]);
        assert_eq!(axes.position([3600.0, axes.range[1]]), [300.0 - RIGHT, 40.0]);
    }
}
