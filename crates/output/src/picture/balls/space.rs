//! Balls in three dimensions: shaded spheres in a box drawn in perspective.

use super::paint::{Seen, Spheres};
use super::{Balls, MOST, Side};
use crate::picture::colour::mix;
use crate::picture::png::data_url;
use crate::picture::svg::{Figure, Svg};

/// Azimuth of the camera to the right of the front, and its elevation, radians.
const TURNED: f64 = 0.55;
const RAISED: f64 = 0.33;

/// Distance of the eye from the middle of the box, in diagonals of the box.
const DISTANCE: f64 = 2.2;

/// How much of the far end's colours is lost in the haze.
const HAZE: f64 = 0.55;

/// Pixels of the painted picture for a CSS pixel.
const FINENESS: f64 = 1.6;

/// Space round the box, CSS pixels.
const MARGIN: f64 = 10.0;

/// How the eye sees the box.
struct Eye {
    middle: [f64; 3],
    distance: f64,
    diagonal: f64,
    /// CSS pixels for a unit of length at the middle of the box.
    scale: f64,
    /// Corners of the picture in those units, y downwards.
    corner: [f64; 2],
    size: [f64; 2],
}

/// A position as the eye sees it: point of the page in CSS pixels, distance from the eye, and how much larger than at the middle.
struct Sight {
    point: [f64; 2],
    distance: f64,
    nearer: f64,
}

impl Eye {
    fn on(view: [[f64; 3]; 2]) -> Self {
        let [from, to] = view;
        let side: [f64; 3] = std::array::from_fn(|k| to[k] - from[k]);
        let diagonal = side.iter().map(|length| length * length).sum::<f64>().sqrt();
        let middle = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
        let mut eye =
            Self { middle, distance: DISTANCE * diagonal, diagonal, scale: 1.0, corner: [0.0; 2], size: [0.0; 2] };
        let points = corners(from, to).map(|corner| eye.see(corner).point);
        let low = [0, 1].map(|k| points.iter().map(|point| point[k]).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|k| points.iter().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max));
        eye.scale = (MOST[0] / (high[0] - low[0])).min(MOST[1] / (high[1] - low[1]));
        eye.corner = low.map(|along| along * eye.scale - MARGIN);
        eye.size = [0, 1].map(|k| (high[k] - low[k]) * eye.scale + 2.0 * MARGIN);
        eye
    }

    fn see(&self, position: [f64; 3]) -> Sight {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| position[k] - self.middle[k]);
        let ((sin_t, cos_t), (sin_r, cos_r)) = (TURNED.sin_cos(), RAISED.sin_cos());
        let (right, away) = (x * cos_t + y * sin_t, y * cos_t - x * sin_t);
        let (up, away) = (z * cos_r + away * sin_r, away * cos_r - z * sin_r);
        let distance = self.distance + away;
        let nearer = self.distance / distance;
        let point = [right * nearer * self.scale - self.corner[0], -up * nearer * self.scale - self.corner[1]];
        Sight { point, distance, nearer }
    }
}

/// The eight corners of a box; the number's bits choose the ends along x, y and z.
fn corners(from: [f64; 3], to: [f64; 3]) -> [[f64; 3]; 8] {
    std::array::from_fn(|number| {
        std::array::from_fn(|axis| if number >> axis & 1 == 1 { to[axis] } else { from[axis] })
    })
}

/// Width and height of the picture.
pub(super) fn size(balls: &Balls) -> [f64; 2] {
    Eye::on(balls.view).size
}

/// The picture.
pub(super) fn picture(balls: &Balls, shown_at: f64) -> Result<Figure, String> {
    let eye = Eye::on(balls.view);
    let mut svg = Svg::default();
    svg.rectangle([0.0, 0.0], eye.size, "paper");
    draw_edges(&mut svg, balls, &eye, false);
    let url = data_url(&paint(balls, &eye, FINENESS * shown_at)?);
    svg.image([0.0, 0.0], eye.size, &url, 1.0);
    draw_faces(&mut svg, balls, &eye);
    draw_edges(&mut svg, balls, &eye, true);
    if !balls.trajectory.is_empty() {
        for class in ["trajectory-under", "trajectory"] {
            svg.path(balls.trajectory.iter().map(|point| eye.see(*point).point), false, class);
        }
    }
    Ok(svg.finish(eye.size, "Balls in their box"))
}

fn paint(balls: &Balls, eye: &Eye, fineness: f64) -> Result<Vec<u8>, String> {
    let mut canvas = Spheres::new(eye.size.map(|length| (length * fineness).ceil() as usize));
    let near = eye.distance - 0.5 * eye.diagonal;
    for disc in &balls.discs {
        let sight = eye.see(disc.position);
        let haze = HAZE * ((sight.distance - near) / eye.diagonal).clamp(0.0, 1.0);
        canvas.sphere(&Seen {
            point: sight.point.map(|length| length * fineness),
            distance: sight.distance * eye.scale * fineness,
            radius: disc.radius * sight.nearer * eye.scale * fineness,
            colour: mix(disc.colour, [0xfc, 0xfd, 0xfe], haze),
        });
    }
    canvas.png()
}

/// Edges of the box: those that meet in the farthest corner behind the balls, the others before them.
fn draw_edges(svg: &mut Svg, balls: &Balls, eye: &Eye, front: bool) {
    let ends = corners(balls.from, balls.to);
    let sights = ends.map(|corner| eye.see(corner));
    let farthest = (0..8).max_by(|a, b| sights[*a].distance.total_cmp(&sights[*b].distance)).unwrap_or(0);
    for corner in 0..8usize {
        for axis in (0..3).filter(|axis| corner >> axis & 1 == 0) {
            let other = corner | 1 << axis;
            let behind = corner == farthest || other == farthest;
            if behind == front {
                continue;
            }
            // An edge lies between two sides; it is one of a wall if either is.
            let open = (0..3).filter(|k| *k != axis).all(|k| balls.sides[k][corner >> k & 1] == Side::Open);
            let class = match (open, front) {
                (true, _) => "wall-open",
                (false, true) => "edge edge-front",
                (false, false) => "edge",
            };
            svg.line(sights[corner].point, sights[other].point, class);
        }
    }
}

/// Pistons and a partition, as faces that one sees through.
fn draw_faces(svg: &mut Svg, balls: &Balls, eye: &Eye) {
    let face = |svg: &mut Svg, axis: usize, at: f64, from: [f64; 3], to: [f64; 3]| {
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        let corner = |ends: [[f64; 3]; 2]| {
            let mut position = [at; 3];
            (position[one], position[other]) = (ends[0][one], ends[1][other]);
            eye.see(position).point
        };
        svg.path([corner([from, from]), corner([to, from]), corner([to, to]), corner([from, to])], true, "face");
    };
    for axis in 0..3 {
        for (end, corner) in [balls.from, balls.to].into_iter().enumerate() {
            if balls.sides[axis][end] == Side::Piston {
                face(svg, axis, corner[axis], balls.from, balls.to);
            }
        }
    }
    let Some(partition) = &balls.partition else { return };
    face(svg, partition.axis, partition.at, balls.from, balls.to);
    let Some(hole) = &partition.hole else { return };
    let ends: Vec<[f64; 3]> = hole.iter().map(|end| spread(end, partition.axis, partition.at)).collect();
    face(svg, partition.axis, partition.at, ends[0], ends[1]);
}

/// A position on a face from its two coordinates there.
fn spread(coordinates: &[f64], axis: usize, at: f64) -> [f64; 3] {
    let mut rest = coordinates.iter().copied();
    std::array::from_fn(|k| if k == axis { at } else { rest.next().unwrap_or(0.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_fills_the_picture_and_near_things_are_larger() {
        let (from, to) = ([0.0; 3], [2e-9, 1e-9, 3e-9]);
        let eye = Eye::on([from, to]);
        for corner in corners(from, to) {
            let point = eye.see(corner).point;
            let inside = (0..2).all(|k| point[k] >= MARGIN - 1e-6 && point[k] <= eye.size[k] - MARGIN + 1e-6);
            assert!(inside, "{point:?} in {:?}", eye.size);
        }
        let front = eye.see([1e-9, 0.0, 1.5e-9]);
        let back = eye.see([1e-9, 1e-9, 1.5e-9]);
        assert!(front.nearer > 1.0 && back.nearer < 1.0 && front.distance < back.distance);
    }
}
