//! One of several rasters that become one.

use super::grid::Grid;
use crate::conversion::Conversion;
use crate::{Raster, TerrainError};
use std::ops::Range;
use std::path::PathBuf;

/// A raster, and the mapping of its cells to the common grid.
pub(super) struct Tile {
    path: PathBuf,
    raster: Raster,
    /// From the common grid's system to its own.
    conversion: Conversion,
    /// Column and row of its north-west cell on the common grid, where its cells are cells of that grid.
    aligned: Option<[usize; 2]>,
    /// Columns and rows of the common grid in which it may lie.
    pub columns: Range<usize>,
    pub rows: Range<usize>,
    /// Heights at the centres of the cells that would lie round it, in the order of [`Tile::ring_points`].
    ring: Vec<Option<f64>>,
}

impl Tile {
    pub fn new(path: PathBuf, raster: Raster, grid: &Grid) -> Result<Self, TerrainError> {
        let own = raster.georeference.system.as_ref();
        let conversion = Conversion::between(grid.georeference.system.as_ref(), own)
            .map_err(|what| TerrainError::unusable(&path, what))?;
        let mut tile = Self {
            path,
            conversion,
            aligned: None,
            columns: 0..grid.size[0],
            rows: 0..grid.size[1],
            ring: Vec::new(),
            raster,
        };
        if tile.conversion.is_none() {
            let outline = tile.raster.outline();
            let [west, north] = grid.georeference.position([outline.west, outline.north]);
            let [east, south] = grid.georeference.position([outline.east, outline.south]);
            let range = |from: f64, to: f64, count: usize| {
                (from.floor().max(0.0) as usize)..((to.ceil().max(0.0) as usize + 1).min(count))
            };
            tile.columns = range(west, east, grid.size[0]);
            tile.rows = range(north, south, grid.size[1]);
            if grid.holds_cells_of(&tile.raster) {
                let first = [west, north].map(|position| (position + 0.5).round().max(0.0) as usize);
                tile.columns = first[0]..first[0] + tile.raster.columns;
                tile.rows = first[1]..first[1] + tile.raster.rows;
                tile.aligned = Some(first);
            }
        }
        Ok(tile)
    }

    /// True where its cells go in as they are.
    pub fn is_aligned(&self) -> bool {
        self.aligned.is_some()
    }

    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Its own fractional (column, row) of a cell of the common grid; none outside.
    pub fn position(&self, grid: &Grid, [column, row]: [usize; 2]) -> Option<[f64; 2]> {
        if let Some([first_column, first_row]) = self.aligned {
            return Some([(column - first_column) as f64, (row - first_row) as f64]);
        }
        self.position_of(grid.georeference.centre(column, row), &self.conversion)
    }

    /// Its own fractional (column, row) of a position, converted where it must be; none outside.
    fn position_of(&self, point: [f64; 2], conversion: &Conversion) -> Option<[f64; 2]> {
        let position = self.raster.georeference.position(conversion.convert(point).ok()?);
        let inside = |axis: usize, count: usize| (-0.5..=count as f64 - 0.5).contains(&position[axis]);
        (inside(0, self.raster.columns) && inside(1, self.raster.rows)).then_some(position)
    }

    /// The height at a fractional (column, row), bilinear over the cells round it that have data; none where the cell in
    /// which it lies has none.
    pub fn height(&self, [column, row]: [f64; 2]) -> Option<f64> {
        let nearest = |position: f64, count: usize| (position.round().max(0.0)).min(count as f64 - 1.0) as isize;
        let under = self.cell(nearest(column, self.raster.columns), nearest(row, self.raster.rows))?;
        if column.fract() == 0.0 && row.fract() == 0.0 {
            return Some(under);
        }
        let (west, north) = (column.floor(), row.floor());
        let (u, v) = (column - west, row - north);
        let (west, north) = (west as isize, north as isize);
        let corners = [
            (west, north, (1.0 - u) * (1.0 - v)),
            (west + 1, north, u * (1.0 - v)),
            (west, north + 1, (1.0 - u) * v),
            (west + 1, north + 1, u * v),
        ];
        let (sum, weights) = corners.iter().fold((0.0, 0.0), |(sum, weights), &(column, row, weight)| {
            self.cell(column, row).map_or((sum, weights), |height| (sum + weight * height, weights + weight))
        });
        Some(sum / weights)
    }

    /// The height of a cell, or of one in the ring round the raster.
    fn cell(&self, column: isize, row: isize) -> Option<f64> {
        let Raster { columns, rows, values, .. } = &self.raster;
        let (last_column, last_row) = (*columns as isize, *rows as isize);
        if (0..last_column).contains(&column) && (0..last_row).contains(&row) {
            let height = values[row as usize * columns + column as usize];
            return (!height.is_nan()).then_some(height);
        }
        // North row, south row, west column, east column.
        let along = (column + 1) as usize;
        let at = match (column, row) {
            (_, -1) => along,
            (_, row) if row == last_row => columns + 2 + along,
            (-1, row) => 2 * (columns + 2) + row as usize,
            (_, row) => 2 * (columns + 2) + rows + row as usize,
        };
        self.ring.get(at).copied().flatten()
    }

    /// Where the cells round the raster would lie, in its own coordinates.
    fn ring_points(&self) -> Vec<[f64; 2]> {
        let (columns, rows) = (self.raster.columns as f64, self.raster.rows as f64);
        let along = |row: f64| (0..self.raster.columns + 2).map(move |column| [column as f64 - 1.0, row]);
        let down = |column: f64| (0..self.raster.rows).map(move |row| [column, row as f64]);
        let all = along(-1.0).chain(along(rows)).chain(down(-1.0)).chain(down(columns));
        all.map(|position| self.raster.georeference.point(position)).collect()
    }
}

/// Gives each raster that is interpolated the heights just beyond its border from the rasters there, so that the ground
/// goes on smoothly.
pub(super) fn see_across_borders(tiles: &mut [Tile]) {
    for index in 0..tiles.len() {
        if tiles[index].is_aligned() {
            continue;
        }
        let points = tiles[index].ring_points();
        let mut ring = vec![None; points.len()];
        for (_, other) in tiles.iter().enumerate().filter(|(other, _)| *other != index) {
            let system = tiles[index].raster.georeference.system.as_ref();
            // Both convert to the common system, so to each other.
            let Ok(conversion) = Conversion::between(system, other.raster.georeference.system.as_ref()) else {
                continue;
            };
            for (height, point) in ring.iter_mut().zip(&points) {
                if height.is_none() {
                    *height = other.position_of(*point, &conversion).and_then(|position| other.height(position));
                }
            }
        }
        tiles[index].ring = ring;
    }
}
