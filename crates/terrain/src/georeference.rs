//! Where a raster lies.

use crate::system::ReferenceSystem;
use geotiff_reader::geokeys::GeoKeyDirectory;

/// Where a raster lies: its north-west corner, its cells, and the reference system of these numbers.
#[derive(Debug, Clone)]
pub struct Georeference {
    /// The outer corner at the north-west: easting and northing, or longitude and latitude in degrees.
    pub corner: [f64; 2],
    /// Size of a cell `[eastwards, southwards]`, both positive, in the same units.
    pub cell: [f64; 2],
    /// The reference system, if the file names one.
    pub system: Option<ReferenceSystem>,
    /// The file's GeoTIFF keys, to be written to results as they are.
    pub(crate) keys: GeoKeyDirectory,
}

impl Georeference {
    /// Metres, or whatever the numbers mean, without a position on Earth.
    pub(crate) fn plain(corner: [f64; 2], cell: [f64; 2]) -> Self {
        Self { corner, cell, system: None, keys: GeoKeyDirectory::new() }
    }

    /// Longitude and latitude on WGS 84 (EPSG:4326), degrees.
    pub fn degrees(corner: [f64; 2], cell: [f64; 2]) -> Self {
        Self::plain(corner, cell).with_system(ReferenceSystem::from_epsg(4326, true, 1.0))
    }

    /// The same grid in the given reference system.
    pub(crate) fn with_system(mut self, system: ReferenceSystem) -> Self {
        system.write_keys(&mut self.keys);
        self.system = Some(system);
        self
    }

    /// Centre of a cell.
    pub fn centre(&self, column: usize, row: usize) -> [f64; 2] {
        self.point([column as f64, row as f64])
    }

    /// The point at a fractional (column, row), whole numbers at the centres of cells.
    pub(crate) fn point(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [self.corner[0] + (column + 0.5) * self.cell[0], self.corner[1] - (row + 0.5) * self.cell[1]]
    }

    /// Fractional (column, row) of a position; whole numbers at the centres of cells.
    pub fn position(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.corner[0]) / self.cell[0] - 0.5, (self.corner[1] - y) / self.cell[1] - 0.5]
    }
}
