//! A convex polygon cut by walls into pieces.
//!
//! The polygon is divided along the lines of the walls that reach into it (binary space partition: Fuchs, Kedem & Naylor 1980) into convex parts, and
//! parts between which no wall stands are joined to pieces. So walls that end inside, cross, or overlap need no cases of their own.

use super::polygon::Polygon;

/// What lies on a line to this part of the spacing is on it.
const ON_LINE: f64 = 1e-9;

/// Openings narrower than this part of the spacing let no water through: walls that meet do so to rounding.
const OPENING: f64 = 1e-6;

/// What lies beyond an edge of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Behind {
    /// What lies beyond this edge of the polygon.
    Edge(usize),
    /// A wall, by its number, and the piece on its other side, if there is one.
    Wall(u32, Option<usize>),
}

/// An edge of a piece, which lies to its left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub ends: [[f64; 2]; 2],
    pub behind: Behind,
}

/// A part of a polygon that walls enclose.
#[derive(Debug, Clone, Default)]
pub(crate) struct Piece {
    /// Convex polygons that fill it, corners in counter-clockwise order.
    pub parts: Vec<Vec<[f64; 2]>>,
    /// m2.
    pub area: f64,
    /// Area times centroid, m3.
    pub moment: [f64; 2],
    pub edges: Vec<Edge>,
}

/// A convex part.
struct Part {
    corners: Vec<[f64; 2]>,
    /// What each edge lies on.
    on: Vec<On>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum On {
    /// An edge of the polygon.
    Edge(usize),
    /// The line of a wall, and whether the part lies to its left.
    Wall(usize, bool),
}

/// A wall that reaches into the polygon: its number, its start, direction and length there.
#[derive(Debug, Clone, Copy)]
struct Reach {
    number: u32,
    start: [f64; 2],
    along: [f64; 2],
    length: f64,
}

impl Reach {
    /// Coordinates of a position along the wall and to its left.
    fn coordinates(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([dx, dy], [u, v]) = ([x - self.start[0], y - self.start[1]], self.along);
        [dx * u + dy * v, dy * u - dx * v]
    }

    fn at(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.start[axis] + t * self.along[axis])
    }
}

/// Area and area times centroid of a polygon.
fn moments(corners: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let (mut twice, mut moment) = (0.0, [0.0; 2]);
    let origin = corners[0];
    for k in 1..corners.len() {
        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]].map(|r| [r[0] - origin[0], r[1] - origin[1]]);
        let cross = a[0] * b[1] - b[0] * a[1];
        twice += cross;
        (0..2).for_each(|axis| moment[axis] += cross * (a[axis] + b[axis]));
    }
    (0.5 * twice, [0, 1].map(|axis| moment[axis] / 6.0 + 0.5 * twice * origin[axis]))
}

/// The part of a straight line inside a convex polygon, as parts of its length; none where it is shorter than `least` m.
fn inside([a, b]: [[f64; 2]; 2], corners: &[[f64; 2]], least: f64) -> Option<[f64; 2]> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let [mut from, mut to] = [0.0_f64, 1.0_f64];
    for k in 0..corners.len() {
        let [p, q] = [corners[k], corners[(k + 1) % corners.len()]];
        let left = |r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let [start, end] = [left(a), left(b)];
        if start <= 0.0 && end <= 0.0 {
            return None;
        }
        if start < 0.0 {
            from = from.max(start / (start - end));
        } else if end < 0.0 {
            to = to.min(start / (start - end));
        }
    }
    ((to - from) * length > least).then_some([from, to])
}

/// Cuts a polygon by walls (number and ends, relative to the same point) where they reach into it, and leaves out the parts for which `is_open` is false
/// at their centroid. None where no wall does.
pub(crate) fn split(
    polygon: &Polygon,
    walls: impl Iterator<Item = (u32, [[f64; 2]; 2])>,
    spacing: f64,
    is_open: impl Fn([f64; 2]) -> bool,
) -> Option<Vec<Piece>> {
    let on_line = ON_LINE * spacing;
    let reach = |(number, ends): (u32, [[f64; 2]; 2])| {
        let [from, to] = inside(ends, &polygon.corners, on_line)?;
        let [a, b] = ends;
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let along = [0, 1].map(|axis| (b[axis] - a[axis]) / length);
        let start = [0, 1].map(|axis| a[axis] + from * (b[axis] - a[axis]));
        Some(Reach { number, start, along, length: (to - from) * length })
    };
    let walls: Vec<Reach> = walls.filter_map(reach).collect();
    if walls.is_empty() {
        return None;
    }
    let parts = divide(polygon, &walls, on_line);
    let open: Vec<bool> = parts.iter().map(|part| is_open(centroid(&part.corners))).collect();
    Some(join(&parts, &open, &walls, spacing))
}

fn centroid(corners: &[[f64; 2]]) -> [f64; 2] {
    let (area, moment) = moments(corners);
    if area > 0.0 { moment.map(|m| m / area) } else { corners[0] }
}

/// Divides the polygon along each wall, the part through which it goes along its whole line.
fn divide(polygon: &Polygon, walls: &[Reach], on_line: f64) -> Vec<Part> {
    let whole = Part { corners: polygon.corners.clone(), on: (0..polygon.corners.len()).map(On::Edge).collect() };
    let mut parts = vec![whole];
    for (number, wall) in walls.iter().enumerate() {
        for k in 0..parts.len() {
            if inside([wall.start, wall.at(wall.length)], &parts[k].corners, on_line).is_none() {
                continue;
            }
            if let Some([left, right]) = halves(&parts[k], wall, number, on_line) {
                parts[k] = left;
                parts.push(right);
            }
        }
    }
    parts
}

/// The halves of a part to the left and to the right of a wall's line; none where it lies on one side.
fn halves(part: &Part, wall: &Reach, number: usize, on_line: f64) -> Option<[Part; 2]> {
    let distance = |corner: &[f64; 2]| {
        let [_, left] = wall.coordinates(*corner);
        if left.abs() <= on_line { 0.0 } else { left }
    };
    let distances: Vec<f64> = part.corners.iter().map(distance).collect();
    if distances.iter().all(|d| *d <= 0.0) || distances.iter().all(|d| *d >= 0.0) {
        return None;
    }
    let mut halves = [1.0, -1.0].map(|sign| (sign, Part { corners: Vec::new(), on: Vec::new() }));
    for k in 0..part.corners.len() {
        let next = (k + 1) % part.corners.len();
        let crossing = (distances[k] * distances[next] < 0.0).then(|| {
            let share = distances[k] / (distances[k] - distances[next]);
            let [p, q] = [part.corners[k], part.corners[next]];
            [0, 1].map(|axis| p[axis] + share * (q[axis] - p[axis]))
        });
        for (sign, half) in &mut halves {
            let line = On::Wall(number, *sign > 0.0);
            let [here, there] = [*sign * distances[k], *sign * distances[next]];
            if here >= 0.0 {
                half.corners.push(part.corners[k]);
                half.on.push(if here == 0.0 && there < 0.0 { line } else { part.on[k] });
            }
            if let Some(crossing) = crossing {
                half.corners.push(crossing);
                half.on.push(if here > 0.0 { line } else { part.on[k] });
            }
        }
    }
    Some(halves.map(|(_, part)| part))
}

/// A stretch of a line with a part on each side.
struct Shared {
    /// The parts to the left and to the right.
    parts: [usize; 2],
    /// The line's wall.
    line: usize,
    /// From where to where along it.
    from: f64,
    to: f64,
    /// The wall that stands there, if one does.
    wall: Option<u32>,
}

/// The stretches that parts share.
fn shared(parts: &[Part], walls: &[Reach], on_line: f64) -> Vec<Shared> {
    let mut shared = Vec::new();
    for (line, wall) in walls.iter().enumerate() {
        let sides = [true, false].map(|left| {
            let mut stretches = Vec::new();
            for (number, part) in parts.iter().enumerate() {
                for k in (0..part.on.len()).filter(|k| part.on[*k] == On::Wall(line, left)) {
                    let ends = [part.corners[k], part.corners[(k + 1) % part.corners.len()]];
                    let [a, b] = ends.map(|end| wall.coordinates(end)[0]);
                    stretches.push((number, a.min(b), a.max(b)));
                }
            }
            stretches
        });
        if sides[0].is_empty() {
            continue;
        }
        let covers = covers(wall, walls, on_line);
        for &(left, from, to) in &sides[0] {
            for &(right, start, end) in &sides[1] {
                let (from, to) = (from.max(start), to.min(end));
                if from < to {
                    let mut add = |from: f64, to: f64, wall| {
                        if from < to {
                            shared.push(Shared { parts: [left, right], line, from, to, wall });
                        }
                    };
                    let mut at = from;
                    for &(start, end, wall) in covers.iter().filter(|(start, end, _)| *end > from && *start < to) {
                        add(at, start.min(to), None);
                        add(at.max(start), end.min(to), Some(wall));
                        at = at.max(end);
                    }
                    add(at, to, None);
                }
            }
        }
    }
    shared
}

/// Where walls stand on the line of one: from where to where, and which.
fn covers(line: &Reach, walls: &[Reach], on_line: f64) -> Vec<(f64, f64, u32)> {
    let cover = |wall: &Reach| {
        let [[a, p], [b, q]] = [wall.start, wall.at(wall.length)].map(|end| line.coordinates(end));
        (p.abs() <= 2.0 * on_line && q.abs() <= 2.0 * on_line).then_some((a.min(b), a.max(b), wall.number))
    };
    let mut covers: Vec<_> = walls.iter().filter_map(cover).collect();
    covers.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    covers
}

/// Joins open parts between which no wall stands.
fn join(parts: &[Part], open: &[bool], walls: &[Reach], spacing: f64) -> Vec<Piece> {
    let shared = shared(parts, walls, ON_LINE * spacing);
    let mut groups = Groups::new(parts.len());
    for stretch in shared.iter().filter(|stretch| stretch.wall.is_none()) {
        let [left, right] = stretch.parts;
        if open[left] && open[right] && stretch.to - stretch.from > OPENING * spacing {
            groups.join(left, right);
        }
    }
    let mut number = vec![usize::MAX; parts.len()];
    let mut pieces: Vec<Piece> = Vec::new();
    for part in (0..parts.len()).filter(|part| open[*part]) {
        let root = groups.root(part);
        if number[root] == usize::MAX {
            number[root] = pieces.len();
            pieces.push(Piece::default());
        }
        pieces[number[root]].add(&parts[part]);
    }
    let piece = |groups: &mut Groups, part: usize| open[part].then(|| number[groups.root(part)]);
    for stretch in &shared {
        let [left, right] = stretch.parts.map(|part| piece(&mut groups, part));
        if left == right {
            continue;
        }
        let line = &walls[stretch.line];
        let wall = stretch.wall.unwrap_or(line.number);
        let [from, to] = [stretch.from, stretch.to].map(|t| line.at(t));
        for (own, other, ends) in [(left, right, [from, to]), (right, left, [to, from])] {
            if let Some(own) = own {
                pieces[own].edges.push(Edge { ends, behind: Behind::Wall(wall, other) });
            }
        }
    }
    pieces
}

impl Piece {
    /// Joins a convex part to it, with those of its edges that lie on the polygon's.
    fn add(&mut self, part: &Part) {
        let (area, moment) = moments(&part.corners);
        self.area += area;
        (0..2).for_each(|axis| self.moment[axis] += moment[axis]);
        for (k, on) in part.on.iter().enumerate() {
            if let On::Edge(edge) = on {
                let ends = [part.corners[k], part.corners[(k + 1) % part.corners.len()]];
                self.edges.push(Edge { ends, behind: Behind::Edge(*edge) });
            }
        }
        self.parts.push(part.corners.clone());
    }

    /// A whole polygon.
    pub fn whole(polygon: &Polygon) -> Self {
        let mut piece = Self::default();
        piece.add(&Part { corners: polygon.corners.clone(), on: (0..polygon.corners.len()).map(On::Edge).collect() });
        piece
    }
}

/// Whether a convex polygon holds a position.
pub(crate) fn holds(corners: &[[f64; 2]], at: [f64; 2]) -> bool {
    (0..corners.len()).all(|k| {
        let [p, q] = [corners[k], corners[(k + 1) % corners.len()]];
        (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]) >= 0.0
    })
}

/// Sets of numbers that are joined (union-find; the root is the least number).
pub(crate) struct Groups(Vec<usize>);

impl Groups {
    pub fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    pub fn root(&mut self, mut of: usize) -> usize {
        while self.0[of] != of {
            self.0[of] = self.0[self.0[of]];
            of = self.0[of];
        }
        of
    }

    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn square() -> Polygon {
        let mut polygon = Polygon::default();
        polygon.reset(1.0);
        polygon
    }

    /// Sum of length times normal.
    fn opening(piece: &Piece) -> f64 {
        let sum = piece
            .edges
            .iter()
            .fold([0.0; 2], |sum, Edge { ends: [a, b], .. }| [sum[0] + b[1] - a[1], sum[1] + a[0] - b[0]]);
        sum[0].hypot(sum[1])
    }

    fn cut(walls: &[[[f64; 2]; 2]], is_open: impl Fn([f64; 2]) -> bool) -> Vec<Piece> {
        split(&square(), walls.iter().enumerate().map(|(k, ends)| (k as u32, *ends)), 1.0, is_open).unwrap()
    }

    #[test]
    fn walls_that_cross_make_four_pieces_and_one_that_ends_inside_none() {
        let pieces = cut(&[[[-2.0, 0.0], [2.0, 0.0]], [[0.3, -2.0], [0.3, 2.0]]], |_| true);
        let mut areas: Vec<f64> = pieces.iter().map(|piece| piece.area).collect();
        areas.sort_by(f64::total_cmp);
        assert!(areas.iter().zip([0.7, 0.7, 1.3, 1.3]).all(|(a, b)| (a - b).abs() < 1e-14), "{areas:?}");
        let pieces = cut(&[[[-2.0, 0.0], [0.5, 0.0]]], |_| true);
        assert!(pieces.len() == 1 && (pieces[0].area - 4.0).abs() < 1e-14 && opening(&pieces[0]) < 1e-14);
        assert!(pieces[0].edges.iter().all(|edge| matches!(edge.behind, Behind::Edge(_))));
    }

    #[test]
    fn an_obstacle_inside_is_left_out_and_a_ring_of_walls_encloses() {
        let ring = [[-0.5, -0.5], [0.5, -0.4], [0.4, 0.5], [-0.3, 0.2]];
        let walls: Vec<_> = (0..4).map(|k| [ring[k], ring[(k + 1) % 4]]).collect();
        let area = moments(&ring).0;
        let pieces = cut(&walls, |_| true);
        assert!(pieces.len() == 2 && pieces.iter().any(|piece| (piece.area - area).abs() < 1e-14));
        assert!(pieces.iter().all(|piece| opening(piece) < 1e-14));
        let pieces = cut(&walls, |[x, y]| !crate::polygon::is_inside(&ring, x, y));
        assert!(pieces.len() == 1 && (pieces[0].area - (4.0 - area)).abs() < 1e-14 && opening(&pieces[0]) < 1e-14);
    }

    /// Closed pieces that fill the polygon, whatever walls there are: crossing, overlapping, touching its corners.
    #[test]
    fn pieces_close_and_fill_the_polygon() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        for round in 0..300 {
            let mut number = || {
                let x: f64 = random.random_range(-1.2..1.2);
                // Every other round on a lattice, so that much coincides.
                if round % 2 == 0 { x } else { (x * 4.0).round() / 4.0 }
            };
            let walls: Vec<_> = (0..12).map(|_| [[number(), number()], [number(), number()]]).collect();
            let walls: Vec<_> = walls.into_iter().filter(|[a, b]| a != b).collect();
            let pieces = cut(&walls, |_| true);
            let area: f64 = pieces.iter().map(|piece| piece.area).sum();
            assert!((area - 4.0).abs() < 1e-12, "{area}");
            for piece in &pieces {
                assert!(opening(piece) < 1e-8, "{round}: {:e}", opening(piece));
            }
        }
    }
}
