//! Other rasters over a terrain: roughness, initial depth.

use super::{Raster, read_values};
use crate::frame::Frame;
use crate::{Bounds, Terrain, TerrainError};
use proj4rs::Proj;
use std::path::Path;
use std::sync::Arc;

/// Steps along each side of a terrain between positions at which it is found out where a raster lies.
const SAMPLES: usize = 16;

/// A raster on any grid, evaluated at model coordinates of a terrain.
#[derive(Debug)]
pub struct RasterField {
    raster: Raster,
    frame: Arc<Frame>,
    /// The raster's own system, where it has one and it is not the terrain's.
    other: Option<Proj>,
}

impl RasterField {
    /// Reads a raster to be evaluated over `terrain`. It is in the terrain's reference system, unless it names
    /// another one; its values are taken as they are, also where the file names a unit of heights.
    ///
    /// # Errors
    /// As [`read_raster`](crate::read_raster), where it names a system from or to which the terrain's positions cannot be converted, and where it lies outside the
    /// terrain.
    pub fn open(path: impl AsRef<Path>, terrain: &Terrain) -> Result<Self, TerrainError> {
        let path = path.as_ref();
        let raster = read_values(path)?;
        let frame = terrain.frame();
        let own = &terrain.map_grid().georeference.system;
        let other = match &raster.georeference.system {
            Some(system) if own.as_ref().is_some_and(|own| own != system) => {
                let projection = system.projection().filter(|_| frame.is_known()).ok_or_else(|| {
                    let what = format!(
                        "its reference system {} differs from the terrain's and cannot be converted; bring it to the \
                         terrain's with `gdalwarp -t_srs`",
                        system.name
                    );
                    TerrainError::unusable(path, what)
                })?;
                Some(projection)
            }
            _ => None,
        };
        let field = Self { raster, frame, other };
        if !field.overlaps(&terrain.bounds()) {
            return Err(TerrainError::unusable(path, "it lies outside the terrain, and would have no effect"));
        }
        Ok(field)
    }

    /// Whether some of its cells may lie within bounds in model coordinates: by the columns and rows of positions all over them.
    fn overlaps(&self, bounds: &Bounds) -> bool {
        let Bounds { x_min, x_max, y_min, y_max } = bounds;
        let along = |low: f64, high: f64, step: usize| low + (high - low) * step as f64 / SAMPLES as f64;
        let mut reached = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for step in 0..(SAMPLES + 1) * (SAMPLES + 1) {
            let model = [along(*x_min, *x_max, step % (SAMPLES + 1)), along(*y_min, *y_max, step / (SAMPLES + 1))];
            let Some(position) = self.position(model) else { continue };
            for ([low, high], at) in reached.iter_mut().zip(position) {
                (*low, *high) = (low.min(at), high.max(at));
            }
        }
        let counts = [self.raster.columns, self.raster.rows];
        reached.iter().zip(counts).all(|([low, high], count)| *low <= count as f64 - 0.5 && *high >= -0.5)
    }

    /// Warnings about the file, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.raster.warnings
    }

    /// Lowest and highest of its values; none without any.
    pub fn range(&self) -> Option<[f64; 2]> {
        let values = || self.raster.values.iter().copied().filter(|value| !value.is_nan());
        let least = values().reduce(f64::min)?;
        Some([least, values().fold(least, f64::max)])
    }

    /// South-west corner, m, and size of the cells `[eastwards, northwards]`, m, where they lie along the model's coordinates.
    pub fn cells_in_model(&self) -> Option<([f64; 2], [f64; 2])> {
        let scale = self.frame.metres_per_unit().filter(|_| self.other.is_none())?;
        let crate::Georeference { corner, cell, .. } = &self.raster.georeference;
        let south = corner[1] - self.raster.rows as f64 * cell[1];
        Some(([corner[0] * scale, south * scale], cell.map(|size| size * scale)))
    }

    /// The value of the cell in which the model coordinates lie; `None` outside and where there is no data. For classes
    /// and coefficients.
    pub fn nearest(&self, x: f64, y: f64) -> Option<f64> {
        self.value_under(self.position([x, y])?)
    }

    /// The value between the centres of the four nearest cells, bilinear over those that have data; `None` where
    /// [`RasterField::nearest`] is. For depths.
    pub fn bilinear(&self, x: f64, y: f64) -> Option<f64> {
        let position = self.position([x, y])?;
        self.value_under(position)?;
        let [column, row] = position;
        let (west, north) = (column.floor(), row.floor());
        let (u, v) = (column - west, row - north);
        let corners = [
            (west, north, (1.0 - u) * (1.0 - v)),
            (west + 1.0, north, u * (1.0 - v)),
            (west, north + 1.0, (1.0 - u) * v),
            (west + 1.0, north + 1.0, u * v),
        ];
        let (sum, weights) = corners.iter().fold((0.0, 0.0), |(sum, weights), &(column, row, weight)| {
            self.value(column, row).map_or((sum, weights), |value| (sum + weight * value, weights + weight))
        });
        Some(sum / weights)
    }

    /// Fractional (column, row) of a position in model coordinates.
    fn position(&self, model: [f64; 2]) -> Option<[f64; 2]> {
        let own = self.frame.to_own(model);
        let own = match &self.other {
            Some(system) => self.frame.own_to(system, own)?,
            None => own,
        };
        Some(self.raster.georeference.position(own))
    }

    /// The value of the cell in which a fractional (column, row) lies, the raster's sides included.
    fn value_under(&self, [column, row]: [f64; 2]) -> Option<f64> {
        let cell = |position: f64, count: usize| {
            let last = count as f64 - 1.0;
            (-0.5..=last + 0.5).contains(&position).then(|| (position + 0.5).floor().min(last))
        };
        self.value(cell(column, self.raster.columns)?, cell(row, self.raster.rows)?)
    }

    /// The value of a cell, if there is one.
    fn value(&self, column: f64, row: f64) -> Option<f64> {
        let Raster { columns, rows, values, .. } = &self.raster;
        let inside = (0.0..*columns as f64).contains(&column) && (0.0..*rows as f64).contains(&row);
        let value = inside.then(|| values[row as usize * columns + column as usize])?;
        (!value.is_nan()).then_some(value)
    }
}
