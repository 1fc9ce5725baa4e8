//! Cells of the box round a solid, and how much of the solid is in each.

use super::Depth;
use crate::Solid;

/// A box of equal cells round a solid.
pub(super) struct Cells<'a> {
    solid: &'a Solid,
    /// Corner at the smallest coordinates, m.
    corner: [f64; 3],
    /// Sides of a cell, m.
    sides: [f64; 3],
    /// Number of cells along each axis.
    counts: [u32; 3],
    /// Cells farther below the surface than this are left out, m.
    deepest: f64,
}

/// A cell that has part of the solid or of its surface in it.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// Number along each axis.
    pub index: [u32; 3],
    /// Part of the cell that is inside the solid.
    pub fraction: f64,
    /// Surface in the cell, m².
    pub area: f64,
    /// Centre of mass of the part inside, m.
    pub centre: [f64; 3],
    /// Whether it is near the surface. Others are whole.
    pub is_cut: bool,
}

/// Samples along each side of a cell that are tested where its centre of mass is outside the solid.
const CENTRE_SAMPLES_PER_SIDE: u32 = 6;

/// Blocks of more cells than this are divided among threads.
const SHARED_OUT: u64 = 1 << 12;

impl<'a> Cells<'a> {
    pub fn new(solid: &'a Solid, spacing: f64, depth: Depth) -> Self {
        let [corner, end] = solid.own_bounds();
        let lengths: [f64; 3] = std::array::from_fn(|axis| end[axis] - corner[axis]);
        let counts = lengths.map(|length| (length / spacing).round().max(1.0) as u32);
        let sides: [f64; 3] = std::array::from_fn(|axis| lengths[axis] / f64::from(counts[axis]));
        let deepest = match depth {
            Depth::Full => f64::INFINITY,
            Depth::Layers(layers) => f64::from(layers) * sides.into_iter().fold(0.0, f64::max),
        };
        Self { solid, corner, sides, counts, deepest }
    }

    /// Volume of a cell, m³.
    pub fn cell_volume(&self) -> f64 {
        self.sides.iter().product()
    }

    /// The cells with a part of the solid in them, in a fixed order, and the number of all whole cells, left out or not.
    pub fn find(&self) -> (Vec<Cell>, u64) {
        self.find_in([0; 3], self.counts)
    }

    fn find_in(&self, from: [u32; 3], to: [u32; 3]) -> (Vec<Cell>, u64) {
        let half: [f64; 3] = std::array::from_fn(|axis| 0.5 * self.sides[axis] * f64::from(to[axis] - from[axis]));
        let middle =
            std::array::from_fn(|axis| self.corner[axis] + self.sides[axis] * f64::from(from[axis]) + half[axis]);
        let distance = self.solid.nearest_of_its_own(middle).distance;
        // An octant sees the surface half a cell's diagonal away, and is a quarter off the cell's middle: see `cut`.
        let (reach, margin) = (length(half), 0.25 * length(self.sides));
        let count: u64 = (0..3).map(|axis| u64::from(to[axis] - from[axis])).product();
        if distance > reach + margin {
            return (Vec::new(), 0);
        }
        if count == 1 {
            return self.find_one(from, middle, distance, distance < -(reach + margin));
        }
        if distance < -(reach + margin) {
            if distance + reach < -self.deepest {
                return (Vec::new(), count);
            }
            if self.deepest == f64::INFINITY {
                return (self.whole(from, to), count);
            }
        }
        let axis = (0..3).max_by_key(|&axis| to[axis] - from[axis]).unwrap_or(0);
        let (mut end, mut start) = (to, from);
        end[axis] = from[axis].midpoint(to[axis]);
        start[axis] = end[axis];
        let (low, high) = if count > SHARED_OUT {
            rayon::join(|| self.find_in(from, end), || self.find_in(start, to))
        } else {
            (self.find_in(from, end), self.find_in(start, to))
        };
        let (mut cells, whole) = low;
        cells.extend(high.0);
        (cells, whole + high.1)
    }

    fn find_one(&self, index: [u32; 3], middle: [f64; 3], distance: f64, is_inside: bool) -> (Vec<Cell>, u64) {
        let cell = if is_inside { None } else { Some(self.cut(index, middle)) };
        match cell {
            Some(cell) if cell.fraction == 0.0 && cell.area == 0.0 => (Vec::new(), 0),
            Some(cell) if cell.fraction < 1.0 || cell.area > 0.0 => (vec![cell], 0),
            _ if distance < -self.deepest => (Vec::new(), 1),
            _ => (self.whole(index, index.map(|at| at + 1)), 1),
        }
    }

    fn whole(&self, from: [u32; 3], to: [u32; 3]) -> Vec<Cell> {
        let mut cells = Vec::new();
        for z in from[2]..to[2] {
            for y in from[1]..to[1] {
                for x in from[0]..to[0] {
                    let index = [x, y, z];
                    let centre = self.middle(index);
                    cells.push(Cell { index, fraction: 1.0, area: 0.0, centre, is_cut: false });
                }
            }
        }
        cells
    }

    fn middle(&self, index: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.corner[axis] + self.sides[axis] * (f64::from(index[axis]) + 0.5))
    }

    /// A cell near the surface, from its eight octants. The surface cuts an octant like a plane across: what is inside
    /// falls from all of it to nothing over the width of an octant, and the surface is a hat twice as wide.
    fn cut(&self, index: [u32; 3], middle: [f64; 3]) -> Cell {
        let volume = self.cell_volume() / 8.0;
        let mut cell = Cell { index, fraction: 0.0, area: 0.0, centre: [0.0; 3], is_cut: true };
        for octant in 0..8 {
            let position: [f64; 3] = std::array::from_fn(|axis| {
                let side = if octant >> axis & 1 == 0 { -0.25 } else { 0.25 };
                middle[axis] + side * self.sides[axis]
            });
            let nearest = self.solid.nearest_of_its_own(position);
            let width = 0.5 * (0..3).map(|axis| (self.sides[axis] * nearest.normal[axis]).abs()).sum::<f64>();
            let inside = (0.5 - nearest.distance / width).clamp(0.0, 1.0) / 8.0;
            cell.fraction += inside;
            cell.area += volume / width * (1.0 - nearest.distance.abs() / width).max(0.0);
            for axis in 0..3 {
                cell.centre[axis] += inside * position[axis];
            }
        }
        let fraction = cell.fraction;
        cell.centre = if fraction > 0.0 { cell.centre.map(|sum| sum / fraction) } else { middle };
        cell
    }

    /// Puts the position of a part inside the solid, where its centre of mass is not: in a hollow or at a sharp edge. What is too
    /// thin for any of the positions tried becomes nothing.
    pub fn move_inside(&self, cell: &mut Cell) {
        let distance = |position: [f64; 3]| self.solid.nearest_of_its_own(position).distance;
        if distance(cell.centre) < 0.0 {
            return;
        }
        let middle = self.middle(cell.index);
        let positions = (0..CENTRE_SAMPLES_PER_SIDE.pow(3))
            .map(|at| {
                [
                    at % CENTRE_SAMPLES_PER_SIDE,
                    at / CENTRE_SAMPLES_PER_SIDE % CENTRE_SAMPLES_PER_SIDE,
                    at / CENTRE_SAMPLES_PER_SIDE.pow(2),
                ]
            })
            .map(|at| {
                let step = |axis: usize| (f64::from(at[axis]) + 0.5) / f64::from(CENTRE_SAMPLES_PER_SIDE) - 0.5;
                std::array::from_fn(|axis| middle[axis] + step(axis) * self.sides[axis])
            });
        let deepest = positions.map(|position| (position, distance(position))).min_by(|a, b| a.1.total_cmp(&b.1));
        match deepest {
            Some((position, distance)) if distance < 0.0 => cell.centre = position,
            _ => (cell.fraction, cell.area) = (0.0, 0.0),
        }
    }

    /// The cells round a cell.
    pub fn neighbours(&self, index: [u32; 3]) -> impl Iterator<Item = [u32; 3]> + '_ {
        let around = (0..27).filter(|&which| which != 13).map(|which| [which % 3, which / 3 % 3, which / 9]);
        around.filter_map(move |step: [u32; 3]| {
            let moved = |axis: usize| (index[axis] + step[axis]).checked_sub(1).filter(|&at| at < self.counts[axis]);
            Some([moved(0)?, moved(1)?, moved(2)?])
        })
    }
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
