//! The sides of a flat box, pistons, and marks.

use super::{Border, LineStyle, Mark, Page};

/// Thickness of a piston, width of its rod, and how far that reaches beyond its length, CSS pixels.
const PISTON: f64 = 16.0;
const ROD: f64 = 9.0;
const GRIP: f64 = 10.0;
/// Radius of a mark at least, and the space between a ring and what is in it, CSS pixels.
const MARK: f64 = 4.5;
const RING: f64 = 2.0;

impl LineStyle {
    /// Its class in the style sheet.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Wall => "wall",
            Self::ThermalWall => "wall-hot",
            Self::Periodic => "wall-open",
            Self::Partition => "partition",
            Self::Region => "region-edge",
            Self::Trajectory => "trajectory",
        }
    }

    /// Half its width, CSS pixels: balls at a wall touch its inner edge.
    fn half_width(self) -> f64 {
        match self {
            Self::Wall => 1.5,
            Self::ThermalWall => 2.0,
            Self::Periodic | Self::Partition | Self::Region | Self::Trajectory => 0.0,
        }
    }
}

/// Draws them; lines last, over the ends of blocks.
pub(super) fn draw(page: &mut Page<'_>, borders: &[Border]) {
    for border in borders {
        if let Border::Piston { ends, outwards, rod } = border {
            draw_piston(page, *ends, *outwards, *rod);
        }
    }
    for border in borders {
        if let Border::Line { style, ends, outwards } = border {
            let Some(ends) = positions(page, *ends) else { continue };
            let moved = ends.map(|end| beyond(end, *outwards, style.half_width()));
            page.svg.line(moved[0], moved[1], style.class());
        }
    }
}

fn draw_piston(page: &mut Page<'_>, ends: [[f64; 2]; 2], outwards: [f64; 2], rod: f64) {
    let middle: [f64; 2] = std::array::from_fn(|k| 0.5 * (ends[0][k] + ends[1][k]));
    let tip = std::array::from_fn(|k| middle[k] + rod * outwards[k]);
    let (Some(ends), Some([middle, tip])) = (positions(page, ends), positions(page, [middle, tip])) else { return };
    let block = |[one, other]: [[f64; 2]; 2], depth: f64| {
        [one, other, beyond(other, outwards, depth), beyond(one, outwards, depth)]
    };
    let long = (tip[0] - middle[0]).hypot(tip[1] - middle[1]).max(PISTON) + GRIP;
    let aside = [0.5 * ROD * outwards[1], 0.5 * ROD * outwards[0]];
    let sides = [[middle[0] - aside[0], middle[1] - aside[1]], [middle[0] + aside[0], middle[1] + aside[1]]];
    page.svg.path(block(sides, long), true, "piston");
    page.svg.path(block(ends, PISTON), true, "piston");
}

/// Draws a mark.
pub(super) fn draw_mark(page: &mut Page<'_>, mark: &Mark) {
    match mark {
        Mark::Start(position) => {
            if let Some(position) = page.position(*position) {
                page.svg.circle(position, MARK, "trajectory-start");
            }
        }
        Mark::Ring(position, radius) => {
            let beside = [position[0] + radius, position[1], position[2]];
            if let (Some(position), Some(beside)) = (page.position(*position), page.position(beside)) {
                let radius = (beside[0] - position[0]).hypot(beside[1] - position[1]);
                page.svg.circle(position, (radius + RING).max(MARK), "trajectory-end");
            }
        }
    }
}

/// Two points, m, on the page.
fn positions(page: &Page<'_>, ends: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let [one, other] = ends.map(|[x, y]| page.position([x, y, 0.0]));
    Some([one?, other?])
}

/// A position on the page moved along a direction of the world, whose y is up.
fn beyond([x, y]: [f64; 2], [right, up]: [f64; 2], far: f64) -> [f64; 2] {
    [x + far * right, y - far * up]
}
