//! Outlines and lines without what lies far from the terrain, so that far corners take no memory and no time.

use corpuscle_terrain::{Bounds, Terrain};

/// The rectangle beyond which no water comes near a wall: the terrain, widened by its longer side and by `reach` m.
pub(crate) fn surroundings(terrain: &Terrain, reach: f64) -> Bounds {
    let Bounds { x_min, x_max, y_min, y_max } = terrain.bounds();
    let by = (x_max - x_min).max(y_max - y_min) + reach;
    Bounds { x_min: x_min - by, x_max: x_max + by, y_min: y_min - by, y_max: y_max + by }
}

/// The sides of a rectangle: axis, coordinate, and the sign of what is inside.
fn limits(bounds: Bounds) -> [(usize, f64, f64); 4] {
    [(0, bounds.x_min, 1.0), (0, bounds.x_max, -1.0), (1, bounds.y_min, 1.0), (1, bounds.y_max, -1.0)]
}

/// The part of a ring inside a rectangle (Sutherland and Hodgman 1974); a ring inside stays as it is.
pub(crate) fn ring_within(mut ring: Vec<[f64; 2]>, bounds: Bounds) -> Vec<[f64; 2]> {
    for (axis, limit, sign) in limits(bounds) {
        let is_inside = |corner: [f64; 2]| sign * (corner[axis] - limit) >= 0.0;
        if ring.iter().all(|corner| is_inside(*corner)) {
            continue;
        }
        let before = std::mem::take(&mut ring);
        for (k, &corner) in before.iter().enumerate() {
            let next = before[(k + 1) % before.len()];
            if is_inside(corner) {
                ring.push(corner);
            }
            if is_inside(corner) != is_inside(next) {
                ring.push(crossing([corner, next], axis, limit));
            }
        }
    }
    ring
}

/// The part of a side inside a rectangle, if any.
pub(crate) fn side_within([mut a, mut b]: [[f64; 2]; 2], bounds: Bounds) -> Option<[[f64; 2]; 2]> {
    for (axis, limit, sign) in limits(bounds) {
        let is_inside = |corner: [f64; 2]| sign * (corner[axis] - limit) >= 0.0;
        match [a, b].map(is_inside) {
            [true, true] => {}
            [true, false] => b = crossing([a, b], axis, limit),
            [false, true] => a = crossing([a, b], axis, limit),
            [false, false] => return None,
        }
    }
    Some([a, b])
}

/// Where a side crosses a line across an axis. Halves and shares do not overflow, as the side's length may.
fn crossing([a, b]: [[f64; 2]; 2], axis: usize, limit: f64) -> [f64; 2] {
    let part = (0.5 * limit - 0.5 * a[axis]) / (0.5 * b[axis] - 0.5 * a[axis]);
    let mut at = [0, 1].map(|along| (1.0 - part) * a[along] + part * b[along]);
    at[axis] = limit;
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 };

    #[test]
    fn what_is_inside_stays_as_it_is() {
        let ring = vec![[1.0, 1.0], [10.0, 1.0], [3.0, 7.0]];
        assert_eq!(ring_within(ring.clone(), BOUNDS), ring);
        assert_eq!(side_within([ring[0], ring[1]], BOUNDS), Some([ring[0], ring[1]]));
    }

    #[test]
    fn what_is_far_ends_at_the_rectangle() {
        for far in [20.0, 1e15, 1e300, f64::MAX] {
            let ring = ring_within(vec![[5.0, 2.0], [far, 2.0], [far, 8.0], [5.0, 8.0]], BOUNDS);
            assert_eq!(ring, [[5.0, 2.0], [10.0, 2.0], [10.0, 8.0], [5.0, 8.0]]);
            let side = side_within([[-far, 5.0], [far, 5.0]], BOUNDS).unwrap();
            assert_eq!(side, [[0.0, 5.0], [10.0, 5.0]]);
            assert_eq!(side_within([[-far, 11.0], [far, 11.0]], BOUNDS), None);
        }
        assert!(ring_within(vec![[11.0, 1.0], [12.0, 1.0], [11.0, 2.0]], BOUNDS).is_empty());
    }
}
