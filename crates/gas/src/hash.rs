//! Finding balls that overlap, in boxes by position.

use crate::functions::pow;

/// Balls filed by the cell of their centre.
pub(crate) struct Hash<const D: usize> {
    low: [f64; D],
    /// Cell sides, and how many there are.
    size: [f64; D],
    count: [usize; D],
    /// Length after which the box repeats; 0 for never.
    period: [f64; D],
    /// How far the image above has slid along x, in a sheared box.
    slid: f64,
    heads: Vec<u32>,
    next: Vec<u32>,
    balls: Vec<([f64; D], f64)>,
}

const NONE: u32 = u32::MAX;

/// Most cells for few balls: 64 MiB.
const MOST_CELLS: usize = 1 << 24;

impl<const D: usize> Hash<D> {
    /// For about `balls` balls of diameters up to `largest`, in a box.
    pub fn new(low: [f64; D], length: [f64; D], period: [f64; D], largest: f64, balls: usize) -> Self {
        let volume: f64 = length.iter().product();
        let side = largest.max(pow(volume / (balls + 1) as f64, 1.0 / D as f64));
        let mut count = length.map(|length| ((length / side) as usize).clamp(1, 1 << 20));
        // In a flat or thin box that is empty but for few balls there would be far more cells than balls.
        while count.iter().product::<usize>() > MOST_CELLS.max(8 * balls) {
            let longest = (0..D).fold(0, |longest, axis| if count[axis] > count[longest] { axis } else { longest });
            count[longest] /= 2;
        }
        let size = std::array::from_fn(|axis| length[axis] / count[axis] as f64);
        let heads = vec![NONE; count.iter().product()];
        Hash { low, size, count, period, slid: 0.0, heads, next: Vec::new(), balls: Vec::new() }
    }

    /// For a sheared box whose image above has slid so far along x.
    pub fn slid(mut self, slid: f64) -> Self {
        self.slid = slid;
        // Of few rows each is on both sides of another: then all balls of the box are near.
        if slid != 0.0 && self.count[1] < 3 {
            for axis in 0..2 {
                self.size[axis] *= self.count[axis] as f64;
                self.count[axis] = 1;
            }
        }
        self
    }

    fn cell(&self, position: &[f64; D]) -> [usize; D] {
        std::array::from_fn(|axis| {
            let cell = ((position[axis] - self.low[axis]) / self.size[axis]).floor().max(0.0) as usize;
            cell.min(self.count[axis] - 1)
        })
    }

    fn number(&self, cell: [usize; D]) -> usize {
        (0..D).rev().fold(0, |number, axis| number * self.count[axis] + cell[axis])
    }

    /// Numbers of positions, those in one cell together and in the cells' order: so that what is read in a row is near in memory.
    pub fn in_order(&self, positions: impl Iterator<Item = [f64; D]>) -> Vec<usize> {
        let mut order: Vec<(usize, usize)> =
            positions.enumerate().map(|(index, position)| (self.number(self.cell(&position)), index)).collect();
        order.sort_unstable();
        order.into_iter().map(|(_, index)| index).collect()
    }

    /// Files a ball.
    pub fn add(&mut self, position: [f64; D], radius: f64) {
        let number = self.number(self.cell(&position));
        self.next.push(self.heads[number]);
        self.heads[number] = self.balls.len() as u32;
        self.balls.push((position, radius));
    }

    /// A filed ball that one at this position would overlap, and how far; of several the deepest.
    pub fn overlap(&self, position: &[f64; D], radius: f64) -> Option<(usize, f64)> {
        let mut deepest: Option<(usize, f64)> = None;
        self.near(position, |ball, distance| {
            let depth = radius + self.balls[ball].1 - distance;
            if depth > deepest.map_or(0.0, |(_, depth)| depth) {
                deepest = Some((ball, depth));
            }
        });
        deepest
    }

    /// True where a ball would overlap none that is filed.
    pub fn is_clear(&self, position: &[f64; D], radius: f64) -> bool {
        self.cells_around(position).all(|cell| {
            self.chain(cell).all(|ball| {
                let (other, reach) = (&self.balls[ball].0, radius + self.balls[ball].1);
                self.distance2(position, other) >= reach * reach
            })
        })
    }

    /// Calls `visit` with each filed ball in the cells around a position, and its distance.
    pub fn near(&self, position: &[f64; D], mut visit: impl FnMut(usize, f64)) {
        for cell in self.cells_around(position) {
            for ball in self.chain(cell) {
                visit(ball, self.distance2(position, &self.balls[ball].0).sqrt());
            }
        }
    }

    /// Numbers of the cells around a position, its own among them.
    fn cells_around(&self, position: &[f64; D]) -> impl Iterator<Item = usize> {
        let centre = self.cell(position);
        let around = (0..3_usize.pow(D as u32)).filter_map(move |around| {
            let step: [usize; D] = std::array::from_fn(|axis| around / 3_usize.pow(axis as u32) % 3);
            if self.slid != 0.0 && self.is_across(&centre, step[1]) {
                return None;
            }
            self.neighbour(&centre, &step).map(|cell| self.number(cell))
        });
        around.chain(self.rows_across(centre))
    }

    /// True where a step along y leaves the box.
    fn is_across(&self, centre: &[usize; D], step: usize) -> bool {
        let row = centre[1] + step;
        row == 0 || row > self.count[1]
    }

    /// Numbers of all cells of the rows across the faces of a sheared box, for a position in a cell there.
    fn rows_across(&self, centre: [usize; D]) -> Vec<usize> {
        let mut cells = Vec::new();
        for step in [0, 2].into_iter().filter(|&step| self.slid != 0.0 && self.is_across(&centre, step)) {
            for around in 0..3_usize.pow(D as u32 - 2) {
                // Along x from the position itself; along z as in a box at rest.
                let mut steps = [1; D];
                (steps[1], steps[D - 1]) = (step, if D == 3 { around } else { step });
                let Some(mut cell) = self.neighbour(&centre, &steps) else { continue };
                for x in 0..self.count[0] {
                    cell[0] = x;
                    cells.push(self.number(cell));
                }
            }
        }
        cells
    }

    /// The balls in a cell.
    fn chain(&self, cell: usize) -> impl Iterator<Item = usize> {
        let after = |&ball: &u32| Some(self.next[ball as usize]).filter(|&next| next != NONE);
        std::iter::successors(Some(self.heads[cell]).filter(|&head| head != NONE), after).map(|ball| ball as usize)
    }

    /// The cell one down (0), at (1) or one up (2) along each axis; none beyond a wall, or where it is met another way.
    fn neighbour(&self, centre: &[usize; D], step: &[usize; D]) -> Option<[usize; D]> {
        let mut cell = *centre;
        for axis in 0..D {
            let count = self.count[axis];
            let to = centre[axis] + step[axis];
            let repeats = self.period[axis] > 0.0;
            cell[axis] = match to.checked_sub(1) {
                Some(to) if to < count => to,
                // With two cells or one, the neighbours across the seam are met already.
                _ if !repeats || count < 3 => return None,
                Some(_) => 0,
                None => count - 1,
            };
        }
        Some(cell)
    }

    fn distance2(&self, a: &[f64; D], b: &[f64; D]) -> f64 {
        let mut above = 0.0;
        if self.slid != 0.0 {
            above = ((a[1] - b[1]) / self.period[1]).round();
        }
        let square = |axis: usize| {
            let mut apart = a[axis] - b[axis];
            if self.slid != 0.0 && axis == 0 {
                apart -= above * self.slid;
                apart -= self.period[0] * (apart / self.period[0]).round();
            } else if self.period[axis] > 0.0 {
                // Positions lie in the box: no more than one period is too much.
                if apart > 0.5 * self.period[axis] {
                    apart -= self.period[axis];
                } else if apart < -0.5 * self.period[axis] {
                    apart += self.period[axis];
                }
            }
            apart * apart
        };
        (0..D).map(square).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_flat_and_thin_boxes_take_little_memory() {
        for length in [[1e12, 1e12, 1.0], [1e30, 1e30, 1e-30], [1e12, 1.0, 1e-12], [1e6; 3]] {
            let mut hash = Hash::new([0.0; 3], length, [0.0; 3], 0.5, 1);
            assert!(hash.heads.len() <= MOST_CELLS, "{length:?}: {}", hash.heads.len());
            assert!(
                hash.size.iter().zip(length).all(|(size, length)| *size >= 0.5 || *size == length),
                "{:?}",
                hash.size
            );
            let middle = length.map(|length| 0.5 * length);
            hash.add(middle, 0.25);
            assert!(hash.overlap(&middle, 0.25).is_some() && hash.is_clear(&[0.0; 3], 0.25) == (middle[0] > 1.0));
        }
    }
}
