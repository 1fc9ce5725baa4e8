//! Walls: straight segments that no water passes, found near a position by a uniform grid.
//!
//! They are the outlines of obstacles, of ground without data, and lines of no thickness.

mod outlines;
mod overtopping;
mod roofs;
#[cfg(feature = "gpu")]
pub(super) mod upload;

pub(crate) use outlines::{no_data, of_lines, of_outlines, of_sides};
#[cfg(feature = "gpu")]
pub(crate) use overtopping::{MAX_CREST_SHARE, coefficient as crest_coefficient};
pub(crate) use overtopping::{OverCrest, crests, overtop};
pub(crate) use roofs::{areas, collect};

use corpuscle_terrain::Bounds;
use std::collections::HashMap;

/// A straight wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    /// m.
    pub ends: [[f64; 2]; 2],
    pub kind: WallKind,
    /// Levels of its crest at both ends, m, over which water flows; infinite where none does.
    pub crest: [f64; 2],
}

/// What a wall belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WallKind {
    /// Ground without data, and what is neither of the others.
    Plain,
    /// The obstacle with a number.
    Obstacle(u32),
    /// The line inside the terrain with a number, at which water enters or leaves on its right.
    Side(u32),
}

/// All walls within a rectangle.
#[derive(Debug, Default)]
pub(crate) struct Walls {
    pub all: Vec<Wall>,
    /// Size of a cell of the grid, m.
    size: f64,
    low: [f64; 2],
    /// Walls that touch each cell of the grid.
    near: HashMap<[i64; 2], Vec<u32>>,
}

impl Walls {
    /// The parts of walls within `bounds`, found by a grid with cells of `size` m.
    pub fn new(walls: impl IntoIterator<Item = Wall>, bounds: Bounds, size: f64) -> Self {
        let mut new = Self { size, low: [bounds.x_min, bounds.y_min], ..Self::default() };
        for wall in walls.into_iter().filter_map(|wall| clipped(wall, bounds)) {
            let number = new.all.len() as u32;
            new.all.push(wall);
            let [a, b] = wall.ends;
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let parts = (length / size).ceil().max(1.0) as usize;
            let at = |part: usize| [0, 1].map(|axis| a[axis] + part as f64 / parts as f64 * (b[axis] - a[axis]));
            for part in 0..parts {
                let [from, to] = [at(part), at(part + 1)].map(|end| new.bin(end));
                for row in from[1].min(to[1])..=from[1].max(to[1]) {
                    for column in from[0].min(to[0])..=from[0].max(to[0]) {
                        let list = new.near.entry([column, row]).or_default();
                        if list.last() != Some(&number) {
                            list.push(number);
                        }
                    }
                }
            }
        }
        new
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn bin(&self, at: [f64; 2]) -> [i64; 2] {
        [0, 1].map(|axis| ((at[axis] - self.low[axis]) / self.size).floor() as i64)
    }

    /// The walls that may touch a rectangle, in the order of their numbers.
    pub fn near(&self, low: [f64; 2], high: [f64; 2], found: &mut Vec<u32>) {
        found.clear();
        let [from, to] = [low, high].map(|corner| self.bin(corner));
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                found.extend(self.near.get(&[column, row]).into_iter().flatten());
            }
        }
        found.sort_unstable();
        found.dedup();
    }

    /// Distance of the nearest wall from a position, m; infinite where it is more than `farthest`.
    pub fn distance(&self, at: [f64; 2], farthest: f64) -> f64 {
        let mut near = Vec::new();
        self.near(at.map(|x| x - farthest), at.map(|x| x + farthest), &mut near);
        let distances = near.iter().map(|wall| self.all[*wall as usize].distance(at));
        let nearest = distances.fold(f64::INFINITY, f64::min);
        if nearest <= farthest { nearest } else { f64::INFINITY }
    }

    /// Rectangles, as their south-west and north-east corners, that hold all walls together.
    pub fn boxes(&self) -> Vec<[[f64; 2]; 2]> {
        let corner = |bin: &[i64; 2]| [0, 1].map(|axis| self.low[axis] + bin[axis] as f64 * self.size);
        let mut bins: Vec<&[i64; 2]> = self.near.keys().collect();
        bins.sort_unstable();
        bins.into_iter().map(|bin| [corner(bin), corner(bin).map(|x| x + self.size)]).collect()
    }
}

impl Wall {
    /// Level of the crest at a position beside it, m.
    pub fn crest_at(&self, at: [f64; 2]) -> f64 {
        self.crest[0] + self.nearest(at) * (self.crest[1] - self.crest[0])
    }

    /// Distance from a position, m.
    fn distance(&self, at: [f64; 2]) -> f64 {
        let ([a, b], part) = (self.ends, self.nearest(at));
        let [dx, dy] = [0, 1].map(|axis| a[axis] + part * (b[axis] - a[axis]) - at[axis]);
        dx.hypot(dy)
    }

    /// How far along it the point nearest to a position is: 0 at the first end, 1 at the second.
    fn nearest(&self, at: [f64; 2]) -> f64 {
        let [a, b] = self.ends;
        let along = [b[0] - a[0], b[1] - a[1]];
        let squared = along[0] * along[0] + along[1] * along[1];
        (((at[0] - a[0]) * along[0] + (at[1] - a[1]) * along[1]) / squared).clamp(0.0, 1.0)
    }
}

/// The part of a wall inside a rectangle.
fn clipped(wall: Wall, bounds: Bounds) -> Option<Wall> {
    let [a, b] = wall.ends;
    if !a.iter().chain(&b).all(|x| x.is_finite()) || a == b {
        return None;
    }
    let (low, high) = ([bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]);
    let [mut from, mut to] = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        for (start, end) in [(a[axis] - low[axis], b[axis] - low[axis]), (high[axis] - a[axis], high[axis] - b[axis])] {
            if start < 0.0 && end < 0.0 {
                return None;
            }
            if start < 0.0 {
                from = from.max(start / (start - end));
            } else if end < 0.0 {
                to = to.min(start / (start - end));
            }
        }
    }
    if from >= to {
        return None;
    }
    let at = |part: f64| [0, 1].map(|axis| a[axis] + part * (b[axis] - a[axis]));
    let [first, last] = wall.crest;
    // Where a crest is infinite a difference would not be finite.
    let crest = |part: f64| if first == last { first } else { first + part * (last - first) };
    let ends = [if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }];
    Some(Wall { ends, crest: [crest(from), crest(to)], ..wall })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_are_cut_off_at_the_sides_and_found_near_them() {
        let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 5.0 };
        let wall = |a, b| Wall { ends: [a, b], kind: WallKind::Obstacle(0), crest: [1.0, 2.0] };
        let walls = [wall([-5.0, 2.0], [15.0, 2.0]), wall([3.0, 6.0], [9.0, 6.0]), wall([4.0, 4.0], [4.0, 4.0])];
        let walls = Walls::new(walls, bounds, 1.0);
        assert_eq!(
            walls.all,
            [Wall { ends: [[0.0, 2.0], [10.0, 2.0]], kind: WallKind::Obstacle(0), crest: [1.25, 1.75] }]
        );
        let mut found = Vec::new();
        walls.near([6.2, 1.5], [6.4, 2.5], &mut found);
        assert_eq!(found, [0]);
        walls.near([6.2, 3.5], [6.4, 4.5], &mut found);
        assert!(found.is_empty());
    }
}
