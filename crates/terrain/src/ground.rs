//! Ground from a raster.

use crate::frame::Frame;
use crate::holes;
use crate::raster::MOST_CELLS;
use crate::surface::Surface;
use crate::terrain::{Ground, Terrain};
use crate::{Bounds, MapGrid, Raster, TerrainError};
use corpuscle_scene::NoData;
use rayon::prelude::*;
use std::path::Path;
use std::sync::Arc;

/// Heights beyond these are no ground on Earth, m: most likely an unnamed no-data mark.
const LOWEST_ON_EARTH: f64 = -11_000.0;
const HIGHEST_ON_EARTH: f64 = 9_000.0;

/// What most files mark cells without data by, m.
const USUAL_MARK: f64 = -9999.0;

/// Largest magnitude of valid heights, m.
const MAX_HEIGHT: f64 = 1e6;

/// A local projection is stretched by more than a thousandth beyond this distance from its middle line, m.
const FAR_FROM_CENTRE: f64 = 285e3;

/// Error of a projection's scale above which there is a warning (UTM and national grids keep within 0.002).
const MAX_SCALE_ERROR: f64 = 0.005;

impl Terrain {
    /// Smooth ground through the heights of a raster; `name` is what messages call it.
    ///
    /// # Errors
    /// A text that names it, where its heights are no ground or it spans too much of the Earth.
    pub fn from_raster(mut raster: Raster, name: &Path, no_data: NoData) -> Result<Self, TerrainError> {
        let mut warnings = std::mem::take(&mut raster.warnings);
        mark_no_data(&mut raster, name, &mut warnings);
        check_heights(&raster, name, &mut warnings)?;
        let size = [raster.columns, raster.rows];
        let has_holes = raster.values.iter().any(|height| height.is_nan());
        // Ground that is filled in is ground.
        let is_solid = has_holes && no_data == NoData::Wall;
        let valid = is_solid.then(|| raster.values.iter().map(|height| !height.is_nan()).collect());
        holes::close(&mut raster.values, size, no_data);
        let frame = Frame::of_grid(&raster.georeference, size).map_err(|what| TerrainError::unusable(name, what))?;
        let map_grid = MapGrid {
            columns: size[0],
            rows: size[1],
            georeference: raster.georeference.clone(),
            frame: Arc::new(frame),
        };
        let geographic = raster.georeference.system.as_ref().is_some_and(|system| system.geographic);
        let (bounds, surface) = if geographic {
            let bounds = inside(&map_grid).map_err(|what| TerrainError::unusable(name, what))?;
            if bounds.x_min < -FAR_FROM_CENTRE || bounds.x_max > FAR_FROM_CENTRE {
                let what = "The terrain is so wide that distances near its sides are wrong by more than 0.1 %; cut it out \
                            smaller if that matters.";
                warnings.push(what.into());
            }
            (bounds, resampled(raster, bounds, &map_grid))
        } else {
            let bounds = outside(&map_grid);
            if let Some(scale) =
                map_grid.frame.scale(bounds.centre()).filter(|scale| (scale - 1.0).abs() > MAX_SCALE_ERROR)
            {
                warnings.push(format!(
                    "A metre of the terrain's projection is {scale:.3} m on the ground, and so are areas and volumes out of \
                     proportion; project it to one that is true to scale here, e.g. UTM, with `gdalwarp -t_srs`."
                ));
            }
            (bounds, metric(raster, &map_grid))
        };
        Ok(Self { bounds, ground: Ground::Surface(surface), map_grid, valid, warnings })
    }
}

/// Takes heights of exactly the usual mark for cells without data, and tells it.
fn mark_no_data(raster: &mut Raster, path: &Path, warnings: &mut Vec<String>) {
    let marked = raster.values.iter().filter(|height| **height == USUAL_MARK).count();
    if marked == 0 || marked == raster.values.iter().filter(|height| !height.is_nan()).count() {
        return;
    }
    raster.values.iter_mut().filter(|height| **height == USUAL_MARK).for_each(|height| *height = f64::NAN);
    warnings.push(format!(
        "{} has {marked} cells of exactly {USUAL_MARK} m, which were taken for cells without data; say so in the file: `gdal_edit.py -a_nodata {USUAL_MARK}`.",
        path.display()
    ));
}

/// Refuses invalid heights, and warns of doubtful ones.
fn check_heights(raster: &Raster, path: &Path, warnings: &mut Vec<String>) -> Result<(), TerrainError> {
    let lowest = raster.values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = raster.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let hint = "if that marks cells without data, say so in the file: `gdal_edit.py -a_nodata`";
    if lowest < -MAX_HEIGHT || highest > MAX_HEIGHT {
        let what = format!("its heights go from {lowest} to {highest} m, which is no ground; {hint}");
        return Err(TerrainError::unusable(path, what));
    }
    if lowest < LOWEST_ON_EARTH || highest > HIGHEST_ON_EARTH {
        warnings.push(format!("{} has heights from {lowest} to {highest} m; {hint}.", path.display()));
    }
    Ok(())
}

/// The heights from the south-west, row by row.
fn from_south_west(raster: Raster) -> Vec<f64> {
    let Raster { columns, rows, mut values, .. } = raster;
    let (north, south) = values.split_at_mut(rows.div_ceil(2) * columns);
    for (north, south) in north.chunks_exact_mut(columns).zip(south.chunks_exact_mut(columns).rev()) {
        north.swap_with_slice(south);
    }
    values
}

/// The surface of a raster whose own coordinates are the model's but for the unit.
fn metric(raster: Raster, grid: &MapGrid) -> Surface {
    let size = [raster.columns, raster.rows];
    let first = grid.centre(0, raster.rows - 1);
    let cell = grid.frame.to_model(raster.georeference.cell);
    Surface::new(from_south_west(raster), size, first, cell)
}

/// The rectangle round the cells of a raster that is not turned against the model's axes.
fn outside(grid: &MapGrid) -> Bounds {
    let [x_min, y_max] = grid.point([-0.5, -0.5]);
    let [x_max, y_min] = grid.point([grid.columns as f64 - 0.5, grid.rows as f64 - 0.5]);
    Bounds { x_min, x_max, y_min, y_max }
}

/// A rectangle in model coordinates inside the curved outline of a geographic raster.
fn inside(grid: &MapGrid) -> Result<Bounds, String> {
    const STEPS: usize = 64;
    let [last_column, last_row] = [grid.columns, grid.rows].map(|count| count as f64 - 0.5);
    let along = |from: [f64; 2], to: [f64; 2]| {
        (0..=STEPS).map(move |step| {
            let t = step as f64 / STEPS as f64;
            grid.point([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])])
        })
    };
    let corners = [[-0.5, -0.5], [last_column, -0.5], [-0.5, last_row], [last_column, last_row]];
    let [north_west, north_east, south_west, south_east] = corners;
    let bounds = Bounds {
        x_min: along(north_west, south_west).map(|[x, _]| x).fold(f64::NEG_INFINITY, f64::max),
        x_max: along(north_east, south_east).map(|[x, _]| x).fold(f64::INFINITY, f64::min),
        y_min: along(south_west, south_east).map(|[_, y]| y).fold(f64::NEG_INFINITY, f64::max),
        y_max: along(north_west, north_east).map(|[_, y]| y).fold(f64::INFINITY, f64::min),
    };
    let [width, height] = bounds.size();
    let finite = corners.iter().flat_map(|corner| grid.point(*corner)).all(f64::is_finite);
    if finite && width > 0.0 && height > 0.0 {
        Ok(bounds)
    } else {
        Err("it spans too much of the Earth to be shown flat; cut out the part that matters (`gdal_translate \
             -projwin`) or project it (`gdalwarp -t_srs`)"
            .into())
    }
}

/// The ground over `bounds`, from the surface over the raster's own coordinates. At twice the raster's resolution, if
/// that is not too much: at the same, tops and channels between the new nodes are flattened.
fn resampled(raster: Raster, bounds: Bounds, grid: &MapGrid) -> Surface {
    let south_west = raster.georeference.centre(0, raster.rows - 1);
    let (own_size, own_cell, own_cells) =
        ([raster.columns, raster.rows], raster.georeference.cell, raster.values.len());
    let own = Surface::new(from_south_west(raster), own_size, south_west, own_cell);
    let size = bounds.size();
    let finer = if 4 * own_cells as u64 <= MOST_CELLS { 2.0 } else { 1.0 };
    let wanted = grid.cell_size().map(|cell| cell / finer);
    let count = [0, 1].map(|axis: usize| (size[axis] / wanted[axis]).round().max(2.0) as usize);
    let cell = [0, 1].map(|axis: usize| size[axis] / count[axis] as f64);
    let first = [bounds.x_min + 0.5 * cell[0], bounds.y_min + 0.5 * cell[1]];
    let heights: Vec<f64> = (0..count[0] * count[1])
        .into_par_iter()
        .with_min_len(1024)
        .map(|index| {
            let (column, row) = (index % count[0], index / count[0]);
            let position = [first[0] + column as f64 * cell[0], first[1] + row as f64 * cell[1]];
            let [longitude, latitude] = grid.frame.to_own(position);
            own.height_and_slope(longitude, latitude).0
        })
        .collect();
    Surface::new(heights, count, first, cell)
}
