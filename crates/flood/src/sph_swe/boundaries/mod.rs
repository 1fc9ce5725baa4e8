//! The four sides of the ground: ghost particles of particles beyond them.

pub(super) mod outflow;

use corpuscle_terrain::Bounds;

/// Where a ghost particle stands: beyond the low side (-1), the high side (1) or neither (0), along x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GhostSide {
    /// Beyond the west (-1) or east (1) side.
    pub x: i8,
    /// Beyond the south (-1) or north (1) side.
    pub y: i8,
}

impl GhostSide {
    /// The particle itself.
    pub const NONE: GhostSide = GhostSide { x: 0, y: 0 };
}

/// What a side does to the water. Sides are numbered 0 west, 1 east, 2 south, 3 north.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeRule {
    /// Flows out freely.
    Open,
    /// A mirror.
    Wall,
    /// Joined to the opposite side.
    Periodic,
}

/// The rules of the four sides of a rectangle.
#[derive(Debug, Clone)]
pub struct EdgeRules {
    /// The rectangle.
    pub bounds: Bounds,
    /// West, east, south, north.
    pub rules: [EdgeRule; 4],
}

impl EdgeRules {
    /// The rule that a ghost particle follows along x, if it stands beyond the west or east side.
    pub fn along_x(&self, ghost: GhostSide) -> Option<&EdgeRule> {
        (ghost.x != 0).then(|| &self.rules[usize::from(ghost.x > 0)])
    }

    /// The rule that a ghost particle follows along y, if it stands beyond the south or north side.
    pub fn along_y(&self, ghost: GhostSide) -> Option<&EdgeRule> {
        (ghost.y != 0).then(|| &self.rules[2 + usize::from(ghost.y > 0)])
    }

    /// Calls `put` with each ghost particle of a particle at (x, y) that stands within `margin` of the rectangle.
    pub fn ghosts(&self, x: f64, y: f64, margin: f64, mut put: impl FnMut(GhostSide, f64, f64)) {
        let along_x = beyond(x, self.bounds.x_min, self.bounds.x_max, margin, &self.rules[..2]);
        let along_y = beyond(y, self.bounds.y_min, self.bounds.y_max, margin, &self.rules[2..]);
        for (side, position) in along_x.iter().flatten() {
            put(GhostSide { x: *side, y: 0 }, *position, y);
        }
        for (side, position) in along_y.iter().flatten() {
            put(GhostSide { x: 0, y: *side }, x, *position);
            for (side_x, position_x) in along_x.iter().flatten() {
                put(GhostSide { x: *side_x, y: *side }, *position_x, *position);
            }
        }
    }

    /// Whether a position is inside.
    pub fn hold(&self, [x, y]: [f64; 2]) -> bool {
        self.bounds.contains(x, y)
    }

    /// Puts a position that has left through a periodic side back in, and one beyond a wall back before it; names the side over which it has left otherwise.
    pub fn keep(&self, position: &mut [f64; 2], velocity: &mut [f64; 2]) -> Option<u8> {
        let mut left = None;
        let bounds = [(self.bounds.x_min, self.bounds.x_max), (self.bounds.y_min, self.bounds.y_max)];
        for axis in 0..2 {
            let (low, high) = bounds[axis];
            let side = if position[axis] < low {
                0
            } else if position[axis] >= high {
                1
            } else {
                continue;
            };
            match self.rules[2 * axis + side] {
                EdgeRule::Periodic => position[axis] = low + (position[axis] - low).rem_euclid(high - low),
                EdgeRule::Wall => {
                    let edge = [low, high][side];
                    position[axis] = (2.0 * edge - position[axis]).clamp(low, high);
                    velocity[axis] = -velocity[axis];
                }
                EdgeRule::Open => left = Some((2 * axis + side) as u8),
            }
        }
        left
    }

    /// How far a position is beyond the side that it is farthest beyond, m; negative inside.
    pub fn beyond(&self, x: f64, y: f64) -> f64 {
        let bounds = &self.bounds;
        let along_x = (bounds.x_min - x).max(x - bounds.x_max);
        along_x.max(bounds.y_min - y).max(y - bounds.y_max)
    }
}

/// Outward unit vectors of the sides.
pub(crate) const OUTWARD: [[f64; 2]; 4] = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];

/// Ghost particles beyond the low and the high side along one axis; none beyond sides over which water leaves: there it goes on
/// by itself.
fn beyond(position: f64, low: f64, high: f64, margin: f64, rules: &[EdgeRule]) -> [Option<(i8, f64)>; 2] {
    let periodic = rules[0] == EdgeRule::Periodic;
    let below = if periodic { position - (high - low) } else { 2.0 * low - position };
    let above = if periodic { position + (high - low) } else { 2.0 * high - position };
    let ghosts = |rule: &EdgeRule| matches!(rule, EdgeRule::Periodic | EdgeRule::Wall);
    let low_ghost = ghosts(&rules[0]) && below > low - margin && below <= low;
    let high_ghost = ghosts(&rules[1]) && above < high + margin && above >= high;
    [low_ghost.then_some((-1, below)), high_ghost.then_some((1, above))]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(rule: EdgeRule) -> EdgeRules {
        let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 5.0 };
        EdgeRules { bounds, rules: [rule; 4] }
    }

    fn ghosts(rules: &EdgeRules, x: f64, y: f64) -> Vec<(i8, i8, f64, f64)> {
        let mut found = Vec::new();
        rules.ghosts(x, y, 2.0, |ghost, x, y| found.push((ghost.x, ghost.y, x, y)));
        found
    }

    #[test]
    fn a_wall_mirrors_and_a_corner_mirrors_twice() {
        let wall = rules(EdgeRule::Wall);
        assert_eq!(ghosts(&wall, 5.0, 2.5), vec![]);
        assert_eq!(ghosts(&wall, 1.0, 4.5), vec![(-1, 0, -1.0, 4.5), (0, 1, 1.0, 5.5), (-1, 1, -1.0, 5.5)]);
    }

    #[test]
    fn a_periodic_side_shows_the_other_one() {
        assert_eq!(ghosts(&rules(EdgeRule::Periodic), 9.5, 2.5), vec![(-1, 0, -0.5, 2.5)]);
    }

    #[test]
    fn what_leaves_comes_back_or_is_gone() {
        let velocity = [3.0, 1.0];
        let keep = |rule, position: [f64; 2]| {
            let (mut position, mut velocity) = (position, velocity);
            let kept = rules(rule).keep(&mut position, &mut velocity);
            (kept, position, velocity)
        };
        assert_eq!(keep(EdgeRule::Wall, [10.5, 1.0]), (None, [9.5, 1.0], [-3.0, 1.0]));
        assert_eq!(keep(EdgeRule::Wall, [0.1, 1.0]), (None, [0.1, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Open, [9.9, 1.0]), (None, [9.9, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Periodic, [10.5, 1.0]), (None, [0.5, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Open, [10.5, 1.0]).0, Some(1));
    }
}
