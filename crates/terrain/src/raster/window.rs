//! The part of a raster that lies in a box.

use super::Raster;
use crate::Georeference;

/// Parts of a cell that count as rounding, not as a position.
const ROUNDING: f64 = 1e-4;

/// A rectangle in a raster's own coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapBox {
    /// Smallest easting or longitude.
    pub west: f64,
    /// Smallest northing or latitude.
    pub south: f64,
    /// Largest easting or longitude.
    pub east: f64,
    /// Largest northing or latitude.
    pub north: f64,
}

impl MapBox {
    /// A box from its sides `[west, south, east, north]`.
    ///
    /// # Errors
    /// Says which sides are not in order or not finite.
    pub fn new([west, south, east, north]: [f64; 4]) -> Result<Self, String> {
        if ![west, south, east, north].iter().all(|side| side.is_finite()) {
            return Err(format!("the box {west},{south},{east},{north} has a side that is not a finite number"));
        }
        if west >= east || south >= north {
            return Err(format!(
                "the box {west},{south},{east},{north} is empty: the order is west,south,east,north, and west must be less \
                 than east and south less than north"
            ));
        }
        Ok(Self { west, south, east, north })
    }

    /// True where the two share area.
    pub fn meets(&self, other: &Self) -> bool {
        self.west < other.east && other.west < self.east && self.south < other.north && other.south < self.north
    }

    /// The smallest box round both.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            west: self.west.min(other.west),
            south: self.south.min(other.south),
            east: self.east.max(other.east),
            north: self.north.max(other.north),
        }
    }
}

/// Some of a raster's cells: those from `first` (column, row from the north-west), `size` of them each way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Column and row of the north-west cell.
    pub first: [usize; 2],
    /// Numbers of columns and rows.
    pub size: [usize; 2],
}

impl Window {
    /// All cells.
    pub fn whole(size: [usize; 2]) -> Self {
        Self { first: [0, 0], size }
    }

    /// The cells of a raster of `size` columns and rows that share area with `part`; none where none do.
    pub fn within(georeference: &Georeference, size: [usize; 2], part: &MapBox) -> Option<Self> {
        let ([x, y], [dx, dy]) = (georeference.corner, georeference.cell);
        let from = [(part.west - x) / dx, (y - part.north) / dy].map(|cells| (cells + ROUNDING).floor().max(0.0));
        let to = [(part.east - x) / dx, (y - part.south) / dy].map(|cells| (cells - ROUNDING).ceil());
        let to = [0, 1].map(|axis| to[axis].min(size[axis] as f64));
        let some = from[0] < to[0] && from[1] < to[1];
        some.then(|| Self {
            first: from.map(|cell| cell as usize),
            size: [0, 1].map(|axis| (to[axis] - from[axis]) as usize),
        })
    }
}

impl Georeference {
    /// The same grid from a window's first cell on.
    pub fn from_cell(&self, [column, row]: [usize; 2]) -> Self {
        let corner = self.point([column as f64 - 0.5, row as f64 - 0.5]);
        Self { corner, ..self.clone() }
    }

    /// The rectangle round so many columns and rows, in its own coordinates.
    pub(crate) fn outline(&self, [columns, rows]: [usize; 2]) -> MapBox {
        let ([west, north], [dx, dy]) = (self.corner, self.cell);
        MapBox { west, south: north - rows as f64 * dy, east: west + columns as f64 * dx, north }
    }
}

impl Raster {
    /// The rectangle round its cells, in its own coordinates.
    pub fn outline(&self) -> MapBox {
        self.georeference.outline([self.columns, self.rows])
    }

    /// The cells that share area with `part`; none where none do.
    pub fn cropped(&self, part: &MapBox) -> Option<Self> {
        let window = Window::within(&self.georeference, [self.columns, self.rows], part)?;
        let [columns, rows] = window.size;
        let values = (window.first[1]..window.first[1] + rows)
            .flat_map(|row| &self.values[row * self.columns + window.first[0]..][..columns])
            .copied()
            .collect();
        let georeference = self.georeference.from_cell(window.first);
        Some(Self { columns, rows, values, georeference, warnings: self.warnings.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn georeference() -> Georeference {
        Georeference::plain([100.0, 500.0], [10.0, 20.0])
    }

    fn window(sides: [f64; 4]) -> Option<Window> {
        Window::within(&georeference(), [8, 6], &MapBox::new(sides).unwrap())
    }

    #[test]
    fn cells_that_are_touched_are_taken() {
        assert_eq!(window([110.0, 440.0, 130.0, 480.0]), Some(Window { first: [1, 1], size: [2, 2] }));
        assert_eq!(window([109.0, 439.0, 131.0, 481.0]), Some(Window { first: [0, 0], size: [4, 4] }));
        assert_eq!(window([-1e9, -1e9, 1e9, 1e9]), Some(Window::whole([8, 6])));
        assert_eq!(window([180.0, 400.0, 200.0, 420.0]), None);
        assert_eq!(window([100.0, 500.0, 120.0, 600.0]), None);
    }

    #[test]
    fn a_part_lies_where_it_lay() {
        let values = (0..48).map(f64::from).collect();
        let raster = Raster { columns: 8, rows: 6, values, georeference: georeference(), warnings: Vec::new() };
        let part = raster.cropped(&MapBox::new([110.0, 440.0, 130.0, 480.0]).unwrap()).unwrap();
        assert_eq!(part.values, [9.0, 10.0, 17.0, 18.0]);
        assert_eq!(part.georeference.corner, [110.0, 480.0]);
        assert_eq!(part.outline(), MapBox { west: 110.0, south: 440.0, east: 130.0, north: 480.0 });
    }

    #[test]
    fn boxes_that_are_none_are_refused() {
        assert!(MapBox::new([2.0, 0.0, 1.0, 1.0]).unwrap_err().contains("west,south,east,north"));
        assert!(MapBox::new([0.0, f64::NAN, 1.0, 1.0]).unwrap_err().contains("finite"));
    }
}
