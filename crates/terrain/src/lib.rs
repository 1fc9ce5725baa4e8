//! Terrain: rasters with their reference systems, generated ground, smooth interpolation.
//!
//! A model sees the ground through [`Terrain`]: heights and slopes in model coordinates (metres), a rectangle of
//! validity, and the grid on which maps are given back (the terrain's own).

mod bounds;
mod error;
mod grid;
mod surface;
mod terrain;

pub use bounds::Bounds;
pub use error::TerrainError;
pub use grid::MapGrid;
pub use terrain::Terrain;
