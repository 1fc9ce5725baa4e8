//! What is known of the water beyond border faces, from old faces to new ones.

use super::super::mesh::Mesh;
use corpuscle_model::ExactSum;

/// Faces lie on one line where they are nearer to it than this part of the longer one.
const ON_LINE: f64 = 1e-3;

/// A face on a border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Border {
    /// The rule that holds there; none at solids.
    pub rule: Option<u16>,
    /// Whether `beyond` is a level, of which the highest counts, and not a mean.
    pub takes_highest: bool,
    pub ends: [[f64; 2]; 2],
    /// State of the water beyond it: see `Boundaries::beyond_at_start`.
    pub beyond: f64,
}

/// Ends of a border face, m.
pub(super) fn ends(mesh: &Mesh, face: usize) -> [[f64; 2]; 2] {
    let face = &mesh.faces[face];
    let cell = mesh.centroid[face.cells[0] as usize];
    let [x, y] = [0, 1].map(|axis| cell[axis] + 0.5 * f64::from(face.between[axis]) + f64::from(face.offset[axis]));
    let [along_x, along_y] = [-0.5 * face.normal[1], 0.5 * face.normal[0]];
    [[x - along_x, y - along_y], [x + along_x, y + along_y]]
}

/// Gives new border faces what old ones with the same rule, over which they lie, have: a mean by length, or the highest. What there was before (of faces
/// that lie over none) stays.
pub(super) fn carry(old: &[Border], new: &[Border], beyond: &mut [f64]) {
    // In bands along x, as wide as the longest face.
    let longest = old.iter().chain(new).map(Border::length).fold(f64::MIN_POSITIVE, f64::max);
    let band = |border: &Border| (border.middle()[0] / longest).floor() as i64;
    let mut sorted: Vec<(i64, &Border)> = old.iter().filter(|b| b.rule.is_some()).map(|b| (band(b), b)).collect();
    sorted.sort_by_key(|(band, _)| *band);
    for (border, beyond) in new.iter().zip(beyond).filter(|(border, _)| border.rule.is_some()) {
        let here = band(border);
        let from = sorted.partition_point(|(band, _)| *band < here - 1);
        let near = sorted[from..].iter().take_while(|(band, _)| *band <= here + 1).map(|(_, border)| *border);
        let of_rule = near.filter(|old| old.rule == border.rule);
        let over = of_rule.map(|old| (border.common(old), old.beyond)).filter(|(length, _)| *length > 0.0);
        let found: Vec<(f64, f64)> = over.collect();
        if found.is_empty() {
            continue;
        }
        *beyond = if border.takes_highest {
            found.iter().fold(f64::NEG_INFINITY, |highest, (_, value)| highest.max(*value))
        } else if let [(_, value)] = found[..] {
            value
        } else {
            let length: ExactSum = found.iter().map(|(length, _)| *length).collect();
            let weighted: ExactSum = found.iter().map(|(part, value)| part * value).collect();
            weighted.value() / length.value()
        };
    }
}

impl Border {
    fn middle(&self) -> [f64; 2] {
        let [a, b] = self.ends;
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }

    fn length(&self) -> f64 {
        let [a, b] = self.ends;
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    /// Length that it has in common with another, m; 0 where they do not lie on one line.
    fn common(&self, other: &Self) -> f64 {
        let [a, b] = self.ends;
        let length = self.length();
        let along = [0, 1].map(|axis| (b[axis] - a[axis]) / length);
        let of = |at: [f64; 2]| {
            let [dx, dy] = [at[0] - a[0], at[1] - a[1]];
            [dx * along[0] + dy * along[1], dy * along[0] - dx * along[1]]
        };
        let [from, to] = other.ends.map(of);
        let near = ON_LINE * length.max(other.length());
        if from[1].abs() > near || to[1].abs() > near {
            return 0.0;
        }
        let common = from[0].max(to[0]).min(length) - from[0].min(to[0]).max(0.0);
        if common > near { common } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_by_length_and_highest_levels() {
        let border = |from: f64, to: f64, beyond: f64, takes_highest: bool| Border {
            rule: Some(1),
            takes_highest,
            ends: [[3.0, from], [3.0, to]],
            beyond,
        };
        for (takes_highest, expected) in [(false, [0.75, 2.0, 7.0]), (true, [1.0, 2.0, 7.0])] {
            let old = [
                border(0.0, 1.0, 0.0, takes_highest),
                border(4.0, 1.0, 1.0, takes_highest),
                border(4.0, 8.0, 2.0, takes_highest),
            ];
            let new = [
                border(0.0, 4.0, 0.0, takes_highest),
                border(4.0, 5.0, 0.0, takes_highest),
                border(9.0, 11.0, 0.0, takes_highest),
            ];
            let mut beyond = [7.0; 3];
            carry(&old, &new, &mut beyond);
            assert_eq!(beyond, expected);
        }
        // Across, and under another rule.
        let across = Border { ends: [[2.0, 1.0], [4.0, 1.0]], ..border(0.0, 1.0, 5.0, false) };
        let other = Border { rule: Some(2), ..border(0.0, 1.0, 5.0, false) };
        let mut beyond = [7.0];
        carry(&[across, other], &[border(0.0, 2.0, 0.0, false)], &mut beyond);
        assert_eq!(beyond, [7.0]);
    }
}
