//! Heights and slopes of many positions at once are those of the positions one by one.

use corpuscle_terrain::{Bounds, Terrain};

const BOUNDS: Bounds = Bounds { x_min: -20.0, x_max: 43.0, y_min: 5.0, y_max: 30.0 };

fn assert_alike(terrain: &Terrain) {
    // Inside, on the sides, outside, and nowhere.
    let mut x: [f64; 32] = std::array::from_fn(|k| -30.0 + 2.7 * k as f64);
    let mut y: [f64; 32] = std::array::from_fn(|k| 1.0 + (11.0 * k as f64) % 37.0);
    (x[3], y[5], x[7], y[9]) = (f64::NAN, f64::NAN, f64::INFINITY, f64::NEG_INFINITY);
    (x[11], y[12]) = (BOUNDS.x_max, BOUNDS.y_min);
    let [heights, slopes_x, slopes_y] = terrain.heights_and_slopes(&x, &y);
    for k in 0..32 {
        let (height, slope) = terrain.height_and_slope(x[k], y[k]);
        let bits = |height: f64, slope: [f64; 2]| [height, slope[0], slope[1]].map(f64::to_bits);
        assert_eq!(bits(height, slope), bits(heights[k], [slopes_x[k], slopes_y[k]]), "at {} {}", x[k], y[k]);
    }
}

#[test]
fn on_gridded_ground() {
    assert_alike(&Terrain::gridded(BOUNDS, 2.0, |x, y| 3.0 * (0.9 * x).sin() + (0.2 * x * y).cos()));
}

#[test]
fn on_exact_ground() {
    assert_alike(&Terrain::analytic(BOUNDS, 2.0, |x, y| (x * y, [y, x])));
}
