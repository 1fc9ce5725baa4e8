//! Outlines of cells: walking the edges between wet and dry.

use std::collections::HashMap;

/// The outline of one connected area (cells joined by sides). Vertices are corners of cells `[column, row]`, row
/// growing southwards; rings are not closed by a repeated vertex. Seen with north up the outer ring runs
/// anticlockwise and the holes clockwise (the right-hand rule of RFC 7946), and every ring is simple.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outline {
    pub outer: Vec<[usize; 2]>,
    pub holes: Vec<Vec<[usize; 2]>>,
}

/// The outlines of all wet areas, in the order of their first cell.
pub(super) fn outlines(wet: &[bool], columns: usize, rows: usize) -> Vec<Outline> {
    let labels = label_areas(wet, columns, rows);
    let areas = labels.iter().copied().filter(|label| *label != DRY).max().map_or(0, |last| last as usize + 1);
    let mut outlines = vec![Outline { outer: Vec::new(), holes: Vec::new() }; areas];
    for ring in rings(wet, columns, rows) {
        let [column, row] = cell_on_the_left(&ring);
        let outline = &mut outlines[labels[row * columns + column] as usize];
        if twice_area(&ring) > 0 {
            outline.outer = ring;
        } else {
            outline.holes.push(ring);
        }
    }
    outlines
}

const DRY: u32 = u32::MAX;

/// Numbers the areas of wet cells joined by sides.
fn label_areas(wet: &[bool], columns: usize, rows: usize) -> Vec<u32> {
    let mut labels = vec![DRY; wet.len()];
    let mut next = 0;
    let mut to_visit = Vec::new();
    for start in 0..wet.len() {
        if !wet[start] || labels[start] != DRY {
            continue;
        }
        labels[start] = next;
        to_visit.push(start);
        while let Some(cell) = to_visit.pop() {
            let (column, row) = (cell % columns, cell / columns);
            let neighbours = [
                (column > 0).then(|| cell - 1),
                (column + 1 < columns).then(|| cell + 1),
                (row > 0).then(|| cell - columns),
                (row + 1 < rows).then(|| cell + columns),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if wet[neighbour] && labels[neighbour] == DRY {
                    labels[neighbour] = next;
                    to_visit.push(neighbour);
                }
            }
        }
        next += 1;
    }
    labels
}

/// Directions in the order of left turns: east, north, west, south.
const STEPS: [[isize; 2]; 4] = [[1, 0], [0, -1], [-1, 0], [0, 1]];

/// All boundary rings, with the wet cells on their left.
fn rings(wet: &[bool], columns: usize, rows: usize) -> Vec<Vec<[usize; 2]>> {
    let width = columns + 1;
    let mut leaving = edges(wet, columns, rows);
    let mut rings = Vec::new();
    for start in 0..leaving.len() {
        while leaving[start] != 0 {
            let mut direction = leaving[start].trailing_zeros() as usize;
            let mut vertex = [start % width, start / width];
            let mut ring = Vec::new();
            // Up to the first edge again, which is taken out when it is walked.
            loop {
                let here = vertex[1] * width + vertex[0];
                // The leftmost way on: round the same cell, so that cells which only touch at a corner stay apart.
                let Some(turned) = [1, 0, 3]
                    .map(|turn| (direction + turn) % 4)
                    .into_iter()
                    .find(|way| leaving[here] & (1 << way) != 0)
                else {
                    break;
                };
                if turned != direction || ring.is_empty() {
                    ring.push(vertex);
                }
                direction = turned;
                leaving[here] &= !(1 << direction);
                vertex = [0, 1].map(|axis| vertex[axis].wrapping_add_signed(STEPS[direction][axis]));
            }
            rings.extend(simple_rings(ring));
        }
    }
    rings
}

/// The boundary edges that leave each corner of cells, one bit for each direction, with the wet cell on the left.
fn edges(wet: &[bool], columns: usize, rows: usize) -> Vec<u8> {
    let width = columns + 1;
    let mut leaving = vec![0; width * (rows + 1)];
    let is_wet = |column: isize, row: isize| {
        (0..columns as isize).contains(&column)
            && (0..rows as isize).contains(&row)
            && wet[row as usize * columns + column as usize]
    };
    for row in 0..rows {
        for column in 0..columns {
            let (c, r) = (column as isize, row as isize);
            if !is_wet(c, r) {
                continue;
            }
            // South side eastwards, east side northwards, north side westwards, west side southwards.
            let sides = [
                (is_wet(c, r + 1), column, row + 1),
                (is_wet(c + 1, r), column + 1, row + 1),
                (is_wet(c, r - 1), column + 1, row),
                (is_wet(c - 1, r), column, row),
            ];
            for (direction, (inside, from_column, from_row)) in sides.into_iter().enumerate() {
                if !inside {
                    leaving[from_row * width + from_column] |= 1 << direction;
                }
            }
        }
    }
    leaving
}

/// Cuts a ring that touches itself at corners into rings that do not.
fn simple_rings(ring: Vec<[usize; 2]>) -> Vec<Vec<[usize; 2]>> {
    let mut rings = Vec::new();
    let mut open: Vec<[usize; 2]> = Vec::with_capacity(ring.len());
    let mut indices: HashMap<[usize; 2], usize> = HashMap::with_capacity(ring.len());
    for vertex in ring {
        if let Some(&start) = indices.get(&vertex) {
            let closed = open.split_off(start);
            closed.iter().for_each(|vertex| {
                indices.remove(vertex);
            });
            rings.push(closed);
        }
        indices.insert(vertex, open.len());
        open.push(vertex);
    }
    rings.push(open);
    rings
}

/// Twice the area in cells, positive for an anticlockwise ring seen with north up.
fn twice_area(ring: &[[usize; 2]]) -> i64 {
    let next = ring.iter().cycle().skip(1);
    let cross = |a: &[usize; 2], b: &[usize; 2]| a[1] as i64 * b[0] as i64 - a[0] as i64 * b[1] as i64;
    ring.iter().zip(next).map(|(a, b)| cross(a, b)).sum()
}

/// The wet cell on the left of a ring's first edge.
fn cell_on_the_left(ring: &[[usize; 2]]) -> [usize; 2] {
    let [column, row] = ring[0];
    let next = ring[1];
    if next[1] == row {
        if next[0] > column { [column, row - 1] } else { [column - 1, row] }
    } else if next[1] < row {
        [column - 1, row - 1]
    } else {
        [column, row]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn mask(picture: &[&str]) -> (Vec<bool>, usize, usize) {
        let wet = picture.iter().flat_map(|row| row.bytes().map(|byte| byte == b'#')).collect();
        (wet, picture[0].len(), picture.len())
    }

    #[test]
    fn one_cell_is_an_anticlockwise_square() {
        let (wet, columns, rows) = mask(&["..", ".#"]);
        let all = outlines(&wet, columns, rows);
        assert_eq!(all.len(), 1);
        assert_eq!(twice_area(&all[0].outer), 2);
        assert_eq!(all[0].outer.len(), 4);
        assert!(all[0].holes.is_empty());
    }

    #[test]
    fn a_hole_belongs_to_the_area_round_it_and_an_island_in_it_is_its_own() {
        let (wet, columns, rows) = mask(&["#####", "#...#", "#.#.#", "#...#", "#####"]);
        let all = outlines(&wet, columns, rows);
        assert_eq!(all.len(), 2);
        assert_eq!((twice_area(&all[0].outer), twice_area(&all[0].holes[0])), (50, -18));
        assert_eq!((twice_area(&all[1].outer), all[1].holes.len()), (2, 0));
    }

    #[test]
    fn cells_that_touch_at_a_corner_stay_apart() {
        let (wet, columns, rows) = mask(&["#.", ".#"]);
        assert_eq!(outlines(&wet, columns, rows).len(), 2);
    }

    #[test]
    fn an_area_that_touches_itself_at_a_corner_has_simple_rings() {
        let (wet, columns, rows) = mask(&["##.", "#.#", "###"]);
        let all = outlines(&wet, columns, rows);
        assert_eq!(all.len(), 1);
        assert_eq!((twice_area(&all[0].outer), twice_area(&all[0].holes[0])), (16, -2));
    }

    proptest! {
        #[test]
        fn areas_add_up_and_rings_are_simple(wet in proptest::collection::vec(any::<bool>(), 7 * 9)) {
            let all = outlines(&wet, 9, 7);
            let mut cells = 0;
            for outline in &all {
                prop_assert!(twice_area(&outline.outer) > 0);
                cells += twice_area(&outline.outer);
                for hole in &outline.holes {
                    prop_assert!(twice_area(hole) < 0);
                    cells += twice_area(hole);
                }
                for ring in std::iter::once(&outline.outer).chain(&outline.holes) {
                    let mut vertices = ring.clone();
                    vertices.sort();
                    vertices.dedup();
                    prop_assert_eq!(vertices.len(), ring.len());
                }
            }
            prop_assert_eq!(cells, 2 * wet.iter().filter(|wet| **wet).count() as i64);
        }
    }
}
