//! Normalisation of the discrete Laplacian of diffusion by a tensor, which makes its pair weights exact for second moments.
//!
//! The viscosity kernel's Laplacian gives sum_j w_ij (A_j - A_i), w_ij = V lap W(r_ij) (Mueller, Charypar & Gross 2003, equation 14).
//! It is exact for a field that is parabolic in x, y and z only where 1/2 sum_j w_ij r r^T = I. Particles that settle into layers miss that by
//! some percent, and differently along each axis. So each particle has a symmetric tensor Q_i for which
//!
//! 1/2 sum_j w_ij (e^T Q_i e) r r^T = I, r from i to j, e = r/|r|,
//!
//! six linear equations (the tensor of Fatehi & Manzari 2011, Computers & Mathematics with Applications 61, 482; without
//! their first-derivative term, which would not conserve). A pair has the weight w_ij e^T (Q_i + Q_j) e / 2: the same from both sides, so
//! what one particle gives the other gets.

use corpuscle_sph::{LANES, Lanes, Simd, SimdBase};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Components xx, yy, zz and, doubled, xy, xz, yz of a symmetric tensor.
pub type Tensor = [f64; 6];

/// Fourth moments of neighbours' offsets: sums of w/(2 r^2) times the products of [`products`]. 1/2 sum w (e^T Q e) r r^T is linear in them.
pub type Moments = [f64; 15];

/// Largest eigenvalue of a [`Tensor`]: a particle with few neighbours diffuses no faster along any axis than one with half of them.
pub(crate) const MAX_EIGENVALUE: f64 = 2.0;

/// Arithmetic of one number or of several at once.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T> + Neg<Output = T>> Number for T {}

/// xx, yy, zz, xy, xz, yz of an offset.
#[inline(always)]
fn squares<T: Number>([x, y, z]: [T; 3]) -> [T; 6] {
    [x * x, y * y, z * z, x * y, x * z, y * z]
}

/// x4, y4, z4, x2y2, x2z2, y2z2, and xy, xz, yz times each of x2, y2, z2 of an offset.
#[inline(always)]
pub fn products<T: Number>(offset: [T; 3]) -> [T; 15] {
    let [xx, yy, zz, xy, xz, yz] = squares(offset);
    let [x4, y4, z4, x2y2, x2z2, y2z2] = [xx * xx, yy * yy, zz * zz, xx * yy, xx * zz, yy * zz];
    // Closures over lanes would not be inlined here and below.
    let [x, y, z] = [[xx * xy, xx * xz, xx * yz], [yy * xy, yy * xz, yy * yz], [zz * xy, zz * xz, zz * yz]];
    [x4, y4, z4, x2y2, x2z2, y2z2, x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]]
}

/// r^T Q r.
#[inline(always)]
pub fn along<T: Number>(tensor: [T; 6], offset: [T; 3]) -> T {
    let [xx, yy, zz, xy, xz, yz] = squares(offset);
    tensor[0] * xx + tensor[1] * yy + tensor[2] * zz + (tensor[3] * xy + tensor[4] * xz + tensor[5] * yz)
}

/// e^T Q e for an offset; 0 where there is none.
pub fn factor(tensor: &Tensor, offset: [f64; 3]) -> f64 {
    let r_squared = offset.iter().map(|along| along * along).sum::<f64>();
    if r_squared > 0.0 { along(*tensor, offset) / r_squared } else { 0.0 }
}

/// The tensor seen in a mirror across some axes.
pub fn mirrored([xx, yy, zz, xy, xz, yz]: Tensor, axes: [bool; 3]) -> Tensor {
    let [x, y, z] = axes.map(|mirrored| if mirrored { -1.0 } else { 1.0 });
    [xx, yy, zz, x * y * xy, x * z * xz, y * z * yz]
}

/// Inverse of the symmetric matrix of components xx, yy, zz, xy, xz, yz, by its cofactors.
#[inline(always)]
fn inverse<T: Number>([xx, yy, zz, xy, xz, yz]: [T; 6], one: T) -> [T; 6] {
    let [a, b, c] = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
    let scale = one / (xx * a + xy * b + xz * c);
    [
        a * scale,
        (xx * zz - xz * xz) * scale,
        (xx * yy - xy * xy) * scale,
        b * scale,
        c * scale,
        (xy * xz - xx * yz) * scale,
    ]
}

/// A symmetric matrix times a vector.
#[inline(always)]
fn times<T: Number>([xx, yy, zz, xy, xz, yz]: [T; 6], [x, y, z]: [T; 3]) -> [T; 3] {
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

#[inline(always)]
fn dot<T: Number>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Solves the six equations for Q. With the doubled components as unknowns their matrix is symmetric and made of the moments as they are:
/// P d + R o = 1 for the diagonal d, R^T d + S o = 0 for the others o, eliminated block by block.
#[inline(always)]
fn solve<T: Number>(moments: [T; 15], one: T) -> [T; 6] {
    let [x4, y4, z4, x2y2, x2z2, y2z2, x3y, x3z, x2yz, y3x, y2xz, y3z, z2xy, z3x, z3y] = moments;
    let rows = [[x3y, x3z, x2yz], [y3x, y2xz, y3z], [z2xy, z3x, z3y]];
    let others = inverse([x2y2, x2z2, y2z2, x2yz, y2xz, z2xy], one);
    let [x, y, z] = [times(others, rows[0]), times(others, rows[1]), times(others, rows[2])];
    let left = [
        x4 - dot(x, rows[0]),
        y4 - dot(y, rows[1]),
        z4 - dot(z, rows[2]),
        x2y2 - dot(x, rows[1]),
        x2z2 - dot(x, rows[2]),
        y2z2 - dot(y, rows[2]),
    ];
    let [a, b, c] = times(inverse(left, one), [one; 3]);
    let other =
        [-(a * x[0] + b * y[0] + c * z[0]), -(a * x[1] + b * y[1] + c * z[1]), -(a * x[2] + b * y[2] + c * z[2])];
    [a, b, c, other[0], other[1], other[2]]
}

/// Whether a symmetric tensor is positive definite, by its leading minors (Sylvester's criterion). Not where a number is none.
fn is_positive([xx, yy, zz, xy, xz, yz]: Tensor) -> bool {
    let [xy, xz, yz] = [0.5 * xy, 0.5 * xz, 0.5 * yz];
    let minor = xx * yy - xy * xy;
    let determinant = zz * minor - xx * yz * yz - yy * xz * xz + 2.0 * xy * xz * yz;
    xx > 0.0 && minor > 0.0 && determinant > 0.0
}

/// A third of the trace of the second moments 1/2 sum w r r^T: 1 on the lattice.
fn mean_moment(m: &Moments) -> f64 {
    (m[0] + m[1] + m[2] + 2.0 * (m[3] + m[4] + m[5])) / 3.0
}

/// Q where it is positive definite and no eigenvalue is above [`MAX_EIGENVALUE`], so that no weight is negative; else, with too few
/// neighbours or all in a plane, the scalar that makes the trace of the second moments exact, within the same bound.
fn accepted(solution: Tensor, moments: &Moments) -> Tensor {
    let [xx, yy, zz, xy, xz, yz] = solution;
    let below = [MAX_EIGENVALUE - xx, MAX_EIGENVALUE - yy, MAX_EIGENVALUE - zz, -xy, -xz, -yz];
    if is_positive(solution) && is_positive(below) {
        return solution;
    }
    let scalar = 1.0 / mean_moment(moments).max(1.0 / MAX_EIGENVALUE);
    [scalar, scalar, scalar, 0.0, 0.0, 0.0]
}

/// The tensor of a particle with such moments.
pub fn tensor(moments: &Moments) -> Tensor {
    accepted(solve(*moments, 1.0), moments)
}

/// The same of several particles at once.
#[inline(always)]
pub fn tensors<S: Simd>(simd: S, moments: [&Moments; LANES]) -> [Tensor; LANES] {
    let mut of_each = [Lanes::splat(simd, 0.0); 15];
    for (k, of_each) in of_each.iter_mut().enumerate() {
        let mut lanes = [0.0; LANES];
        for (lane, moments) in lanes.iter_mut().zip(moments) {
            *lane = moments[k];
        }
        *of_each = Lanes::from_slice(simd, &lanes);
    }
    let solution = solve(of_each, Lanes::splat(simd, 1.0));
    let mut tensors = [Tensor::default(); LANES];
    for (k, lanes) in solution.into_iter().enumerate() {
        let lanes: [f64; LANES] = lanes.into();
        for (tensor, value) in tensors.iter_mut().zip(lanes) {
            tensor[k] = value;
        }
    }
    for (tensor, moments) in tensors.iter_mut().zip(moments) {
        *tensor = accepted(*tensor, moments);
    }
    tensors
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Moments of neighbours with such weights, and the second moments with a tensor's factors.
    fn moments(neighbours: &[([f64; 3], f64)]) -> Moments {
        let mut sum = Moments::default();
        for &(offset, weight) in neighbours {
            let r_squared: f64 = offset.iter().map(|along| along * along).sum();
            let products = products(offset).map(|product| 0.5 * weight / r_squared * product);
            sum.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
        }
        sum
    }

    fn second_moments(neighbours: &[([f64; 3], f64)], tensor: &Tensor) -> [f64; 6] {
        let mut sum = [0.0; 6];
        for &(offset, weight) in neighbours {
            let weight = 0.5 * weight * factor(tensor, offset);
            sum.iter_mut().zip(squares(offset)).for_each(|(sum, square)| *sum += weight * square);
        }
        sum
    }

    fn neighbour() -> impl Strategy<Value = ([f64; 3], f64)> {
        let along = || -1.0..1.0f64;
        (along(), along(), along(), 0.01..0.5f64).prop_map(|(x, y, z, weight)| ([x, y, z], weight))
    }

    proptest! {
        #[test]
        fn no_weight_is_negative_and_accepted_tensors_are_exact(
            neighbours in prop::collection::vec(neighbour(), 0..40), along in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let moments = moments(&neighbours);
            let tensor = tensor(&moments);
            let factor = factor(&tensor, along);
            prop_assert!((0.0..=2.0 + 1e-9).contains(&factor), "{factor}");
            if tensor[3..] != [0.0; 3] {
                let found = second_moments(&neighbours, &tensor);
                let exact = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
                prop_assert!(found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-6), "{found:?}");
            }
            let several = corpuscle_sph::dispatch!(corpuscle_sph::Level::new(), simd => tensors(simd, [&moments; LANES]));
            prop_assert_eq!(several, [tensor; LANES]);
        }
    }

    #[test]
    fn too_few_neighbours_get_a_scalar() {
        let plane: Vec<_> = (0..8).map(f64::from).map(|angle: f64| ([angle.cos(), angle.sin(), 0.0], 0.3)).collect();
        for neighbours in [&[][..], &[([0.0, 0.0, 1.0], 0.1)], &plane] {
            let [x, y, z, others @ ..] = tensor(&moments(neighbours));
            assert!(x > 0.0 && x <= 2.0 && x == y && y == z && others == [0.0; 3], "{neighbours:?}");
        }
    }

    #[test]
    fn crowded_layers_get_what_makes_each_axis_exact() {
        // Layers nearer to each other than particles are within a layer.
        let mut neighbours = Vec::new();
        for index in 0..343 {
            let at = [index % 7 - 3, index / 7 % 7 - 3, index / 49 - 3].map(f64::from);
            let offset = [1.05 * at[0], at[1], 0.95 * at[2]];
            let r = offset.iter().map(|along| along * along).sum::<f64>().sqrt();
            if r > 0.0 && r < 2.0 {
                neighbours.push((offset, 0.2 * (2.0 - r)));
            }
        }
        let tensor = tensor(&moments(&neighbours));
        let found = second_moments(&neighbours, &tensor);
        assert!(tensor[0] != tensor[1] && (0..6).all(|k| (found[k] - f64::from(k < 3)).abs() < 1e-12), "{found:?}");
    }
}
