//! Ray marching of solids by their signed distances (sphere tracing, Hart 1996).

use super::view::{Vector, View, along, normalised};
use corpuscle_model::SolidShape;
use rayon::prelude::*;

/// Most steps of a ray; one without a hit by then passes close by.
const MOST_STEPS: u32 = 120;

/// Distance of a hit, pixels.
const MET: f64 = 0.1;

/// The hit of a pixel's ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// The solid; none where there is no hit.
    pub solid: Option<usize>,
    pub position: Vector,
    pub normal: Vector,
    /// Depth along the view, m.
    pub depth: f64,
    /// Part of the pixel that the solid covers.
    pub cover: f64,
}

const NOTHING: Hit = Hit { solid: None, position: [0.0; 3], normal: [0.0; 3], depth: f64::INFINITY, cover: 0.0 };

/// Pixels over a part of the view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Screen {
    pub view: View,
    /// The view's coordinates of the corner at the left and top, m.
    pub corner: [f64; 2],
    /// Side of a pixel, m.
    pub pixel: f64,
    pub width: usize,
    pub height: usize,
}

impl Screen {
    /// The view's coordinates of the middle of a pixel.
    fn at(&self, column: usize, row: usize) -> [f64; 2] {
        [self.corner[0] + (column as f64 + 0.5) * self.pixel, self.corner[1] - (row as f64 + 0.5) * self.pixel]
    }

    /// Column and row, with their parts, of a position in the view.
    pub(super) fn pixel_of(&self, position: Vector) -> [f64; 2] {
        [(position[0] - self.corner[0]) / self.pixel, (self.corner[1] - position[1]) / self.pixel]
    }

    /// What each pixel shows, row by row. Of solids only what is in `room` is seen.
    pub(super) fn trace(&self, solids: &[SolidShape], room: [Vector; 2]) -> Vec<Hit> {
        let boxes: Vec<[Vector; 2]> = solids.iter().map(|solid| common(solid.bounds, room)).collect();
        let shown: Vec<[Vector; 2]> = boxes.iter().map(|bounds| self.view.around(*bounds)).collect();
        let pixels = (0..self.width * self.height).into_par_iter().with_min_len(256);
        let hit = |number: usize| {
            let [x, y] = self.at(number % self.width, number / self.width);
            let seen = |solid: &usize| {
                let [from, to] = shown[*solid];
                let near = |value: f64, axis: usize| value > from[axis] - self.pixel && value < to[axis] + self.pixel;
                near(x, 0) && near(y, 1)
            };
            let hits = (0..solids.len()).filter(seen).map(|solid| {
                let depths = [shown[solid][0][2], shown[solid][1][2]];
                Hit { solid: Some(solid), ..self.meet(&solids[solid], boxes[solid], [x, y], depths) }
            });
            hits.filter(|hit| hit.cover > 0.0).fold(NOTHING, nearer)
        };
        pixels.map(hit).collect()
    }

    fn meet(&self, solid: &SolidShape, bounds: [Vector; 2], [x, y]: [f64; 2], depths: [f64; 2]) -> Hit {
        let start = self.view.point([x, y, depths[0] - self.pixel]);
        let Some([enter, leave]) = through(start, self.view.ahead, bounds, self.pixel) else { return NOTHING };
        let mut way = enter;
        let mut nearest = f64::INFINITY;
        for step in 0..MOST_STEPS {
            let position = along(start, self.view.ahead, way);
            let distance = (solid.distance)(position);
            if distance < MET * self.pixel {
                // A solid that goes on beyond the room is cut there, and seen as it faces the eye.
                let is_cut = step == 0 && distance < -self.pixel;
                let normal = if is_cut { self.view.ahead.map(|x| -x) } else { self.slope(solid, position) };
                return Hit { solid: None, position, normal, depth: depths[0] - self.pixel + way, cover: 1.0 };
            }
            if distance < nearest {
                nearest = distance;
            }
            way += distance;
            if way > leave {
                break;
            }
        }
        let cover = (0.5 - nearest / self.pixel).max(0.0);
        let position = along(start, self.view.ahead, way.min(leave));
        Hit { solid: None, position, normal: self.slope(solid, position), depth: depths[0] + way.min(leave), cover }
    }

    /// The outward normal of a solid near its surface, by differences.
    fn slope(&self, solid: &SolidShape, position: Vector) -> Vector {
        let step = 0.5 * self.pixel;
        let slope: Vector = std::array::from_fn(|axis| {
            let [mut before, mut after] = [position; 2];
            before[axis] -= step;
            after[axis] += step;
            (solid.distance)(after) - (solid.distance)(before)
        });
        if slope == [0.0; 3] { self.view.ahead.map(|x| -x) } else { normalised(slope) }
    }
}

/// Of two that a pixel shows the nearer; one that covers only a part of it is before the other.
fn nearer(one: Hit, other: Hit) -> Hit {
    let is_before =
        if one.cover < 1.0 || other.cover < 1.0 { other.cover > one.cover } else { other.depth < one.depth };
    if is_before { other } else { one }
}

fn common(a: [Vector; 2], b: [Vector; 2]) -> [Vector; 2] {
    [std::array::from_fn(|k| a[0][k].max(b[0][k])), std::array::from_fn(|k| a[1][k].min(b[1][k]))]
}

/// Where a ray enters and leaves a box made larger by `margin`.
fn through(start: Vector, direction: Vector, [from, to]: [Vector; 2], margin: f64) -> Option<[f64; 2]> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = [from[axis] - margin, to[axis] + margin];
        if direction[axis].abs() < 1e-12 {
            if start[axis] < low || start[axis] > high {
                return None;
            }
            continue;
        }
        let ends = [low, high].map(|end| (end - start[axis]) / direction[axis]);
        enter = enter.max(ends[0].min(ends[1]));
        leave = leave.min(ends[0].max(ends[1]));
    }
    (enter < leave).then_some([enter, leave])
}
