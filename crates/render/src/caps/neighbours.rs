//! Which drops come so near to each other that they flow together.

use glam::Vec3;
use std::collections::HashMap;

/// Most neighbours of a drop.
const MOST: usize = 24;

/// For each disc (position and radius) those that it nearly touches: less than `gap` between them. Where neighbours begin in the
/// list, how many, and the list.
pub(super) fn neighbours(discs: &[(Vec3, f32)], gap: f32) -> (Vec<[u32; 2]>, Vec<u32>) {
    let largest = discs.iter().map(|(_, radius)| *radius).fold(0.0, f32::max);
    let cell = (2.0 * largest + gap).max(1e-6);
    let at = |position: Vec3| (position / cell).floor().as_ivec3().to_array();
    let mut cells: HashMap<[i32; 3], Vec<u32>> = HashMap::new();
    for (number, (position, _)) in discs.iter().enumerate() {
        cells.entry(at(*position)).or_default().push(number as u32);
    }
    let (mut spans, mut all) = (Vec::with_capacity(discs.len()), Vec::new());
    for (number, (position, radius)) in discs.iter().enumerate() {
        let [x, y, z] = at(*position);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let between = |other: u32| {
            let (there, reach) = discs[other as usize];
            (there - *position).length() - reach - radius
        };
        let near = around.filter_map(|cell| cells.get(&cell)).flatten().copied();
        let mut found: Vec<u32> = near.filter(|other| *other as usize != number && between(*other) < gap).collect();
        found.sort_by(|a, b| between(*a).total_cmp(&between(*b)).then(a.cmp(b)));
        found.truncate(MOST);
        spans.push([all.len() as u32, found.len() as u32]);
        all.extend(found);
    }
    (spans, all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_those_that_nearly_touch() {
        let disc = |x: f32, radius: f32| (Vec3::new(x, 0.0, 0.0), radius);
        let (spans, all) = neighbours(&[disc(0.0, 1.0), disc(2.05, 1.0), disc(4.5, 0.2), disc(-3.0, 0.1)], 0.1);
        assert_eq!(spans, [[0, 1], [1, 1], [2, 0], [2, 0]]);
        assert_eq!(all, [1, 0]);
    }
}
