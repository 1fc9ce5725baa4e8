//! Views of solids.

use corpuscle_model::Surface;

/// A position or direction in space.
pub(crate) type Vector = [f64; 3];

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn normalised(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// `from` and so far along a direction.
pub(super) fn along(from: Vector, direction: Vector, way: f64) -> Vector {
    std::array::from_fn(|axis| from[axis] + way * direction[axis])
}

/// A view without perspective: lengths across it are to scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    /// Directions to the right, upwards and into the picture.
    pub right: Vector,
    pub up: Vector,
    pub ahead: Vector,
}

/// Fraction of the water that one side must have for a view square to it.
const MOSTLY: f64 = 0.6;

impl View {
    /// Seen by looking `ahead`.
    pub(crate) fn looking(ahead: Vector) -> Self {
        let ahead = normalised(ahead);
        let upright = if ahead[2].abs() > 0.99 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let right = normalised(cross(ahead, upright));
        Self { right, up: cross(right, ahead), ahead }
    }

    /// Square on to the side of solids on which the most is; where it is on all sides, from the front and above.
    pub(crate) fn of(surfaces: &[Surface], amount: impl Fn(&Surface) -> Vec<f64>) -> Self {
        let (side, part) = Self::fullest(surfaces, amount);
        if part < MOSTLY { Self::looking([-0.32, 1.0, -0.42]) } else { Self::looking(side) }
    }

    /// Square on to the side of a solid on which the most is.
    pub(crate) fn square_on(surface: &Surface, amount: &[f64]) -> Self {
        Self::looking(Self::fullest(std::slice::from_ref(surface), |_| amount.to_vec()).0)
    }

    /// The view direction to the side with most water, and its fraction of all water.
    fn fullest(surfaces: &[Surface], amount: impl Fn(&Surface) -> Vec<f64>) -> (Vector, f64) {
        let (mut sides, mut all) = ([[0.0; 2]; 3], 0.0);
        for surface in surfaces {
            let amounts = amount(surface);
            for ((normal, half), amount) in surface.normal.iter().zip(&surface.half_width).zip(amounts) {
                let amount = amount * half * half;
                all += amount;
                for axis in 0..3 {
                    sides[axis][usize::from(normal[axis] > 0.0)] += amount * normal[axis] * normal[axis];
                }
            }
        }
        let (mut best, mut most) = ([0.0, 1.0, 0.0], 0.0);
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            if sides[axis][side] > most {
                most = sides[axis][side];
                best = [0.0; 3];
                best[axis] = if side == 1 { -1.0 } else { 1.0 };
            }
        }
        (best, if all > 0.0 { most / all } else { 0.0 })
    }

    /// How far to the right, up and ahead a position is.
    pub(super) fn position(&self, point: Vector) -> Vector {
        [dot(point, self.right), dot(point, self.up), dot(point, self.ahead)]
    }

    /// The position so far to the right, up and ahead.
    pub(super) fn point(&self, [x, y, depth]: Vector) -> Vector {
        std::array::from_fn(|axis| x * self.right[axis] + y * self.up[axis] + depth * self.ahead[axis])
    }

    /// Smallest and largest positions of a box.
    pub(super) fn around(&self, [from, to]: [Vector; 2]) -> [Vector; 2] {
        let corners =
            (0..8).map(|which| std::array::from_fn(|axis| if which >> axis & 1 == 0 { from } else { to }[axis]));
        corners.map(|corner| self.position(corner)).fold(
            [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]],
            |[low, high], position| {
                [std::array::from_fn(|k| low[k].min(position[k])), std::array::from_fn(|k| high[k].max(position[k]))]
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_upright_and_not_mirrored() {
        let front = View::looking([0.0, 1.0, 0.0]);
        assert_eq!((front.right, front.up), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
        let position = [1.0, 2.0, 3.0];
        let slanting = View::looking([0.3, 0.5, -0.7]);
        let back = slanting.point(slanting.position(position));
        assert!((0..3).all(|axis| (back[axis] - position[axis]).abs() < 1e-12));
        assert!(slanting.up[2] > 0.0 && slanting.right[2].abs() < 1e-12);
    }
}
