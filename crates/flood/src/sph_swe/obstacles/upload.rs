//! Obstacles as the shaders have them: boundary particles in cells, outlines as lists of sides, rectangles round them.

use crate::obstacles::OutlineCells;
use crate::sph_swe::gpu::shared::{Grid, OnObstacle, WallSite};
use crate::sph_swe::gpu::upload::Origin;
use crate::sph_swe::obstacles::Obstacles;
use corpuscle_terrain::Bounds;

/// Obstacles, to be uploaded.
#[derive(Debug)]
pub(in crate::sph_swe) struct GpuObstacles {
    pub count: usize,
    /// Cells of the boundary particles, and those by which outlines are found.
    pub grid: Grid,
    pub outlines_grid: Grid,
    pub start: Vec<u32>,
    pub sites: Vec<WallSite>,
    pub outlines: Vec<u32>,
    /// As it is at the start: nothing has pushed yet.
    pub rectangles: Vec<OnObstacle>,
}

impl GpuObstacles {
    /// Obstacles that particles touch from `reach` m away at most.
    pub fn new(obstacles: &Obstacles, origin: Origin, reach: f64) -> Self {
        let (grid, start, sites) = sites(obstacles, origin, reach);
        let (outlines_grid, outlines) = outlines(obstacles, origin);
        let count = obstacles.names.len();
        let rectangles = (0..count).map(|number| rectangle(obstacles, number, origin, reach)).collect();
        Self { count, grid, outlines_grid, start, sites, outlines, rectangles }
    }

    /// As it is where nothing has pushed yet but for the last evaluation, whose forces are `forces`, m4/s2.
    pub fn packed(&self, forces: &[[f64; 2]]) -> Vec<OnObstacle> {
        let packed = self.rectangles.iter().zip(forces);
        packed.map(|(rectangle, force)| OnObstacle { force: force.map(|along| along as f32), ..*rectangle }).collect()
    }
}

/// Cells over the boundary particles, the first of each cell, and they themselves in that order.
fn sites(obstacles: &Obstacles, origin: Origin, reach: f64) -> (Grid, Vec<u32>, Vec<WallSite>) {
    let all = obstacles.sites();
    let along = |pick: fn(f64, f64) -> f64, none: f64| {
        [all.iter().map(|site| site.x).fold(none, pick), all.iter().map(|site| site.y).fold(none, pick)]
    };
    if all.is_empty() {
        return (Grid::default(), vec![0; 2], Vec::new());
    }
    let (low, high) = (along(f64::min, f64::INFINITY), along(f64::max, f64::NEG_INFINITY));
    // A kernel then covers a few cells, whatever its reach.
    let size = 0.25 * reach;
    let grid = grid(low, high, size, origin);
    let cell = |site: &WallSite| {
        let index = [0, 1].map(|axis| ((site.position[axis] - grid.corner[axis]) * grid.per_cell).max(0.0) as u32);
        index[1].min(grid.rows - 1) * grid.columns + index[0].min(grid.columns - 1)
    };
    let mut sites: Vec<WallSite> = all
        .iter()
        .map(|site| WallSite {
            position: origin.relative([site.x, site.y]),
            area: site.area as f32,
            obstacle: site.obstacle as u32,
            volume: site.volume as f32,
            unused: 0,
        })
        .collect();
    sites.sort_by_key(cell);
    let first = |wanted: u32| sites.partition_point(|site| cell(site) < wanted) as u32;
    let start = (0..=grid.columns * grid.rows).map(first).collect();
    (grid, start, sites)
}

fn grid(low: [f64; 2], high: [f64; 2], size: f64, origin: Origin) -> Grid {
    let [columns, rows] = [0, 1].map(|axis| ((high[axis] - low[axis]) / size) as u32 + 1);
    let (cell, per_cell) = (size as f32, (1.0 / size) as f32);
    Grid { corner: origin.relative(low), cell, per_cell, columns, rows, unused: [0.0; 2] }
}

/// The outlines in the format of `sph_outlines.wgsl`.
fn outlines(obstacles: &Obstacles, origin: Origin) -> (Grid, Vec<u32>) {
    let Some(cells) = obstacles.outlines_by_cell() else { return (Grid::default(), vec![0; 4]) };
    let OutlineCells { corner: low, size, columns, near } = cells;
    let rows = near.len() / columns;
    let high = [columns, rows].map(|number| (number as f64 - 0.5) * size);
    let grid = grid(low, [low[0] + high[0], low[1] + high[1]], size, origin);
    let entries: usize = near.iter().map(Vec::len).sum();
    // The sides begin at a multiple of four, behind the lists.
    let sides_from = (near.len() + 1 + 3 * entries).next_multiple_of(4);
    let mut first_side = sides_from as u32 / 4;
    let mut sides = Vec::new();
    let mut ranges = Vec::new();
    for outline in obstacles.outlines() {
        for corner in outline.sides().flatten() {
            sides.extend(origin.relative(corner).map(f32::to_bits));
        }
        let end = (sides_from + sides.len()) as u32 / 4;
        ranges.push([outline.obstacle as u32, first_side, end]);
        first_side = end;
    }
    let mut numbers = Vec::new();
    let mut begin = near.len() as u32 + 1;
    for cell in near {
        numbers.push(begin);
        begin += 3 * cell.len() as u32;
    }
    numbers.push(begin);
    numbers.extend(near.iter().flatten().flat_map(|&outline| ranges[outline as usize]));
    numbers.resize(sides_from, 0);
    numbers.extend(sides);
    (grid, numbers)
}

/// The rectangle in which particles may touch an obstacle.
fn rectangle(obstacles: &Obstacles, number: usize, origin: Origin, reach: f64) -> OnObstacle {
    let of_it = obstacles.outlines().iter().filter(|outline| outline.obstacle == number);
    let Some(bounds) = of_it.map(|outline| outline.bounds()).reduce(|a, b| Bounds {
        x_min: a.x_min.min(b.x_min),
        y_min: a.y_min.min(b.y_min),
        x_max: a.x_max.max(b.x_max),
        y_max: a.y_max.max(b.y_max),
    }) else {
        return OnObstacle::default();
    };
    OnObstacle {
        low: origin.relative([bounds.x_min - reach, bounds.y_min - reach]),
        high: origin.relative([bounds.x_max + reach, bounds.y_max + reach]),
        ..OnObstacle::default()
    }
}
