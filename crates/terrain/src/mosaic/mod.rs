//! Several rasters as one.

mod grid;
mod tile;

use crate::raster::{check_size, refuse_empty};
use crate::{Raster, TerrainError};
use grid::Grid;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use tile::Tile;

/// Heights that two files give for the same position differ when they do by more than this, m.
const SAME_HEIGHT: f64 = 0.01;

/// Several rasters as one, on the grid of the finest of those in the first one's reference system. Rasters that lie on
/// that grid go in cell by cell; others are interpolated onto it (bilinear, across the border to the next raster). Where
/// several have data the one named first counts; where none has, there is none. Warnings are in the
/// result's warnings. `rasters` are not empty; their names are for messages.
///
/// # Errors
/// A text that names the raster, where a reference system is missing or cannot be converted, or the rectangle round all
/// has too many cells.
pub fn merge(rasters: Vec<(PathBuf, Raster)>) -> Result<Raster, TerrainError> {
    let mut warnings = Vec::new();
    for (_, raster) in &rasters {
        warnings.extend(raster.warnings.iter().cloned());
    }
    let grid = Grid::round(&rasters)?;
    let first = rasters[0].0.clone();
    check_size(&first, grid.size).map_err(|_| too_large(&first, grid.size))?;
    let mut tiles =
        rasters.into_iter().map(|(path, raster)| Tile::new(path, raster, &grid)).collect::<Result<Vec<_>, _>>()?;
    tile::see_across_borders(&mut tiles);
    let rows: Vec<Row> = (0..grid.size[1]).into_par_iter().map(|row| Row::merged(&tiles, &grid, row)).collect();
    warnings.extend(grid_warning(&tiles));
    warnings.extend(row_warnings(&rows, grid.size));
    let values = rows.into_iter().flat_map(|row| row.values).collect();
    let [columns, rows] = grid.size;
    let merged = Raster { columns, rows, values, georeference: grid.georeference, warnings };
    refuse_empty(&first, &merged)?;
    Ok(merged)
}

fn too_large(first: &Path, [columns, rows]: [usize; 2]) -> TerrainError {
    let what = format!(
        "together with the other files it makes a rectangle of {columns} x {rows} cells, more than can be used; name \
         fewer files, or cut out the part that matters (`corpuscle terrain clip`)"
    );
    TerrainError::unusable(first, what)
}

/// A row of the merged raster, and what was seen on the way.
struct Row {
    values: Vec<f64>,
    /// Cells in which two files differ, and the largest difference.
    differing: usize,
    difference: f64,
    /// Cells that lie in no file.
    outside: usize,
}

impl Row {
    fn merged(tiles: &[Tile], grid: &Grid, row: usize) -> Self {
        let columns = grid.size[0];
        let mut merged = Self { values: vec![f64::NAN; columns], differing: 0, difference: 0.0, outside: 0 };
        let mut inside = vec![false; columns];
        for tile in tiles.iter().filter(|tile| tile.rows.contains(&row)) {
            for column in tile.columns.clone() {
                let Some(position) = tile.position(grid, [column, row]) else { continue };
                inside[column] = true;
                let Some(height) = tile.height(position) else { continue };
                merged.put(column, height);
            }
        }
        merged.outside = inside.iter().filter(|inside| !**inside).count();
        merged
    }

    /// The first height stays; a second is compared with it.
    fn put(&mut self, column: usize, height: f64) {
        let value = &mut self.values[column];
        if value.is_nan() {
            *value = height;
            return;
        }
        let difference = (*value - height).abs();
        if difference > SAME_HEIGHT {
            self.differing += 1;
            self.difference = self.difference.max(difference);
        }
    }
}

/// A word about files that had to be interpolated.
fn grid_warning(tiles: &[Tile]) -> Option<String> {
    let names: Vec<_> = tiles.iter().filter(|tile| !tile.is_aligned()).map(|tile| tile.name()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "The cells of {} do not lie on the grid of the others: their heights are interpolated onto it.",
            names.join(", ")
        )
    })
}

/// Words about overlaps and gaps.
fn row_warnings(rows: &[Row], [columns, count]: [usize; 2]) -> Vec<String> {
    let mut warnings = Vec::new();
    let differing: usize = rows.iter().map(|row| row.differing).sum();
    if differing > 0 {
        let largest = rows.iter().map(|row| row.difference).fold(0.0, f64::max);
        warnings.push(format!(
            "Terrain files overlap and differ in {differing} cells, by up to {largest:.2} m; the one named first counts."
        ));
    }
    let outside: usize = rows.iter().map(|row| row.outside).sum();
    if outside > 0 {
        let share = 100.0 * outside as f64 / (columns * count) as f64;
        warnings.push(format!(
            "{outside} cells ({share:.1} %) of the rectangle round the terrain files lie in none of them and have no data."
        ));
    }
    warnings
}
