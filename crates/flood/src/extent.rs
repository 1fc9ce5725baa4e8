//! The extent of the terrain: what lies within it.

use crate::error::setup;
use corpuscle_model::ModelError;
use corpuscle_terrain::{Bounds, Terrain};

/// Refuses positions in the terrain's own coordinates that lie outside it.
pub(crate) fn check_inside(what: &str, positions: &[[f64; 2]], terrain: &Terrain) -> Result<(), ModelError> {
    let is_outside = |position: &&[f64; 2]| {
        let [x, y] = terrain.to_model(**position);
        !terrain.bounds().contains(x, y)
    };
    match positions.iter().find(is_outside) {
        None => Ok(()),
        Some(position) => Err(setup(format!(
            "{what} has the point {position:?}, which lies outside the terrain: that spans {}",
            span(terrain)
        ))),
    }
}

/// The terrain's extent in its own coordinates, for messages.
pub(crate) fn span(terrain: &Terrain) -> String {
    let Bounds { x_min, x_max, y_min, y_max } = terrain.bounds();
    let ([west, south], [east, north]) = (terrain.to_own([x_min, y_min]), terrain.to_own([x_max, y_max]));
    format!("x from {west} to {east} and y from {south} to {north}")
}

/// Whether all of some corners in model coordinates lie beyond one side of the bounds by more than `margin` m.
pub(crate) fn is_beside(corners: &[[f64; 2]], bounds: Bounds, margin: f64) -> bool {
    let beyond = |axis: usize, low: f64, high: f64| {
        corners.iter().all(|corner| corner[axis] < low - margin)
            || corners.iter().all(|corner| corner[axis] > high + margin)
    };
    beyond(0, bounds.x_min, bounds.x_max) || beyond(1, bounds.y_min, bounds.y_max)
}
