//! Polygons cut off at the border of a picture.

/// The part of a polygon inside the unit square (Sutherland & Hodgman, Commun. ACM 17, 1974, 32); empty where it is all outside.
pub(crate) fn inside_unit_square(polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut corners = polygon.to_vec();
    for (axis, border, sign) in [(0, 0.0, 1.0), (0, 1.0, -1.0), (1, 0.0, 1.0), (1, 1.0, -1.0)] {
        let inside = |corner: [f64; 2]| sign * (corner[axis] - border);
        let mut kept = Vec::with_capacity(corners.len() + 4);
        for (number, &corner) in corners.iter().enumerate() {
            let before = corners[(number + corners.len() - 1) % corners.len()];
            let [from, to] = [inside(before), inside(corner)];
            if (from >= 0.0) != (to >= 0.0) {
                let part = from / (from - to);
                kept.push([0, 1].map(|k| before[k] + part * (corner[k] - before[k])));
            }
            if to >= 0.0 {
                kept.push(corner);
            }
        }
        corners = kept;
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[[f64; 2]]) -> f64 {
        let next = corners.iter().cycle().skip(1);
        0.5 * corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>().abs()
    }

    #[test]
    fn what_is_inside_stays_and_what_is_outside_goes() {
        let triangle = [[0.2, 0.2], [0.8, 0.2], [0.5, 0.9]];
        assert_eq!(inside_unit_square(&triangle), triangle);
        assert!(inside_unit_square(&[[1.2, 0.2], [1.8, 0.2], [1.5, 0.9]]).is_empty());
    }

    #[test]
    fn what_crosses_the_border_is_cut_there() {
        let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        assert!((area(&inside_unit_square(&square)) - 0.25).abs() < 1e-12);
        let round_all = [[-1.0, -1.0], [3.0, -1.0], [3.0, 3.0], [-1.0, 3.0]];
        assert!((area(&inside_unit_square(&round_all)) - 1.0).abs() < 1e-12);
    }
}
