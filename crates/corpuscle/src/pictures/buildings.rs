//! Obstacles of a flood as buildings.

use corpuscle_model::SolidShape;
use corpuscle_scene::{Flood, Obstacle};
use corpuscle_terrain::Terrain;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Height above the ground of what is only said to be high enough, m.
const HIGH_ENOUGH: f64 = 7.0;
/// Corners of a round one.
const CORNERS: u32 = 48;

/// The obstacles that the scene itself gives corners of, upright from the lowest ground at their walls to a level roof. Those from
/// files are left out.
pub(super) fn shapes(flood: &Flood, terrain: &Terrain) -> Vec<SolidShape> {
    flood.obstacle.iter().filter_map(|obstacle| Some(shape(obstacle, corners(obstacle, terrain)?, terrain))).collect()
}

/// Corners in model coordinates.
fn corners(obstacle: &Obstacle, terrain: &Terrain) -> Option<Vec<[f64; 2]>> {
    let round = |number: u32, [x, y]: [f64; 2], radius: f64| {
        let (sin, cos) = (TAU * f64::from(number) / f64::from(CORNERS)).sin_cos();
        [x + radius * cos, y + radius * sin]
    };
    match (&obstacle.polygon, obstacle.circle) {
        (Some(polygon), _) => Some(polygon.iter().map(|corner| terrain.to_model(*corner)).collect()),
        (None, Some(circle)) => {
            let middle = terrain.to_model(circle.centre);
            Some((0..CORNERS).map(|number| round(number, middle, circle.radius_m)).collect())
        }
        (None, None) => None,
    }
}

fn shape(obstacle: &Obstacle, corners: Vec<[f64; 2]>, terrain: &Terrain) -> SolidShape {
    let ground = || corners.iter().map(|[x, y]| terrain.height(*x, *y));
    let low = ground().fold(f64::INFINITY, f64::min);
    let high = ground().fold(f64::NEG_INFINITY, f64::max) + obstacle.height_m.unwrap_or(HIGH_ENOUGH);
    let along = |axis: usize| corners.iter().map(move |corner| corner[axis]);
    let least = [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
    let most = [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
    SolidShape {
        bounds: [[least[0], least[1], low], [most[0], most[1], high]],
        distance: Arc::new(move |[x, y, z]| from_walls(&corners, [x, y]).max(low - z).max(z - high)),
    }
}

/// Distance from the walls of a polygon, m, negative inside.
fn from_walls(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut inside = false;
    for (number, &[x1, y1]) in corners.iter().enumerate() {
        let [x2, y2] = corners[(number + 1) % corners.len()];
        let (dx, dy) = (x2 - x1, y2 - y1);
        let part = (((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy).max(1e-300)).clamp(0.0, 1.0);
        nearest = nearest.min((x - x1 - part * dx).hypot(y - y1 - part * dy));
        // A ray to the east crosses the walls an odd number of times from inside.
        if (y1 > y) != (y2 > y) && x < x1 + (y - y1) / dy * dx {
            inside = !inside;
        }
    }
    if inside { -nearest } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_the_walls_of_an_angle() {
        let angle = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for (place, distance) in
            [([0.5, 2.0], -0.5), ([2.0, 2.0], 1.0), ([-3.0, 4.0], 10f64.sqrt()), ([3.0, 0.25], -0.25)]
        {
            assert!((from_walls(&angle, place) - distance).abs() < 1e-12, "{place:?}");
        }
    }
}
