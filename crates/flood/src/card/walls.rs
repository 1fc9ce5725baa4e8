//! Obstacles as the shaders have them: boundary particles in cells, outlines as lists of sides, rectangles round them.

use super::layout::{Grid, OnObstacle, Origin, Push, WallSite};
use crate::obstacles::{Obstacles, OutlineCells};
use corpuscle_gpu::{Gpu, GpuError, storage, wgpu};
use corpuscle_terrain::Bounds;

/// Obstacles on the device.
#[derive(Debug)]
pub(super) struct Walls {
    pub count: usize,
    /// Cells of the boundary particles, and those by which outlines are found.
    pub grid: Grid,
    pub outlines_grid: Grid,
    pub start: wgpu::Buffer,
    pub sites: wgpu::Buffer,
    pub outlines: wgpu::Buffer,
    /// Impulses of particles that were put back, and how many were.
    pub knocks: wgpu::Buffer,
    pub on_obstacles: wgpu::Buffer,
    /// As it is at the start: nothing has pushed yet.
    rectangles: Vec<OnObstacle>,
}

impl Walls {
    /// Obstacles that particles touch from `reach` m away at most.
    pub fn new(gpu: &Gpu, obstacles: &Obstacles, origin: Origin, reach: f64) -> Result<Self, GpuError> {
        let (grid, start, sites) = sites(obstacles, origin, reach);
        let (outlines_grid, outlines) = outlines(obstacles, origin);
        let count = obstacles.names.len();
        let rectangles: Vec<OnObstacle> =
            (0..count).map(|number| rectangle(obstacles, number, origin, reach)).collect();
        let walls = Self {
            count,
            grid,
            outlines_grid,
            start: filled(gpu, "starts of walls", &start)?,
            sites: filled(gpu, "boundary particles", &sites)?,
            outlines: filled(gpu, "outlines of obstacles", &outlines)?,
            knocks: storage::<i32>(gpu, "knocks", 2 * count + 1)?,
            on_obstacles: storage::<OnObstacle>(gpu, "forces on obstacles", count)?,
            rectangles,
        };
        Ok(walls)
    }

    /// Forgets all impulses; `forces` are those of the last evaluation.
    pub fn begin(&self, gpu: &Gpu, forces: &[[f64; 2]]) {
        let begun = self.rectangles.iter().zip(forces);
        let begun: Vec<OnObstacle> = begun
            .map(|(rectangle, force)| OnObstacle { force: force.map(|along| along as f32), ..*rectangle })
            .collect();
        gpu.queue.write_buffer(&self.on_obstacles, 0, bytemuck::cast_slice(&begun));
        gpu.queue.write_buffer(&self.knocks, 0, bytemuck::cast_slice(&vec![0_i32; 2 * self.count + 1]));
    }

    /// Room for what walls do to each of so many particles.
    pub fn pushes(gpu: &Gpu, count: usize) -> Result<wgpu::Buffer, GpuError> {
        storage::<Push>(gpu, "pushes of walls", count)
    }
}

fn filled<T: bytemuck::NoUninit>(gpu: &Gpu, label: &'static str, values: &[T]) -> Result<wgpu::Buffer, GpuError> {
    let buffer = storage::<T>(gpu, label, values.len())?;
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(values));
    Ok(buffer)
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
        let index = [0, 1].map(|axis| ((site.place[axis] - grid.corner[axis]) * grid.per_cell).max(0.0) as u32);
        index[1].min(grid.rows - 1) * grid.columns + index[0].min(grid.columns - 1)
    };
    let mut sites: Vec<WallSite> = all
        .iter()
        .map(|site| WallSite {
            place: origin.relative([site.x, site.y]),
            normal: site.normal.map(|along| along as f32),
            area: site.area as f32,
            obstacle: site.obstacle as u32,
            volume: site.volume as f32,
            unused: 0.0,
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

/// The outlines as `flood_outlines.wgsl` tells.
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
