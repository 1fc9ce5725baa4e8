//! The four sides of the ground: images of particles beyond them.

use corpuscle_scene::Table;
use corpuscle_terrain::Bounds;

/// Where an image stands: beyond the low side (-1), the high side (1) or neither (0), along x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Image {
    /// Beyond the west (-1) or east (1) side.
    pub x: i8,
    /// Beyond the south (-1) or north (1) side.
    pub y: i8,
}

impl Image {
    /// The particle itself.
    pub const NONE: Image = Image { x: 0, y: 0 };
}

/// What a side does to the water. Sides are numbered 0 west, 1 east, 2 south, 3 north.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeRule {
    /// Flows out freely.
    Open,
    /// A mirror.
    Wall,
    /// Joined to the opposite side.
    Periodic,
    /// Held at a level over time, m.
    Stage(Table),
}

/// The rules of the four sides of a rectangle.
#[derive(Debug, Clone)]
pub struct EdgeRules {
    /// The rectangle.
    pub bounds: Bounds,
    /// West, east, south, north.
    pub rules: [EdgeRule; 4],
}

/// How near particles come to walls. A column of water has a width; and in the corner of two walls a particle would meet its three
/// images in one point, where no smoothing length is short enough and no pressure drives it out again.
#[derive(Debug, Clone, Copy)]
pub struct BeforeWalls {
    /// Smoothing length over particle distance.
    pub eta: f64,
    /// Distance of particles in water of the depth that goes with their volume, m. 0 lets them come as near as they like.
    pub spacing: f64,
}

impl BeforeWalls {
    /// A quarter of the distance of particles, m, for a particle with a smoothing length.
    pub fn of(self, h: f64) -> f64 {
        0.25 * self.spacing.min(h / self.eta)
    }
}

impl EdgeRules {
    /// The rule that an image follows along x, if it stands beyond the west or east side.
    pub fn along_x(&self, image: Image) -> Option<&EdgeRule> {
        (image.x != 0).then(|| &self.rules[usize::from(image.x > 0)])
    }

    /// The rule that an image follows along y, if it stands beyond the south or north side.
    pub fn along_y(&self, image: Image) -> Option<&EdgeRule> {
        (image.y != 0).then(|| &self.rules[2 + usize::from(image.y > 0)])
    }

    /// Whether an image is a particle of this water, seen from the other side.
    pub fn is_periodic(&self, image: Image) -> bool {
        [self.along_x(image), self.along_y(image)].into_iter().flatten().all(|rule| *rule == EdgeRule::Periodic)
    }

    /// Whether some side is held at a level.
    pub fn holds_level(&self) -> bool {
        self.rules.iter().any(|rule| matches!(rule, EdgeRule::Stage(_)))
    }

    /// Calls `put` with each image of a particle at (x, y) that stands within `margin` of the rectangle.
    pub fn images(&self, x: f64, y: f64, margin: f64, mut put: impl FnMut(Image, f64, f64)) {
        let along_x = beyond(x, self.bounds.x_min, self.bounds.x_max, margin, &self.rules[..2]);
        let along_y = beyond(y, self.bounds.y_min, self.bounds.y_max, margin, &self.rules[2..]);
        for (side, place) in along_x.iter().flatten() {
            put(Image { x: *side, y: 0 }, *place, y);
        }
        for (side, place) in along_y.iter().flatten() {
            put(Image { x: 0, y: *side }, x, *place);
            for (side_x, place_x) in along_x.iter().flatten() {
                put(Image { x: *side_x, y: *side }, *place_x, *place);
            }
        }
    }

    /// Puts a place that has left through a periodic side back in, and one beyond a wall back before it; names the side
    /// over which it has left otherwise. Before walls it stands `off` m at least (see
    /// [`BeforeWalls`]).
    pub fn keep(&self, place: &mut [f64; 2], velocity: &mut [f64; 2], off: f64) -> Option<u8> {
        let side = self.keep_in(place, velocity);
        for axis in 0..2 {
            let [low, high] = self.between_walls(axis, off);
            if place[axis] < low && side.is_none() {
                (place[axis], velocity[axis]) = (low, velocity[axis].max(0.0));
            } else if place[axis] > high && side.is_none() {
                (place[axis], velocity[axis]) = (high, velocity[axis].min(0.0));
            }
        }
        side
    }

    /// Whether a place is inside, and at least `off` m before the walls.
    pub fn hold(&self, place: [f64; 2], off: f64) -> bool {
        let within = |axis: usize| {
            let [low, high] = self.between_walls(axis, off);
            (low..=high).contains(&place[axis])
        };
        self.bounds.contains(place[0], place[1]) && within(0) && within(1)
    }

    /// What is at least `off` m before the walls along an axis.
    fn between_walls(&self, axis: usize, off: f64) -> [f64; 2] {
        let (low, high) = [(self.bounds.x_min, self.bounds.x_max), (self.bounds.y_min, self.bounds.y_max)][axis];
        let off = off.min(0.5 * (high - low));
        let before = |side: usize| if self.rules[2 * axis + side] == EdgeRule::Wall { off } else { 0.0 };
        [low + before(0), high - before(1)]
    }

    fn keep_in(&self, place: &mut [f64; 2], velocity: &mut [f64; 2]) -> Option<u8> {
        let mut left = None;
        let bounds = [(self.bounds.x_min, self.bounds.x_max), (self.bounds.y_min, self.bounds.y_max)];
        for axis in 0..2 {
            let (low, high) = bounds[axis];
            let side = if place[axis] < low {
                0
            } else if place[axis] >= high {
                1
            } else {
                continue;
            };
            match self.rules[2 * axis + side] {
                EdgeRule::Periodic => place[axis] = low + (place[axis] - low).rem_euclid(high - low),
                EdgeRule::Wall => {
                    let edge = [low, high][side];
                    place[axis] = (2.0 * edge - place[axis]).clamp(low, high);
                    velocity[axis] = -velocity[axis];
                }
                EdgeRule::Open | EdgeRule::Stage(_) => left = Some((2 * axis + side) as u8),
            }
        }
        left
    }

    /// The place `distance` m before the edge that is nearest to a place beyond it.
    pub fn before(&self, x: f64, y: f64, distance: f64) -> [f64; 2] {
        let within = |value: f64, low: f64, high: f64| {
            let margin = distance.min(0.5 * (high - low));
            value.clamp(low + margin, high - margin)
        };
        let Bounds { x_min, x_max, y_min, y_max } = self.bounds;
        [within(x, x_min, x_max), within(y, y_min, y_max)]
    }

    /// How far beyond a side a place is, m; negative inside.
    pub fn beyond(&self, side: u8, x: f64, y: f64) -> f64 {
        let bounds = &self.bounds;
        match side {
            0 => bounds.x_min - x,
            1 => x - bounds.x_max,
            2 => bounds.y_min - y,
            _ => y - bounds.y_max,
        }
    }
}

/// Outward unit vectors of the sides.
pub(crate) const OUTWARD: [[f64; 2]; 4] = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];

/// Images beyond the low and the high side along one axis; none beyond sides over which water leaves: there it goes on
/// by itself.
fn beyond(place: f64, low: f64, high: f64, margin: f64, rules: &[EdgeRule]) -> [Option<(i8, f64)>; 2] {
    let periodic = rules[0] == EdgeRule::Periodic;
    let below = if periodic { place - (high - low) } else { 2.0 * low - place };
    let above = if periodic { place + (high - low) } else { 2.0 * high - place };
    let images = |rule: &EdgeRule| matches!(rule, EdgeRule::Periodic | EdgeRule::Wall);
    let low_image = images(&rules[0]) && below > low - margin && below <= low;
    let high_image = images(&rules[1]) && above < high + margin && above >= high;
    [low_image.then_some((-1, below)), high_image.then_some((1, above))]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(rule: EdgeRule) -> EdgeRules {
        let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 5.0 };
        EdgeRules { bounds, rules: std::array::from_fn(|_| rule.clone()) }
    }

    fn images(rules: &EdgeRules, x: f64, y: f64) -> Vec<(i8, i8, f64, f64)> {
        let mut found = Vec::new();
        rules.images(x, y, 2.0, |image, x, y| found.push((image.x, image.y, x, y)));
        found
    }

    #[test]
    fn a_wall_mirrors_and_a_corner_mirrors_twice() {
        let wall = rules(EdgeRule::Wall);
        assert_eq!(images(&wall, 5.0, 2.5), vec![]);
        assert_eq!(images(&wall, 1.0, 4.5), vec![(-1, 0, -1.0, 4.5), (0, 1, 1.0, 5.5), (-1, 1, -1.0, 5.5)]);
    }

    #[test]
    fn a_periodic_side_shows_the_other_one() {
        assert_eq!(images(&rules(EdgeRule::Periodic), 9.5, 2.5), vec![(-1, 0, -0.5, 2.5)]);
    }

    #[test]
    fn what_leaves_comes_back_or_is_gone() {
        let velocity = [3.0, 1.0];
        let keep = |rule, place: [f64; 2]| {
            let (mut place, mut velocity) = (place, velocity);
            let kept = rules(rule).keep(&mut place, &mut velocity, 0.25);
            (kept, place, velocity)
        };
        assert_eq!(keep(EdgeRule::Wall, [10.5, 1.0]), (None, [9.5, 1.0], [-3.0, 1.0]));
        assert_eq!(keep(EdgeRule::Wall, [9.9, 1.0]), (None, [9.75, 1.0], [0.0, 1.0]));
        assert_eq!(keep(EdgeRule::Wall, [0.1, 1.0]), (None, [0.25, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Open, [9.9, 1.0]), (None, [9.9, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Periodic, [10.5, 1.0]), (None, [0.5, 1.0], velocity));
        assert_eq!(keep(EdgeRule::Open, [10.5, 1.0]).0, Some(1));
    }
}
