//! What old and new cells have in common.

use super::super::bed::Bed;
use super::super::mesh::{Ground, Mesh, NONE, area};
use super::super::start::Clip;
use super::super::storage::{self, Heights};
use std::collections::HashMap;
use std::sync::OnceLock;

/// Pieces smaller than this part of a cell are left out: polygons that touch.
const SMALLEST: f64 = 1e-12;

/// Convex polygons, corners in counter-clockwise order, m.
type Polygons = Vec<Vec<[f64; 2]>>;

/// What an old and a new cell have in common.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// The new cell.
    pub cell: u32,
    /// m2.
    pub area: f64,
    /// From the old cell's centroid to that of the piece, m.
    pub from_centroid: [f64; 2],
    /// Mean height of its ground above that of the old cell, m.
    pub bed: f64,
    /// Heights of its parts above that mean; none where the mean alone counts.
    heights: Option<Heights>,
}

impl Piece {
    /// Water in it below a level above the old cell's mean ground, m, spread over all of it, m.
    pub fn depth_below(&self, level: f64) -> f64 {
        match &self.heights {
            None => (level - self.bed).max(0.0),
            Some(heights) => storage::depth(heights, level - self.bed),
        }
    }

    /// Part of it that is under water at a level.
    pub fn wet_share(&self, level: f64) -> f64 {
        let is_wet = |ground: f64| f64::from(u8::from(level - self.bed > ground));
        self.heights.as_ref().map_or_else(|| is_wet(0.0), |heights| storage::mean_of(heights, is_wet))
    }

    /// The highest of its ground above the old cell's mean ground, m.
    pub fn top(&self) -> f64 {
        let highest = self.heights.as_ref().map_or(0.0, |heights| {
            heights.iter().fold(0.0_f64, |highest, height| highest.max(2.0 * f64::from(height.abs())))
        });
        self.bed + highest
    }
}

/// Old and new cells.
pub(super) struct Overlap<'a> {
    old: &'a Mesh,
    new: &'a Mesh,
    bed: &'a Bed,
    /// The new cell that each old one is still, to the bit; [`NONE`] where there is none.
    pub same: Vec<u32>,
    /// Polygons of the new cells, made on first use.
    polygons: Vec<OnceLock<Polygons>>,
}

impl<'a> Overlap<'a> {
    pub fn new(old: &'a Mesh, new: &'a Mesh, bed: &'a Bed) -> Self {
        let key = |mesh: &Mesh, cell: usize| {
            let [x, y] = mesh.centroid[cell].map(f64::to_bits);
            (x, y, mesh.area[cell].to_bits())
        };
        let of_new: HashMap<_, _> = (0..new.len()).map(|cell| (key(new, cell), cell as u32)).collect();
        let same = (0..old.len()).map(|cell| of_new.get(&key(old, cell)).copied().unwrap_or(NONE)).collect();
        Self { old, new, bed, same, polygons: vec![OnceLock::new(); new.len()] }
    }

    /// The pieces of an old cell, in the order of the new cells. Together they have its area, but for rounding.
    pub fn pieces(&self, cell: usize) -> Vec<Piece> {
        let mut parts = Vec::new();
        self.old.parts(cell, &mut parts);
        let mut clip = Clip::default();
        let mut seen: Vec<u32> = Vec::new();
        let mut pieces = Vec::new();
        // From the cells in the middle of each part on to those beside them, as far as they have something in common.
        let mut next: Vec<u32> = parts.iter().filter_map(|part| self.cell_in(part)).collect();
        while let Some(new) = next.pop() {
            if seen.contains(&new) {
                continue;
            }
            seen.push(new);
            if let Some(piece) = self.piece(cell, new, &parts, &mut clip) {
                pieces.push(piece);
                let beside = self.new.links_of(new as usize).iter().filter_map(|link| link.cell());
                next.extend(beside.map(|other| other as u32));
            }
        }
        pieces.sort_unstable_by_key(|piece| piece.cell);
        pieces
    }

    /// The new cell in the middle of a polygon, or next to it.
    fn cell_in(&self, polygon: &[[f64; 2]]) -> Option<u32> {
        let count = polygon.len() as f64;
        let middle = [0, 1].map(|axis| polygon.iter().map(|corner| corner[axis]).sum::<f64>() / count);
        let toward = polygon.iter().flat_map(|corner| {
            [0.25, 0.5, 0.75].map(|part| [0, 1].map(|axis| middle[axis] + part * (corner[axis] - middle[axis])))
        });
        let positions = std::iter::once(middle).chain(toward);
        positions.map(|at| self.new.layout.home(at)).find_map(|at| self.new.cell_at(at)).map(|cell| cell as u32)
    }

    /// What an old cell, made of `parts`, and a new one have in common.
    fn piece(&self, old: usize, new: u32, parts: &Polygons, clip: &mut Clip) -> Option<Piece> {
        let theirs = self.polygons[new as usize].get_or_init(|| {
            let mut polygons = Vec::new();
            self.new.parts(new as usize, &mut polygons);
            polygons
        });
        let least = SMALLEST * self.old.area[old];
        let (mut whole, mut moment, mut heights) = (0.0, [0.0; 2], 0.0);
        let mut common: Polygons = Vec::new();
        for part in parts {
            let (away, lift) = self.seen_from(old, part);
            for polygon in theirs {
                let shifted = self.beside(part, polygon);
                let found = clip.inside(shifted.as_deref().unwrap_or(polygon), part);
                let size = if found.len() > 2 { area(found) } else { 0.0 };
                if size <= least {
                    continue;
                }
                let centre = centroid(found);
                whole += size;
                heights += size * (self.bed.mean(found) + lift);
                (0..2)
                    .for_each(|axis| moment[axis] += size * (centre[axis] + away[axis] - self.old.centroid[old][axis]));
                common.push(found.to_vec());
            }
        }
        (whole > 0.0).then(|| {
            let bed = heights / whole;
            Piece {
                cell: new,
                area: whole,
                from_centroid: moment.map(|moment| moment / whole),
                bed: bed - self.old.bed[old],
                heights: self.bed.heights(&common, bed),
            }
        })
    }

    /// How far a part of an old cell is seen from its position beside the cell's centroid, m, and by how much its ground stands higher there, m: beyond joined
    /// sides.
    fn seen_from(&self, old: usize, part: &[[f64; 2]]) -> ([f64; 2], f64) {
        let sides = self.sides(part[0], self.old.centroid[old]);
        let (size, lift) = (self.old.layout.bounds.size(), self.bed.lift());
        let away = [0, 1].map(|axis| sides[axis] * size[axis]);
        (away, sides[0] * lift[0] + sides[1] * lift[1])
    }

    /// A polygon of a new cell as it is seen from a part of an old one; none where that is where it is.
    fn beside(&self, part: &[[f64; 2]], polygon: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
        let sides = self.sides(polygon[0], part[0]);
        let size = self.new.layout.bounds.size();
        let moved = |corner: &[f64; 2]| [0, 1].map(|axis| corner[axis] + sides[axis] * size[axis]);
        (sides != [0.0; 2]).then(|| polygon.iter().map(moved).collect())
    }

    /// By how many times the size of the terrain a position is nearest to another beyond joined sides.
    fn sides(&self, at: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        let size = self.new.layout.bounds.size();
        [0, 1].map(
            |axis| {
                if self.new.layout.periodic[axis] { ((to[axis] - at[axis]) / size[axis]).round() } else { 0.0 }
            },
        )
    }
}

/// Centroid of a convex polygon, m.
fn centroid(corners: &[[f64; 2]]) -> [f64; 2] {
    let origin = corners[0];
    let (mut twice, mut moment) = (0.0, [0.0; 2]);
    for pair in corners[1..].windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|corner| [corner[0] - origin[0], corner[1] - origin[1]]);
        let cross = a[0] * b[1] - a[1] * b[0];
        twice += cross;
        (0..2).for_each(|axis| moment[axis] += cross * (a[axis] + b[axis]));
    }
    [0, 1].map(|axis| origin[axis] + moment[axis] / (3.0 * twice))
}
