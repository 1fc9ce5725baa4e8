//! The grid on which several rasters become one.

use crate::conversion::Conversion;
use crate::{Georeference, Raster, TerrainError};
use std::path::PathBuf;

/// Parts of a cell by which a position on a grid may be off.
const ROUNDING: f64 = 0.01;

/// A grid that holds several rasters.
pub(super) struct Grid {
    pub georeference: Georeference,
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Grid {
    /// The grid of the finest raster in the first one's reference system, round all of them.
    pub fn round(rasters: &[(PathBuf, Raster)]) -> Result<Self, TerrainError> {
        let system = &rasters[0].1.georeference.system;
        let area = |raster: &Raster| raster.georeference.cell[0] * raster.georeference.cell[1];
        let own = rasters.iter().map(|(_, raster)| raster).filter(|raster| raster.georeference.system == *system);
        let finest = own.min_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or(&rasters[0].1);
        let georeference = finest.georeference.clone();
        let mut all = finest.outline();
        for (path, raster) in rasters {
            let outline = Conversion::between(raster.georeference.system.as_ref(), system.as_ref())
                .and_then(|conversion| conversion.map_box(&raster.outline()))
                .map_err(|what| TerrainError::unusable(path, what))?;
            all = all.with(outline);
        }
        let cells = |length: f64, axis: usize| {
            let cells = length / georeference.cell[axis];
            if (cells - cells.round()).abs() < ROUNDING { cells.round() } else { cells.ceil() }
        };
        let west = cells(georeference.corner[0] - all.west, 0);
        let north = cells(all.north - georeference.corner[1], 1);
        let columns = west + cells(all.east - georeference.corner[0], 0);
        let rows = north + cells(georeference.corner[1] - all.south, 1);
        let corner = [
            georeference.corner[0] - west * georeference.cell[0],
            georeference.corner[1] + north * georeference.cell[1],
        ];
        Ok(Self { georeference: Georeference { corner, ..georeference }, size: [columns as usize, rows as usize] })
    }

    /// True for a raster whose cells are cells of this grid.
    pub fn holds_cells_of(&self, raster: &Raster) -> bool {
        let (own, other) = (&self.georeference, &raster.georeference);
        let count = [raster.columns, raster.rows];
        own.system == other.system
            && [0, 1].into_iter().all(|axis| {
                let drift = (other.cell[axis] / own.cell[axis] - 1.0).abs() * count[axis] as f64;
                let offset = (other.corner[axis] - own.corner[axis]) / own.cell[axis];
                drift < ROUNDING && (offset - offset.round()).abs() < ROUNDING
            })
    }
}
