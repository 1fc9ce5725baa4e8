//! A field on the patches of a surface, at any position of it.

use super::view::{Vector, dot};
use corpuscle_model::Surface;
use std::collections::HashMap;

/// Patches filed in cells.
pub(super) struct Field<'a> {
    surface: &'a Surface,
    values: &'a [f64],
    side: f64,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

/// How far the value of a patch reaches, in its half widths.
const REACH: f64 = 4.5;

impl<'a> Field<'a> {
    pub(super) fn new(surface: &'a Surface, values: &'a [f64]) -> Self {
        let side = REACH * surface.half_width.iter().copied().fold(1e-9, f64::max);
        let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (patch, position) in surface.position.iter().enumerate() {
            cells.entry(cell(*position, side)).or_default().push(patch);
        }
        Self { surface, values, side, cells }
    }

    /// The mean of the patches near that face alike, the nearest most; none where none is near, or the nearest has no value.
    pub(super) fn at(&self, position: Vector, normal: Vector) -> Option<f64> {
        let middle = cell(position, self.side);
        let (mut sum, mut weights) = (0.0, 0.0);
        let (mut largest, mut nearest_has_value) = (0.0, false);
        for which in 0..27_i64 {
            let offset = [which % 3 - 1, which / 3 % 3 - 1, which / 9 - 1];
            let cell = std::array::from_fn(|axis| middle[axis] + offset[axis]);
            for &patch in self.cells.get(&cell).into_iter().flatten() {
                let away: Vector = std::array::from_fn(|axis| position[axis] - self.surface.position[patch][axis]);
                let part = 1.0 - dot(away, away) / (REACH * self.surface.half_width[patch]).powi(2);
                let alike = dot(normal, self.surface.normal[patch]);
                if part <= 0.0 || alike <= 0.3 {
                    continue;
                }
                let (weight, has_value) = (part * part * alike, self.values[patch].is_finite());
                if weight > largest {
                    (largest, nearest_has_value) = (weight, has_value);
                }
                if has_value {
                    sum += weight * self.values[patch];
                    weights += weight;
                }
            }
        }
        nearest_has_value.then(|| sum / weights)
    }
}

fn cell(position: Vector, side: f64) -> [i64; 3] {
    position.map(|x| (x / side).floor() as i64)
}
