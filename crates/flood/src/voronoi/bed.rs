//! The bed of the cells.

use super::mesh::{Ground, SOLID};
use super::storage::{self, Heights};
use super::walls::{Wall, Walls, no_data, of_outlines};
use crate::obstacles::Outlines;
use corpuscle_scene::Storage;
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

/// Samples along a side at which the ground is compared with that on the joined side.
const SIDE_SAMPLES: usize = 64;

/// Tolerance, as a part of the range of heights, within which ground on joined sides differs by a constant and is continued beyond them.
const SIDE_TOLERANCE: f64 = 1e-6;

/// Size of a cell of the grid by which walls are found, in spacings.
const WALL_GRID_CELL: f64 = 2.0;

/// Terrain, holes in it, and obstacles.
pub(crate) struct Bed {
    pub terrain: Arc<Terrain>,
    pub obstacles: Arc<Outlines>,
    walls: Walls,
    mirrors: [bool; 4],
    periodic: [bool; 2],
    lift: [f64; 2],
    storage: Storage,
}

impl Bed {
    /// Ground for cells about `spacing` m wide, with `lines` that are walls.
    pub fn new(
        terrain: Arc<Terrain>,
        obstacles: Arc<Outlines>,
        mirrors: [bool; 4],
        periodic: [bool; 2],
        lines: Vec<Wall>,
        spacing: f64,
        storage: Storage,
    ) -> Self {
        let walls = of_outlines(&obstacles.all).chain(no_data(&terrain)).chain(lines);
        let walls = Walls::new(walls, terrain.bounds(), WALL_GRID_CELL * spacing);
        let lift = [0, 1].map(|axis| if periodic[axis] { lift(&terrain, axis) } else { 0.0 });
        Self { terrain, obstacles, walls, mirrors, periodic, lift, storage }
    }

    /// Height of the ground at a position, beyond joined sides too, m.
    fn height(&self, mut at: [f64; 2]) -> f64 {
        let bounds = self.terrain.bounds();
        let (low, size) = ([bounds.x_min, bounds.y_min], bounds.size());
        let mut lift = 0.0;
        for axis in (0..2).filter(|axis| self.periodic[*axis]) {
            let sides = ((at[axis] - low[axis]) / size[axis]).floor();
            at[axis] -= sides * size[axis];
            lift += sides * self.lift[axis];
        }
        self.terrain.height(at[0], at[1]) + lift
    }

    /// Integral of the height over a convex polygon, m3, and its area, m2. What lies beyond a joined side is the ground inside the opposite side, from
    /// axis number `axis` on.
    fn integral(&self, polygon: &[[f64; 2]], axis: usize) -> [f64; 2] {
        if axis == 2 {
            let area = area(polygon);
            return if area > 0.0 { [area * self.terrain.mean_over(polygon), area] } else { [0.0; 2] };
        }
        let Bounds { x_min, x_max, y_min, y_max } = self.terrain.bounds();
        let [low, high] = [[x_min, x_max], [y_min, y_max]][axis];
        if !self.periodic[axis] || polygon.iter().all(|corner| (low..=high).contains(&corner[axis])) {
            return self.integral(polygon, axis + 1);
        }
        let [below, rest] = cut(polygon, axis, low);
        let [within, above] = cut(&rest, axis, high);
        let mut sum = [0.0; 2];
        for (mut part, sides) in [(below, -1.0), (within, 0.0), (above, 1.0)] {
            part.iter_mut().for_each(|corner| corner[axis] -= sides * (high - low));
            let [integral, area] = self.integral(&part, axis + 1);
            sum = [sum[0] + integral + sides * self.lift[axis] * area, sum[1] + area];
        }
        sum
    }
}

/// The parts of a convex polygon below and above a coordinate.
fn cut(polygon: &[[f64; 2]], axis: usize, at: f64) -> [Vec<[f64; 2]>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    for (k, &corner) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        let side = usize::from(corner[axis] > at);
        parts[side].push(corner);
        if side != usize::from(next[axis] > at) {
            let share = (at - corner[axis]) / (next[axis] - corner[axis]);
            let mut crossing = [0, 1].map(|k| corner[k] + share * (next[k] - corner[k]));
            crossing[axis] = at;
            parts.iter_mut().for_each(|part| part.push(crossing));
        }
    }
    parts
}

/// Area of a polygon with corners in counter-clockwise order, m2.
fn area(polygon: &[[f64; 2]]) -> f64 {
    let Some(&origin) = polygon.first() else { return 0.0 };
    let from = |corner: [f64; 2]| [corner[0] - origin[0], corner[1] - origin[1]];
    let triangles = polygon.windows(2).map(|side| (from(side[0]), from(side[1])));
    triangles.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

impl Ground for Bed {
    fn mean(&self, polygon: &[[f64; 2]]) -> f64 {
        if self.periodic == [false; 2] {
            return self.terrain.mean_over(polygon);
        }
        let [integral, area] = self.integral(polygon, 0);
        if area > 0.0 { integral / area } else { self.terrain.mean_over(polygon) }
    }

    fn heights(&self, polygons: &[Vec<[f64; 2]>], mean: f64) -> Option<Heights> {
        (self.storage == Storage::LevelVolume).then(|| storage::heights(polygons, mean, |at| self.height(at)))
    }

    fn is_there(&self, at: [f64; 2]) -> bool {
        self.terrain.has_data_at(at[0], at[1]) && !self.obstacles.hold(at)
    }

    fn mirrors(&self, border: u8) -> bool {
        border == SOLID || self.mirrors.get(usize::from(border)).is_some_and(|mirrors| *mirrors)
    }

    fn lift(&self) -> [f64; 2] {
        self.lift
    }

    fn walls(&self) -> Option<&Walls> {
        Some(&self.walls)
    }
}

/// By how much the ground on the east (north) side stands higher than on the west (south) side: the same all along, or 0. So a slope between
/// joined sides goes on for ever.
fn lift(terrain: &Terrain, axis: usize) -> f64 {
    let Bounds { x_min, x_max, y_min, y_max } = terrain.bounds();
    let [low, high, from, to] = if axis == 0 { [x_min, x_max, y_min, y_max] } else { [y_min, y_max, x_min, x_max] };
    let height = |across: f64, part: usize| {
        let along = from + (part as f64 + 0.5) / SIDE_SAMPLES as f64 * (to - from);
        if axis == 0 { terrain.height(across, along) } else { terrain.height(along, across) }
    };
    let lifts: Vec<f64> = (0..SIDE_SAMPLES).map(|part| height(high, part) - height(low, part)).collect();
    let [least, most] = [f64::min, f64::max].map(|of| lifts.iter().copied().reduce(of).unwrap_or(0.0));
    let scale = lifts.iter().fold(0.0_f64, |scale, lift| scale.max(lift.abs()));
    if most - least <= SIDE_TOLERANCE * scale { 0.5 * (least + most) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ground that is continued beyond both pairs of joined sides: on a slope, with waves.
    #[test]
    fn ground_goes_on_beyond_joined_sides() {
        let bounds = Bounds { x_min: 0.0, x_max: 20.0, y_min: -5.0, y_max: 5.0 };
        let height = |x: f64, y: f64| -0.3 * x + (0.2 * std::f64::consts::PI * y).sin();
        let terrain = Arc::new(Terrain::analytic(bounds, 1.0, move |x, y| (height(x, y), [0.0; 2])));
        let wide = Bounds { x_min: -20.0, x_max: 40.0, y_min: -15.0, y_max: 15.0 };
        let endless = Terrain::analytic(wide, 1.0, move |x, y| (height(x, y), [0.0; 2]));
        let obstacles = Arc::new(Outlines::default());
        let bed = Bed::new(terrain, obstacles, [false; 4], [true; 2], Vec::new(), 1.0, Storage::Mean);
        for [x, y] in [[7.0, 0.0], [19.8, 1.0], [0.1, -4.9], [20.0, 5.0], [-0.2, 5.1]] {
            let corners = [[-0.6, -0.5], [0.7, -0.4], [0.5, 0.6], [-0.3, 0.7]].map(|[a, b]| [x + a, y + b]);
            let [found, exact] = [bed.mean(&corners), endless.mean_over(&corners)];
            assert!((found - exact).abs() < 1e-8, "{x} {y}: {found} {exact}");
            assert!((bed.height([x, y]) - endless.height(x, y)).abs() < 1e-8, "{x} {y}");
        }
    }
}
