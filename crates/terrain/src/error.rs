//! What can go wrong with terrain.

/// Why ground cannot be had. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum TerrainError {
    /// A generated terrain's numbers make no ground.
    #[error("the terrain cannot be made: {0}")]
    Shape(String),
    /// A place on Earth was asked for, and the terrain has none.
    #[error(
        "the terrain has no reference system, so longitude and latitude mean nothing on it; give places in the \
         terrain's own coordinates, or name the reference system of a terrain file with `crs` in [terrain.file]"
    )]
    NoReferenceSystem,
}
