//! Terrain: rasters with their reference systems, generated ground, smooth interpolation.
//!
//! A model sees the ground through [`Terrain`]: heights and slopes in model coordinates (metres), a rectangle of
//! validity, and the grid on which maps are given back (the terrain's own). [`Terrain::mean_over`] gives
//! the mean height over a polygon, for finite-volume schemes.

mod bounds;
mod bytes;
mod conversion;
mod error;
mod files;
mod frame;
mod generated;
mod georeference;
mod grid;
mod ground;
mod holes;
mod mean;
mod mosaic;
mod open;
mod outline;
mod polygons;
mod raster;
mod summary;
mod surface;
mod system;
mod terrain;

pub use bounds::Bounds;
pub use error::TerrainError;
pub use files::read_rasters;
pub use generated::valley_centre;
pub use georeference::Georeference;
pub use grid::MapGrid;
pub use mosaic::merge;
pub use polygons::{Polygon, polygons_of_geojson};
pub use raster::{
    MapBox, Photo, Raster, RasterField, Survey, Window, hold_in_memory, in_memory, keep_in_memory, read_raster,
    read_raster_part, survey, write_geotiff, write_raster, write_raster_exactly,
};
pub use summary::{Summary, summarize};
pub use surface::GroundPatches;
pub use system::ReferenceSystem;
pub use terrain::Terrain;
