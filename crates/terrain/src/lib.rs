//! Terrain: rasters with their reference systems, generated ground, smooth interpolation.
//!
//! A model sees the ground through [`Terrain`]: heights and slopes in model coordinates (metres), a rectangle of
//! validity, and the grid on which maps are given back (the terrain's own).

mod bounds;
mod error;
mod file;
mod frame;
mod generated;
mod georeference;
mod grid;
mod holes;
mod raster;
mod surface;
mod system;
mod terrain;

pub use bounds::Bounds;
pub use error::TerrainError;
pub use generated::valley_centre;
pub use georeference::Georeference;
pub use grid::MapGrid;
pub use raster::{Raster, RasterField, read_raster, write_geotiff};
pub use system::ReferenceSystem;
pub use terrain::Terrain;
