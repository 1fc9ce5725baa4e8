//! The run-up line: the limit of the wet cells, where the terrain continues beyond it.

use super::outline::outlines;
use super::{feature_collection, has_system, note_of_system, position_of};
use crate::OutputError;
use corpuscle_terrain::Terrain;
use serde_json::json;
use std::io::Write;
use std::path::Path;

/// A corner of cells `[column, row]`, row growing southwards.
type Corner = [usize; 2];

/// Writes the run-up line as GeoJSON: one MultiLineString along the border of the cells that were ever wet (`max_depth` has a value for each cell of
/// the terrain's map grid, not-a-number where dry). Left out are the terrain's own border and that of ground without data, where the water
/// ends because the ground does. Its property `highest_m` is the highest ground among the wet cells beside it, the run-up height, m; null where there
/// is no line. Coordinates are as in [`write_extent`](super::write_extent).
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_run_up(path: &Path, terrain: &Terrain, max_depth: &[f32]) -> Result<(), OutputError> {
    let grid = terrain.map_grid();
    let wet: Vec<bool> = max_depth.iter().map(|depth| !depth.is_nan()).collect();
    let is_ground =
        |[column, row]: [usize; 2]| column < grid.columns && row < grid.rows && terrain.is_valid_cell(column, row);
    let (mut lines, mut highest) = (Vec::new(), None::<f64>);
    for outline in outlines(&wet, grid.columns, grid.rows) {
        for ring in std::iter::once(&outline.outer).chain(&outline.holes) {
            lines.extend(pieces(ring, |side| side.beyond().is_some_and(is_ground)));
            let shores = sides(ring).filter(|side| side.beyond().is_some_and(is_ground));
            for [column, row] in shores.map(|side| side.wet()) {
                let [x, y] = grid.centre(column, row);
                let height = terrain.height(x, y);
                highest = Some(highest.map_or(height, |highest| highest.max(height)));
            }
        }
    }
    let with_system = has_system(terrain);
    let position = |line: &Vec<Corner>| line.iter().map(|corner| position_of(terrain, *corner, with_system)).collect();
    let coordinates: Vec<Vec<[f64; 2]>> = lines.iter().map(position).collect();
    let mut properties = json!({ "name": "run-up line", "highest_m": highest.filter(|height| height.is_finite()) });
    note_of_system(&mut properties, with_system);
    let collection = feature_collection(&properties, &json!({ "type": "MultiLineString", "coordinates": coordinates }));
    crate::whole::write_whole(path, |file| writeln!(file, "{collection}"))
}

/// A side of a cell on a ring, with the wet cell on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellSide {
    from: Corner,
    to: Corner,
}

impl CellSide {
    /// The wet cell.
    fn wet(&self) -> [usize; 2] {
        let [[c, r], [c1, r1]] = [self.from, self.to];
        match (c1 > c, c1 < c, r1 < r) {
            (true, ..) => [c, r - 1],
            (_, true, _) => [c1, r],
            (.., true) => [c - 1, r1],
            _ => [c, r],
        }
    }

    /// The cell on its right; none west or north of the grid. It may lie east or south of it.
    fn beyond(&self) -> Option<[usize; 2]> {
        let [[c, r], [c1, r1]] = [self.from, self.to];
        match (c1 > c, c1 < c, r1 < r) {
            (true, ..) => Some([c, r]),
            (_, true, _) => Some([c1, r.checked_sub(1)?]),
            (.., true) => Some([c, r1]),
            _ => Some([c.checked_sub(1)?, r]),
        }
    }
}

/// The sides of cells along a ring of corners.
fn sides(ring: &[Corner]) -> impl Iterator<Item = CellSide> + '_ {
    (0..ring.len()).flat_map(|k| {
        let [from, to] = [ring[k], ring[(k + 1) % ring.len()]];
        let length = from[0].abs_diff(to[0]) + from[1].abs_diff(to[1]);
        let toward = move |step: usize| {
            [0, 1].map(|axis| {
                if to[axis] >= from[axis] {
                    from[axis] + step.min(to[axis] - from[axis])
                } else {
                    from[axis] - step.min(from[axis] - to[axis])
                }
            })
        };
        (0..length).map(move |step| CellSide { from: toward(step), to: toward(step + 1) })
    })
}

/// The pieces of a ring whose sides are kept, as lines of corners where they turn; a ring that is kept whole ends where it begins.
fn pieces(ring: &[Corner], is_kept: impl Fn(&CellSide) -> bool) -> Vec<Vec<Corner>> {
    let sides: Vec<CellSide> = sides(ring).collect();
    let first = sides.iter().position(|side| !is_kept(side)).map_or(0, |dropped| dropped + 1);
    let mut lines: Vec<Vec<Corner>> = Vec::new();
    let mut goes_on = false;
    for side in (0..sides.len()).map(|k| sides[(first + k) % sides.len()]) {
        if !is_kept(&side) {
            goes_on = false;
            continue;
        }
        match lines.last_mut().filter(|_| goes_on) {
            Some(line) => extend(line, side.to),
            None => lines.push(vec![side.from, side.to]),
        }
        goes_on = true;
    }
    lines
}

/// Adds a corner to a line; the one before goes where the line is straight there.
fn extend(line: &mut Vec<Corner>, to: Corner) {
    if let [.., before, last] = line[..]
        && (0..2).any(|axis| before[axis] == last[axis] && last[axis] == to[axis])
    {
        line.pop();
    }
    line.push(to);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(picture: &[&str], is_ground: impl Fn([usize; 2]) -> bool) -> Vec<Vec<Corner>> {
        let wet: Vec<bool> = picture.iter().flat_map(|row| row.bytes().map(|byte| byte == b'#')).collect();
        let outlines = outlines(&wet, picture[0].len(), picture.len());
        let rings = outlines.iter().flat_map(|outline| std::iter::once(&outline.outer).chain(&outline.holes));
        rings.flat_map(|ring| pieces(ring, |side| side.beyond().is_some_and(&is_ground))).collect()
    }

    #[test]
    fn the_border_of_the_grid_is_left_out() {
        let inside = |[column, row]: [usize; 2]| column < 4 && row < 3;
        assert_eq!(lines(&["##..", "###.", "##.."], inside), [vec![[2, 3], [2, 2], [3, 2], [3, 1], [2, 1], [2, 0]]]);
        assert_eq!(lines(&["####", "####", "####"], inside), Vec::<Vec<Corner>>::new());
    }

    #[test]
    fn ground_without_data_is_left_out_and_a_whole_ring_is_closed() {
        let ring = lines(&["...", ".#.", "..."], |_| true);
        assert!(ring.len() == 1 && ring[0].len() == 5 && ring[0][0] == ring[0][4], "{ring:?}");
        // No ground north of the cell.
        let open = lines(&["...", ".#.", "..."], |[_, row]| row > 0);
        assert_eq!(open, [vec![[1, 1], [1, 2], [2, 2], [2, 1]]]);
    }

    #[test]
    fn sides_know_the_cells_beside_them() {
        let wet = [false, false, false, false, true, false, false, false, false];
        let ring = &outlines(&wet, 3, 3)[0].outer;
        let mut beyond: Vec<_> = sides(ring).map(|side| (side.wet(), side.beyond().unwrap())).collect();
        beyond.sort_unstable();
        assert_eq!(beyond, [[0, 1], [1, 0], [1, 2], [2, 1]].map(|cell| ([1, 1], cell)));
    }
}
