//! The ground as a model sees it.

use crate::surface::Surface;
use crate::{Bounds, MapGrid, TerrainError};
use std::fmt;

/// The ground: heights and slopes in model coordinates, and the grid on which maps are given back.
///
/// Model coordinates are metres, x eastwards and y northwards. Immutable; share it in an `Arc`.
#[derive(Debug)]
pub struct Terrain {
    bounds: Bounds,
    ground: Ground,
    map_grid: MapGrid,
    warnings: Vec<String>,
}

/// A function that gives height, m, and slope `[dz/dx, dz/dy]` at `(x, y)`.
type Function = Box<dyn Fn(f64, f64) -> (f64, [f64; 2]) + Send + Sync>;

/// Where heights come from.
enum Ground {
    /// A formula.
    Function(Function),
    /// A smooth surface through gridded heights.
    Surface(Surface),
}

impl fmt::Debug for Ground {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Function(_) => "Function",
            Self::Surface(_) => "Surface",
        })
    }
}

impl Terrain {
    /// Exact ground from a function giving height, m, and slope `[dz/dx, dz/dy]` at `(x, y)`. Maps are given back on
    /// a grid of cells about `cell` wide.
    pub fn analytic(
        bounds: Bounds,
        cell: f64,
        ground: impl Fn(f64, f64) -> (f64, [f64; 2]) + Send + Sync + 'static,
    ) -> Self {
        Self {
            bounds,
            ground: Ground::Function(Box::new(ground)),
            map_grid: MapGrid::over(bounds, cell),
            warnings: Vec::new(),
        }
    }

    /// Smooth ground through heights on a grid: `height` gives them, m, at the centres of cells about `cell` wide
    /// that fill `bounds`.
    pub fn gridded(bounds: Bounds, cell: f64, height: impl Fn(f64, f64) -> f64) -> Self {
        let map_grid = MapGrid::over(bounds, cell);
        let [columns, rows] = [map_grid.columns, map_grid.rows];
        let heights: Vec<f64> = (0..rows)
            .rev()
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let [x, y] = map_grid.centre(column, row);
                height(x, y)
            })
            .collect();
        let surface = Surface::new(&heights, [columns, rows], map_grid.centre(0, rows - 1), map_grid.cell_size());
        Self { bounds, ground: Ground::Surface(surface), map_grid, warnings: Vec::new() }
    }

    /// The rectangle in model coordinates inside which heights are defined.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Height of the ground, m. Outside the bounds that of the nearest place inside.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.height_and_slope(x, y).0
    }

    /// Height of the ground, m, and its slope `[dz/dx, dz/dy]`. Outside the bounds those of the nearest place inside.
    #[inline]
    pub fn height_and_slope(&self, x: f64, y: f64) -> (f64, [f64; 2]) {
        let [x, y] = self.bounds.nearest(x, y);
        match &self.ground {
            Ground::Surface(surface) => surface.height_and_slope(x, y),
            Ground::Function(function) => function(x, y),
        }
    }

    /// The terrain's own grid, on which maps are given back.
    pub fn map_grid(&self) -> &MapGrid {
        &self.map_grid
    }

    /// False for cells of the map grid in which the file has no data: maps have none there either.
    pub fn is_valid_cell(&self, column: usize, row: usize) -> bool {
        column < self.map_grid.columns && row < self.map_grid.rows
    }

    /// From the terrain's own coordinates (longitude and latitude in degrees for a geographic one) to model metres.
    pub fn to_model(&self, place: [f64; 2]) -> [f64; 2] {
        place
    }

    /// From model metres to the terrain's own coordinates.
    pub fn to_own(&self, model: [f64; 2]) -> [f64; 2] {
        model
    }

    /// From longitude and latitude, degrees (WGS 84), to model metres.
    ///
    /// # Errors
    /// [`TerrainError::NoReferenceSystem`] where the terrain has no place on Earth.
    pub fn from_lon_lat(&self, _lon_lat: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        Err(TerrainError::NoReferenceSystem)
    }

    /// From model metres to longitude and latitude, degrees (WGS 84).
    ///
    /// # Errors
    /// [`TerrainError::NoReferenceSystem`] where the terrain has no place on Earth.
    pub fn to_lon_lat(&self, _model: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        Err(TerrainError::NoReferenceSystem)
    }

    /// What a user should know about this terrain, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}
