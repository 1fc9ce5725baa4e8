//! Where walls come from: outlines of obstacles, and of ground without data.

use super::{Wall, WallKind};
use crate::obstacles::{Line, Outline, check_overlap, lines, side_within, surroundings};
use corpuscle_model::ModelError;
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;

/// The sides of outlines; no water flows over them.
pub(crate) fn of_outlines(outlines: &[Outline]) -> impl Iterator<Item = Wall> {
    let walls = |outline: &Outline| {
        let kind = WallKind::Obstacle(outline.obstacle as u32);
        outline.sides().map(move |ends| Wall { ends, kind, crest: [f64::INFINITY; 2] }).collect::<Vec<_>>()
    };
    outlines.iter().flat_map(walls)
}

/// The lines of obstacles without thickness, in parts about `spacing` m long between which the crest may rise and fall with the ground.
///
/// # Errors
/// [`ModelError::Setup`] for one that lies outside the terrain.
pub(crate) fn of_lines(scene: &Flood, terrain: &Terrain, spacing: f64) -> Result<Vec<Wall>, ModelError> {
    let wall = |line: Line| Wall { ends: line.ends, kind: WallKind::Obstacle(line.obstacle as u32), crest: line.crest };
    Ok(lines(scene, terrain, spacing)?.into_iter().map(wall).collect())
}

/// The lines inside the terrain at which water enters or leaves.
///
/// # Errors
/// [`ModelError::Setup`] for one that lies outside the terrain.
pub(crate) fn of_sides(scene: &Flood, terrain: &Terrain) -> Result<Vec<Wall>, ModelError> {
    let mut walls = Vec::new();
    let far = surroundings(terrain, 0.0);
    for (number, side) in scene.edge_line.iter().enumerate() {
        let line: Vec<[f64; 2]> = side.line.iter().map(|corner| terrain.to_model(*corner)).collect();
        check_overlap(&format!("flood.edge_line.{number}"), &line, terrain)?;
        let kind = WallKind::Side(number as u32);
        let sides = line.windows(2).filter_map(|ends| side_within([ends[0], ends[1]], far));
        walls.extend(sides.map(|ends| Wall { ends, kind, crest: [f64::INFINITY; 2] }));
    }
    Ok(walls)
}

/// The outline of ground without data: sides of cells of the terrain's grid with data on one side of them only, joined to straight runs.
pub(crate) fn no_data(terrain: &Terrain) -> Vec<Wall> {
    let grid = terrain.map_grid();
    let (columns, rows) = (grid.columns, grid.rows);
    let mut walls = Vec::new();
    let mut add = |from: [usize; 2], to: [usize; 2]| {
        let corner = |[column, row]: [usize; 2]| grid.point([column as f64 - 0.5, row as f64 - 0.5]);
        walls.push(Wall { ends: [corner(from), corner(to)], kind: WallKind::Plain, crest: [f64::INFINITY; 2] });
    };
    // Sides between a row and the next, then between a column and the next.
    for row in 1..rows {
        let is_side = |column| terrain.is_valid_cell(column, row - 1) != terrain.is_valid_cell(column, row);
        runs(columns, is_side, |from, to| add([from, row], [to, row]));
    }
    for column in 1..columns {
        let is_side = |row| terrain.is_valid_cell(column - 1, row) != terrain.is_valid_cell(column, row);
        runs(rows, is_side, |from, to| add([column, from], [column, to]));
    }
    walls
}

/// Calls `found` with the start and the end of each run of numbers below `count` that are wanted.
fn runs(count: usize, is_wanted: impl Fn(usize) -> bool, mut found: impl FnMut(usize, usize)) {
    let mut start = None;
    for number in 0..=count {
        let wanted = number < count && is_wanted(number);
        match (start, wanted) {
            (None, true) => start = Some(number),
            (Some(from), false) => {
                found(from, number);
                start = None;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_found_from_end_to_end() {
        let mut found = Vec::new();
        runs(6, |n| n != 2 && n != 3, |from, to| found.push([from, to]));
        assert_eq!(found, [[0, 2], [4, 6]]);
    }
}
