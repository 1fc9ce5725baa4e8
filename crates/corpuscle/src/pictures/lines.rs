//! Walls of no thickness in pictures: thin plates.

use corpuscle_flood::LineWall;

/// Corners of triangles, three by three: position, m, and unit vector outwards.
pub(super) type Corners = Vec<([f64; 3], [f64; 3])>;

/// Plates of a thickness, m, along walls; `heights` exaggerates heights.
pub(super) fn plates(walls: &[LineWall], thickness: f64, heights: f64) -> Corners {
    walls.iter().flat_map(|wall| plate(wall, thickness, heights)).collect()
}

/// The sides, the ends and the top of a plate, longer by its thickness so that plates at an angle join.
fn plate(wall: &LineWall, thickness: f64, heights: f64) -> Corners {
    let [a, b] = wall.ends;
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if !(length > 0.0 && length.is_finite()) {
        return Corners::new();
    }
    let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    let left = [-along[1], along[0]];
    let half = 0.5 * thickness;
    let base = heights * wall.base;
    // By end, then by side: right and left.
    let foot = |end: usize, side: usize| {
        let [onward, aside] = [[-half, half][end], [-half, half][side]];
        [0, 1].map(|axis| wall.ends[end][axis] + onward * along[axis] + aside * left[axis])
    };
    let at = |end: usize, side: usize, z: f64| {
        let [x, y] = foot(end, side);
        [x, y, z]
    };
    let low = |end, side| at(end, side, base);
    let high = |end: usize, side| at(end, side, (heights * wall.crest[end]).max(base));
    let mut corners = Corners::new();
    // Anticlockwise as seen from outside.
    let mut quad = |quad: [[f64; 3]; 4], out: [f64; 3]| {
        corners.extend([0, 1, 2, 0, 2, 3].map(|corner: usize| (quad[corner], out)));
    };
    quad([low(0, 0), low(1, 0), high(1, 0), high(0, 0)], [-left[0], -left[1], 0.0]);
    quad([low(1, 1), low(0, 1), high(0, 1), high(1, 1)], [left[0], left[1], 0.0]);
    quad([low(1, 0), low(1, 1), high(1, 1), high(1, 0)], [along[0], along[1], 0.0]);
    quad([low(0, 1), low(0, 0), high(0, 0), high(0, 1)], [-along[0], -along[1], 0.0]);
    quad([high(0, 0), high(1, 0), high(1, 1), high(0, 1)], [0.0, 0.0, 1.0]);
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every triangle is anticlockwise round its vector outwards, and all but the bottom is closed.
    #[test]
    fn plates_are_closed_and_face_outwards() {
        let wall = LineWall { ends: [[1.0, 2.0], [4.0, 6.0]], base: 0.5, crest: [3.0, 3.0] };
        let corners = plates(&[wall], 0.2, 2.0);
        assert_eq!(corners.len(), 30);
        let mut flux = [0.0; 3];
        for triangle in corners.chunks_exact(3) {
            let [p, q, r] = [triangle[0].0, triangle[1].0, triangle[2].0];
            let [u, v] = [q, r].map(|corner| [0, 1, 2].map(|k: usize| corner[k] - p[k]));
            let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            let out = triangle[0].1;
            assert!((0..3).map(|k| cross[k] * out[k]).sum::<f64>() > 0.0, "{triangle:?}");
            (0..3).for_each(|k| flux[k] += 0.5 * cross[k]);
        }
        // Only the bottom is missing: 5.2 m by 0.2 m.
        assert!(flux[0].abs() < 1e-12 && flux[1].abs() < 1e-12 && (flux[2] - 5.2 * 0.2).abs() < 1e-12, "{flux:?}");
        assert!(corners.iter().all(|(position, _)| (1.0..=6.0).contains(&position[2])));
        let point = LineWall { ends: [[1.0; 2]; 2], ..wall };
        assert!(plates(&[point], 0.2, 1.0).is_empty());
    }
}
