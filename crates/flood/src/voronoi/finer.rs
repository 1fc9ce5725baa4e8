//! Parts of the terrain with finer cells, from a scene.

use super::mesh::Grading;
use super::walls::{Wall, of_outlines};
use crate::error::setup;
use crate::extent::is_beside;
use crate::obstacles::{Outline, polygons};
use corpuscle_model::ModelError;
use corpuscle_scene::{Flood, Obstacle};
use corpuscle_terrain::{Polygon, Terrain};
use std::path::Path;

/// The parts of a scene with finer cells than those `spacing` m wide. `outlines` are those of its obstacles, `lines` its walls of no thickness.
pub(super) fn grading(
    scene: &Flood,
    terrain: &Terrain,
    folder: &Path,
    (spacing, outlines, lines): (f64, &[Outline], &[Wall]),
) -> Result<Grading, ModelError> {
    let mut grading = Grading::new(spacing);
    for (number, finer) in scene.finer.iter().enumerate() {
        let key = format!("flood.finer.{number}");
        if finer.spacing_m >= spacing {
            let what = format!(
                "{key}.spacing_m is {}: must be smaller than {spacing:.4}, the spacing elsewhere",
                finer.spacing_m
            );
            return Err(setup(what));
        }
        let area = Obstacle {
            name: key,
            polygon: finer.polygon.clone(),
            circle: finer.circle,
            file: finer.file.clone(),
            ..Obstacle::default()
        };
        let polygons = polygons(&area, terrain, folder)?;
        let line: Vec<_> = finer.line.iter().flatten().map(|position| terrain.to_model(*position)).collect();
        check_region(number, finer.within_m, &polygons, &line, terrain)?;
        let along = line.windows(2).map(|pair| [pair[0], pair[1]]);
        let walls = of_outlines(outlines).chain(lines.iter().copied()).map(|wall| wall.ends);
        let walls = walls.filter(|_| finer.walls);
        grading.add(finer.spacing_m, finer.within_m, polygons, along.chain(walls), terrain.bounds());
    }
    Ok(grading)
}

/// Refuses a region of finer cells that lies outside the terrain as a whole.
fn check_region(
    number: usize,
    within: f64,
    polygons: &[Polygon],
    line: &[[f64; 2]],
    terrain: &Terrain,
) -> Result<(), ModelError> {
    let bounds = terrain.bounds();
    let mut shapes = polygons
        .iter()
        .filter_map(|rings| rings.first())
        .map(Vec::as_slice)
        .chain((!line.is_empty()).then_some(line))
        .peekable();
    if shapes.peek().is_some() && shapes.all(|corners| is_beside(corners, bounds, within)) {
        return Err(setup(format!(
            "flood.finer.{number} lies outside the terrain: its positions are in the terrain's coordinates, x before y"
        )));
    }
    Ok(())
}
