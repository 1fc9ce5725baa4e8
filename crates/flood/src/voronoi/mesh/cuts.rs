//! The cells near walls: pieces of Voronoi cells, small ones joined to a neighbour, and the faces between them.
//!
//! They are found for all walls at once, before any tile is made: a small piece may be joined to one of another tile.

use super::polygon::{Beyond, Polygon};
use super::split::{Behind, Groups, Piece, holds, split};
use super::{Ground, Layout, NewBeyond, NewCell, NewEdge, rim};
use crate::voronoi::walls::{Wall, WallKind, Walls};
use rayon::prelude::*;
use std::collections::HashMap;

/// Area over that of a whole cell below which pieces are joined to the neighbour behind their longest open faces: they would set the time step (cell
/// merging: Quirk 1994, "An alternative to unstructured grids", section 3).
const MIN_AREA_RATIO: f64 = 0.3;

/// Largest distance from a wall of points whose cells it cuts, in spacings.
const CUT_RADIUS: f64 = 1.5;

/// Least length of a face between overlapping edges, over the spacing.
const MIN_OVERLAP: f64 = 1e-11;

/// [`Layout::rim`] of cells near walls over that of others: pieces that are joined to them lie farther out than their points.
const RIM: f64 = 2.0;

/// The cells near walls.
#[derive(Debug, Default)]
pub(crate) struct Cuts {
    /// Cells by the point of their largest piece; for all points whose Voronoi cell is cut, or beside one that is.
    cells: HashMap<u64, Vec<NewCell>>,
    /// Pieces of each Voronoi cell that is cut: the cell that they belong to, and convex parts relative to the point.
    pieces: HashMap<u64, Vec<(u64, Vec<Polygon2>)>>,
    /// Convex parts of each cell that is cut, m.
    parts: HashMap<u64, Vec<Polygon2>>,
    /// Walls with a crest between cells.
    pub crests: Vec<Crest>,
}

type Polygon2 = Vec<[f64; 2]>;

/// A wall with a crest between two cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crest {
    /// Numbers of the cells' points.
    pub points: [u64; 2],
    /// Length, m.
    pub length: f64,
    /// Mean level of the crest, m.
    pub level: f64,
}

/// A Voronoi cell near walls.
struct Entry {
    point: u64,
    position: [f64; 2],
    /// What lies beyond each edge: a side of the terrain, or a neighbour and the vector to it.
    beyond: Vec<Option<Next>>,
    pieces: Vec<Piece>,
    is_cut: bool,
}

#[derive(Debug, Clone, Copy)]
enum Next {
    Side(u8),
    Point(u64, [f64; 2]),
}

/// An edge of a piece, relative to its point.
struct Rim {
    normal: [f64; 2],
    middle: [f64; 2],
    beyond: Outside,
}

enum Outside {
    Border(u8),
    Wall(Option<u32>),
    /// A line at which water enters or leaves.
    Line(u32),
    /// Behind an edge that no wall reaches.
    Point(u64, [f64; 2]),
    /// Another piece, the number of the face, and the vector from this piece's point to the other's.
    Piece(usize, u64, [f64; 2]),
}

impl Cuts {
    /// The cells near the walls of the ground.
    pub fn new(layout: &Layout, ground: &impl Ground) -> Self {
        let Some(walls) = ground.walls().filter(|walls| !walls.is_empty()) else { return Self::default() };
        let entries = entries(layout, walls, ground);
        let mut build = Build::new(layout, walls, &entries);
        build.find_edges();
        let groups = build.join_small();
        build.cells(groups, ground)
    }

    /// The cells at a point near walls; none where no wall is near.
    pub fn at_point(&self, point: u64) -> Option<&[NewCell]> {
        self.cells.get(&point).map(Vec::as_slice)
    }

    /// Whether walls cut the Voronoi cell of a point.
    pub fn cut(&self, point: u64) -> bool {
        self.pieces.contains_key(&point)
    }

    /// The number of the cell that holds a position relative to a point whose Voronoi cell is cut; none in solids.
    pub fn holding(&self, point: u64, at: [f64; 2]) -> Option<u64> {
        let pieces = self.pieces.get(&point)?;
        pieces.iter().find(|(_, parts)| parts.iter().any(|part| holds(part, at))).map(|(id, _)| *id)
    }

    /// Convex parts of a cell; none where it is a whole Voronoi cell.
    pub fn parts(&self, id: u64) -> Option<&[Polygon2]> {
        self.parts.get(&id).map(Vec::as_slice)
    }
}

/// The Voronoi cells that walls cut and those beside them, in the order of their points.
fn entries(layout: &Layout, walls: &Walls, ground: &impl Ground) -> Vec<Entry> {
    let reach = CUT_RADIUS * layout.spacing();
    let boxes = walls.boxes().into_par_iter();
    let near = boxes.flat_map_iter(|[low, high]| layout.points_within(low.map(|x| x - reach), high.map(|x| x + reach)));
    let mut near: Vec<u64> = near.collect();
    near.par_sort_unstable();
    near.dedup();
    let mut entries: Vec<Entry> =
        near.into_par_iter().filter_map(|point| entry(layout, point, Some(walls), ground)).collect();
    let cut: std::collections::HashSet<u64> = entries.iter().map(|entry| entry.point).collect();
    let beside = entries.iter().flat_map(|entry| &entry.beyond).filter_map(|next| match next {
        Some(Next::Point(point, _)) if !cut.contains(point) => Some(*point),
        _ => None,
    });
    let mut beside: Vec<u64> = beside.collect();
    beside.sort_unstable();
    beside.dedup();
    entries.par_extend(beside.into_par_iter().filter_map(|point| entry(layout, point, None, ground)));
    entries.sort_unstable_by_key(|entry| entry.point);
    entries
}

/// The Voronoi cell of a point cut by walls, none if they do not; or whole, without walls.
fn entry(layout: &Layout, point: u64, walls: Option<&Walls>, ground: &impl Ground) -> Option<Entry> {
    let (tile, k) = layout.tile_and_index(point);
    let position = layout.position(tile, k);
    let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
    layout.cell(tile, k, &mut polygon, &mut candidates);
    let (pieces, is_cut) = match walls {
        Some(walls) => (cut(layout, (position, layout.spacing_at(tile, k)), &polygon, walls, ground)?, true),
        None if ground.is_there(position) => (vec![Piece::whole(&polygon)], false),
        None => (Vec::new(), false),
    };
    let next = |beyond: &Option<Beyond>| {
        Some(match (*beyond)? {
            Beyond::Side(side) => Next::Side(side),
            Beyond::Cell(number) => {
                let candidate = &candidates[number as usize];
                Next::Point(candidate.point, candidate.to)
            }
        })
    };
    Some(Entry { point, position, beyond: polygon.beyond.iter().map(next).collect(), pieces, is_cut })
}

/// The pieces of the Voronoi cell of a point where points are `spacing` m apart; none where no wall reaches into it. Beyond joined sides there are the
/// walls of the opposite side.
fn cut(
    layout: &Layout,
    (at, spacing): ([f64; 2], f64),
    polygon: &Polygon,
    walls: &Walls,
    ground: &impl Ground,
) -> Option<Vec<Piece>> {
    let size = layout.bounds.size();
    let low = [layout.bounds.x_min, layout.bounds.y_min];
    let along = |axis: usize| polygon.corners.iter().map(move |r| r[axis]);
    let from = [0, 1].map(|axis| at[axis] + along(axis).fold(f64::INFINITY, f64::min));
    let to = [0, 1].map(|axis| at[axis] + along(axis).fold(f64::NEG_INFINITY, f64::max));
    let images = |axis: usize| if layout.periodic[axis] { -1..=1 } else { 0..=0 };
    let mut near = Vec::new();
    let mut found = Vec::new();
    for column in images(0) {
        for row in images(1) {
            let shift = [f64::from(column) * size[0], f64::from(row) * size[1]];
            let moved = |corner: [f64; 2]| [corner[0] - shift[0], corner[1] - shift[1]];
            walls.near(moved(from), moved(to), &mut found);
            near.extend(found.iter().map(|number| {
                let ends = walls.all[*number as usize].ends;
                (*number, ends.map(|end| [0, 1].map(|axis| end[axis] + shift[axis] - at[axis])))
            }));
        }
    }
    let is_open = |r: [f64; 2]| {
        ground.is_there([0, 1].map(|axis| {
            let x = at[axis] + r[axis];
            if layout.periodic[axis] { low[axis] + (x - low[axis]).rem_euclid(size[axis]) } else { x }
        }))
    };
    split(polygon, near.into_iter(), spacing, is_open)
}

/// The work on all pieces, numbered entry by entry.
struct Build<'a> {
    layout: &'a Layout,
    walls: &'a Walls,
    entries: &'a [Entry],
    /// First piece of each entry.
    first: Vec<usize>,
    /// Entry of each piece.
    entry_of: Vec<usize>,
    index: HashMap<u64, usize>,
    edges: Vec<Vec<Rim>>,
    faces: u64,
}

/// From where to where along the edge between two points, and the piece.
type Stretch = (f64, f64, usize);

impl<'a> Build<'a> {
    fn new(layout: &'a Layout, walls: &'a Walls, entries: &'a [Entry]) -> Self {
        let mut first = Vec::with_capacity(entries.len());
        let mut entry_of = Vec::new();
        for (number, entry) in entries.iter().enumerate() {
            first.push(entry_of.len());
            entry_of.extend(entry.pieces.iter().map(|_| number));
        }
        let index = entries.iter().enumerate().map(|(number, entry)| (entry.point, number)).collect();
        let edges = entry_of.iter().map(|_| Vec::new()).collect();
        Self { layout, walls, entries, first, entry_of, index, edges, faces: 0 }
    }

    fn piece(&self, piece: usize) -> &Piece {
        let entry = self.entry_of[piece];
        &self.entries[entry].pieces[piece - self.first[entry]]
    }

    /// Number of a piece's cell if it is the first of the cell.
    fn id(&self, piece: usize) -> u64 {
        let entry = self.entry_of[piece];
        self.entries[entry].point + (piece - self.first[entry]) as u64 * self.layout.total()
    }

    /// Finds what lies behind the edges of all pieces.
    fn find_edges(&mut self) {
        for number in 0..self.entries.len() {
            self.add_walls(number);
            for edge in 0..self.entries[number].beyond.len() {
                match self.entries[number].beyond[edge] {
                    Some(Next::Side(side)) => self.add_plain(number, edge, || Outside::Border(side)),
                    Some(Next::Point(point, to)) => self.add_between(number, edge, point, to),
                    None => {}
                }
            }
        }
    }

    fn add_walls(&mut self, number: usize) {
        let first = self.first[number];
        for (k, piece) in self.entries[number].pieces.iter().enumerate() {
            for edge in &piece.edges {
                if let Behind::Wall(wall, _) = edge.behind {
                    let outside = Outside::of_wall(&self.walls.all[wall as usize], edge.ends);
                    self.edges[first + k].push(Rim::of(edge.ends, outside));
                }
            }
        }
    }

    /// Adds the parts of an edge of a Voronoi cell with the same behind them all along.
    fn add_plain(&mut self, number: usize, edge: usize, outside: impl Fn() -> Outside) {
        let first = self.first[number];
        for (k, piece) in self.entries[number].pieces.iter().enumerate() {
            for part in piece.edges.iter().filter(|part| part.behind == Behind::Edge(edge)) {
                self.edges[first + k].push(Rim::of(part.ends, outside()));
            }
        }
    }

    /// Adds faces where pieces on both sides of the edge between two points overlap, and walls where there is a piece on one side only. So both sides
    /// have the same faces, whatever rounding did.
    fn add_between(&mut self, number: usize, edge: usize, point: u64, to: [f64; 2]) {
        let own = self.entries[number].point;
        let Some(&other) = self.index.get(&point) else {
            return self.add_plain(number, edge, || Outside::Point(point, to));
        };
        if !self.entries[number].is_cut && !self.entries[other].is_cut {
            return self.add_plain(number, edge, || Outside::Point(point, to));
        }
        let is_back = |next: &Option<Next>| matches!(next, Some(Next::Point(point, _)) if *point == own);
        let back = self.entries[other].beyond.iter().position(is_back);
        if own > point && back.is_some() {
            return;
        }
        let distance = to[0].hypot(to[1]);
        let normal = to.map(|x| x / distance);
        let along = [-normal[1], normal[0]];
        let ours = self.stretches(number, edge, along);
        let theirs = back.map_or(Vec::new(), |back| self.stretches(other, back, along));
        let shortest = MIN_OVERLAP * self.layout.spacing();
        let rim = |from: f64, to: f64, sign: f64, beyond: Outside| {
            let middle = 0.5 * (from + to);
            let middle = [0, 1].map(|axis| sign * 0.5 * distance * normal[axis] + middle * along[axis]);
            Rim { normal: normal.map(|n| sign * (to - from) * n), middle, beyond }
        };
        let mut shared = Vec::new();
        for &(a, b, mine) in &ours {
            for &(c, d, yours) in &theirs {
                let (from, until) = (a.max(c), b.min(d));
                if until - from > shortest {
                    self.faces += 1;
                    shared.push((from, until));
                    self.edges[mine].push(rim(from, until, 1.0, Outside::Piece(yours, self.faces, to)));
                    let back = to.map(|x| -x);
                    self.edges[yours].push(rim(from, until, -1.0, Outside::Piece(mine, self.faces, back)));
                }
            }
        }
        shared.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (stretches, sign) in [(&ours, 1.0), (&theirs, -1.0)] {
            for &(from, until, piece) in stretches {
                let ends = shared.iter().copied().filter(|(_, end)| *end > from).chain([(until, until)]);
                let mut at = from;
                for (start, end) in ends {
                    if start.min(until) - at > shortest {
                        self.edges[piece].push(rim(at, start.min(until), sign, Outside::Wall(None)));
                    }
                    at = at.max(end);
                }
            }
        }
    }

    /// Where the pieces of an entry lie along one of its edges.
    fn stretches(&self, number: usize, edge: usize, along: [f64; 2]) -> Vec<Stretch> {
        let first = self.first[number];
        let mut stretches = Vec::new();
        for (k, piece) in self.entries[number].pieces.iter().enumerate() {
            for part in piece.edges.iter().filter(|part| part.behind == Behind::Edge(edge)) {
                let [a, b] = part.ends.map(|end| end[0] * along[0] + end[1] * along[1]);
                stretches.push((a.min(b), a.max(b), first + k));
            }
        }
        stretches.sort_by(|a, b| a.0.total_cmp(&b.0));
        stretches
    }

    /// The area below which a piece is small, m2.
    fn small(&self, piece: usize) -> f64 {
        let (tile, k) = self.layout.tile_and_index(self.entries[self.entry_of[piece]].point);
        MIN_AREA_RATIO * self.layout.spacing_at(tile, k).powi(2)
    }

    /// Whether a piece is a whole Voronoi cell. Its neighbours farther from the walls know it by its point, so that what is joined to it has its number;
    /// two whole cells are never joined.
    fn is_whole(&self, piece: usize) -> bool {
        !self.entries[self.entry_of[piece]].is_cut
    }

    /// Joins small pieces to neighbours, the smallest first, until they are no longer small, belong to a whole cell (which may be smaller, where cells
    /// are finer) or have no neighbour.
    fn join_small(&self) -> Groups {
        let count = self.entry_of.len();
        let mut groups = Groups::new(count);
        let mut area: Vec<f64> = (0..count).map(|piece| self.piece(piece).area).collect();
        let mut has_whole: Vec<bool> = (0..count).map(|piece| self.is_whole(piece)).collect();
        let mut members: Vec<Vec<usize>> = (0..count).map(|piece| vec![piece]).collect();
        let is_small = |piece: &usize| !self.is_whole(*piece) && self.piece(*piece).area < self.small(*piece);
        let mut queue: Vec<usize> = (0..count).filter(is_small).collect();
        queue.sort_by(|a, b| area[*a].total_cmp(&area[*b]).then(a.cmp(b)));
        for piece in queue {
            loop {
                let group = groups.root(piece);
                if has_whole[group] || area[group] >= self.small(piece) {
                    break;
                }
                let Some(other) = self.longest(&mut groups, group, &members[group]) else { break };
                let (low, high) = (group.min(other), group.max(other));
                groups.join(low, high);
                area[low] += area[high];
                has_whole[low] |= has_whole[high];
                let moved = std::mem::take(&mut members[high]);
                members[low].extend(moved);
            }
        }
        groups
    }

    /// The group with the longest faces to one; none where there is no open face.
    fn longest(&self, groups: &mut Groups, group: usize, members: &[usize]) -> Option<usize> {
        let mut lengths: Vec<(usize, f64)> = Vec::new();
        for edge in members.iter().flat_map(|piece| &self.edges[*piece]) {
            let Outside::Piece(other, ..) = edge.beyond else { continue };
            let other = groups.root(other);
            if other == group {
                continue;
            }
            let length = edge.normal[0].hypot(edge.normal[1]);
            match lengths.iter_mut().find(|(known, _)| *known == other) {
                Some((_, sum)) => *sum += length,
                None => lengths.push((other, length)),
            }
        }
        lengths.into_iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map(|(other, _)| other)
    }

    /// Makes the cells of groups of pieces.
    fn cells(&self, mut groups: Groups, ground: &impl Ground) -> Cuts {
        let count = self.entry_of.len();
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        let group_of: Vec<usize> = (0..count).map(|piece| groups.root(piece)).collect();
        (0..count).for_each(|piece| members[group_of[piece]].push(piece));
        members.retain(|members| !members.is_empty());
        let placed: Vec<Vec<Placed>> = members.par_iter().map(|members| self.place(members, &group_of)).collect();
        let mut home = vec![Placed::default(); count];
        let mut root = vec![0; count];
        for placed in &placed {
            for member in placed {
                home[member.piece] = *member;
                root[member.piece] = placed[0].piece;
            }
        }
        let made: Vec<(NewCell, Vec<Polygon2>)> =
            placed.par_iter().map(|placed| self.cell(placed, &home, &root, ground)).collect();
        let mut cuts = Cuts::default();
        self.entries.iter().for_each(|entry| _ = cuts.cells.insert(entry.point, Vec::new()));
        for ((cell, parts), placed) in made.into_iter().zip(&placed) {
            let entry = &self.entries[self.entry_of[placed[0].piece]];
            if entry.is_cut || placed.len() > 1 {
                cuts.parts.insert(cell.point, parts);
            }
            cuts.cells.entry(entry.point).or_default().push(cell);
        }
        for (number, entry) in self.entries.iter().enumerate().filter(|(_, entry)| entry.is_cut) {
            let pieces = entry.pieces.iter().enumerate();
            let pieces = pieces.map(|(k, piece)| (self.id(root[self.first[number] + k]), piece.parts.clone()));
            cuts.pieces.insert(entry.point, pieces.collect());
        }
        cuts.crests = self.crests(&root);
        cuts
    }

    /// The members of a group, the whole cell or else the largest first, and where their points are as seen from its.
    fn place(&self, members: &[usize], group_of: &[usize]) -> Vec<Placed> {
        let larger = |a: &&usize, b: &&usize| {
            let whole = self.is_whole(**a).cmp(&self.is_whole(**b));
            whole.then(self.piece(**a).area.total_cmp(&self.piece(**b).area)).then(b.cmp(a))
        };
        let root = members.iter().max_by(larger).copied().unwrap_or(members[0]);
        let mut placed = vec![Placed { piece: root, offset: [0.0; 2] }];
        let mut next = 0;
        while next < placed.len() && placed.len() < members.len() {
            let Placed { piece, offset } = placed[next];
            next += 1;
            for edge in &self.edges[piece] {
                let Outside::Piece(other, _, to) = edge.beyond else { continue };
                if group_of[other] == group_of[root] && placed.iter().all(|placed| placed.piece != other) {
                    placed.push(Placed { piece: other, offset: [0, 1].map(|axis| offset[axis] + to[axis]) });
                }
            }
        }
        placed
    }

    /// The cell of a group.
    fn cell(
        &self,
        placed: &[Placed],
        home: &[Placed],
        root: &[usize],
        ground: &impl Ground,
    ) -> (NewCell, Vec<Polygon2>) {
        let own = placed[0].piece;
        let base = self.entries[self.entry_of[own]].position;
        let (mut area, mut moment, mut heights, mut perimeter) = (0.0, [0.0; 2], 0.0, 0.0);
        let (mut edges, mut parts) = (Vec::new(), Vec::new());
        for &Placed { piece: number, offset } in placed {
            let piece = self.piece(number);
            let at = self.entries[self.entry_of[number]].position;
            let seen = [0, 1].map(|axis| base[axis] + offset[axis]);
            let lift = self.lift([0, 1].map(|axis| seen[axis] - at[axis]), ground);
            area += piece.area;
            (0..2).for_each(|axis| moment[axis] += piece.moment[axis] + piece.area * offset[axis]);
            for part in &piece.parts {
                let on_ground: Polygon2 = part.iter().map(|r| [at[0] + r[0], at[1] + r[1]]).collect();
                heights += super::polygon::area(part) * (ground.mean(&on_ground) + lift);
                parts.push(part.iter().map(|r| [seen[0] + r[0], seen[1] + r[1]]).collect::<Polygon2>());
            }
            for edge in &self.edges[number] {
                let length = edge.normal[0].hypot(edge.normal[1]);
                if length <= MIN_OVERLAP * self.layout.spacing() {
                    continue;
                }
                let Some(beyond) = self.beyond(edge, seen, own, home, root, ground) else { continue };
                perimeter += length;
                let middle = [0, 1].map(|axis| seen[axis] + edge.middle[axis]);
                edges.push(NewEdge { beyond, normal: edge.normal, middle });
            }
        }
        let mut width = 2.0 * area / perimeter;
        let is_open = |edge: &NewEdge| !matches!(edge.beyond, NewBeyond::Wall(_) | NewBeyond::Border(_));
        if area < self.small(own) && !edges.iter().any(is_open) {
            // Enclosed by walls: its water does not move.
            edges.clear();
            width = f64::INFINITY;
        }
        let whole = area.max(f64::MIN_POSITIVE);
        let point = self.entries[self.entry_of[own]].point;
        let (tile, k) = self.layout.tile_and_index(point);
        let cell = NewCell {
            point: self.id(own),
            centroid: [0, 1].map(|axis| base[axis] + moment[axis] / whole),
            area,
            width,
            bed: heights / whole,
            heights: ground.heights(&parts, heights / whole),
            rim: rim(self.layout, tile, k, RIM * self.layout.rim),
            edges,
        };
        (cell, parts)
    }

    /// What lies behind an edge of a piece whose point is seen at `seen` from the cell `own`; none within the cell.
    fn beyond(
        &self,
        edge: &Rim,
        seen: [f64; 2],
        own: usize,
        home: &[Placed],
        root: &[usize],
        ground: &impl Ground,
    ) -> Option<NewBeyond> {
        Some(match edge.beyond {
            Outside::Border(side) => NewBeyond::Border(side),
            Outside::Wall(obstacle) => NewBeyond::Wall(obstacle),
            Outside::Line(number) => NewBeyond::Line(number),
            Outside::Point(point, to) => super::neighbour(self.layout, seen, to, point, ground),
            Outside::Piece(other, face, to) => {
                let theirs = root[other];
                if theirs == own {
                    return None;
                }
                let base = self.entries[self.entry_of[theirs]].position;
                let size = self.layout.bounds.size();
                let shift = [0, 1].map(|axis| {
                    let shift = seen[axis] + to[axis] - (base[axis] + home[other].offset[axis]);
                    (shift / size[axis]).round() * size[axis]
                });
                NewBeyond::Cell { point: self.id(theirs), face, shift, lift: self.lift(shift, ground) }
            }
        })
    }

    /// By how much the ground stands higher that is seen so far away, m: a whole number of times across joined sides.
    fn lift(&self, shift: [f64; 2], ground: &impl Ground) -> f64 {
        let size = self.layout.bounds.size();
        (0..2).map(|axis| (shift[axis] / size[axis]).round() * ground.lift()[axis]).sum()
    }

    /// Walls with a crest between two cells.
    fn crests(&self, root: &[usize]) -> Vec<Crest> {
        let mut crests = Vec::new();
        for (number, entry) in self.entries.iter().enumerate() {
            let first = self.first[number];
            for (k, piece) in entry.pieces.iter().enumerate() {
                for edge in &piece.edges {
                    let Behind::Wall(wall, Some(other)) = edge.behind else { continue };
                    let [a, b] = [k, other].map(|piece| root[first + piece]);
                    let wall = &self.walls.all[wall as usize];
                    if k < other && a != b && wall.crest[0].is_finite() {
                        let [p, q] = edge.ends;
                        let middle = [0, 1].map(|axis| entry.position[axis] + 0.5 * (p[axis] + q[axis]));
                        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
                        crests.push(Crest { points: [self.id(a), self.id(b)], length, level: wall.crest_at(middle) });
                    }
                }
            }
        }
        crests
    }
}

/// A piece of a cell, and where its point is as seen from the cell's.
#[derive(Debug, Clone, Copy, Default)]
struct Placed {
    piece: usize,
    offset: [f64; 2],
}

impl Outside {
    /// What a wall is to a piece with an edge on it. The piece lies on the left of its edge.
    fn of_wall(wall: &Wall, [a, b]: [[f64; 2]; 2]) -> Self {
        let [from, to] = wall.ends;
        let along = (b[0] - a[0]) * (to[0] - from[0]) + (b[1] - a[1]) * (to[1] - from[1]);
        match wall.kind {
            WallKind::Obstacle(obstacle) => Self::Wall(Some(obstacle)),
            WallKind::Side(number) if along < 0.0 => Self::Line(number),
            WallKind::Side(_) | WallKind::Plain => Self::Wall(None),
        }
    }
}

impl Rim {
    fn of([a, b]: [[f64; 2]; 2], beyond: Outside) -> Self {
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        Self { normal: [b[1] - a[1], a[0] - b[0]], middle, beyond }
    }
}
