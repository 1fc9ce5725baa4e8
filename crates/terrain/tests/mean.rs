//! Mean heights over polygons against means that are known, against the polygon cut into pieces on each of which the
//! ground is one polynomial, and against many samples.

use corpuscle_scene::NoData;
use corpuscle_terrain::{Bounds, Terrain, read_raster};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::path::Path;

type Polygon = Vec<[f64; 2]>;

const BOUNDS: Bounds = Bounds { x_min: -20.0, x_max: 100.0, y_min: 30.0, y_max: 177.0 };
/// Cells of the ground, m.
const CELL: [f64; 2] = [120.0 / 30.0, 147.0 / 37.0];

/// Ground with heights from 200 m to 300 m in no order.
fn rough() -> Terrain {
    Terrain::gridded(BOUNDS, 4.0, |x, y| {
        200.0 + 100.0 * ((12.9898 * x + 78.233 * y).sin() * 43_758.545_3).rem_euclid(1.0)
    })
}

/// Area and centroid.
fn area_and_centroid(polygon: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let [x0, y0] = polygon[0];
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let [ax, ay, bx, by] = [a[0] - x0, a[1] - y0, b[0] - x0, b[1] - y0];
        let cross = ax * by - ay * bx;
        area += 0.5 * cross;
        moment = [moment[0] + cross * (ax + bx) / 6.0, moment[1] + cross * (ay + by) / 6.0];
    }
    (area, [x0 + moment[0] / area, y0 + moment[1] / area])
}

/// The part of a polygon where `sign * (coordinate - line)` is not negative (Sutherland and Hodgman 1974).
fn clipped(polygon: &[[f64; 2]], axis: usize, line: f64, sign: f64) -> Polygon {
    let beyond = |corner: &[f64; 2]| sign * (corner[axis] - line);
    let mut kept = Polygon::new();
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (from, to) = (beyond(a), beyond(b));
        if from >= 0.0 {
            kept.push(*a);
        }
        if (from < 0.0) != (to < 0.0) {
            let share = from / (from - to);
            let mut cut = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
            cut[axis] = line;
            kept.push(cut);
        }
    }
    kept
}

/// Lines along an axis between which the ground is one polynomial: middles of cells and sides of the bounds.
fn lines(axis: usize) -> Vec<f64> {
    let (from, to) = [(BOUNDS.x_min, BOUNDS.x_max), (BOUNDS.y_min, BOUNDS.y_max)][axis];
    let cells = ((to - from) / CELL[axis]).round() as usize;
    let middles = (0..cells).map(|cell| from + CELL[axis] * (cell as f64 + 0.5));
    [f64::NEG_INFINITY, from].into_iter().chain(middles).chain([to, f64::INFINITY]).collect()
}

/// The parts of a polygon between neighbouring lines along an axis.
fn slices(polygon: Polygon, axis: usize) -> Vec<Polygon> {
    let slice = |pair: &[f64]| {
        let mut part = polygon.clone();
        for (line, sign) in [(pair[0], 1.0), (pair[1], -1.0)] {
            if line.is_finite() && part.len() > 2 {
                part = clipped(&part, axis, line, sign);
            }
        }
        part
    };
    lines(axis).windows(2).map(slice).filter(|part| part.len() > 2).collect()
}

/// Integral over a triangle with one corner at `a`: Gauss-Legendre rules of five points in both directions of a square
/// folded into the triangle, exact up to degree 8.
fn over_triangle(terrain: &Terrain, [a, b, c]: [[f64; 2]; 3]) -> f64 {
    let root = |sign: f64| (5.0 + sign * 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let weight = |sign: f64| (322.0 + sign * 13.0 * 70.0_f64.sqrt()) / 900.0;
    let (near, far) = ((root(-1.0), weight(1.0)), (root(1.0), weight(-1.0)));
    let points = [(-far.0, far.1), (-near.0, near.1), (0.0, 128.0 / 225.0), near, far];
    let points = points.map(|(position, weight)| (0.5 + 0.5 * position, 0.5 * weight));
    let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let mut sum = 0.0;
    for ((s, ws), (t, wt)) in points.into_iter().flat_map(|p| points.map(|q| (p, q))) {
        let [x, y] = [0, 1].map(|k| a[k] + s * (b[k] + t * (c[k] - b[k]) - a[k]));
        sum += ws * wt * s * terrain.height(x, y);
    }
    twice_area * sum
}

/// The mean by cutting the polygon into pieces.
fn mean_by_pieces(terrain: &Terrain, polygon: &[[f64; 2]]) -> f64 {
    let pieces = slices(polygon.to_vec(), 0).into_iter().flat_map(|slice| slices(slice, 1));
    let (mut sum, mut area) = (0.0, 0.0);
    for piece in pieces {
        for k in 2..piece.len() {
            sum += over_triangle(terrain, [piece[0], piece[k - 1], piece[k]]);
        }
        area += area_and_centroid(&piece).0;
    }
    sum / area
}

/// The mean of samples at the middles of squares whose middles lie in the polygon, about `count` of them.
fn mean_of_samples(terrain: &Terrain, polygon: &[[f64; 2]], count: f64) -> f64 {
    let step = (area_and_centroid(polygon).0 / count).sqrt();
    let range = |axis: usize| {
        let along = polygon.iter().map(|corner| corner[axis]);
        let (low, high) = (along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max));
        (0..((high - low) / step).ceil() as usize).map(move |k| low + step * (k as f64 + 0.5))
    };
    let left_of = |a: &[f64; 2], b: &[f64; 2], x: f64, y: f64| (b[0] - a[0]) * (y - a[1]) > (b[1] - a[1]) * (x - a[0]);
    let holds = |x, y| polygon.iter().zip(polygon.iter().cycle().skip(1)).all(|(a, b)| left_of(a, b, x, y));
    let inside = range(0).flat_map(|x| range(1).map(move |y| (x, y))).filter(|(x, y)| holds(*x, *y));
    let (sum, hits) = inside.fold((0.0, 0.0), |(sum, hits), (x, y)| (sum + terrain.height(x, y), hits + 1.0));
    sum / hits
}

/// Convex polygons of `size` cells across with corners on an ellipse, their middle anywhere in a rectangle.
fn polygons(
    size: std::ops::Range<f64>,
    x: std::ops::Range<f64>,
    y: std::ops::Range<f64>,
) -> impl Strategy<Value = Polygon> {
    let corners = prop::collection::vec(0.2..1.0_f64, 3..9);
    (corners, size.start.ln()..size.end.ln(), 0.3..1.0_f64, 0.0..TAU, x, y).prop_map(
        |(gaps, size, flat, turn, x, y)| {
            let radius = 0.5 * size.exp() * CELL[0];
            let round: f64 = gaps.iter().sum();
            let angles = gaps.iter().scan(0.0, |angle, gap| {
                *angle += gap / round * TAU;
                Some(*angle)
            });
            let on_ellipse = |angle: f64| [radius * angle.cos(), radius * flat * angle.sin()];
            let turned = |[p, q]: [f64; 2]| [x + p * turn.cos() - q * turn.sin(), y + p * turn.sin() + q * turn.cos()];
            angles.map(on_ellipse).map(turned).collect()
        },
    )
}

/// Polygons all over the ground and round it.
fn anywhere() -> impl Strategy<Value = Polygon> {
    polygons(0.2..20.0, -40.0..120.0, 10.0..197.0)
}

fn assert_near(found: f64, expected: f64, relative: f64) -> Result<(), TestCaseError> {
    prop_assert!((found - expected).abs() <= relative * expected.abs(), "{found} {expected}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// All over the ground and partly or wholly beyond its bounds.
    #[test]
    fn is_the_mean_of_all_pieces(polygon in anywhere()) {
        let terrain = rough();
        assert_near(terrain.mean_over(&polygon), mean_by_pieces(&terrain, &polygon), 1e-12)?;
    }

    #[test]
    fn of_a_plane_is_the_height_at_the_centroid(polygon in polygons(0.2..10.0, 5.0..75.0, 55.0..150.0)) {
        let plane = |x: f64, y: f64| 3.0 + 0.25 * x - 0.5 * y;
        let (_, [x, y]) = area_and_centroid(&polygon);
        let gridded = Terrain::gridded(BOUNDS, 4.0, plane);
        let exact = Terrain::analytic(BOUNDS, 4.0, move |x, y| (plane(x, y), [0.25, -0.5]));
        for terrain in [gridded, exact] {
            let mean = terrain.mean_over(&polygon);
            prop_assert!((mean - plane(x, y)).abs() < 1e-12, "{mean} {}", plane(x, y));
        }
    }

    /// Cut along a line between two corners.
    #[test]
    fn adds_up_over_two_halves(polygon in anywhere().prop_filter("a triangle", |polygon| polygon.len() > 3), at in 0..100_usize) {
        let terrain = rough();
        let second = 2 + at % (polygon.len() - 3);
        let halves = [polygon[..=second].to_vec(), [&polygon[second..], &polygon[..1]].concat()];
        let [one, other] = halves.each_ref().map(|half| area_and_centroid(half).0);
        let [first, last] = halves.each_ref().map(|half| terrain.mean_over(half));
        assert_near(terrain.mean_over(&polygon), (one * first + other * last) / (one + other), 1e-12)?;
    }

    #[test]
    fn is_the_same_whichever_corner_comes_first_and_either_way_round(mut polygon in anywhere(), at in 0..100_usize) {
        let terrain = rough();
        let mean = terrain.mean_over(&polygon);
        let count = polygon.len();
        polygon.rotate_left(at % count);
        assert_near(terrain.mean_over(&polygon), mean, 1e-13)?;
        polygon.reverse();
        assert_near(terrain.mean_over(&polygon), mean, 1e-13)?;
    }

    #[test]
    fn lies_in_the_range_as_do_all_heights(polygon in anywhere(), s in 0.0..1.0_f64, t in 0.0..1.0_f64) {
        let terrain = rough();
        let (mean, lowest, highest) = terrain.mean_and_range_over(&polygon);
        prop_assert_eq!(mean, terrain.mean_over(&polygon));
        prop_assert!(lowest <= mean && mean <= highest);
        let [a, b, c] = [polygon[0], polygon[1], polygon[2]];
        let [x, y] = [0, 1].map(|k| a[k] + s * (b[k] + t * (c[k] - b[k]) - a[k]));
        let height = terrain.height(x, y);
        prop_assert!((lowest - 1e-9..=highest + 1e-9).contains(&height), "{lowest} {height} {highest}");
    }

    /// Any numbers at all, convex or not, are answered with numbers.
    #[test]
    fn any_corners_have_a_mean(polygon in prop::collection::vec([any_coordinate(), any_coordinate()], 0..7)) {
        let terrain = rough();
        let mean = terrain.mean_over(&polygon);
        prop_assert!(mean.is_finite());
        let (mean, lowest, highest) = terrain.mean_and_range_over(&polygon);
        prop_assert!(lowest <= mean && mean <= highest && lowest.is_finite() && highest.is_finite());
        let exact = Terrain::analytic(BOUNDS, 4.0, |x, y| (x * y, [y, x]));
        prop_assert!(exact.mean_over(&polygon).is_finite());
        exact.mean_and_range_over(&polygon);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn is_near_the_mean_of_many_samples(polygon in anywhere()) {
        let terrain = rough();
        let samples = mean_of_samples(&terrain, &polygon, 1e5);
        let mean = terrain.mean_over(&polygon);
        prop_assert!((mean - samples).abs() < 0.1, "{mean} {samples}");
    }
}

fn any_coordinate() -> impl Strategy<Value = f64> {
    // Also positions on the lines between patches and on the sides of the bounds.
    prop_oneof![any::<f64>(), -30.0..110.0_f64, (-10..40_i32).prop_map(|cell| f64::from(cell) * 2.0 + 30.0)]
}

/// Cells of a scheme whose sides lie on the lines between patches: rectangles from middle to middle of the ground's
/// cells.
#[test]
fn sides_on_the_lines_between_patches_are_no_trouble() {
    let terrain = rough();
    let [xs, ys] = [lines(0), lines(1)];
    for (west, east) in [(1, 2), (2, 3), (5, 17), (30, 32)] {
        for (south, north) in [(1, 2), (2, 12), (37, 39)] {
            let (x, y) = ([xs[west], xs[east]], [ys[south], ys[north]]);
            let rectangle = vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
            let (found, expected) = (terrain.mean_over(&rectangle), mean_by_pieces(&terrain, &rectangle));
            assert!((found - expected).abs() < 1e-10, "{found} {expected}");
        }
    }
}

/// More columns than one block of running sums.
#[test]
fn long_runs_of_whole_patches_add_up() {
    let bounds = Bounds { x_min: 0.0, x_max: 1000.0, y_min: 0.0, y_max: 20.0 };
    let terrain = Terrain::gridded(bounds, 1.0, |x, y| 2000.0 + (0.37 * x * x + 9.1 * y).sin() * 10.0);
    let rectangle = |west: f64, east: f64| vec![[west, 3.2], [east, 4.4], [east, 15.8], [west, 17.1]];
    let strip = |west: f64, east: f64| vec![[west, 3.2], [east, 3.2], [east, 15.8], [west, 15.8]];
    assert!(terrain.mean_over(&rectangle(2.0, 990.0)).is_finite());
    // Strips too narrow for runs, and one over them all.
    let parts = (0..240).map(|k| terrain.mean_over(&strip(10.2 + 4.0 * f64::from(k), 14.2 + 4.0 * f64::from(k))));
    let (found, expected) = (terrain.mean_over(&strip(10.2, 970.2)), parts.sum::<f64>() / 240.0);
    assert!((found - expected).abs() < 1e-10, "{found} {expected}");
}

#[test]
fn small_and_thin_polygons_have_the_mean_of_a_point_or_a_line() {
    let terrain = rough();
    let [x, y] = [31.7, 88.1];
    for size in [1e-12, 1e-9, 3e-6, 1e-4] {
        let mean = terrain.mean_over(&[[x, y], [x + size, y], [x + size, y + size], [x, y + size]]);
        let middle = terrain.height(x + 0.5 * size, y + 0.5 * size);
        assert!((mean - middle).abs() < 1e-9 + 1e2 * size * size, "{size}: {mean} {middle}");
    }
    let point = terrain.height(x, y);
    assert_eq!(terrain.mean_over(&[[x, y]]), point);
    assert_eq!(terrain.mean_over(&[[x, y]; 4]), point);
    assert_eq!(terrain.mean_over(&[[x - 1.0, y], [x + 1.0, y]]), point);
    assert_eq!(terrain.mean_over(&[]), terrain.height(40.0, 103.5));
    let line = |width: f64| terrain.mean_over(&[[x, y], [x + 2.0, y], [x + 2.0, y + width], [x, y + width]]);
    assert!((line(1e-10) - line(1e-3)).abs() < 0.1, "{} {}", line(1e-10), line(1e-3));
}

#[test]
fn threads_that_need_the_same_sums_at_once_get_the_same_means() {
    use rayon::prelude::*;
    let polygon = |k: i32| {
        let x = f64::from(k % 20);
        vec![[x, 40.0], [x + 60.0, 50.0], [x + 50.0, 140.0], [x + 3.0, 150.0]]
    };
    let alone: Vec<f64> = (0..200).map(|k| rough().mean_over(&polygon(k))).collect();
    let terrain = rough();
    let together: Vec<f64> = (0..200).into_par_iter().map(|k| terrain.mean_over(&polygon(k))).collect();
    assert_eq!(alone, together);
}

#[test]
fn polynomials_up_to_degree_8_are_exact_on_ground_from_a_formula() {
    let terrain = Terrain::analytic(BOUNDS, 4.0, |x, y| ((0.1 * x).powi(5) * (0.01 * y).powi(3), [0.0, 0.0]));
    let mean = terrain.mean_over(&[[10.0, 100.0], [20.0, 100.0], [20.0, 150.0], [10.0, 150.0]]);
    let (over_x, over_y) = ((2.0_f64.powi(6) - 1.0) / 6.0, (1.5_f64.powi(4) - 1.0) / (4.0 * 0.5));
    assert!((mean - over_x * over_y).abs() < 1e-11, "{mean} {}", over_x * over_y);
}

#[test]
fn data_is_where_the_file_has_some() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hole.asc");
    let text = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 50\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 -9999 6\n";
    std::fs::write(&path, text).unwrap();
    let terrain = Terrain::from_raster(read_raster(&path).unwrap(), Path::new("hole"), NoData::default()).unwrap();
    for (position, has_data) in [
        ([105.0, 55.0], true),
        ([115.0, 55.0], false),
        ([119.9, 59.9], false),
        ([119.9, 60.1], true),
        ([109.9, 55.0], true),
        ([100.0, 50.0], true),
        ([130.0, 70.0], true),
        ([130.1, 65.0], false),
        ([99.9, 65.0], false),
        ([105.0, 49.9], false),
        ([105.0, 70.1], false),
        ([f64::NAN, 65.0], false),
        ([105.0, f64::INFINITY], false),
    ] {
        assert_eq!(terrain.has_data_at(position[0], position[1]), has_data, "{position:?}");
    }
}
