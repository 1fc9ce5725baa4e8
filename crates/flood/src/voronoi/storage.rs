//! The volume that a cell holds below a level, where the heights of the ground within it count (`flood.storage = "level-volume"`).
//!
//! The ground of a cell is taken as level parts of the same area, each at a height of its own, as in the tables of volume against level of
//! Casulli (2009, "A high-resolution wetting and drying algorithm for free-surface hydrodynamics", equation 7). So a cell in which the water stands
//! partly has the level of its water, not that of the mean ground with the water spread over it.

/// Parts of a cell.
pub(crate) const PARTS: usize = 16;

/// Parts into which each side of a triangle of ground is divided to sample its heights.
const TRIANGLE_DIVISIONS: usize = 4;

/// Heights of the parts of a cell above its mean ground, m, the lowest first.
pub(crate) type Heights = [f32; PARTS];

/// The heights of a cell's parts: those of the ground, given by `height`, over convex polygons. `bed` is their mean, m.
pub(crate) fn heights(parts: &[Vec<[f64; 2]>], bed: f64, height: impl Fn([f64; 2]) -> f64) -> Heights {
    let mut samples: Vec<[f64; 2]> = Vec::new();
    for part in parts.iter().filter(|part| part.len() > 2) {
        let centre = [0, 1].map(|axis| part.iter().map(|r| r[axis]).sum::<f64>() / part.len() as f64);
        for (k, a) in part.iter().enumerate() {
            let b = part[(k + 1) % part.len()];
            let [p, q] = [*a, b].map(|r| [r[0] - centre[0], r[1] - centre[1]]);
            let area = 0.5 * (p[0] * q[1] - p[1] * q[0]);
            let position = |[s, t]: [f64; 2]| [0, 1].map(|axis| centre[axis] + s * p[axis] + t * q[axis]);
            samples.extend(
                middles().map(|at| [height(position(at)), area / (TRIANGLE_DIVISIONS * TRIANGLE_DIVISIONS) as f64]),
            );
        }
    }
    samples.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    parts_of(&samples, bed)
}

/// The middles of the small triangles into which the triangle (0, 0), (1, 0), (0, 1) is cut.
fn middles() -> impl Iterator<Item = [f64; 2]> {
    let third = |k: usize| k as f64 / (3 * TRIANGLE_DIVISIONS) as f64;
    (0..TRIANGLE_DIVISIONS).flat_map(move |row| {
        let upright = (0..TRIANGLE_DIVISIONS - row).map(move |column| [third(3 * column + 1), third(3 * row + 1)]);
        let turned = (0..TRIANGLE_DIVISIONS - row - 1).map(move |column| [third(3 * column + 2), third(3 * row + 2)]);
        upright.chain(turned)
    })
}

/// Mean heights above `bed` of parts of the same area, from heights in order with the area of each.
fn parts_of(samples: &[[f64; 2]], bed: f64) -> Heights {
    let area: f64 = samples.iter().map(|[_, area]| area).sum();
    let size = area / PARTS as f64;
    let mut sums = [0.0; PARTS];
    let mut passed = 0.0;
    for &[height, mut rest] in samples {
        while rest > 0.0 {
            let part = ((passed / size) as usize).min(PARTS - 1);
            let room = if part == PARTS - 1 { rest } else { ((part + 1) as f64 * size - passed).max(1e-12 * size) };
            let taken = rest.min(room);
            sums[part] += taken * (height - bed);
            passed += taken;
            rest -= taken;
        }
    }
    let mean = sums.iter().sum::<f64>() / area;
    if area > 0.0 { sums.map(|sum| (sum / size - mean) as f32) } else { [0.0; PARTS] }
}

/// Mean of the heights, m: 0 but for rounding, which is taken off wherever they are used.
#[inline]
fn mean(heights: &Heights) -> f64 {
    heights.iter().map(|height| f64::from(*height)).sum::<f64>() / PARTS as f64
}

/// The heights above their mean, m.
#[cfg(feature = "gpu")]
pub(crate) fn above_mean(heights: &Heights) -> [f64; PARTS] {
    let mean = mean(heights);
    heights.map(|height| f64::from(height) - mean)
}

/// Mean over the parts of a cell of what `of_part` gives for the height of each above the mean ground, m.
#[inline]
pub(crate) fn mean_of(heights: &Heights, of_part: impl Fn(f64) -> f64) -> f64 {
    let mean = mean(heights);
    heights.iter().map(|height| of_part(f64::from(*height) - mean)).sum::<f64>() / PARTS as f64
}

/// The level above the mean ground, m, at which a cell holds `depth` m of water, spread over all of it; that of its lowest part where it is dry.
#[inline]
pub(crate) fn level(heights: &Heights, depth: f64) -> f64 {
    let mean = mean(heights);
    if depth >= f64::from(heights[PARTS - 1]) - mean {
        return depth;
    }
    let mut sum = 0.0;
    for (k, height) in heights.iter().enumerate() {
        sum += f64::from(*height) - mean;
        let level = (depth * PARTS as f64 + sum) / (k + 1) as f64;
        let next = heights.get(k + 1).map_or(f64::INFINITY, |height| f64::from(*height) - mean);
        if level <= next {
            return level;
        }
    }
    depth
}

/// Water below a level above the mean ground, m, spread over all of the cell, m.
pub(crate) fn depth(heights: &Heights, level: f64) -> f64 {
    if level >= f64::from(heights[PARTS - 1]) - mean(heights) {
        return level;
    }
    mean_of(heights, |ground| (level - ground).max(0.0))
}

/// Potential energy of the water below a level above the mean ground, relative to that ground, over density, gravity and area, m2.
pub(crate) fn potential(heights: &Heights, level: f64) -> f64 {
    mean_of(heights, |ground| if level > ground { 0.5 * (level * level - ground * ground) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A square whose ground falls evenly: half of it stands dry where the level is that of its middle, and holds an eighth of its fall.
    #[test]
    fn a_slope_holds_what_lies_below_the_level() {
        let square = vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]];
        let fall = 3.0;
        let heights = heights(&square, 10.0, |[x, _]| 10.0 + 0.5 * fall * (x - 1.0));
        for share in [0.2_f64, 0.5, 0.8] {
            // Exactly: the fall times half of the square of the part that is wet.
            let exact = 0.5 * fall * share * share;
            let found = depth(&heights, fall * (share - 0.5));
            assert!((found - exact).abs() < 0.01 * fall, "{share}: {found} {exact}");
        }
        assert_eq!(depth(&heights, fall), fall);
        assert!((potential(&heights, 2.0) - (0.5 * 4.0 - fall * fall / 24.0)).abs() < 0.01 * fall * fall);
    }

    proptest! {
        /// Level and depth are each other's inverse, from dry to deep.
        #[test]
        fn depth_and_level_are_inverse(raw in prop::collection::vec(-5.0_f64..5.0, PARTS), water in 0.0_f64..8.0) {
            let mut samples: Vec<[f64; 2]> = raw.iter().map(|height| [*height, 1.0]).collect();
            samples.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            let bed = raw.iter().sum::<f64>() / PARTS as f64;
            let heights = parts_of(&samples, bed);
            let found = depth(&heights, level(&heights, water));
            prop_assert!((found - water).abs() < 1e-13, "{found} {water}");
            let lowest = f64::from(heights[0]) - mean(&heights);
            prop_assert!((level(&heights, 0.0) - lowest).abs() < 1e-12);
            prop_assert!(level(&heights, water) >= lowest - 1e-12);
        }
    }
}
