//! Fields on a grid.

/// A field over the model's own grid (flood: the cells of the terrain), row by row from the north-west corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Name as in files: `depth`, `max_depth`.
    pub name: &'static str,
    /// What it shows, for legends: `Maximum depth`.
    pub title: &'static str,
    /// Unit as printed: `m`.
    pub unit: &'static str,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// `rows * columns` values; not-a-number where there is nothing (dry, outside).
    pub values: Vec<f32>,
}
