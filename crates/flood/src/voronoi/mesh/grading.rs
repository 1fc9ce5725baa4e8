//! Where cells are finer, and the points there.
//!
//! The spacing is halved a whole number of times, its level. Round a part with finer cells it grows again by a level at a time, so that neighbours
//! differ by a factor of two at most. The points of a level are the pattern of a tile made smaller; each is present where its level is required.

use super::blocks::{Blocks, lowered};
use super::layout::Points;
use crate::polygon::is_inside;
use crate::voronoi::walls::{Wall, WallKind, Walls};
use corpuscle_terrain::{Bounds, Polygon};
use std::sync::Arc;

/// Most halvings of the spacing.
const MAX_LEVEL: u8 = 6;

/// Width of the band over which a level lasts, in spacings of the finer level next to it.
pub(super) const BAND: f64 = 8.0;

/// Least distance of the points of a level from those of the coarser level beside it, in their spacings; nearer ones are left out.
const MIN_POINT_DISTANCE: f64 = 0.8;

/// A part of the terrain with finer cells.
#[derive(Debug)]
struct Part {
    /// How often the spacing is halved.
    level: u8,
    /// The spacing there, m.
    spacing: f64,
    /// How far round it the cells are as fine, m.
    within: f64,
    /// Farther round that no cell is finer, m.
    band: f64,
    /// Cells inside are finer.
    polygons: Vec<Polygon>,
    /// What distances are counted from.
    lines: Walls,
}

/// Where cells are finer.
#[derive(Debug, Default)]
pub(crate) struct Grading {
    parts: Arc<Vec<Part>>,
    /// Levels that the water requires beside the parts.
    blocks: Blocks,
    spacing: f64,
}

impl Grading {
    /// No finer cells, where the spacing is `spacing` m elsewhere.
    pub fn new(spacing: f64) -> Self {
        Self { parts: Arc::default(), blocks: Blocks::default(), spacing }
    }

    /// Adds the inside of polygons and the ground `within` m of their sides and of `lines`: cells about `spacing` m wide. `bounds` are those of
    /// the terrain.
    pub fn add(
        &mut self,
        spacing: f64,
        within: f64,
        polygons: Vec<Polygon>,
        lines: impl Iterator<Item = [[f64; 2]; 2]>,
        bounds: Bounds,
    ) {
        let whole = |polygon: Polygon| polygon.into_iter().filter(|ring| ring.len() >= 3).collect();
        let polygons: Vec<Polygon> = polygons.into_iter().map(whole).collect();
        let level = self.level_of(spacing);
        let spacing = self.spacing / f64::from(1 << level);
        let far = within + BAND * self.spacing;
        let sides = polygons.iter().flatten().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(from, to)| [*from, *to])
        });
        let lines = sides.chain(lines).map(|ends| Wall { ends, kind: WallKind::Plain, crest: [f64::INFINITY; 2] });
        // Positions are seen beyond joined sides too.
        let [width, length] = bounds.size();
        let Bounds { x_min, x_max, y_min, y_max } = bounds;
        let (x_min, x_max, y_min, y_max) = (x_min - width, x_max + width, y_min - length, y_max + length);
        let lines = Walls::new(lines, Bounds { x_min, x_max, y_min, y_max }, far);
        let band = 0.5 * BAND * self.spacing;
        let part = Part { level, spacing, within, band, polygons, lines };
        if let Some(parts) = Arc::get_mut(&mut self.parts) {
            parts.push(part);
        }
    }

    /// The same parts, with other blocks.
    pub fn with(&self, blocks: Blocks) -> Self {
        Self { parts: Arc::clone(&self.parts), blocks, spacing: self.spacing }
    }

    /// How often the spacing is halved for about `spacing` m.
    pub fn level_of(&self, spacing: f64) -> u8 {
        (self.spacing / spacing).log2().round().clamp(0.0, f64::from(MAX_LEVEL)) as u8
    }

    /// The blocks.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// Whether cells are the same everywhere.
    pub fn is_even(&self) -> bool {
        self.finest() == 0
    }

    /// How often the spacing is halved at most.
    pub fn finest(&self) -> u8 {
        self.parts.iter().map(|part| part.level).max().unwrap_or(0).max(self.blocks.finest())
    }

    /// How often the parts have the spacing halved at most at a position, given with its images beyond joined sides.
    pub fn of_parts(&self, images: impl Iterator<Item = [f64; 2]>) -> u8 {
        images.flat_map(|at| self.parts.iter().map(move |part| part.level_at(at, 0.0))).max().unwrap_or(0)
    }

    /// How often the spacing is halved at most within `reach` m of a position, given with its images beyond joined sides.
    pub fn finest_within(&self, images: impl Iterator<Item = [f64; 2]>, reach: f64) -> u8 {
        let at_image = |at: [f64; 2]| {
            let of_parts = self.parts.iter().map(|part| part.level_at(at, reach)).max().unwrap_or(0);
            of_parts.max(self.blocks.level_within(at, reach))
        };
        images.map(at_image).max().unwrap_or(0)
    }

    /// The points of a tile of size `tile` m, whose pattern is `pattern`; `images` gives where a position in the tile is, once or, round joined sides, more
    /// often.
    pub fn points<I: Iterator<Item = [f64; 2]>>(
        &self,
        pattern: &[[f64; 2]],
        tile: [f64; 2],
        images: impl Fn([f64; 2]) -> I,
    ) -> Points {
        let level_at = |at: [f64; 2], reach: f64| self.finest_within(images(at), reach);
        let mut found =
            Found { pattern: Pattern::new(pattern, tile), level_at: &level_at, at: Vec::new(), levels: Vec::new() };
        found.add(Block { level: 0, corner: [0.0; 2] });
        let Found { at, levels, .. } = found;
        let bins = (at.len() as f64 / (tile[0] * tile[1])).sqrt();
        let bins = tile.map(|size| (bins * size).ceil().max(1.0) as usize);
        Points::sorted(at, &levels, bins, tile)
    }
}

/// The pattern of a tile.
struct Pattern<'a> {
    points: &'a [[f64; 2]],
    sorted: Points,
    tile: [f64; 2],
    spacing: f64,
}

impl<'a> Pattern<'a> {
    fn new(points: &'a [[f64; 2]], tile: [f64; 2]) -> Self {
        let spacing = (tile[0] * tile[1] / points.len() as f64).sqrt();
        let bins = tile.map(|size| (size / spacing).ceil().max(1.0) as usize);
        Self { points, sorted: Points::sorted(points.to_vec(), &[], bins, tile), tile, spacing }
    }

    /// Whether a point of the pattern made smaller by a level is less than `reach` m from a position and `holds`.
    fn any_near(&self, level: u8, at: [f64; 2], reach: f64, holds: impl Fn([f64; 2]) -> bool) -> bool {
        let scale = f64::from(1 << level);
        let size = self.tile.map(|size| size / scale);
        let span = |axis: usize| {
            let block = |x: f64| (x / size[axis]).floor() as i64;
            block(at[axis] - reach)..=block(at[axis] + reach)
        };
        span(1).any(|row| {
            span(0).any(|column| {
                let corner = [column as f64 * size[0], row as f64 * size[1]];
                let within = |side: f64| [0, 1].map(|axis| (at[axis] - corner[axis] + side * reach) * scale);
                self.sorted.within(within(-1.0), within(1.0), self.tile).any(|k| {
                    let point = [0, 1].map(|axis| corner[axis] + self.sorted.at[k][axis] / scale);
                    (point[0] - at[0]).hypot(point[1] - at[1]) < reach && holds(point)
                })
            })
        })
    }
}

/// A part of a tile that holds the pattern made smaller by a level.
#[derive(Clone, Copy)]
struct Block {
    level: u8,
    corner: [f64; 2],
}

/// The points of a tile found so far.
struct Found<'a, F: Fn([f64; 2], f64) -> u8> {
    pattern: Pattern<'a>,
    /// Level at a position in the tile, or the highest within a distance of it.
    level_at: &'a F,
    at: Vec<[f64; 2]>,
    levels: Vec<u8>,
}

impl<F: Fn([f64; 2], f64) -> u8> Found<'_, F> {
    /// Adds the points of a block, and those of finer levels within it.
    fn add(&mut self, block: Block) {
        let scale = f64::from(1 << block.level);
        let size = self.pattern.tile.map(|size| size / scale);
        let middle = [0, 1].map(|axis| block.corner[axis] + 0.5 * size[axis]);
        let highest = (self.level_at)(middle, 0.5 * size[0].hypot(size[1]));
        if highest < block.level {
            return;
        }
        for point in self.pattern.points {
            let at = [0, 1].map(|axis| block.corner[axis] + point[axis] / scale);
            if (self.level_at)(at, 0.0) == block.level && !self.is_crowded(at, block.level) {
                self.at.push(at);
                self.levels.push(block.level);
            }
        }
        if highest > block.level {
            for [column, row] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                let corner = [block.corner[0] + 0.5 * column * size[0], block.corner[1] + 0.5 * row * size[1]];
                self.add(Block { level: block.level + 1, corner });
            }
        }
    }

    /// Whether a point of the coarser level stands too near.
    fn is_crowded(&self, at: [f64; 2], level: u8) -> bool {
        if level == 0 {
            return false;
        }
        let coarser = level - 1;
        let reach = MIN_POINT_DISTANCE * self.pattern.spacing / f64::from(1 << level);
        self.pattern.any_near(coarser, at, reach, |point| (self.level_at)(point, 0.0) == coarser)
    }
}

impl Part {
    /// Level at a position, or the highest within a distance of it, m.
    fn level_at(&self, at: [f64; 2], reach: f64) -> u8 {
        let sure = self.within + reach;
        let beyond = self.distance(at, sure + self.band) - sure;
        lowered(self.level, beyond, self.spacing * f64::from(1 << self.level))
    }

    /// Distance of a position from the inside of the polygons or from the lines, m; infinite where it is more than `farthest`.
    fn distance(&self, at: [f64; 2], farthest: f64) -> f64 {
        let rings = |polygon: &Polygon| polygon.iter().filter(|ring| is_inside(ring, at[0], at[1])).count();
        if self.polygons.iter().any(|polygon| rings(polygon) % 2 == 1) {
            return 0.0;
        }
        self.lines.distance(at, farthest)
    }
}
