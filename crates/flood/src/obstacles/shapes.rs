//! Obstacles as solids, to be drawn.

use super::Outline;
use super::open::polygons;
use corpuscle_model::{ModelError, SolidShape};
use corpuscle_scene::Flood as Settings;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// The obstacles of a scene, those from files included, upright from the lowest ground at their walls to a level roof: `height_m` above
/// the highest ground there, `high_enough` m where a scene says no height. Relative paths are taken from `folder`.
///
/// # Errors
/// [`ModelError::Setup`] for a file that cannot be read or holds no polygon.
pub fn obstacle_shapes(
    flood: &Settings,
    terrain: &Terrain,
    folder: &Path,
    high_enough: f64,
) -> Result<Vec<SolidShape>, ModelError> {
    let mut shapes = Vec::new();
    for (number, obstacle) in flood.obstacle.iter().enumerate() {
        let outlines = polygons(obstacle, terrain, folder)?.into_iter();
        let outlines = outlines.map(|rings| Outline { obstacle: number, rings });
        let height = obstacle.height_m.unwrap_or(high_enough);
        shapes.extend(outlines.filter_map(|outline| upright(outline, terrain, height)));
    }
    Ok(shapes)
}

/// An outline on its ground; none without corners.
fn upright(outline: Outline, terrain: &Terrain, height: f64) -> Option<SolidShape> {
    let ground = || outline.rings.iter().flatten().map(|[x, y]| terrain.height(*x, *y));
    let low = ground().min_by(f64::total_cmp)?;
    let high = ground().max_by(f64::total_cmp)? + height;
    let round = outline.bounds();
    Some(SolidShape {
        bounds: [[round.x_min, round.y_min, low], [round.x_max, round.y_max, high]],
        distance: Arc::new(move |[x, y, z]| outline.nearest([x, y], 0).distance.max(low - z).max(z - high)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;

    #[test]
    fn an_angle_stands_upright_on_its_ground() {
        let angle = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 };
        let terrain = Terrain::analytic(bounds, 1.0, |x, _| (0.5 * x, [0.5, 0.0]));
        let shape = upright(Outline { obstacle: 0, rings: vec![angle] }, &terrain, 3.0).unwrap();
        assert_eq!(shape.bounds, [[0.0; 3], [4.0, 3.0, 5.0]]);
        let places = [
            ([0.5, 2.0, 2.0], -0.5),
            ([2.0, 2.0, 2.0], 1.0),
            ([-3.0, 4.0, 2.0], 10f64.sqrt()),
            ([3.0, 0.25, 2.0], -0.25),
            ([0.5, 2.0, 7.0], 2.0),
        ];
        for (place, distance) in places {
            assert!(((shape.distance)(place) - distance).abs() < 1e-12, "{place:?}");
        }
    }
}
