//! Balls evenly on a lattice.

use crate::functions::pow;

/// Points evenly in a box of side lengths `length`, `count` of them: on the square or the centred rectangular lattice (in three
/// dimensions the cubic or the face-centred one), stretched to fit, whichever keeps them farthest apart. Along periodic axes the
/// box repeats; along others points lie on its faces too. With the points comes the smallest distance.
pub(super) fn lattice<const D: usize>(count: usize, length: [f64; D], periodic: [bool; D]) -> (Vec<[f64; D]>, f64) {
    let simple: &[[f64; D]] = &[[0.0; D]];
    let centred = centred::<D>();
    let (one, many) = (best(count, length, periodic, simple), best(count, length, periodic, &centred));
    let (cells, basis) = if one.1 >= many.1 { (one.0, simple) } else { (many.0, &centred[..]) };
    let step = steps(cells, length, periodic, basis);
    let sites = cells.iter().product::<usize>() * basis.len();
    let site = |number: usize| -> [f64; D] {
        let (mut cell, base) = (number / basis.len(), &basis[number % basis.len()]);
        std::array::from_fn(|axis| {
            let along = cell % cells[axis];
            cell /= cells[axis];
            // One layer alone stands in the middle.
            if step[axis].is_finite() { (along as f64 + base[axis]) * step[axis] } else { 0.5 * length[axis] }
        })
    };
    // Sites too many are left out evenly.
    let points = (0..count).map(|ball| site((ball as u128 * sites as u128 / count as u128) as usize)).collect();
    (points, one.1.max(many.1))
}

/// Corner and centres of the faces (in two dimensions of the cell itself), as parts of the cell's sides.
fn centred<const D: usize>() -> Vec<[f64; D]> {
    let half_pairs = if D == 2 { vec![[0, 1]] } else { vec![[0, 1], [0, 2], [1, 2]] };
    let centre = |pair: [usize; 2]| std::array::from_fn(|axis| if pair.contains(&axis) { 0.5 } else { 0.0 });
    std::iter::once([0.0; D]).chain(half_pairs.into_iter().map(centre)).collect()
}

/// Sides of a cell when this many fill the box.
fn steps<const D: usize>(cells: [usize; D], length: [f64; D], periodic: [bool; D], basis: &[[f64; D]]) -> [f64; D] {
    std::array::from_fn(|axis| {
        let beyond = basis.iter().map(|base| base[axis]).fold(0.0, f64::max);
        let across = if periodic[axis] { cells[axis] as f64 } else { cells[axis] as f64 - 1.0 + beyond };
        if across > 0.0 { length[axis] / across } else { f64::INFINITY }
    })
}

/// Numbers of cells along each axis that hold `count` points farthest apart, and that distance.
fn best<const D: usize>(count: usize, length: [f64; D], periodic: [bool; D], basis: &[[f64; D]]) -> ([usize; D], f64) {
    let cells = count.div_ceil(basis.len());
    let volume: f64 = length.iter().map(|length| length.max(1e-300)).product();
    let usual = pow(volume / cells as f64, 1.0 / D as f64);
    // A cell's sides may differ by this factor from a cube's; beyond it points only come nearer to each other.
    let range = |axis: usize| {
        let even = length[axis] / usual;
        (even / 2.5) as usize..=(even * 2.5) as usize + 2
    };
    let mut found = ([1; D], 0.0);
    let mut consider = |tried: [usize; D]| {
        let distance = spacing(steps(tried, length, periodic, basis), tried, periodic, basis);
        if distance > found.1 {
            found = (tried, distance);
        }
    };
    for first in range(0).filter(|&first| first > 0) {
        if D == 2 {
            consider(std::array::from_fn(|axis| [first, cells.div_ceil(first)][axis]));
            continue;
        }
        for second in range(1).filter(|&second| second > 0) {
            consider(std::array::from_fn(|axis| [first, second, cells.div_ceil(first * second)][axis]));
        }
    }
    found
}

/// Smallest distance of two points of the lattice.
fn spacing<const D: usize>(step: [f64; D], cells: [usize; D], periodic: [bool; D], basis: &[[f64; D]]) -> f64 {
    let mut nearest = f64::INFINITY;
    for axis in 0..D {
        if cells[axis] > 1 || periodic[axis] {
            nearest = nearest.min(step[axis]);
        }
    }
    for base in &basis[1..] {
        let apart2: f64 = (0..D).filter(|&axis| base[axis] > 0.0).map(|axis| (base[axis] * step[axis]).powi(2)).sum();
        nearest = nearest.min(apart2.sqrt());
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::lattice;

    #[test]
    fn close_packing_is_nearly_reached() {
        // 2 n^2 disks fit a box with the sides of a triangular lattice at diameter 1.
        let n = 10.0;
        let (points, apart) = lattice::<2>(200, [n, n * 3_f64.sqrt()], [true; 2]);
        assert_eq!(points.len(), 200);
        assert!((apart - 1.0).abs() < 1e-12);
        // 4 n^3 balls fit a cube of n cells at a diameter of 1 / sqrt(2) of a cell.
        let (points, apart) = lattice::<3>(500, [5.0; 3], [true; 3]);
        assert_eq!(points.len(), 500);
        assert!((apart - 0.5_f64.sqrt()).abs() < 1e-12);
    }

    /// Their positions were not a number.
    #[test]
    fn few_points_and_one_layer_lie_in_the_box() {
        for count in 1..12 {
            for length in [[8.0, 6.0, 7.0], [80.0, 1.0, 1.0], [80.0, 80.0, 1.0]] {
                for periodic in [[false; 3], [true, false, true]] {
                    let (points, apart) = lattice::<3>(count, length, periodic);
                    let is_in = |point: &[f64; 3]| (0..3).all(|axis| (0.0..=length[axis]).contains(&point[axis]));
                    assert!(
                        points.len() == count && points.iter().all(is_in),
                        "{count} {length:?} {periodic:?}: {points:?}"
                    );
                    assert!(count == 1 || apart.is_finite() && apart > 0.0, "{count} {length:?}: {apart}");
                }
            }
        }
    }

    #[test]
    fn points_are_as_far_apart_as_told() {
        for (count, periodic) in [(37, [true, true]), (50, [false, true]), (800, [false, false])] {
            let length = [8.0, 6.0];
            let (points, apart) = lattice::<2>(count, length, periodic);
            for (number, a) in points.iter().enumerate() {
                for b in &points[..number] {
                    let square = |axis: usize| {
                        let straight = (a[axis] - b[axis]).abs();
                        let shortest = if periodic[axis] { straight.min(length[axis] - straight) } else { straight };
                        shortest * shortest
                    };
                    assert!((square(0) + square(1)).sqrt() >= apart * (1.0 - 1e-9));
                }
                assert!((0..2).all(|axis| (0.0..=length[axis]).contains(&a[axis])));
            }
        }
    }
}
