//! Axes along the edges of a box.

use super::{Axes, LETTER, Page, Sheet, axis_unit};
use crate::{Camera, Stage};
use corpuscle_drawing::bars::label;
use corpuscle_drawing::svg::Anchor;
use corpuscle_drawing::ticks;

/// Length of a tick, distance of its number from the edge, and of the axis's name from the numbers, CSS pixels.
const TICK: f64 = 6.0;
const NUMBER: f64 = 18.0;
const NAME: f64 = 24.0;
/// From the upper end of an axis to its name above it.
const NAME_ABOVE: f64 = 16.0;
/// Space of a step between ticks at least, and steps at most.
const STEP: f64 = 46.0;
const MOST_STEPS: f64 = 8.0;

/// An axis as it lies on a page.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisOnPage {
    /// The edge that it runs along.
    pub line: [[f64; 2]; 2],
    /// Its ticks, each from the edge outwards, with its number and where that stands.
    pub ticks: Vec<([[f64; 2]; 2], [f64; 2], String)>,
    /// Its name with the unit, and where that stands.
    pub name: ([f64; 2], String),
    /// Which part of numbers and name stands there; their baseline is a little below.
    pub anchor: Anchor,
}

impl Axes {
    /// Draws the axes on the edges where they hide nothing.
    pub(super) fn draw(&self, page: &mut Page<'_>) {
        for axis in self.on_page(page.stage, page.camera, page.size) {
            page.svg.line(axis.line[0], axis.line[1], "over-line");
            for ([from, to], [x, y], number) in &axis.ticks {
                page.svg.line(*from, *to, "over-line");
                page.svg.text([*x, y + 4.0], axis.anchor, "over-number", number);
            }
            let ([x, y], name) = &axis.name;
            page.svg.text([*x, y + 4.0], axis.anchor, "over", name);
        }
    }

    /// The axes on a page of `size`, of which texts take some 12 units a line: on the edges where they hide nothing.
    pub fn on_page(&self, stage: &Stage, camera: &Camera, size: [f64; 2]) -> Vec<AxisOnPage> {
        let sheet = Sheet { stage, camera, size };
        let axes = (0..3).filter(|axis| self.to[*axis] > self.from[*axis]);
        axes.filter_map(|axis| self.axis_on_page(&sheet, axis)).collect()
    }

    fn axis_on_page(&self, page: &Sheet<'_>, axis: usize) -> Option<AxisOnPage> {
        let [start, end] = self.edge(page, axis)?;
        let [one, other] = [page.position(start)?, page.position(end)?];
        let middle = page.position(std::array::from_fn(|k| 0.5 * (self.from[k] + self.to[k])))?;
        let long = (other[0] - one[0]).hypot(other[1] - one[1]);
        if long < STEP {
            return None;
        }
        let out = outwards(one, other, middle, long);
        let longest = (0..3).map(|k| self.to[k] - self.from[k]).fold(0.0, f64::max);
        let (factor, unit) = axis_unit(longest, &self.unit);
        let factor = if axis == 2 { factor * self.heights } else { factor };
        let [low, high] = [self.from[axis] / factor, self.to[axis] / factor];
        let step = ticks::step(high - low, (long / STEP).min(MOST_STEPS) as usize);
        let mut widest = 0.0_f64;
        let mut on_edge = Vec::new();
        for value in ticks::multiples(low, high, step) {
            let mut point = start;
            point[axis] = value * factor;
            let Some(at) = page.position(point) else { continue };
            let away = |far: f64| [at[0] + far * out[0], at[1] + far * out[1]];
            let text = label(value, step);
            widest = widest.max(LETTER * text.chars().count() as f64);
            on_edge.push(([at, away(TICK)], away(NUMBER), text));
        }
        let name = ["x", "y", "z"][axis];
        let name = if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") };
        let away = NUMBER + NAME + if anchor(out) == Anchor::Middle { 0.0 } else { widest - 12.0 };
        let mut at: [f64; 2] = std::array::from_fn(|k| 0.5 * (one[k] + other[k]) + away * out[k]);
        let is_cut = at[0] - LETTER * name.chars().count() as f64 <= 0.0;
        if anchor(out) == Anchor::End && is_cut {
            // Beside the numbers there is no room: above the axis.
            let top = if one[1] < other[1] { one } else { other };
            at = [top[0], top[1] - NAME_ABOVE];
        }
        Some(AxisOnPage { line: [one, other], ticks: on_edge, name: (at, name), anchor: anchor(out) })
    }

    /// Ends of the edge for an axis: in the plane that at the bottom or on the left; in space on the bottom face the one nearer to
    /// the eye, and upright the one farthest left.
    fn edge(&self, page: &Sheet<'_>, axis: usize) -> Option<[[f64; 3]; 2]> {
        let flat = self.from[2] == self.to[2];
        let edges = (0..8_usize).filter(|bits| bits >> axis & 1 == 0).map(|bits| {
            let start: [f64; 3] = std::array::from_fn(|k| if bits >> k & 1 == 1 { self.to[k] } else { self.from[k] });
            let mut end = start;
            end[axis] = self.to[axis];
            [start, end]
        });
        let is_low = |edge: &[[f64; 3]; 2]| edge[0][2] == self.from[2];
        if flat {
            return edges.clone().find(|edge| edge[0] == self.from);
        }
        let left = |edge: &[[f64; 3]; 2]| page.position(edge[0]).map_or(f64::INFINITY, |position| position[0]);
        let below = |edge: &[[f64; 3]; 2]| {
            edge.iter().filter_map(|end| page.position(*end)).map(|position| position[1]).sum::<f64>()
        };
        match axis {
            2 => edges.min_by(|a, b| left(a).total_cmp(&left(b))),
            _ => edges.filter(is_low).max_by(|a, b| below(a).total_cmp(&below(b))),
        }
    }
}

/// The direction across an edge on the page, away from the middle of the box.
fn outwards(one: [f64; 2], other: [f64; 2], middle: [f64; 2], long: f64) -> [f64; 2] {
    let across = [(other[1] - one[1]) / long, (one[0] - other[0]) / long];
    let away = [0.5 * (one[0] + other[0]) - middle[0], 0.5 * (one[1] + other[1]) - middle[1]];
    let sign = if across[0] * away[0] + across[1] * away[1] < 0.0 { -1.0 } else { 1.0 };
    across.map(|component| sign * component)
}

fn anchor(out: [f64; 2]) -> Anchor {
    match out[0] {
        ..-0.5 => Anchor::End,
        0.5.. => Anchor::Start,
        _ => Anchor::Middle,
    }
}
