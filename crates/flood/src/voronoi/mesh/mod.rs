//! The cells of the particles and the faces between them, made where there is water or where it may come next.

mod blocks;
mod cuts;
mod grading;
mod layout;
mod polygon;
mod split;

pub(crate) use blocks::Blocks;
pub(crate) use cuts::Crest;
pub(crate) use grading::Grading;
pub(crate) use layout::Layout;
pub(crate) use polygon::area;

use super::storage::{self, Heights};
use super::walls::Walls;
use super::water::{Column, Water};
use cuts::Cuts;

use layout::Candidate;
use polygon::{Beyond, Polygon};
use rayon::prelude::*;
use std::collections::HashMap;

/// Stands for no cell.
pub(crate) const NONE: u32 = u32::MAX;

/// Neighbours numbered from here on are sides of the terrain (0 west, 1 east, 2 south, 3 north), walls or lines.
const FIRST_BORDER: u32 = u32::MAX - 8;

/// A face to a position without data or a solid is like one to a side with this number.
pub(crate) const SOLID: u8 = 4;

/// A face to a line inside the terrain, at which water enters or leaves, is like one to a side with this number.
pub(crate) const LINE: u8 = 5;

/// Edges shorter than this part of the spacing are no faces.
const SHORTEST: f64 = 1e-9;

/// Least distance of a wall from a centroid that slopes count with, over the square root of the cell's area.
const NEAREST: f64 = 0.05;

/// Least eigenvalue of a least-squares matrix over its trace: where neighbours stand nearly in one straight line, how the water changes across it is not
/// known, and slopes from their small distances across would drive it. Of 400 narrow strips between lines (`tests/voronoi_lines.rs`, with 400 in place of 50)
/// waves grow in three with 0.1, in none with 0.15; a cell in a corner of the terrain has 0.18.
const MIN_EIGENVALUE: f64 = 0.15;

/// A face between two cells, or between a cell and a border.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    /// The two cells; the second is a border's number ([`Face::border`]) for a face on the border.
    pub cells: [u32; 2],
    /// Unit normal from the first cell to the second times the length, m.
    pub normal: [f64; 2],
    /// From the first cell's centroid to the second's, m; on a border to the first's mirror image.
    pub between: [f32; 2],
    /// From the middle between the two centroids to the middle of the face, m.
    pub offset: [f32; 2],
}

impl Face {
    /// The side of the terrain (or [`SOLID`], or [`LINE`]) behind it, if it is on a border.
    #[inline]
    pub fn border(&self) -> Option<u8> {
        (self.cells[1] >= FIRST_BORDER && self.cells[1] != NONE).then(|| (self.cells[1] - FIRST_BORDER) as u8)
    }
}

/// A face from the side of one of its cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Link {
    /// The cell on the other side, a border's number, or [`NONE`] where its tile is not made yet.
    pub neighbour: u32,
    /// The face; [`NONE`] where there is none yet.
    pub face: u32,
    /// What the difference to the neighbour is multiplied by in the least-squares gradient, 1/m.
    pub gradient: [f32; 2],
}

impl Link {
    /// The cell on the other side, if it is one.
    #[inline]
    pub fn cell(&self) -> Option<usize> {
        (self.neighbour < FIRST_BORDER).then_some(self.neighbour as usize)
    }

    /// Which of the face's cells `cell`, whose link it is, is: a face is made with the later of its cells, which is its first.
    #[inline]
    pub fn side(&self, cell: usize) -> usize {
        usize::from(self.cell().is_some_and(|other| other > cell))
    }
}

/// Properties of the ground that a mesh needs.
pub(crate) trait Ground: Sync {
    /// Mean height of the ground over a polygon, m.
    fn mean(&self, polygon: &[[f64; 2]]) -> f64;
    /// Heights of the parts of a cell, its convex polygons given with their mean height, m; none where the mean alone counts.
    fn heights(&self, _polygons: &[Vec<[f64; 2]>], _mean: f64) -> Option<Heights> {
        None
    }
    /// Whether there is ground at a position.
    fn is_there(&self, at: [f64; 2]) -> bool;
    /// Whether water is mirrored at a side (or at [`SOLID`]), so that its image counts in slopes.
    fn mirrors(&self, border: u8) -> bool;
    /// By how much the ground beyond the east and the north side stands higher than where these sides are joined on, m.
    fn lift(&self) -> [f64; 2];
    /// The walls that cut cells; without them a cell is there where its point has ground.
    fn walls(&self) -> Option<&Walls> {
        None
    }
}

/// Cells and faces.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub layout: Layout,
    /// The tiles that are made, in the order in which they were.
    pub made: Vec<u32>,
    /// First entry of each tile in `cell_of_point`; [`NONE`] where the tile is not made.
    first_of_tile: Vec<u32>,
    /// The cell of each point of the tiles that are made; [`NONE`] where there is no ground.
    cell_of_point: Vec<u32>,
    /// Number of each cell's point: tile times points a tile plus point. The second cell of a point, and others, where walls cut it, have
    /// the number of all points more each.
    pub point: Vec<u64>,
    /// Centroid, m.
    pub centroid: Vec<[f64; 2]>,
    /// Area, m2.
    pub area: Vec<f64>,
    /// Twice the area over the perimeter, m: the length that the time step goes by.
    pub width: Vec<f64>,
    /// Mean height of the ground, m.
    pub bed: Vec<f64>,
    /// Heights of the parts of each cell; empty where the mean alone counts.
    heights: Vec<Heights>,
    /// First link of each cell, and the number of links at the end.
    pub first_link: Vec<u32>,
    pub links: Vec<Link>,
    pub faces: Vec<Face>,
    /// By how much the second cell of each face stands higher than its bed says, m: beyond joined sides. Empty where it never does.
    pub lift: Vec<f64>,
    /// Tiles round the one of each cell that must be made before water comes into the cell, as bits: see [`AROUND`].
    pub rim: Vec<u8>,
    /// Links to cells of tiles that are not made yet, by the number of the point there.
    pending: HashMap<u64, Vec<Pending>>,
    /// The cells near walls.
    cuts: Cuts,
    /// Cells of points that walls cut, by their numbers.
    cut_cells: HashMap<u64, u32>,
    /// Faces at obstacles, in order, and the obstacle.
    pub obstacle_faces: Vec<(u32, u32)>,
    /// Faces at lines at which water enters or leaves, in order, and the line.
    pub line_faces: Vec<(u32, u32)>,
}

/// A link that waits for the cell on the other side: link, cell, and number of the face between cells near walls (0 elsewhere).
type Pending = (u32, u32, u64);

/// The tiles round a tile.
pub(crate) const AROUND: [[i64; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// A cell of a tile that is being made.
#[derive(Debug, Clone)]
struct NewCell {
    point: u64,
    centroid: [f64; 2],
    area: f64,
    width: f64,
    bed: f64,
    heights: Option<Heights>,
    rim: u8,
    edges: Vec<NewEdge>,
}

/// An edge of a cell that is being made.
#[derive(Debug, Clone)]
struct NewEdge {
    beyond: NewBeyond,
    /// Outward unit normal times length, m.
    normal: [f64; 2],
    /// Middle, m.
    middle: [f64; 2],
}

#[derive(Debug, Clone)]
enum NewBeyond {
    /// Number of the point, the vector to it, m, and the lift of its ground, m.
    Point(u64, [f64; 2], f64),
    /// A cell near walls: its number, that of the face, how far from its position it is seen, m, and the lift of its ground, m.
    Cell {
        point: u64,
        face: u64,
        shift: [f64; 2],
        lift: f64,
    },
    Border(u8),
    /// A wall, and the obstacle that it belongs to.
    Wall(Option<u32>),
    /// A line at which water enters or leaves, by its number.
    Line(u32),
}

impl Mesh {
    /// A mesh without cells.
    pub fn new(layout: Layout) -> Self {
        let tiles = layout.tiles[0] * layout.tiles[1];
        Self {
            layout,
            made: Vec::new(),
            first_of_tile: vec![NONE; tiles],
            cell_of_point: Vec::new(),
            point: Vec::new(),
            centroid: Vec::new(),
            area: Vec::new(),
            width: Vec::new(),
            bed: Vec::new(),
            heights: Vec::new(),
            first_link: vec![0],
            links: Vec::new(),
            faces: Vec::new(),
            lift: Vec::new(),
            rim: Vec::new(),
            pending: HashMap::new(),
            cuts: Cuts::default(),
            cut_cells: HashMap::new(),
            obstacle_faces: Vec::new(),
            line_faces: Vec::new(),
        }
    }

    /// Finds the cells that the ground's walls cut: before any tile is made.
    pub fn cut(&mut self, ground: &impl Ground) {
        self.cuts = Cuts::new(&self.layout, ground);
    }

    /// Walls with a crest between cells that are made, and the cells.
    pub fn crests(&self) -> impl Iterator<Item = ([u32; 2], &Crest)> {
        let cell = |point: u64| self.cell_of(point).map(|cell| cell as u32);
        self.cuts.crests.iter().filter_map(move |crest| {
            let [a, b] = crest.points.map(cell);
            Some(([a?, b?], crest))
        })
    }

    /// Heights of the parts of each cell above its mean bed, m, the lowest first; none where they do not count.
    #[cfg(feature = "gpu")]
    pub fn heights(&self) -> Option<impl Iterator<Item = [f64; storage::PARTS]> + '_> {
        (!self.heights.is_empty()).then(|| self.heights.iter().map(storage::above_mean))
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.area.len()
    }

    /// Whether a tile is made.
    pub fn has(&self, tile: usize) -> bool {
        self.first_of_tile[tile] != NONE
    }

    /// Adds the tiles round a cell that must be made before it gets wet and are not, and takes them for made from here on.
    pub fn take_rim(&mut self, cell: usize, missing: &mut Vec<usize>) {
        let mask = std::mem::take(&mut self.rim[cell]);
        let (tile, _) = self.layout.tile_and_index(self.point[cell]);
        let beside = AROUND.iter().enumerate().filter(|(bit, _)| mask & 1 << bit != 0);
        let tiles = beside.filter_map(|(_, away)| self.layout.beside(tile, *away));
        missing.extend(tiles.filter(|tile| self.first_of_tile[*tile] == NONE));
    }

    /// The links of a cell.
    #[inline]
    pub fn links_of(&self, cell: usize) -> &[Link] {
        &self.links[self.first_link[cell] as usize..self.first_link[cell + 1] as usize]
    }

    /// The cell that holds a position; none where it is not made or there is no ground.
    pub fn cell_at(&self, at: [f64; 2]) -> Option<usize> {
        let (tile, k) = self.layout.nearest(at);
        let point = self.layout.number(tile, k);
        if !self.cuts.cut(point) {
            return self.cell_of(point);
        }
        let own = self.layout.position(tile, k);
        let size = self.layout.bounds.size();
        let to = [0, 1].map(|axis| {
            let to = at[axis] - own[axis];
            if self.layout.periodic[axis] { to - (to / size[axis]).round() * size[axis] } else { to }
        });
        self.cell_of(self.cuts.holding(point, to)?)
    }

    /// The cell of a point.
    pub fn cell_of(&self, point: u64) -> Option<usize> {
        if !self.cut_cells.is_empty()
            && let Some(cell) = self.cut_cells.get(&point)
        {
            return Some(*cell as usize);
        }
        if point >= self.layout.total() {
            return None;
        }
        let (tile, k) = self.layout.tile_and_index(point);
        let first = self.first_of_tile[tile];
        if first == NONE {
            return None;
        }
        let cell = self.cell_of_point[first as usize + k];
        (cell != NONE).then_some(cell as usize)
    }

    /// Convex polygons that a cell is made of, each with its corners in counter-clockwise order, m.
    pub fn parts(&self, cell: usize, parts: &mut Vec<Vec<[f64; 2]>>) {
        let number = self.point[cell];
        parts.clear();
        if let Some(of_cell) = self.cuts.parts(number) {
            parts.extend_from_slice(of_cell);
            return;
        }
        let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
        let (tile, k) = self.layout.tile_and_index(number);
        self.layout.cell(tile, k, &mut polygon, &mut candidates);
        let position = self.layout.position(tile, k);
        parts.push(polygon.corners.iter().map(|r| [position[0] + r[0], position[1] + r[1]]).collect());
    }

    /// Makes the cells of tiles that are not made yet, in this order.
    pub fn make(&mut self, tiles: &[usize], ground: &impl Ground) {
        let made: Vec<Vec<NewCell>> =
            tiles.par_iter().map(|&tile| new_cells(&self.layout, &self.cuts, tile, ground)).collect();
        let (first_cell, first_face) = (self.len(), self.faces.len());
        for (&tile, cells) in tiles.iter().zip(&made) {
            self.add_cells(tile, cells);
        }
        for (number, cell) in made.iter().flatten().enumerate() {
            self.add_links(first_cell + number, cell, ground);
        }
        let touched = self.faces[first_face..].iter().flat_map(|face| face.cells);
        let mut touched: Vec<usize> = touched.filter(|cell| *cell < FIRST_BORDER).map(|cell| cell as usize).collect();
        touched.sort_unstable();
        touched.dedup();
        touched.into_iter().for_each(|cell| self.fit_gradient(cell, ground));
    }

    fn add_cells(&mut self, tile: usize, cells: &[NewCell]) {
        let count = self.layout.count(tile);
        self.made.push(tile as u32);
        self.first_of_tile[tile] = self.cell_of_point.len() as u32;
        let first = self.cell_of_point.len();
        self.cell_of_point.resize(first + count, NONE);
        for cell in cells {
            let number = self.area.len() as u32;
            let point = cell.point % self.layout.total();
            if self.cuts.cut(point) {
                self.cut_cells.insert(cell.point, number);
            } else {
                self.cell_of_point[first + self.layout.tile_and_index(point).1] = number;
            }
            self.point.push(cell.point);
            self.centroid.push(cell.centroid);
            self.area.push(cell.area);
            self.width.push(cell.width);
            self.bed.push(cell.bed);
            self.heights.extend(cell.heights);
            self.rim.push(cell.rim);
        }
    }

    /// Adds the links of a cell that was added, and the faces for which both cells are there.
    fn add_links(&mut self, cell: usize, new: &NewCell, ground: &impl Ground) {
        for edge in &new.edges {
            let link = self.links.len() as u32;
            let mut made = Link { neighbour: NONE, face: NONE, gradient: [0.0; 2] };
            match edge.beyond {
                NewBeyond::Border(side) => {
                    made.neighbour = FIRST_BORDER + u32::from(side);
                    made.face = self.faces.len() as u32;
                    let face = border_face(cell, made.neighbour, new, edge);
                    self.add_face(face, 0.0, ground);
                }
                NewBeyond::Wall(obstacle) => {
                    made.neighbour = FIRST_BORDER + u32::from(SOLID);
                    made.face = self.faces.len() as u32;
                    self.obstacle_faces.extend(obstacle.map(|obstacle| (made.face, obstacle)));
                    let face = border_face(cell, made.neighbour, new, edge);
                    self.add_face(face, 0.0, ground);
                }
                NewBeyond::Line(number) => {
                    made.neighbour = FIRST_BORDER + u32::from(LINE);
                    made.face = self.faces.len() as u32;
                    self.line_faces.push((made.face, number));
                    let face = border_face(cell, made.neighbour, new, edge);
                    self.add_face(face, 0.0, ground);
                }
                NewBeyond::Point(point, to, lift) => {
                    let home = self.position_of(point);
                    let own = self.position_of(new.point % self.layout.total());
                    let shift = [0, 1].map(|axis| own[axis] + to[axis] - home[axis]);
                    self.join((cell, link), new, edge, (point, 0, shift, lift), &mut made, ground);
                }
                NewBeyond::Cell { point, face, shift, lift } => {
                    self.join((cell, link), new, edge, (point, face, shift, lift), &mut made, ground);
                }
            }
            self.links.push(made);
        }
        self.pending.remove(&new.point);
        self.first_link.push(self.links.len() as u32);
    }

    /// Links a cell to one with the number `point`, which is seen `shift` from its position. The face is made once both cells have their links:
    /// whichever comes second finds the first's waiting.
    fn join(
        &mut self,
        (cell, link): (usize, u32),
        new: &NewCell,
        edge: &NewEdge,
        (point, face, shift, lift): (u64, u64, [f64; 2], f64),
        made: &mut Link,
        ground: &impl Ground,
    ) {
        let waiting = self.pending.get_mut(&new.point).and_then(|waiting| {
            let fits = |(_, other, number): &Pending| self.point[*other as usize] == point && *number == face;
            let found = waiting.iter().position(fits)?;
            Some(waiting.swap_remove(found))
        });
        let Some((their_link, other, _)) = waiting else {
            self.pending.entry(point).or_default().push((link, cell as u32, face));
            return;
        };
        let face = self.faces.len() as u32;
        made.neighbour = other;
        made.face = face;
        self.links[their_link as usize].neighbour = cell as u32;
        self.links[their_link as usize].face = face;
        let theirs = self.centroid[other as usize];
        let second = [0, 1].map(|axis| theirs[axis] + shift[axis]);
        self.add_face(inner_face([cell as u32, other], [new.centroid, second], edge), lift, ground);
    }

    fn position_of(&self, point: u64) -> [f64; 2] {
        let (tile, k) = self.layout.tile_and_index(point);
        self.layout.position(tile, k)
    }

    fn add_face(&mut self, face: Face, lift: f64, ground: &impl Ground) {
        self.faces.push(face);
        if ground.lift() != [0.0; 2] {
            self.lift.push(lift);
        }
    }

    /// Level of the water in a cell, m, that holds `depth` m spread over all of it; that of its ground where it is dry.
    #[inline]
    pub fn level(&self, cell: usize, depth: f64) -> f64 {
        let above = if self.heights.is_empty() { depth } else { storage::level(&self.heights[cell], depth) };
        self.bed[cell] + above
    }

    /// Water in a cell below a level, m, spread over all of it, m.
    pub fn depth_below(&self, cell: usize, level: f64) -> f64 {
        let above = level - self.bed[cell];
        if self.heights.is_empty() { above.max(0.0) } else { storage::depth(&self.heights[cell], above) }
    }

    /// Potential energy of a volume, m3, at rest in a cell above the level 0, over density and gravity, m4.
    pub fn potential(&self, cell: usize, volume: f64) -> f64 {
        let depth = volume / self.area[cell];
        let own = match self.heights.get(cell) {
            None => 0.5 * depth * depth,
            Some(heights) => storage::potential(heights, storage::level(heights, depth)),
        };
        volume * self.bed[cell] + self.area[cell] * own
    }

    /// Work over density, gravity and area, m2, that it takes to bring the water of a cell from a level, m, to that at which it holds `depth` m, while
    /// what comes and goes does so at the former level.
    pub fn raised(&self, cell: usize, depth: f64, level: f64) -> f64 {
        let level = level - self.bed[cell];
        let of_part = |ground: f64, surface: f64| {
            let [from, to] = [level, surface].map(|level| level.max(ground) - ground);
            // Of ground above the level: what stands on it was lifted there.
            let lifted = (ground - level).max(0.0);
            0.5 * (to - from) * (to - from) + lifted * to
        };
        match self.heights.get(cell) {
            None => of_part(0.0, depth),
            Some(heights) => storage::mean_of(heights, |ground| of_part(ground, storage::level(heights, depth))),
        }
    }

    /// The water of a column over a cell: see [`Water::of`].
    #[inline]
    pub fn water(&self, cell: usize, column: &mut Column) -> Water {
        Water::of(column, self.area[cell], |depth| self.level(cell, depth))
    }

    /// The same of a column whose momentum was bounded before: see [`Water::as_it_is`].
    pub fn water_as_it_is(&self, cell: usize, column: &Column) -> Water {
        Water::as_it_is(column, self.area[cell], |depth| self.level(cell, depth))
    }

    /// By how much the second cell of a face stands higher than its bed says, m.
    #[inline]
    pub fn lift_of(&self, face: usize) -> f64 {
        if self.lift.is_empty() { 0.0 } else { self.lift[face] }
    }

    /// By how much the neighbour behind a link of a cell stands higher than its bed says, m.
    #[inline]
    pub fn lift_seen(&self, link: &Link, cell: usize) -> f64 {
        if self.lift.is_empty() {
            return 0.0;
        }
        let lift = self.lift[link.face as usize];
        if link.side(cell) == 0 { lift } else { -lift }
    }

    /// Finds the factors of the least-squares gradient of a cell: weights length over distance. Mirror images behind walls count; where the
    /// border is open there is none. A cell that walls enclose has no slopes: of mirror images alone they would turn its velocity round at its faces, and the walls
    /// would drive the water on.
    fn fit_gradient(&mut self, cell: usize, ground: &impl Ground) {
        let [first, end] = [0, 1].map(|next| self.first_link[cell + next] as usize);
        if self.links[first..end].iter().all(|link| link.cell().is_none()) {
            return;
        }
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        let vector = |mesh: &Self, link: &Link| {
            let face = (link.face != NONE).then(|| &mesh.faces[link.face as usize])?;
            if face.border().is_some_and(|border| !ground.mirrors(border)) {
                return None;
            }
            let sign = if face.cells[0] == cell as u32 { 1.0 } else { -1.0 };
            let e = face.between.map(|e| sign * f64::from(e));
            let weight = face.normal[0].hypot(face.normal[1]) / e[0].hypot(e[1]);
            Some((e, weight))
        };
        for link in &self.links[first..end] {
            let Some((e, weight)) = vector(self, link) else { continue };
            xx += weight * e[0] * e[0];
            xy += weight * e[0] * e[1];
            yy += weight * e[1] * e[1];
        }
        // Both eigenvalues are half the trace, more or less `apart`; the matrix of the weaker direction is (stronger - M) / (2 apart).
        let trace = xx + yy;
        let apart = (0.5 * (xx - yy)).hypot(xy);
        let lacking = MIN_EIGENVALUE * trace - (0.5 * trace - apart);
        if lacking > 0.0 {
            let (share, stronger) = (lacking / (2.0 * apart), 0.5 * trace + apart);
            (xx, xy, yy) = (xx + share * (stronger - xx), xy - share * xy, yy + share * (stronger - yy));
        }
        let determinant = xx * yy - xy * xy;
        for k in first..end {
            if let Some((e, weight)) = vector(self, &self.links[k]) {
                let factor = [yy * e[0] - xy * e[1], xx * e[1] - xy * e[0]];
                self.links[k].gradient = factor.map(|f| (weight * f / determinant) as f32);
            }
        }
    }

    /// Gives back the room that no cell needs.
    pub fn shrink(&mut self) {
        let Self {
            cell_of_point, point, centroid, area, width, bed, heights, first_link, links, faces, lift, rim, ..
        } = self;
        heights.shrink_to_fit();
        [area, width, bed, lift].into_iter().for_each(Vec::shrink_to_fit);
        [cell_of_point, first_link].into_iter().for_each(Vec::shrink_to_fit);
        point.shrink_to_fit();
        centroid.shrink_to_fit();
        rim.shrink_to_fit();
        links.shrink_to_fit();
        faces.shrink_to_fit();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.links.capacity() * size_of::<Link>()
            + self.faces.capacity() * size_of::<Face>()
            + self.lift.capacity() * 8
            + self.heights.capacity() * size_of::<Heights>()
            + self.area.capacity() * (8 + 16 + 8 + 8 + 8 + 4 + 1 + 4)
    }
}

fn inner_face(cells: [u32; 2], centroids: [[f64; 2]; 2], edge: &NewEdge) -> Face {
    let between = [0, 1].map(|axis| (centroids[1][axis] - centroids[0][axis]) as f32);
    let offset = [0, 1].map(|axis| (edge.middle[axis] - 0.5 * (centroids[0][axis] + centroids[1][axis])) as f32);
    Face { cells, normal: edge.normal, between, offset }
}

/// A face on a border: its second cell is the first's mirror image.
fn border_face(cell: usize, border: u32, new: &NewCell, edge: &NewEdge) -> Face {
    let (centroid, least) = (new.centroid, NEAREST * new.area.sqrt());
    let length = edge.normal[0].hypot(edge.normal[1]);
    let normal = edge.normal.map(|n| n / length);
    let distance = (0..2).map(|axis| (edge.middle[axis] - centroid[axis]) * normal[axis]).sum::<f64>();
    let offset = [0, 1].map(|axis| (edge.middle[axis] - centroid[axis] - distance * normal[axis]) as f32);
    // Cells round a corner of a wall may have their centroids behind it.
    let distance = if distance > least { distance } else { least };
    let between = normal.map(|n| (2.0 * distance * n) as f32);
    Face { cells: [cell as u32, border], normal: edge.normal, between, offset }
}

/// The cells of a tile.
fn new_cells(layout: &Layout, cuts: &Cuts, tile: usize, ground: &impl Ground) -> Vec<NewCell> {
    let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
    let mut corners = Vec::new();
    let count = layout.count(tile);
    let mut cells = Vec::with_capacity(count);
    for k in 0..count {
        if let Some(made) = cuts.at_point(layout.number(tile, k)) {
            cells.extend_from_slice(made);
        } else if ground.is_there(layout.position(tile, k)) {
            cells.push(new_cell(layout, tile, k, ground, (&mut polygon, &mut candidates, &mut corners)));
        }
    }
    cells
}

fn new_cell(
    layout: &Layout,
    tile: usize,
    k: usize,
    ground: &impl Ground,
    (polygon, candidates, corners): (&mut Polygon, &mut Vec<Candidate>, &mut Vec<[f64; 2]>),
) -> NewCell {
    layout.cell(tile, k, polygon, candidates);
    let position = layout.position(tile, k);
    let on_ground = |r: [f64; 2]| [position[0] + r[0], position[1] + r[1]];
    let shortest = SHORTEST * layout.spacing_at(tile, k);
    let edges = (0..polygon.corners.len()).filter_map(|edge| {
        let [a, b] = polygon.edge(edge);
        let normal = [b[1] - a[1], a[0] - b[0]];
        let middle = on_ground([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        let beyond = match polygon.beyond[edge]? {
            Beyond::Side(side) => NewBeyond::Border(side),
            Beyond::Cell(number) => {
                let Candidate { to, point, .. } = candidates[number as usize];
                neighbour(layout, position, to, point, ground)
            }
        };
        (normal[0].hypot(normal[1]) > shortest).then_some(NewEdge { beyond, normal, middle })
    });
    let edges = edges.collect();
    let measures = polygon.measures();
    corners.clear();
    corners.extend(polygon.corners.iter().map(|r| on_ground(*r)));
    let bed = ground.mean(corners);
    NewCell {
        point: layout.number(tile, k),
        centroid: on_ground(measures.centroid),
        area: measures.area,
        width: 2.0 * measures.area / measures.perimeter,
        bed,
        heights: ground.heights(std::slice::from_ref(corners), bed),
        rim: rim(layout, tile, k, layout.rim),
        edges,
    }
}

/// What is behind an edge to the point `to` away: its cell, or a solid where there is no ground.
fn neighbour(layout: &Layout, position: [f64; 2], to: [f64; 2], point: u64, ground: &impl Ground) -> NewBeyond {
    let (tile, k) = layout.tile_and_index(point);
    let home = layout.position(tile, k);
    if !ground.is_there(home) {
        return NewBeyond::Border(SOLID);
    }
    let size = layout.bounds.size();
    let lift = (0..2).map(|axis| ((position[axis] + to[axis] - home[axis]) / size[axis]).round() * ground.lift()[axis]);
    NewBeyond::Point(point, to, lift.sum())
}

/// The tiles round its own, `margin` spacings away at most, that must be made before the cell of a point gets wet.
fn rim(layout: &Layout, tile: usize, k: usize, margin: f64) -> u8 {
    let within = layout.within(tile, k);
    let margin = margin * layout.spacing();
    let near = [0, 1].map(|axis| [within[axis] < margin, true, within[axis] > layout.tile[axis] - margin]);
    let needed = |away: &[i64; 2]| {
        near[0][(away[0] + 1) as usize] && near[1][(away[1] + 1) as usize] && layout.beside(tile, *away).is_some()
    };
    AROUND.iter().enumerate().filter(|(_, away)| needed(away)).fold(0, |mask, (bit, _)| mask | 1 << bit)
}

#[cfg(test)]
mod tests {
    use super::super::walls::{Wall, WallKind, of_outlines};
    use super::*;
    use crate::obstacles::Outline;
    use corpuscle_terrain::Bounds;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    struct Plane;

    impl Ground for Plane {
        fn mean(&self, polygon: &[[f64; 2]]) -> f64 {
            polygon.iter().map(|[x, y]| 0.1 * x - 0.2 * y).sum::<f64>() / polygon.len() as f64
        }
        fn is_there(&self, [x, y]: [f64; 2]) -> bool {
            (x - 30.0).hypot(y - 20.0) > 6.0
        }
        fn mirrors(&self, border: u8) -> bool {
            border == SOLID
        }
        fn lift(&self) -> [f64; 2] {
            [10.0, 0.0]
        }
    }

    fn mesh(order: &[usize]) -> Mesh {
        let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 70.0 };
        let mut mesh = Mesh::new(Layout::new(bounds, [true, false], 1.0, 3));
        let tiles: Vec<usize> = (0..mesh.layout.tiles[0] * mesh.layout.tiles[1]).collect();
        assert!(tiles.len() == order.len(), "{}", tiles.len());
        order.iter().for_each(|tile| mesh.make(&[*tile], &Plane));
        mesh
    }

    #[test]
    fn a_link_knows_which_of_the_cells_of_its_face_is_its_own() {
        let mesh = mesh(&[5, 0, 3, 1, 4, 2]);
        for cell in 0..mesh.len() {
            for link in mesh.links_of(cell) {
                assert_eq!(mesh.faces[link.face as usize].cells[link.side(cell)], cell as u32);
            }
        }
    }

    /// Sum of length times normal round each cell.
    #[test]
    fn faces_of_every_cell_close_whatever_the_order_of_the_tiles() {
        for order in [[0, 1, 2, 3, 4, 5], [5, 0, 3, 1, 4, 2]] {
            let mesh = mesh(&order);
            assert!(mesh.pending.values().all(Vec::is_empty));
            let mut sums = vec![[0.0; 2]; mesh.len()];
            for face in &mesh.faces {
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    if face.cells[side] < FIRST_BORDER {
                        (0..2).for_each(|axis| sums[face.cells[side] as usize][axis] += sign * face.normal[axis]);
                    }
                }
            }
            let worst = sums.iter().map(|sum| sum[0].hypot(sum[1])).fold(0.0, f64::max);
            assert!(worst < 1e-12, "{worst}");
        }
    }

    /// Flat ground with obstacles, and lines.
    struct Walled {
        outlines: Vec<Outline>,
        walls: Walls,
    }

    impl Walled {
        fn new(seed: u64) -> Self {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut number = |low: f64, high: f64| random.random_range(low..high);
            let square = |k: usize| {
                let [x, y] = [10.0 * (k % 10) as f64 + 5.0, 10.0 * (k / 10) as f64 + 5.0];
                let (a, b, angle) = (number(0.1, 3.0), number(0.1, 3.0), number(0.0, 6.0));
                let corner =
                    |u: f64, v: f64| [x + u * angle.cos() - v * angle.sin(), y + u * angle.sin() + v * angle.cos()];
                vec![corner(-a, -b), corner(a, -b), corner(a, b), corner(-a, b)]
            };
            let squares: Vec<_> = (0..70).map(square).collect();
            let (lines, solid) = squares.split_at(30);
            let outlines: Vec<_> =
                solid.iter().map(|ring| Outline { obstacle: 0, rings: vec![ring.clone()] }).collect();
            let line = |ring: &Vec<[f64; 2]>| {
                let sides = ring.windows(2).map(|side| [side[0], side[1]]).chain([[ring[0], ring[2]]]);
                sides.map(|ends| Wall { ends, kind: WallKind::Obstacle(1), crest: [1.0; 2] }).collect::<Vec<_>>()
            };
            let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 70.0 };
            let walls: Vec<_> = of_outlines(&outlines).chain(lines.iter().flat_map(line)).collect();
            Self { walls: Walls::new(walls, bounds, 2.0), outlines }
        }
    }

    impl Ground for Walled {
        fn mean(&self, polygon: &[[f64; 2]]) -> f64 {
            Plane.mean(polygon)
        }
        fn is_there(&self, at: [f64; 2]) -> bool {
            !self.outlines.iter().any(|outline| outline.contains(at))
        }
        fn mirrors(&self, _: u8) -> bool {
            true
        }
        fn lift(&self) -> [f64; 2] {
            [10.0, 0.0]
        }
        fn walls(&self) -> Option<&Walls> {
            Some(&self.walls)
        }
    }

    /// Cells that walls cut close, fill what obstacles leave, and are not small; positions are found in them.
    #[test]
    fn cut_cells_close_and_fill_the_ground_beside_obstacles() {
        for seed in 0..3 {
            let ground = Walled::new(seed);
            let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 70.0 };
            let mut mesh = Mesh::new(Layout::new(bounds, [true, false], 1.0, seed));
            mesh.cut(&ground);
            [5, 0, 3, 1, 4, 2].iter().for_each(|tile| mesh.make(&[*tile], &ground));
            assert!(mesh.pending.values().all(Vec::is_empty));
            let mut sums = vec![[0.0; 2]; mesh.len()];
            for face in &mesh.faces {
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    if face.cells[side] < FIRST_BORDER {
                        (0..2).for_each(|axis| sums[face.cells[side] as usize][axis] += sign * face.normal[axis]);
                    }
                }
            }
            let worst = sums.iter().map(|sum| sum[0].hypot(sum[1])).fold(0.0, f64::max);
            assert!(worst < 1e-9, "{worst:e}");
            let solid: f64 = ground.outlines.iter().map(|outline| polygon::area(&outline.rings[0])).sum();
            let area: f64 = mesh.area.iter().sum();
            assert!((area + solid - 7000.0).abs() < 1e-9 * 7000.0, "{}", area + solid - 7000.0);
            let small = (0..mesh.len()).filter(|cell| mesh.area[*cell] < 0.25 && mesh.width[*cell].is_finite());
            assert_eq!(small.count(), 0);
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut parts = Vec::new();
            for _ in 0..5000 {
                let at = [random.random_range(5.0..95.0), random.random_range(0.0..70.0)];
                let cell = mesh.cell_at(at);
                assert_eq!(cell.is_some(), ground.is_there(at), "{at:?}");
                if let Some(cell) = cell {
                    mesh.parts(cell, &mut parts);
                    assert!(parts.iter().any(|part| split::holds(part, at)), "{at:?}");
                }
            }
            let mut numbers = mesh.point.clone();
            numbers.sort_unstable();
            assert!(numbers.windows(2).all(|pair| pair[0] != pair[1]));
            assert!(mesh.crests().count() > 20);
        }
    }

    /// The least-squares gradient of a linear function, across joined sides too.
    #[test]
    fn gradients_of_a_plane_are_its_slopes() {
        let mesh = mesh(&[0, 1, 2, 3, 4, 5]);
        let value = |at: [f64; 2]| 0.1 * at[0] - 0.2 * at[1];
        let mut checked = 0;
        for cell in 0..mesh.len() {
            let mut gradient = [0.0; 2];
            let links = mesh.links_of(cell);
            if links.iter().any(|link| link.cell().is_none()) {
                continue;
            }
            for link in links {
                let other = link.cell().unwrap();
                let face = &mesh.faces[link.face as usize];
                let lift = if face.cells[0] == cell as u32 { 1.0 } else { -1.0 } * mesh.lift_of(link.face as usize);
                let difference = value(mesh.centroid[other]) + lift - value(mesh.centroid[cell]);
                (0..2).for_each(|axis| gradient[axis] += f64::from(link.gradient[axis]) * difference);
            }
            assert!((gradient[0] - 0.1).abs() < 1e-6 && (gradient[1] + 0.2).abs() < 1e-6, "{gradient:?}");
            checked += 1;
        }
        assert!(checked > 6000);
    }
}
