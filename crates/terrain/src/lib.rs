//! Terrain: rasters with their reference systems, generated ground, smooth interpolation.
//!
//! A model sees the ground through [`Terrain`]: heights and slopes in model coordinates (metres), a rectangle of
//! validity, and the grid on which maps are given back (the terrain's own).

#[cfg(test)]
mod tests {}
