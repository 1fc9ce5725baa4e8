//! The ground of a model.

use crate::frame::Frame;
use crate::surface::{GroundPatches, Surface};
use crate::{Bounds, MapGrid, TerrainError};
use corpuscle_simd::{LANES, Lanes, Level, Simd, SimdBase, dispatch};
use rayon::prelude::*;
use std::fmt;
use std::sync::Arc;

/// The ground: heights and slopes in model coordinates, and the grid on which maps are given back.
///
/// Model coordinates are metres, x eastwards and y northwards. Immutable; share it in an `Arc`.
#[derive(Debug)]
pub struct Terrain {
    pub(crate) bounds: Bounds,
    pub(crate) ground: Ground,
    pub(crate) map_grid: MapGrid,
    /// Whether the file has data, for each cell of the map grid; `None` where it has everywhere.
    pub(crate) valid: Option<Vec<bool>>,
    pub(crate) warnings: Vec<String>,
}

/// A function that gives height, m, and slope `[dz/dx, dz/dy]` at `(x, y)`.
type Function = Box<dyn Fn(f64, f64) -> (f64, [f64; 2]) + Send + Sync>;

/// Where heights come from.
pub(crate) enum Ground {
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

#[inline(always)]
fn on_surface<S: Simd, const N: usize>(
    simd: S,
    surface: &Surface,
    bounds: Bounds,
    x: &[f64; N],
    y: &[f64; N],
    found: &mut [[f64; N]; 3],
) {
    for first in (0..N).step_by(LANES) {
        let lanes = first..first + LANES;
        let x = Lanes::from_slice(simd, &x[lanes.clone()]).max(bounds.x_min).min(bounds.x_max);
        let y = Lanes::from_slice(simd, &y[lanes.clone()]).max(bounds.y_min).min(bounds.y_max);
        for (found, lanes_found) in found.iter_mut().zip(surface.heights_and_slopes(simd, x, y)) {
            lanes_found.store_slice(&mut found[lanes.clone()]);
        }
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
            valid: None,
            warnings: Vec::new(),
        }
    }

    /// Smooth ground through heights on a grid: `height` gives them, m, at the centres of cells about `cell` wide
    /// that fill `bounds`.
    pub fn gridded(bounds: Bounds, cell: f64, height: impl Fn(f64, f64) -> f64 + Sync) -> Self {
        let map_grid = MapGrid::over(bounds, cell);
        let [columns, rows] = [map_grid.columns, map_grid.rows];
        let heights: Vec<f64> = (0..columns * rows)
            .into_par_iter()
            .with_min_len(256)
            .map(|index| {
                let [x, y] = map_grid.centre(index % columns, rows - 1 - index / columns);
                height(x, y)
            })
            .collect();
        let surface = Surface::new(heights, [columns, rows], map_grid.centre(0, rows - 1), map_grid.georeference.cell);
        Self { bounds, ground: Ground::Surface(surface), map_grid, valid: None, warnings: Vec::new() }
    }

    /// The rectangle in model coordinates inside which heights are defined.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Height of the ground, m. Outside the bounds that of the nearest position inside.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.height_and_slope(x, y).0
    }

    /// [`Self::height`], for positions far from each other: nothing is kept for looking at positions beside them, as the
    /// others do. Slower where the ground has not been looked at, and takes no memory.
    pub fn height_once(&self, x: f64, y: f64) -> f64 {
        let [x, y] = self.bounds.nearest(x, y);
        match &self.ground {
            Ground::Surface(surface) => surface.height_once(x, y),
            Ground::Function(function) => function(x, y).0,
        }
    }

    /// [`Self::height`] at the nodes of a grid over the bounds, `[eastwards, northwards]`, at least 2 each, row by row from the
    /// south-west, in single precision. Nothing is kept for it.
    pub fn heights_on(&self, nodes: [usize; 2]) -> Vec<f32> {
        let Bounds { x_min, y_min, .. } = self.bounds;
        let [width, height] = self.bounds.size();
        let along = |from: f64, length: f64, nodes: usize| -> Vec<f64> {
            (0..nodes).map(|node| from + node as f64 * (length / (nodes - 1) as f64)).collect()
        };
        let (x, y) = (along(x_min, width, nodes[0]), along(y_min, height, nodes[1]));
        match &self.ground {
            Ground::Surface(surface) => surface.heights_on(&x, &y),
            Ground::Function(_) => y.iter().flat_map(|y| x.iter().map(|x| self.height(*x, *y) as f32)).collect(),
        }
    }

    /// Height of the ground, m, and its slope `[dz/dx, dz/dy]`. Outside the bounds those of the nearest position inside.
    #[inline]
    pub fn height_and_slope(&self, x: f64, y: f64) -> (f64, [f64; 2]) {
        let [x, y] = self.bounds.nearest(x, y);
        match &self.ground {
            Ground::Surface(surface) => surface.height_and_slope(x, y),
            Ground::Function(function) => function(x, y),
        }
    }

    /// [`Self::height_and_slope`] at many positions at once, to the same bits and far quicker: heights, m, dz/dx and dz/dy.
    /// `N` is a multiple of [`corpuscle_simd::LANES`].
    pub fn heights_and_slopes<const N: usize>(&self, x: &[f64; N], y: &[f64; N]) -> [[f64; N]; 3] {
        const { assert!(N.is_multiple_of(LANES)) };
        let mut found = [[0.0; N]; 3];
        match &self.ground {
            Ground::Surface(surface) => {
                dispatch!(Level::new(), simd => on_surface(simd, surface, self.bounds, x, y, &mut found));
            }
            Ground::Function(function) => {
                for k in 0..N {
                    let [x, y] = self.bounds.nearest(x[k], y[k]);
                    let (height, slope) = function(x, y);
                    (found[0][k], [found[1][k], found[2][k]]) = (height, slope);
                }
            }
        }
        found
    }

    /// The smooth surface as numbers for a GPU, its heights above `level`, m. Ground from a formula is met at nodes four times
    /// as close as the cells of its maps, with its own slopes, and to fourth order between them.
    pub fn patches_above(&self, level: f64) -> GroundPatches {
        match &self.ground {
            Ground::Surface(surface) => surface.patches_above(level),
            Ground::Function(ground) => {
                GroundPatches::of_function(self.bounds, self.map_grid.cell_size(), level, ground)
            }
        }
    }

    /// The terrain's own grid, on which maps are given back.
    pub fn map_grid(&self) -> &MapGrid {
        &self.map_grid
    }

    /// False for cells of the map grid in which the file has no data, and outside the grid: maps have none there
    /// either.
    pub fn is_valid_cell(&self, column: usize, row: usize) -> bool {
        let MapGrid { columns, rows, .. } = self.map_grid;
        column < columns && row < rows && self.valid.as_ref().is_none_or(|valid| valid[row * columns + column])
    }

    /// True where cells of the map grid have no data.
    pub fn has_holes(&self) -> bool {
        self.valid.is_some()
    }

    /// From the terrain's own coordinates (longitude and latitude in degrees for a geographic one) to model metres.
    /// Not-a-number for a position that a geographic terrain's local projection cannot show, half the Earth away.
    pub fn to_model(&self, position: [f64; 2]) -> [f64; 2] {
        self.map_grid.frame.to_model(position)
    }

    /// From model metres to the terrain's own coordinates.
    pub fn to_own(&self, model: [f64; 2]) -> [f64; 2] {
        self.map_grid.frame.to_own(model)
    }

    /// From longitude and latitude, degrees (WGS 84), to model metres.
    ///
    /// # Errors
    /// [`TerrainError::NoReferenceSystem`] where the terrain has no known position on Earth, [`TerrainError::Position`]
    /// where its reference system does not reach.
    pub fn from_lon_lat(&self, lon_lat: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        self.map_grid.frame.lon_lat_to_model(lon_lat)
    }

    /// From model metres to longitude and latitude, degrees (WGS 84).
    ///
    /// # Errors
    /// As [`Terrain::from_lon_lat`].
    pub fn to_lon_lat(&self, model: [f64; 2]) -> Result<[f64; 2], TerrainError> {
        self.map_grid.frame.model_to_lon_lat(model)
    }

    pub(crate) fn frame(&self) -> Arc<Frame> {
        Arc::clone(&self.map_grid.frame)
    }

    /// A height, m, below which there is no ground in the rectangle between two corners `[x, y]`, m, found by the heights
    /// alone, without the surface through them. Of ground from a formula, of a rectangle that holds more than `most` heights
    /// and of one with a corner that is not a number that is -infinity.
    pub fn lowest_within(&self, [from, to]: [[f64; 2]; 2], most: usize) -> f64 {
        let Ground::Surface(surface) = &self.ground else { return f64::NEG_INFINITY };
        if from.iter().chain(&to).any(|coordinate| coordinate.is_nan()) {
            return f64::NEG_INFINITY;
        }
        let [from, to] = [from, to].map(|[x, y]| self.bounds.nearest(x, y));
        surface.lowest_in(from, to, most).unwrap_or(f64::NEG_INFINITY)
    }

    /// Lowest and highest ground at the centres of the cells of the map grid that have data, m; infinite, the lowest
    /// above the highest, where none has.
    pub fn height_range(&self) -> [f64; 2] {
        let MapGrid { columns, rows, .. } = self.map_grid;
        let none = || [f64::INFINITY, f64::NEG_INFINITY];
        let with =
            |[low, high]: [f64; 2], [other_low, other_high]: [f64; 2]| [low.min(other_low), high.max(other_high)];
        let is_geographic = self.map_grid.georeference.system.as_ref().is_some_and(|system| system.geographic);
        let own = match &self.ground {
            Ground::Surface(surface) if !is_geographic => Some(surface),
            _ => None,
        };
        let height = |column: usize, row: usize| match own {
            // Its grid is the map's.
            Some(surface) => surface.height_of_node(column, rows - 1 - row),
            None => {
                let [x, y] = self.map_grid.centre(column, row);
                self.height_once(x, y)
            }
        };
        let of_row = |row: usize| {
            let valid = (0..columns).filter(|column| self.is_valid_cell(*column, row));
            valid.fold(none(), |range, column| with(range, [height(column, row); 2]))
        };
        (0..rows).into_par_iter().map(of_row).reduce(none, with)
    }

    /// Warnings about this terrain, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}
