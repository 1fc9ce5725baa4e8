//! Obstacles as solids, to be drawn.

use super::Outline;
use super::lines::lines;
use super::open::polygons;
use corpuscle_model::{ModelError, SolidShape};
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// Most parts of a wall of no thickness, to be drawn.
const MOST_PARTS: f64 = 1e4;

/// The obstacles of a scene, those from files included, upright from the lowest ground at their walls to a level roof: `height_m` above
/// the highest ground there, `high_enough` m where a scene says no height. Relative paths are taken from `folder`.
///
/// # Errors
/// [`ModelError::Setup`] for a file that cannot be read or holds no polygon.
pub fn obstacle_shapes(
    flood: &Flood,
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

/// A straight part of a wall of no thickness, to be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineWall {
    /// Its ends in model coordinates, m.
    pub ends: [[f64; 2]; 2],
    /// A height below the ground along it, m.
    pub base: f64,
    /// Levels of its crest at both ends, m.
    pub crest: [f64; 2],
}

/// The obstacles of a scene that are lines, in parts as long as the terrain's cells, between which the ground beneath them rises and falls: up to their crest, or
/// `high_enough` m above the ground where no water flows over them.
///
/// # Errors
/// [`ModelError::Setup`] for one that lies outside the terrain.
pub fn line_walls(flood: &Flood, terrain: &Terrain, high_enough: f64) -> Result<Vec<LineWall>, ModelError> {
    let cell = terrain.map_grid().cell_size().into_iter().fold(f64::INFINITY, f64::min);
    let lines = lines(flood, terrain, cell)?;
    Ok(lines.into_iter().flat_map(|line| line_parts(line.ends, line.crest, terrain, cell, high_enough)).collect())
}

fn line_parts(
    [a, b]: [[f64; 2]; 2],
    crest: [f64; 2],
    terrain: &Terrain,
    cell: f64,
    high_enough: f64,
) -> impl Iterator<Item = LineWall> {
    let parts = ((b[0] - a[0]).hypot(b[1] - a[1]) / cell).ceil().clamp(1.0, MOST_PARTS);
    let at = move |part: f64| [0, 1].map(|axis| a[axis] + part / parts * (b[axis] - a[axis]));
    (0..parts as usize).map(move |part| {
        let part = part as f64;
        let grounds = [part, part + 0.5, part + 1.0].map(|part| terrain.height(at(part)[0], at(part)[1]));
        let [low, high] = [
            grounds.iter().copied().fold(f64::INFINITY, f64::min),
            grounds.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        let top = |share: f64, ground: f64| {
            if crest[0].is_finite() { crest[0] + share / parts * (crest[1] - crest[0]) } else { ground + high_enough }
        };
        let crest = [top(part, grounds[0]), top(part + 1.0, grounds[2])];
        LineWall { ends: [at(part), at(part + 1.0)], base: low - (high - low), crest }
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
        let positions = [
            ([0.5, 2.0, 2.0], -0.5),
            ([2.0, 2.0, 2.0], 1.0),
            ([-3.0, 4.0, 2.0], 10f64.sqrt()),
            ([3.0, 0.25, 2.0], -0.25),
            ([0.5, 2.0, 7.0], 2.0),
        ];
        for (position, distance) in positions {
            assert!(((shape.distance)(position) - distance).abs() < 1e-12, "{position:?}");
        }
    }

    #[test]
    fn lines_stand_on_the_ground_up_to_their_crest() {
        let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 };
        let terrain = Terrain::analytic(bounds, 1.0, |x, _| (0.5 * x, [0.5, 0.0]));
        let walls = |crest| line_parts([[2.0, 3.0], [4.0, 3.0]], crest, &terrain, 1.0, 7.0).collect::<Vec<_>>();
        let levee = walls([3.0, 4.0]);
        assert_eq!(levee[0], LineWall { ends: [[2.0, 3.0], [3.0, 3.0]], base: 0.5, crest: [3.0, 3.5] });
        assert_eq!((levee.len(), levee[1].crest), (2, [3.5, 4.0]));
        assert_eq!(walls([f64::INFINITY; 2])[1].crest, [8.5, 9.0]);
    }
}
