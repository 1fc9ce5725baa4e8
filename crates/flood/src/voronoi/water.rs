//! The water of a cell: what is conserved, and what follows from it.

use serde::{Deserialize, Serialize};

/// Depth below which the velocity is taken from volume and momentum so that it stays finite, m (Kurganov & Petrova 2007, equation 2.17).
pub(crate) const THIN: f64 = 1e-6;

/// Depth below which water does not move, m.
pub(crate) const STILL: f64 = 1e-12;

/// What is conserved: a column of water over a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Column {
    /// m3.
    pub volume: f64,
    /// Volume times velocity, m4/s.
    pub momentum: [f64; 2],
}

impl Column {
    /// Half of the sum of two columns: the last step of Heun's method.
    pub fn mean(self, other: Self) -> Self {
        Self {
            volume: 0.5 * (self.volume + other.volume),
            momentum: [0, 1].map(|axis| 0.5 * (self.momentum[axis] + other.momentum[axis])),
        }
    }

    /// Kinetic energy over density, m5/s2.
    pub fn kinetic(&self) -> f64 {
        let [p, q] = self.momentum;
        if self.volume > 0.0 { 0.5 * (p * p + q * q) / self.volume } else { 0.0 }
    }
}

/// Depth, level and velocity of a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Water {
    /// m; 0 where dry.
    pub depth: f64,
    /// Bed plus depth, m; where a cell stores by volume against level, the level of the water in its lower part.
    pub level: f64,
    /// m/s.
    pub velocity: [f64; 2],
}

/// Slopes of the water in a cell: of depth, level, and velocity east- and northwards ([`DEPTH`], [`LEVEL`], [`EAST`], [`NORTH`]), first those along
/// x, then those along y. Single precision: they are multiplied by a part of the spacing, and are exactly 0 in a level lake.
pub(crate) type Slopes = [f32; 8];

/// Slope of the depth.
pub(crate) const DEPTH: usize = 0;
/// Slope of the level.
pub(crate) const LEVEL: usize = 1;
/// Slope of the velocity eastwards, 1/s.
pub(crate) const EAST: usize = 2;
/// Slope of the velocity northwards, 1/s.
pub(crate) const NORTH: usize = 3;

/// The slope `[along x, along y]` of a quantity.
#[inline]
pub(crate) fn slope(slopes: &Slopes, quantity: usize) -> [f64; 2] {
    [slopes[quantity], slopes[quantity + 4]].map(f64::from)
}

impl Water {
    /// The water of a column over a cell of an area, m2, where `level` gives the level for a depth, m; momentum that its velocity does not carry is taken off the column.
    #[inline]
    pub fn of(column: &mut Column, area: f64, level: impl FnOnce(f64) -> f64) -> Self {
        let depth = column.volume / area;
        if depth < STILL {
            column.momentum = [0.0; 2];
        } else if depth < THIN {
            let thin = THIN * area;
            let factor = 2.0 * column.volume * column.volume / (column.volume * column.volume + thin * thin);
            column.momentum = column.momentum.map(|momentum| momentum * factor);
        }
        Self::as_it_is(column, area, level)
    }

    /// The same of a column whose momentum was bounded before.
    #[inline]
    pub fn as_it_is(column: &Column, area: f64, level: impl FnOnce(f64) -> f64) -> Self {
        let depth = (column.volume / area).max(0.0);
        let moves = depth >= STILL;
        let velocity = column.momentum.map(|momentum| if moves { momentum / column.volume } else { 0.0 });
        Self { depth, level: level(depth), velocity }
    }

    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        let [u, v] = self.velocity;
        (u * u + v * v).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocity_stays_finite_where_there_is_next_to_no_water() {
        for volume in [0.0_f64, 1e-300, 1e-13, 1e-9, 1e-6, 1.0] {
            let mut column = Column { volume, momentum: [volume.sqrt(), 0.0] };
            let water = Water::of(&mut column, 1.0, |depth| 3.0 + depth);
            assert!(water.velocity[0].is_finite() && water.velocity[0] <= 1.000001 / volume.sqrt().max(1e-3));
            assert!((column.momentum[0] - volume * water.velocity[0]).abs() <= 1e-15);
        }
    }
}
