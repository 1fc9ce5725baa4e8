//! Polygons in the plane.

use corpuscle_terrain::Bounds;

/// The rectangle round a polygon.
pub(crate) fn rectangle_round(polygon: &[[f64; 2]]) -> Bounds {
    let start = Bounds { x_min: f64::INFINITY, x_max: -f64::INFINITY, y_min: f64::INFINITY, y_max: -f64::INFINITY };
    polygon.iter().fold(start, |b, &[x, y]| Bounds {
        x_min: b.x_min.min(x),
        x_max: b.x_max.max(x),
        y_min: b.y_min.min(y),
        y_max: b.y_max.max(y),
    })
}

/// Whether a polygon holds a position: an odd number of sides crosses the ray eastwards.
pub(crate) fn is_inside(polygon: &[[f64; 2]], x: f64, y: f64) -> bool {
    let mut inside = false;
    let mut before = polygon[polygon.len() - 1];
    for &corner in polygon {
        let [[x0, y0], [x1, y1]] = [before, corner];
        if (y0 > y) != (y1 > y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0) {
            inside = !inside;
        }
        before = corner;
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_holds_its_inside_and_not_its_bay() {
        let polygon = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 4.0], [0.0, 10.0]];
        assert!(is_inside(&polygon, 2.0, 2.0));
        assert!(is_inside(&polygon, 9.0, 8.0));
        assert!(!is_inside(&polygon, 5.0, 6.0));
        assert!(!is_inside(&polygon, -1.0, 2.0));
    }
}
