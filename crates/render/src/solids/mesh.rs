//! Meshes from signed distances.
//!
//! Dual contouring (Ju, Losasso, Schaefer & Warren, SIGGRAPH 2002): a vertex in each cell of a grid that the surface crosses, a
//! quad for each edge of the grid that it crosses. Vertices are moved to where the planes through a cell's crossings meet by
//! steps along their errors (Schmitz et al. 2009, "Isosurfaces from distance fields"), so edges stay sharp.

use corpuscle_model::SolidShape;
use std::collections::HashMap;

/// Cells along the longest side of a solid; and at least along each.
const CELLS: usize = 72;
const FEWEST: usize = 7;
/// Steps of halving for a crossing, and of moving a vertex.
const HALVINGS: usize = 12;
const MOVES: usize = 24;

/// Corners of triangles, three by three: position, m, and outward normal.
pub(super) type Corners = Vec<([f64; 3], [f64; 3])>;

type Point = [f64; 3];

/// The grid round a solid.
struct Grid<'a> {
    shape: &'a SolidShape,
    from: Point,
    cell: Point,
    count: [usize; 3],
    /// Distances at the nodes.
    nodes: Vec<f64>,
}

/// The mesh of a solid.
pub(super) fn mesh(shape: &SolidShape) -> Corners {
    let grid = Grid::round(shape);
    let (vertices, crossings) = grid.vertices();
    let mut corners = Corners::new();
    for (edge, inside_first) in crossings {
        let Some(quad) = grid.quad(&edge, &vertices) else { continue };
        let quad = if inside_first { quad } else { [quad[3], quad[2], quad[1], quad[0]] };
        let centre: Point = std::array::from_fn(|k| quad.iter().map(|corner| corner[k]).sum::<f64>() / 4.0);
        let corner = |number: usize| {
            // Sampled a little within its quad, so that an edge keeps its two normals.
            let at: Point = std::array::from_fn(|k| 0.9 * quad[number][k] + 0.1 * centre[k]);
            (quad[number], grid.normal_at(at))
        };
        corners.extend([0, 1, 2, 0, 2, 3].map(corner));
    }
    corners
}

/// An edge of the grid: the node it begins at and its axis.
type Edge = ([usize; 3], usize);
/// Vertices by cell, and the edges that the surface crosses, with whether they begin inside.
type Crossed = (HashMap<[usize; 3], Point>, Vec<(Edge, bool)>);

impl<'a> Grid<'a> {
    fn round(shape: &'a SolidShape) -> Self {
        let [low, high] = shape.bounds;
        let longest = (0..3).map(|k| high[k] - low[k]).fold(1e-12, f64::max);
        let inner: [usize; 3] =
            std::array::from_fn(|k| ((CELLS as f64 * (high[k] - low[k]) / longest).round() as usize).max(FEWEST));
        let cell: Point = std::array::from_fn(|k| ((high[k] - low[k]) / inner[k] as f64).max(1e-9 * longest));
        // One and a half cells of room on each side; no face of the solid lies on nodes.
        let from = std::array::from_fn(|k| low[k] - 1.5 * cell[k]);
        let count = inner.map(|cells| cells + 4);
        let mut grid = Self { shape, from, cell, count, nodes: Vec::new() };
        grid.nodes =
            (0..count.iter().product()).map(|index| (shape.distance)(grid.position(grid.node(index)))).collect();
        grid
    }

    fn node(&self, index: usize) -> [usize; 3] {
        let [x, y, _] = self.count;
        [index % x, index / x % y, index / (x * y)]
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.count[1] + y) * self.count[0] + x
    }

    fn position(&self, node: [usize; 3]) -> Point {
        std::array::from_fn(|k| self.from[k] + self.cell[k] * node[k] as f64)
    }

    /// The outward unit normal at a position: the normalised gradient of the distance.
    fn normal_at(&self, at: Point) -> Point {
        let step = 0.02 * self.cell.iter().copied().fold(f64::INFINITY, f64::min);
        let slope: Point = std::array::from_fn(|k| {
            let [mut before, mut after] = [at; 2];
            (before[k], after[k]) = (at[k] - step, at[k] + step);
            (self.shape.distance)(after) - (self.shape.distance)(before)
        });
        let length = slope.iter().map(|part| part * part).sum::<f64>().sqrt().max(1e-300);
        slope.map(|part| part / length)
    }

    /// A vertex in each cell that the surface crosses, and the edges that it crosses, with whether they begin inside.
    fn vertices(&self) -> Crossed {
        let mut planes: HashMap<[usize; 3], Vec<(Point, Point)>> = HashMap::new();
        let mut crossings = Vec::new();
        for index in 0..self.nodes.len() {
            let node = self.node(index);
            for axis in 0..3 {
                let mut next = node;
                next[axis] += 1;
                if next[axis] >= self.count[axis] {
                    continue;
                }
                let inside_first = self.nodes[index] < 0.0;
                if inside_first == (self.nodes[self.index(next)] < 0.0) {
                    continue;
                }
                let at = self.crossing(self.position(node), axis, inside_first);
                let plane = (at, self.normal_at(at));
                self.cells_round(&(node, axis))
                    .into_iter()
                    .flatten()
                    .for_each(|cell| planes.entry(cell).or_default().push(plane));
                crossings.push(((node, axis), inside_first));
            }
        }
        let vertices = planes.into_iter().map(|(cell, planes)| (cell, self.vertex(cell, &planes))).collect();
        (vertices, crossings)
    }

    /// Where the surface crosses an edge.
    fn crossing(&self, start: Point, axis: usize, inside_first: bool) -> Point {
        let (mut low, mut high) = (0.0, self.cell[axis]);
        let mut at = start;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            at[axis] = start[axis] + middle;
            if ((self.shape.distance)(at) < 0.0) == inside_first { low = middle } else { high = middle }
        }
        at[axis] = start[axis] + 0.5 * (low + high);
        at
    }

    /// Where the planes of a cell meet best, within it.
    fn vertex(&self, cell: [usize; 3], planes: &[(Point, Point)]) -> Point {
        let count = planes.len() as f64;
        let mut at: Point = std::array::from_fn(|k| planes.iter().map(|(point, _)| point[k]).sum::<f64>() / count);
        for _ in 0..MOVES {
            let mut push = [0.0; 3];
            for (point, normal) in planes {
                let off: f64 = (0..3).map(|k| normal[k] * (at[k] - point[k])).sum();
                (0..3).for_each(|k| push[k] -= off * normal[k]);
            }
            let low = self.position(cell);
            at = std::array::from_fn(|k| (at[k] + push[k] / count).clamp(low[k], low[k] + self.cell[k]));
        }
        at
    }

    /// The four cells round an edge, in turn; none where one lies outside the grid.
    fn cells_round(&self, (node, axis): &Edge) -> Option<[[usize; 3]; 4]> {
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        if node[one] == 0 || node[other] == 0 {
            return None;
        }
        Some([[1, 1], [0, 1], [0, 0], [1, 0]].map(|[a, b]| {
            let mut cell = *node;
            cell[one] -= a;
            cell[other] -= b;
            cell
        }))
    }

    fn quad(&self, edge: &Edge, vertices: &HashMap<[usize; 3], Point>) -> Option<[Point; 4]> {
        let cells = self.cells_round(edge)?;
        let mut quad = [[0.0; 3]; 4];
        for (corner, cell) in quad.iter_mut().zip(&cells) {
            *corner = *vertices.get(cell)?;
        }
        Some(quad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn solid(bounds: [Point; 2], distance: impl Fn(Point) -> f64 + Send + Sync + 'static) -> SolidShape {
        SolidShape { bounds, distance: Arc::new(distance) }
    }

    /// Volume inside a mesh whose triangles turn left seen from outside.
    fn volume(corners: &Corners) -> f64 {
        let of = |a: Point, b: Point, c: Point| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        corners.chunks_exact(3).map(|t| of(t[0].0, t[1].0, t[2].0) / 6.0).sum()
    }

    #[test]
    fn a_thin_pane_keeps_its_edges_and_a_ball_is_round() {
        let half = [0.15, 0.1, 0.002];
        let pane = solid([half.map(|length| -length), half], move |at| {
            let off: Point = std::array::from_fn(|k| at[k].abs() - half[k]);
            let outside = off.iter().map(|length| length.max(0.0).powi(2)).sum::<f64>().sqrt();
            outside + off.iter().copied().fold(f64::NEG_INFINITY, f64::max).min(0.0)
        });
        let corners = mesh(&pane);
        let exact = 8.0 * half.iter().product::<f64>();
        assert!((volume(&corners) / exact - 1.0).abs() < 0.01, "{} {exact}", volume(&corners));
        let ball = solid([[-1.0; 3], [1.0; 3]], |at| at.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0);
        let corners = mesh(&ball);
        assert!((volume(&corners) / 4.18879 - 1.0).abs() < 0.01, "{}", volume(&corners));
        for (position, normal) in corners {
            let along: f64 = (0..3).map(|k| position[k] * normal[k]).sum();
            assert!(along > 0.995, "{position:?} {normal:?}");
        }
    }
}
