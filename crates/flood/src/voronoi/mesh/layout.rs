//! Where the particles stand: a pattern of points without order, repeated over tiles that fill the terrain.
//!
//! Any part of the plane can be filled when water comes there, and always with the same particles.

use super::polygon::{Beyond, Polygon};
use corpuscle_terrain::Bounds;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Points along a side of a tile, where the terrain is wide enough.
const POINTS_A_SIDE: f64 = 32.0;

/// Fewest points along a side of the terrain: no cell is its own neighbour, and none is another's twice.
const FEWEST_A_SIDE: f64 = 5.0;

/// Greatest shift of a point from its place in the lattice, part of the spacing.
const JITTER: f64 = 0.5;

/// Rounds in which each point moves to the centroid of its cell (Lloyd 1982).
const ROUNDS: usize = 10;

/// Tiles of points over a rectangle.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub bounds: Bounds,
    /// Whether the west and east, the south and north sides are joined.
    pub periodic: [bool; 2],
    /// Number of tiles along x and y.
    pub tiles: [usize; 2],
    /// Size of a tile, m.
    pub tile: [f64; 2],
    /// Points of a tile, relative to its south-west corner, m, bin by bin.
    pub points: Vec<[f64; 2]>,
    /// Bins of a tile along x and y.
    bins: [usize; 2],
    /// First point of each bin, row by row, and the number of points at the end.
    starts: Vec<u32>,
}

/// A neighbour that may have an edge of the cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    /// Square of the distance, m2.
    squared: f64,
    /// From the point to the neighbour, m.
    pub to: [f64; 2],
    /// The neighbour's number: tile times points a tile plus point.
    pub point: u64,
}

impl Layout {
    /// Points about `spacing` m apart over `bounds`, by the random numbers of `seed`.
    pub fn new(bounds: Bounds, periodic: [bool; 2], spacing: f64, seed: u64) -> Self {
        let size = bounds.size();
        let count = size.map(|length| (length / spacing).round().max(FEWEST_A_SIDE));
        let tiles = count.map(|count| (count / POINTS_A_SIDE).round().max(1.0));
        let lattice = [0, 1].map(|axis| (count[axis] / tiles[axis]).round().max(FEWEST_A_SIDE));
        let tile = [0, 1].map(|axis| size[axis] / tiles[axis]);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let step = [0, 1].map(|axis| tile[axis] / lattice[axis]);
        let points = (0..(lattice[0] * lattice[1]) as usize).map(|k| {
            let place = [k % lattice[0] as usize, k / lattice[0] as usize];
            [0, 1].map(|axis| (place[axis] as f64 + 0.5 + random.random_range(-JITTER..JITTER)) * step[axis])
        });
        let bins = lattice.map(|points| points as usize);
        let mut pattern = Self {
            bounds: Bounds { x_min: 0.0, x_max: tile[0], y_min: 0.0, y_max: tile[1] },
            periodic: [true; 2],
            tiles: [1; 2],
            tile,
            points: points.collect(),
            bins,
            starts: Vec::new(),
        };
        pattern.sort();
        for _ in 0..ROUNDS {
            pattern.relax();
        }
        Self { bounds, periodic, tiles: tiles.map(|count| count as usize), ..pattern }
    }

    /// Sorts the points into bins.
    fn sort(&mut self) {
        let (tile, bins) = (self.tile, self.bins);
        let bin = |point: &[f64; 2]| {
            let [column, row] =
                [0, 1].map(|axis| ((point[axis] / tile[axis] * bins[axis] as f64) as usize).min(bins[axis] - 1));
            row * bins[0] + column
        };
        self.points.sort_by_key(bin);
        self.starts.clear();
        self.starts.resize(bins[0] * bins[1] + 1, 0);
        self.points.iter().for_each(|point| self.starts[bin(point) + 1] += 1);
        (1..self.starts.len()).for_each(|k| self.starts[k] += self.starts[k - 1]);
    }

    /// Moves each point to the centroid of its cell.
    fn relax(&mut self) {
        let moved = |(k, point): (usize, &[f64; 2])| {
            let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
            self.cell(0, k, &mut polygon, &mut candidates);
            let centroid = polygon.measures().centroid;
            [0, 1].map(|axis| (point[axis] + centroid[axis]).rem_euclid(self.tile[axis]))
        };
        self.points = self.points.par_iter().enumerate().map(moved).collect();
        self.sort();
    }

    /// Mean distance of the points, m.
    pub fn spacing(&self) -> f64 {
        (self.tile[0] * self.tile[1] / self.points.len() as f64).sqrt()
    }

    /// South-west corner of a tile, m.
    pub fn corner(&self, tile: usize) -> [f64; 2] {
        let place = [tile % self.tiles[0], tile / self.tiles[0]];
        let low = [self.bounds.x_min, self.bounds.y_min];
        [0, 1].map(|axis| low[axis] + place[axis] as f64 * self.tile[axis])
    }

    /// Position of point `k` of a tile, m.
    pub fn position(&self, tile: usize, k: usize) -> [f64; 2] {
        let corner = self.corner(tile);
        [0, 1].map(|axis| corner[axis] + self.points[k][axis])
    }

    /// Number of points of all tiles.
    pub fn total(&self) -> u64 {
        (self.tiles[0] * self.tiles[1] * self.points.len()) as u64
    }

    /// Points in the bins that a rectangle touches, round joined sides.
    pub fn points_within(&self, low: [f64; 2], high: [f64; 2]) -> impl Iterator<Item = u64> {
        let corner = [self.bounds.x_min, self.bounds.y_min];
        let span = move |axis: usize| {
            let size = self.tile[axis] / self.bins[axis] as f64;
            let [from, to] = [low, high].map(|end| ((end[axis] - corner[axis]) / size).floor() as i64);
            let count = (self.tiles[axis] * self.bins[axis]) as i64;
            let (from, to) = if self.periodic[axis] { (from, to) } else { (from.max(0), to.min(count - 1)) };
            (from..=to).map(move |bin| bin.rem_euclid(count) as usize)
        };
        span(1).flat_map(move |row| {
            span(0).flat_map(move |column| {
                let tile = row / self.bins[1] * self.tiles[0] + column / self.bins[0];
                let bin = row % self.bins[1] * self.bins[0] + column % self.bins[0];
                let points = self.starts[bin]..self.starts[bin + 1];
                points.map(move |k| (tile * self.points.len()) as u64 + u64::from(k))
            })
        })
    }

    /// The tile that holds a position; the nearest where none does.
    pub fn tile_at(&self, at: [f64; 2]) -> usize {
        let low = [self.bounds.x_min, self.bounds.y_min];
        let [column, row] =
            [0, 1].map(|axis| (((at[axis] - low[axis]) / self.tile[axis]).max(0.0) as usize).min(self.tiles[axis] - 1));
        row * self.tiles[0] + column
    }

    /// The tile `[dx, dy]` tiles away from one, round joined sides; none beyond others.
    pub fn beside(&self, tile: usize, away: [i64; 2]) -> Option<usize> {
        let place = [tile % self.tiles[0], tile / self.tiles[0]];
        let mut there = [0; 2];
        for axis in 0..2 {
            let count = self.tiles[axis] as i64;
            let to = place[axis] as i64 + away[axis];
            if !self.periodic[axis] && !(0..count).contains(&to) {
                return None;
            }
            there[axis] = to.rem_euclid(count) as usize;
        }
        Some(there[1] * self.tiles[0] + there[0])
    }

    /// The Voronoi cell of point `k` of `tile`, cut off at the sides that are not joined. `Beyond::Cell` numbers the entries of
    /// `candidates`.
    ///
    /// The cell is cut by the bisectors of the neighbours in order of their distance, until the next one is farther than twice its farthest
    /// corner (Ray, Sokolov, Lefebvre & Levy 2018, "Meshless Voronoi on the GPU", section 3).
    pub fn cell(&self, tile: usize, k: usize, polygon: &mut Polygon, candidates: &mut Vec<Candidate>) {
        let spacing = self.spacing();
        for rings in 2.. {
            let covered = self.candidates(tile, k, rings, candidates);
            polygon.reset(1e3 * spacing);
            self.cut_at_sides(self.position(tile, k), polygon);
            for (number, candidate) in candidates.iter().enumerate() {
                if candidate.squared > 4.0 * polygon.reach_squared() {
                    break;
                }
                polygon.cut(candidate.to, 0.5 * candidate.squared, Beyond::Cell(number as u64));
            }
            if 4.0 * polygon.reach_squared() <= covered * covered || rings > 40 {
                return;
            }
        }
    }

    fn cut_at_sides(&self, [x, y]: [f64; 2], polygon: &mut Polygon) {
        let Bounds { x_min, x_max, y_min, y_max } = self.bounds;
        if !self.periodic[0] {
            polygon.cut([-1.0, 0.0], x - x_min, Beyond::Side(0));
            polygon.cut([1.0, 0.0], x_max - x, Beyond::Side(1));
        }
        if !self.periodic[1] {
            polygon.cut([0.0, -1.0], y - y_min, Beyond::Side(2));
            polygon.cut([0.0, 1.0], y_max - y, Beyond::Side(3));
        }
    }

    /// Lists the points in the bins up to `rings` away, nearest first; how far from the point all of them are listed, m.
    fn candidates(&self, tile: usize, k: usize, rings: i64, candidates: &mut Vec<Candidate>) -> f64 {
        candidates.clear();
        let own = self.points[k];
        let size = [0, 1].map(|axis| self.tile[axis] / self.bins[axis] as f64);
        let bin = [0, 1].map(|axis| ((own[axis] / size[axis]) as i64).min(self.bins[axis] as i64 - 1));
        for row in bin[1] - rings..=bin[1] + rings {
            for column in bin[0] - rings..=bin[0] + rings {
                let bins = self.bins.map(|count| count as i64);
                let away = [column.div_euclid(bins[0]), row.div_euclid(bins[1])];
                let Some(there) = self.beside(tile, away) else { continue };
                let number = row.rem_euclid(bins[1]) * bins[0] + column.rem_euclid(bins[0]);
                let [start, end] = [0, 1].map(|next| self.starts[number as usize + next] as usize);
                for other in start..end {
                    let to =
                        [0, 1].map(|axis| self.points[other][axis] - own[axis] + away[axis] as f64 * self.tile[axis]);
                    let squared = to[0] * to[0] + to[1] * to[1];
                    if squared > 0.0 {
                        let point = (there * self.points.len() + other) as u64;
                        candidates.push(Candidate { squared, to, point });
                    }
                }
            }
        }
        candidates.sort_unstable_by(|a, b| a.squared.total_cmp(&b.squared).then(a.point.cmp(&b.point)));
        let reach = |axis: usize| {
            let within = own[axis] / size[axis] - bin[axis] as f64;
            (rings as f64 + within.min(1.0 - within)) * size[axis]
        };
        reach(0).min(reach(1))
    }

    /// The point nearest to a position inside: its tile and number there.
    pub fn nearest(&self, at: [f64; 2]) -> (usize, usize) {
        let tile = self.tile_at(at);
        let corner = self.corner(tile);
        let within = [at[0] - corner[0], at[1] - corner[1]];
        let bins = self.bins.map(|count| count as i64);
        let size = [0, 1].map(|axis| self.tile[axis] / self.bins[axis] as f64);
        let bin = [0, 1].map(|axis| ((within[axis] / size[axis]) as i64).clamp(0, bins[axis] - 1));
        let mut best = (f64::INFINITY, (tile, 0));
        for rings in 0..40 {
            for row in bin[1] - rings..=bin[1] + rings {
                for column in bin[0] - rings..=bin[0] + rings {
                    if (row - bin[1]).abs().max((column - bin[0]).abs()) != rings {
                        continue;
                    }
                    let away = [column.div_euclid(bins[0]), row.div_euclid(bins[1])];
                    let Some(there) = self.beside(tile, away) else { continue };
                    let number = (row.rem_euclid(bins[1]) * bins[0] + column.rem_euclid(bins[0])) as usize;
                    for k in self.starts[number] as usize..self.starts[number + 1] as usize {
                        let to = [0, 1]
                            .map(|axis| self.points[k][axis] - within[axis] + away[axis] as f64 * self.tile[axis]);
                        let squared = to[0] * to[0] + to[1] * to[1];
                        if squared < best.0 {
                            best = (squared, (there, k));
                        }
                    }
                }
            }
            // All bins nearer than this have been looked into.
            let covered = (rings as f64) * size[0].min(size[1]);
            if best.0 <= covered * covered {
                break;
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(periodic: [bool; 2]) -> Layout {
        let bounds = Bounds { x_min: -3.0, x_max: 97.0, y_min: 5.0, y_max: 45.0 };
        Layout::new(bounds, periodic, 1.1, 7)
    }

    /// Cells fill the rectangle, close, and see each other over edges of the same length.
    #[test]
    fn cells_fill_the_rectangle_and_share_their_edges() {
        for periodic in [[false, false], [true, false], [true, true]] {
            let layout = layout(periodic);
            let (mut polygon, mut other) = (Polygon::default(), Polygon::default());
            let [mut candidates, mut theirs] = [Vec::new(), Vec::new()];
            let count = layout.points.len();
            let mut area = 0.0;
            for point in 0..layout.tiles[0] * layout.tiles[1] * count {
                layout.cell(point / count, point % count, &mut polygon, &mut candidates);
                area += polygon.measures().area;
                for (k, beyond) in polygon.beyond.iter().enumerate() {
                    let Some(Beyond::Cell(number)) = beyond else { continue };
                    let there = candidates[*number as usize].point as usize;
                    layout.cell(there / count, there % count, &mut other, &mut theirs);
                    let length = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
                    let shared = other.beyond.iter().enumerate().find(|(_, beyond)| {
                        matches!(beyond, Some(Beyond::Cell(n)) if theirs[*n as usize].point as usize == point)
                    });
                    let theirs = shared.map_or(0.0, |(k, _)| length(other.edge(k)));
                    assert!((length(polygon.edge(k)) - theirs).abs() < 1e-11, "{point} {there}");
                }
            }
            assert!((area - 4000.0).abs() < 1e-8, "{area}");
        }
    }

    #[test]
    fn cells_are_of_like_size_and_lie_on_no_lattice() {
        let layout = layout([true, true]);
        let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
        let mut directions = [0.0; 2];
        for k in 0..layout.points.len() {
            layout.cell(0, k, &mut polygon, &mut candidates);
            let area = polygon.measures().area / layout.spacing().powi(2);
            assert!((0.6..1.5).contains(&area), "{area}");
            let [x, y] = candidates[0].to;
            let angle = 6.0 * y.atan2(x);
            directions = [directions[0] + angle.cos(), directions[1] + angle.sin()];
        }
        let order = directions[0].hypot(directions[1]) / layout.points.len() as f64;
        assert!(order < 0.2, "{order}");
    }

    #[test]
    fn the_nearest_point_is_found() {
        let layout = layout([true, false]);
        for at in [[-3.0, 5.0], [96.9, 44.9], [20.3, 17.2], [50.0, 30.0]] {
            let (tile, k) = layout.nearest(at);
            let found = layout.position(tile, k);
            let distance = |p: [f64; 2]| {
                let dx = (p[0] - at[0]).rem_euclid(100.0);
                dx.min(100.0 - dx).hypot(p[1] - at[1])
            };
            let tiles = layout.tiles[0] * layout.tiles[1];
            let all = (0..tiles).flat_map(|tile| (0..layout.points.len()).map(move |k| (tile, k)));
            let best = all.map(|(tile, k)| distance(layout.position(tile, k))).fold(f64::INFINITY, f64::min);
            assert!((distance(found) - best).abs() < 1e-12);
        }
    }
}
