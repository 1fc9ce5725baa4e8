//! Obstacles without thickness.

use super::clip::{side_within, surroundings};
use super::open::check_overlap;
use corpuscle_model::ModelError;
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;

/// Most parts of a side of a line.
const MOST_PARTS: f64 = 1e5;

/// A straight part of an obstacle without thickness.
pub(crate) struct Line {
    /// The obstacle.
    pub obstacle: usize,
    /// m.
    pub ends: [[f64; 2]; 2],
    /// Levels of its crest at both ends, m, over which water flows; infinite where none does.
    pub crest: [f64; 2],
}

/// The lines of obstacles without thickness, in parts about `spacing` m long between which the crest may rise and fall with the ground.
///
/// # Errors
/// [`ModelError::Setup`] for one that lies outside the terrain.
pub(crate) fn lines(scene: &Flood, terrain: &Terrain, spacing: f64) -> Result<Vec<Line>, ModelError> {
    let mut lines = Vec::new();
    let far = surroundings(terrain, spacing);
    for (number, obstacle) in scene.obstacle.iter().enumerate() {
        let Some(line) = &obstacle.line else { continue };
        let line: Vec<[f64; 2]> = line.iter().map(|corner| terrain.to_model(*corner)).collect();
        check_overlap(&format!("the obstacle '{}'", obstacle.name), &line, terrain)?;
        let crest = |[x, y]: [f64; 2]| match (obstacle.crest_m, obstacle.height_m) {
            (Some(level), _) => level,
            (None, Some(height)) => terrain.height(x, y) + height,
            (None, None) => f64::INFINITY,
        };
        for [a, b] in line.windows(2).filter_map(|side| side_within([side[0], side[1]], far)) {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let parts =
                if obstacle.height_m.is_some() { (length / spacing).ceil().clamp(1.0, MOST_PARTS) } else { 1.0 };
            let at = |part: usize| {
                if part as f64 == parts {
                    return b;
                }
                [0, 1].map(|axis| a[axis] + part as f64 / parts * (b[axis] - a[axis]))
            };
            lines.extend((0..parts as usize).map(|part| {
                let ends = [at(part), at(part + 1)];
                Line { obstacle: number, ends, crest: ends.map(crest) }
            }));
        }
    }
    Ok(lines)
}
