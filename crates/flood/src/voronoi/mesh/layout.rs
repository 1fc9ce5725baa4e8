//! Where the particles stand: a pattern of points without order, repeated over tiles that fill the terrain.
//!
//! Any part of the plane can be filled when water comes there, and always with the same particles.

use super::blocks::Blocks;
use super::grading::Grading;
use super::polygon::{Beyond, Polygon};
use corpuscle_terrain::Bounds;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

/// Points along a side of a tile, where the terrain is wide enough.
const POINTS_A_SIDE: f64 = 32.0;

/// Fewest points along a side of the terrain: no cell is its own neighbour, and none is another's twice.
const FEWEST_A_SIDE: f64 = 5.0;

/// How near to a side of its tile a cell must be for the next tile to be made before it gets wet, in spacings, where water comes two cells on in a step.
const RIM: f64 = 3.0;

/// Greatest shift of a point from its position in the lattice, part of the spacing.
const JITTER: f64 = 0.5;

/// Rounds in which each point moves to the centroid of its cell (Lloyd 1982).
const ROUNDS: usize = 10;

/// Samples of the cells' level along each side of a tile.
const TILE_SAMPLES_PER_SIDE: usize = 16;

/// Radius in which neighbours are searched first, in spacings; one spacing more each time that this is not enough.
const FIRST_RING: f64 = 2.5;

/// So often at most: nothing is farther than the finest cells beside the coarsest.
const MOST_RINGS: u32 = 400;

/// Tiles of points over a rectangle.
#[derive(Debug)]
pub(crate) struct Layout {
    pub bounds: Bounds,
    /// Whether the west and east, the south and north sides are joined.
    pub periodic: [bool; 2],
    /// Number of tiles along x and y.
    pub tiles: [usize; 2],
    /// Size of a tile, m.
    pub tile: [f64; 2],
    /// The points of a tile without finer cells.
    pattern: Points,
    /// Where cells are finer.
    grading: Grading,
    /// The points of the tiles with finer cells, found on first use.
    graded: HashMap<u32, OnceLock<Points>>,
    /// The tiles in which parts of the terrain have finer cells, whatever the blocks.
    of_parts: Vec<u32>,
    /// Room in the numbers of points for those of a tile.
    most_points: usize,
    /// How near to a side of its tile a cell must be for the next tile to be made before it gets wet, in spacings. Cells with a neighbour that is not
    /// made stay dry so.
    pub rim: f64,
}

/// The points of a tile, bin by bin.
#[derive(Debug, Clone, Default)]
pub(crate) struct Points {
    /// Relative to the south-west corner of the tile, m.
    pub at: Vec<[f64; 2]>,
    /// How often the spacing is halved at each; empty where it nowhere is.
    pub levels: Vec<u8>,
    /// The highest of them.
    finest: u8,
    /// Bins along x and y.
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
    /// The neighbour's number: see [`Layout::number`].
    pub point: u64,
}

impl Points {
    /// Sorts points over a tile of size `tile` into bins.
    pub fn sorted(at: Vec<[f64; 2]>, levels: &[u8], bins: [usize; 2], tile: [f64; 2]) -> Self {
        let bin = |point: &[f64; 2]| {
            let [column, row] =
                [0, 1].map(|axis| ((point[axis] / tile[axis] * bins[axis] as f64) as usize).min(bins[axis] - 1));
            row * bins[0] + column
        };
        let mut order: Vec<usize> = (0..at.len()).collect();
        order.sort_by_key(|k| bin(&at[*k]));
        let mut starts = vec![0; bins[0] * bins[1] + 1];
        at.iter().for_each(|point| starts[bin(point) + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        let levels = if levels.is_empty() { Vec::new() } else { order.iter().map(|k| levels[*k]).collect() };
        let finest = levels.iter().copied().max().unwrap_or(0);
        Self { at: order.into_iter().map(|k| at[k]).collect(), levels, finest, bins, starts }
    }

    /// The numbers of the points in the bins that a rectangle touches.
    pub fn within(&self, low: [f64; 2], high: [f64; 2], tile: [f64; 2]) -> impl Iterator<Item = usize> {
        let span = move |axis: usize| {
            let last = self.bins[axis] - 1;
            let bin = |x: f64| ((x / tile[axis] * self.bins[axis] as f64).max(0.0) as usize).min(last);
            bin(low[axis])..=bin(high[axis])
        };
        span(1).flat_map(move |row| {
            let columns = span(0);
            let first = row * self.bins[0];
            self.starts[first + columns.start()] as usize..self.starts[first + columns.end() + 1] as usize
        })
    }

    /// How often the spacing is halved at a point.
    fn level(&self, k: usize) -> u8 {
        self.levels.get(k).copied().unwrap_or(0)
    }
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
            let index = [k % lattice[0] as usize, k / lattice[0] as usize];
            [0, 1].map(|axis| (index[axis] as f64 + 0.5 + random.random_range(-JITTER..JITTER)) * step[axis])
        });
        let points: Vec<_> = points.collect();
        let mut pattern = Self {
            bounds: Bounds { x_min: 0.0, x_max: tile[0], y_min: 0.0, y_max: tile[1] },
            periodic: [true; 2],
            tiles: [1; 2],
            tile,
            most_points: points.len(),
            rim: RIM,
            pattern: Points::sorted(points, &[], lattice.map(|points| points as usize), tile),
            grading: Grading::default(),
            graded: HashMap::new(),
            of_parts: Vec::new(),
        };
        for _ in 0..ROUNDS {
            pattern.relax();
        }
        Self { bounds, periodic, tiles: tiles.map(|count| count as usize), ..pattern }
    }

    /// Has finer cells in parts of the terrain. The spacing is halved `deepest` times at most, now or later.
    pub fn refine(&mut self, grading: Grading, deepest: u8) {
        let count = self.tiles[0] * self.tiles[1];
        let reach = 0.5 * self.tile[0].hypot(self.tile[1]);
        if !grading.is_even() {
            let graded = (0..count).into_par_iter().filter(|tile| {
                let corner = self.corner(*tile);
                let middle = [0, 1].map(|axis| corner[axis] + 0.5 * self.tile[axis]);
                grading.finest_within(self.images(middle), reach) > 0
            });
            self.of_parts = graded.map(|tile| tile as u32).collect();
        }
        self.graded = self.of_parts.iter().map(|tile| (*tile, OnceLock::new())).collect();
        // As many as where all of a tile is as fine as anything, and some more where coarse points stand beside it.
        let whole = self.pattern.at.len();
        self.most_points = whole * (1 << (2 * deepest.max(grading.finest()))) + whole;
        self.grading = grading;
    }

    /// The same layout with other blocks. Tiles whose blocks, and those round them, are the same keep their points.
    pub fn with(&self, blocks: Blocks) -> Self {
        let touched = self.tiles_of(self.grading.blocks()).into_iter().chain(self.tiles_of(&blocks));
        let changed: HashSet<u32> = self.tiles_of(&blocks.difference(self.grading.blocks())).into_iter().collect();
        let mut tiles: Vec<u32> = touched.chain(self.of_parts.iter().copied()).collect();
        tiles.sort_unstable();
        tiles.dedup();
        let kept = |tile: &u32| self.graded.get(tile).filter(|_| !changed.contains(tile)).cloned().unwrap_or_default();
        Self {
            graded: tiles.iter().map(|tile| (*tile, kept(tile))).collect(),
            of_parts: self.of_parts.clone(),
            pattern: self.pattern.clone(),
            grading: self.grading.with(blocks),
            ..*self
        }
    }

    /// The tiles in which cells may be finer for the sake of blocks, in the order of their numbers.
    fn tiles_of(&self, blocks: &Blocks) -> Vec<u32> {
        let far = blocks.band() + self.spacing();
        let mut tiles: Vec<u32> = Vec::new();
        for (block, _) in blocks.finer() {
            let [low, high] =
                blocks.corners(block as usize).map(|corner| [0, 1].map(|axis| corner[axis] - self.corner(0)[axis]));
            let span = |axis: usize| {
                let tile = |x: f64| (x / self.tile[axis]).floor() as i64;
                tile(low[axis] - far)..=tile(high[axis] + far)
            };
            let round = span(1).flat_map(|row| span(0).map(move |column| [column, row]));
            tiles.extend(round.filter_map(|away| self.beside(0, away)).map(|tile| tile as u32));
        }
        tiles.sort_unstable();
        tiles.dedup();
        tiles
    }

    /// The blocks that say where cells are finer for the water's sake.
    pub fn blocks(&self) -> &Blocks {
        self.grading.blocks()
    }

    /// How often the spacing is halved at a position for the sake of parts of the terrain.
    pub fn level_of_parts(&self, at: [f64; 2]) -> u8 {
        self.grading.of_parts(self.images(at))
    }

    /// How often the spacing is halved for about `spacing` m.
    pub fn level_of(&self, spacing: f64) -> u8 {
        self.grading.level_of(spacing)
    }

    /// Moves each point to the centroid of its cell.
    fn relax(&mut self) {
        let moved = |(k, point): (usize, &[f64; 2])| {
            let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
            self.cell(0, k, &mut polygon, &mut candidates);
            let centroid = polygon.measures().centroid;
            [0, 1].map(|axis| (point[axis] + centroid[axis]).rem_euclid(self.tile[axis]))
        };
        let points = self.pattern.at.par_iter().enumerate().map(moved).collect();
        self.pattern = Points::sorted(points, &[], self.pattern.bins, self.tile);
    }

    /// Mean distance of the points where cells are not finer, m.
    pub fn spacing(&self) -> f64 {
        (self.tile[0] * self.tile[1] / self.pattern.at.len() as f64).sqrt()
    }

    /// Mean distance of the points where cells are finest, m.
    pub fn finest_spacing(&self) -> f64 {
        self.spacing() / f64::from(1 << self.grading.finest())
    }

    /// Mean distance of the points round point `k` of a tile, m.
    pub fn spacing_at(&self, tile: usize, k: usize) -> f64 {
        self.spacing() / f64::from(1 << self.points(tile).level(k))
    }

    /// Number of points of a tile.
    pub fn count(&self, tile: usize) -> usize {
        self.points(tile).at.len()
    }

    /// Positions all over a tile, a spacing apart, whether its cells are finer or not, m.
    pub fn positions(&self, tile: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let corner = self.corner(tile);
        self.pattern.at.iter().map(move |within| [0, 1].map(|axis| corner[axis] + within[axis]))
    }

    /// South-west and north-east corner of a tile, m.
    pub fn rectangle(&self, tile: usize) -> [[f64; 2]; 2] {
        let corner = self.corner(tile);
        [corner, [0, 1].map(|axis| corner[axis] + self.tile[axis])]
    }

    /// About how many points a tile has, without making them.
    pub fn about(&self, tile: usize) -> f64 {
        let count = self.pattern.at.len() as f64;
        if !self.graded.contains_key(&(tile as u32)) {
            return count;
        }
        let corner = self.corner(tile);
        let at = |sample: usize, axis: usize| {
            corner[axis] + (sample as f64 + 0.5) / TILE_SAMPLES_PER_SIDE as f64 * self.tile[axis]
        };
        let level = |k: usize| {
            self.grading
                .finest_within(self.images([at(k % TILE_SAMPLES_PER_SIDE, 0), at(k / TILE_SAMPLES_PER_SIDE, 1)]), 0.0)
        };
        let finer: f64 =
            (0..TILE_SAMPLES_PER_SIDE * TILE_SAMPLES_PER_SIDE).map(|k| f64::from(1 << (2 * level(k)))).sum();
        count * finer / (TILE_SAMPLES_PER_SIDE * TILE_SAMPLES_PER_SIDE) as f64
    }

    /// South-west corner of a tile, m.
    pub fn corner(&self, tile: usize) -> [f64; 2] {
        let index = [tile % self.tiles[0], tile / self.tiles[0]];
        let low = [self.bounds.x_min, self.bounds.y_min];
        [0, 1].map(|axis| low[axis] + index[axis] as f64 * self.tile[axis])
    }

    /// Position of point `k` of a tile relative to the tile's south-west corner, m.
    pub fn within(&self, tile: usize, k: usize) -> [f64; 2] {
        self.points(tile).at[k]
    }

    /// Position of point `k` of a tile, m.
    pub fn position(&self, tile: usize, k: usize) -> [f64; 2] {
        let (corner, within) = (self.corner(tile), self.within(tile, k));
        [0, 1].map(|axis| corner[axis] + within[axis])
    }

    /// The number of point `k` of a tile among all points.
    pub fn number(&self, tile: usize, k: usize) -> u64 {
        (tile * self.most_points + k) as u64
    }

    /// Tile and number there of the point with a number among all, or of the first with this number less a multiple of [`Layout::total`].
    pub fn tile_and_index(&self, point: u64) -> (usize, usize) {
        let (point, most) = (point % self.total(), self.most_points as u64);
        ((point / most) as usize, (point % most) as usize)
    }

    /// More than the number of any point.
    pub fn total(&self) -> u64 {
        (self.tiles[0] * self.tiles[1] * self.most_points) as u64
    }

    /// The points of a tile.
    fn points(&self, tile: usize) -> &Points {
        let graded = self.graded.get(&(tile as u32));
        graded.map_or(&self.pattern, |points| points.get_or_init(|| self.graded_points(tile)))
    }

    /// The points of a tile with finer cells.
    fn graded_points(&self, tile: usize) -> Points {
        let corner = self.corner(tile);
        let images = |within: [f64; 2]| self.images([0, 1].map(|axis| corner[axis] + within[axis]));
        self.grading.points(&self.pattern.at, self.tile, images)
    }

    /// Where a position beyond a joined side is inside, m.
    pub fn home(&self, at: [f64; 2]) -> [f64; 2] {
        let (low, size) = ([self.bounds.x_min, self.bounds.y_min], self.bounds.size());
        [0, 1].map(|axis| {
            let x = at[axis] - low[axis];
            if self.periodic[axis] && !(0.0..size[axis]).contains(&x) {
                low[axis] + x.rem_euclid(size[axis])
            } else {
                at[axis]
            }
        })
    }

    /// Where a position is, round joined sides too.
    fn images(&self, at: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + use<> {
        let size = self.bounds.size();
        let sides = self.periodic.map(|periodic| if periodic { -1..=1 } else { 0..=0 });
        let [columns, rows] = sides;
        rows.flat_map(move |row| {
            columns.clone().map(move |column| [at[0] + f64::from(column) * size[0], at[1] + f64::from(row) * size[1]])
        })
    }

    /// Points in the bins that a rectangle touches, round joined sides.
    pub fn points_within(&self, low: [f64; 2], high: [f64; 2]) -> Vec<u64> {
        let corner = self.corner(0);
        let [low, high] = [low, high].map(|end| [0, 1].map(|axis| end[axis] - corner[axis]));
        let mut points = Vec::new();
        self.visit(0, low, high, |tile, k, _| points.push(self.number(tile, k)));
        points
    }

    /// Goes through the points in the bins that a rectangle touches, given relative to the corner of a tile: `each` gets the tile of each, its number
    /// there, and how many tiles away it is.
    fn visit(&self, tile: usize, low: [f64; 2], high: [f64; 2], mut each: impl FnMut(usize, usize, [i64; 2])) {
        let span = |axis: usize| {
            let tile = |x: f64| (x / self.tile[axis]).floor() as i64;
            tile(low[axis])..=tile(high[axis])
        };
        for row in span(1) {
            for column in span(0) {
                let away = [column, row];
                let Some(there) = self.beside(tile, away) else { continue };
                let seen = |end: [f64; 2]| [0, 1].map(|axis| end[axis] - away[axis] as f64 * self.tile[axis]);
                self.points(there).within(seen(low), seen(high), self.tile).for_each(|k| each(there, k, away));
            }
        }
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
        let index = [tile % self.tiles[0], tile / self.tiles[0]];
        let mut there = [0; 2];
        for axis in 0..2 {
            let count = self.tiles[axis] as i64;
            let to = index[axis] as i64 + away[axis];
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
        let spacing = self.spacing_at(tile, k);
        for rings in 0..MOST_RINGS {
            let covered = spacing * (FIRST_RING + f64::from(rings));
            self.candidates(tile, k, covered, candidates);
            polygon.reset(1e3 * self.spacing());
            self.cut_at_sides(self.position(tile, k), polygon);
            for (number, candidate) in candidates.iter().enumerate() {
                if candidate.squared > 4.0 * polygon.reach_squared() {
                    break;
                }
                polygon.cut(candidate.to, 0.5 * candidate.squared, Beyond::Cell(number as u64));
            }
            if 4.0 * polygon.reach_squared() <= covered * covered {
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

    /// Lists the points up to `reach` m away, and some farther ones, nearest first.
    fn candidates(&self, tile: usize, k: usize, reach: f64, candidates: &mut Vec<Candidate>) {
        candidates.clear();
        let own = self.within(tile, k);
        let [low, high] = [-reach, reach].map(|reach| own.map(|x| x + reach));
        self.visit(tile, low, high, |there, other, away| {
            let at = self.within(there, other);
            let to = [0, 1].map(|axis| at[axis] - own[axis] + away[axis] as f64 * self.tile[axis]);
            let squared = to[0] * to[0] + to[1] * to[1];
            if squared > 0.0 {
                candidates.push(Candidate { squared, to, point: self.number(there, other) });
            }
        });
        candidates.sort_unstable_by(|a, b| a.squared.total_cmp(&b.squared).then(a.point.cmp(&b.point)));
    }

    /// The point nearest to a position inside: its tile and number there.
    pub fn nearest(&self, at: [f64; 2]) -> (usize, usize) {
        let tile = self.tile_at(at);
        let corner = self.corner(tile);
        let within = [at[0] - corner[0], at[1] - corner[1]];
        let mut reach = self.spacing() / f64::from(1 << self.points(tile).finest);
        let widest = self.tile[0].hypot(self.tile[1]);
        loop {
            let mut best = (f64::INFINITY, (tile, 0));
            let [low, high] = [-reach, reach].map(|reach| within.map(|x| x + reach));
            self.visit(tile, low, high, |there, k, away| {
                let point = self.within(there, k);
                let to = [0, 1].map(|axis| point[axis] - within[axis] + away[axis] as f64 * self.tile[axis]);
                let squared = to[0] * to[0] + to[1] * to[1];
                if squared < best.0 {
                    best = (squared, (there, k));
                }
            });
            // All points nearer than this have been tested.
            if best.0 <= reach * reach || reach > widest {
                return best.1;
            }
            reach *= 2.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(periodic: [bool; 2]) -> Layout {
        let bounds = Bounds { x_min: -3.0, x_max: 97.0, y_min: 5.0, y_max: 45.0 };
        Layout::new(bounds, periodic, 1.1, 7)
    }

    /// With finer cells in a square at the west side and along a line.
    fn graded(periodic: [bool; 2]) -> Layout {
        let mut layout = layout(periodic);
        let mut grading = Grading::new(layout.spacing());
        let square = vec![vec![[-9.0, 9.0], [9.0, 9.0], [9.0, 21.0], [-9.0, 21.0]]];
        grading.add(0.28, 1.0, vec![square], std::iter::empty(), layout.bounds);
        grading.add(0.55, 2.0, Vec::new(), [[[40.0, 30.0], [80.0, 50.0]]].into_iter(), layout.bounds);
        layout.refine(grading, 0);
        layout
    }

    fn points(layout: &Layout) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..layout.tiles[0] * layout.tiles[1]).flat_map(|tile| (0..layout.count(tile)).map(move |k| (tile, k)))
    }

    /// Cells fill the rectangle, close, and see each other over edges of the same length.
    #[test]
    fn cells_fill_the_rectangle_and_share_their_edges() {
        let all = [[false, false], [true, false], [true, true]];
        for layout in all.map(layout).into_iter().chain(all.map(graded)) {
            let (mut polygon, mut other) = (Polygon::default(), Polygon::default());
            let [mut candidates, mut theirs] = [Vec::new(), Vec::new()];
            let mut area = 0.0;
            for (tile, k) in points(&layout) {
                let point = layout.number(tile, k);
                assert_eq!(layout.tile_and_index(point), (tile, k));
                layout.cell(tile, k, &mut polygon, &mut candidates);
                area += polygon.measures().area;
                for (k, beyond) in polygon.beyond.iter().enumerate() {
                    let Some(Beyond::Cell(number)) = beyond else { continue };
                    let there = candidates[*number as usize].point;
                    let (tile, k_there) = layout.tile_and_index(there);
                    layout.cell(tile, k_there, &mut other, &mut theirs);
                    let length = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
                    let shared = other.beyond.iter().enumerate().find(
                        |(_, beyond)| matches!(beyond, Some(Beyond::Cell(n)) if theirs[*n as usize].point == point),
                    );
                    let theirs = shared.map_or(0.0, |(k, _)| length(other.edge(k)));
                    assert!((length(polygon.edge(k)) - theirs).abs() < 1e-11, "{point} {there}");
                }
            }
            assert!((area - 4000.0).abs() < 1e-8, "{area}");
        }
    }

    /// As fine as required where required, as coarse as before elsewhere, and no cell much narrower than those on its level.
    #[test]
    fn cells_are_finer_where_asked() {
        let layout = graded([true, false]);
        let mut polygon = (Polygon::default(), Vec::new());
        let mut sums = [[0.0_f64; 2]; 3];
        for (tile, k) in points(&layout) {
            let [x, y] = layout.position(tile, k);
            layout.cell(tile, k, &mut polygon.0, &mut polygon.1);
            let measures = polygon.0.measures();
            let part = match (x, y) {
                (x, y) if (-2.5..8.5).contains(&x) && (9.5..20.5).contains(&y) => 0,
                (x, y) if (42.0..68.0).contains(&x) && (y - 10.0 - 0.5 * x).abs() < 1.5 => 1,
                (x, y) if (25.0..40.0).contains(&x) && y < 15.0 => 2,
                _ => 3,
            };
            if let Some(sum) = sums.get_mut(part) {
                *sum = [sum[0] + 1.0, sum[1] + measures.area];
            }
            let spacing = layout.spacing_at(tile, k);
            let width = 2.0 * measures.area / measures.perimeter / spacing;
            assert!((0.3..0.9).contains(&width), "{x} {y}: {width}");
        }
        let spacings = sums.map(|[count, area]| (area / count).sqrt() / layout.spacing());
        for (found, expected) in spacings.into_iter().zip([0.25, 0.5, 1.0]) {
            assert!((found / expected - 1.0).abs() < 0.01, "{spacings:?}");
        }
        for tile in 0..layout.tiles[0] * layout.tiles[1] {
            let share = layout.about(tile) / layout.count(tile) as f64;
            assert!((0.8..1.25).contains(&share), "{tile}: {share}");
        }
        // The square lies at a joined side: cells beyond are finer too.
        let (tile, k) = layout.nearest([96.5, 15.0]);
        assert!(layout.spacing_at(tile, k) < 0.3 * layout.spacing());
    }

    #[test]
    fn cells_are_of_like_size_and_lie_on_no_lattice() {
        let layout = layout([true, true]);
        let (mut polygon, mut candidates) = (Polygon::default(), Vec::new());
        let mut directions = [0.0; 2];
        for k in 0..layout.pattern.at.len() {
            layout.cell(0, k, &mut polygon, &mut candidates);
            let area = polygon.measures().area / layout.spacing().powi(2);
            assert!((0.6..1.5).contains(&area), "{area}");
            let [x, y] = candidates[0].to;
            let angle = 6.0 * y.atan2(x);
            directions = [directions[0] + angle.cos(), directions[1] + angle.sin()];
        }
        let order = directions[0].hypot(directions[1]) / layout.pattern.at.len() as f64;
        assert!(order < 0.2, "{order}");
    }

    #[test]
    fn the_nearest_point_is_found() {
        for layout in [layout([true, false]), graded([true, false])] {
            for at in [[-3.0, 5.0], [96.9, 44.9], [20.3, 17.2], [50.0, 30.0], [9.7, 12.0], [12.0, 15.0]] {
                let (tile, k) = layout.nearest(at);
                let found = layout.position(tile, k);
                let distance = |p: [f64; 2]| {
                    let dx = (p[0] - at[0]).rem_euclid(100.0);
                    dx.min(100.0 - dx).hypot(p[1] - at[1])
                };
                let distances = points(&layout).map(|(tile, k)| distance(layout.position(tile, k)));
                let best = distances.fold(f64::INFINITY, f64::min);
                assert!((distance(found) - best).abs() < 1e-12);
            }
        }
    }
}
