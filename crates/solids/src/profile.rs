//! Profiles of solids of revolution.

use crate::SolidError;
use crate::shape::length_and_direction;
use std::f64::consts::PI;

/// A closed profile in the half plane of distance from the axis and position along it, m; turned about the axis it bounds a
/// solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Corners `[distance, position]`, in turn so that the solid is on the left of its edges; the last is joined to the first.
    corners: Vec<[f64; 2]>,
    /// Boxes round runs of edges.
    runs: Vec<Run>,
}

/// Edges of a run.
const RUN: usize = 8;
/// How much nearer than it is a box may be found by rounding.
const ROUNDING: f64 = 1e-9;

/// Edges one after another that bound the solid, and the box round them.
#[derive(Debug, Clone, PartialEq)]
struct Run {
    edges: Vec<[[f64; 2]; 2]>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Run {
    fn of(edges: &[[[f64; 2]; 2]]) -> Self {
        let along = |axis: usize| edges.iter().flatten().map(move |corner| corner[axis]);
        let low = [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
        Self { edges: edges.to_vec(), low, high }
    }

    /// Squared distance of its box: no edge is nearer.
    fn distance2(&self, point: [f64; 2]) -> f64 {
        let outside = |axis: usize| (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]).max(0.0);
        outside(0) * outside(0) + outside(1) * outside(1)
    }
}

impl Profile {
    /// A profile of corners `[distance from the axis, position along it]`, in turn, in either sense.
    ///
    /// # Errors
    /// [`SolidError::Profile`] for fewer than three corners, one that is not finite or beyond the axis, edges that cross
    /// or an area of 0.
    pub fn new(mut corners: Vec<[f64; 2]>) -> Result<Self, SolidError> {
        let wrong = |what: String| Err(SolidError::Profile(what));
        if corners.len() < 3 {
            return wrong(format!("it has {} corners; give three or more", corners.len()));
        }
        if let Some(corner) = corners.iter().find(|corner| !corner.iter().all(|x| x.is_finite()) || corner[0] < 0.0) {
            return wrong(format!("{corner:?} is not a distance of 0 or more and a height, both finite"));
        }
        corners.dedup();
        if let Some([one, other]) = crossing_edges(&corners) {
            return wrong(format!("its edges from corners {one} and {other} cross or touch (counted from 0)"));
        }
        let area = twice_area(&corners);
        if area == 0.0 || corners.len() < 3 {
            return wrong("it encloses no area".into());
        }
        if area < 0.0 {
            corners.reverse();
        }
        // Edges on the axis bound nothing.
        let outer: Vec<_> = edges(&corners).filter(|[a, b]| a[0] > 0.0 || b[0] > 0.0).collect();
        let runs = outer.chunks(RUN).map(Run::of).collect();
        Ok(Self { corners, runs })
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        edges(&self.corners)
    }

    /// Signed distance, negative inside, and its gradient.
    pub(crate) fn nearest(&self, point: [f64; 2]) -> (f64, [f64; 2]) {
        let nearest_of =
            |run: &Run| run.edges.iter().map(|edge| from_edge(point, *edge).0).fold(f64::INFINITY, f64::min);
        let first = self.runs.iter().min_by(|a, b| a.distance2(point).total_cmp(&b.distance2(point)));
        let most_of = |run: &Run| (nearest_of(run) * (1.0 + ROUNDING)).max(run.distance2(point));
        let at_most = first.map_or(f64::INFINITY, most_of);
        let near = self.runs.iter().filter(|run| run.distance2(point) <= at_most).flat_map(|run| &run.edges);
        let nearest = near.map(|edge| (from_edge(point, *edge), *edge));
        let ((_, away), edge) = nearest.min_by(|a, b| a.0.0.total_cmp(&b.0.0)).expect("a profile has outer edges");
        let sign = if self.contains(point) { -1.0 } else { 1.0 };
        let (length, direction) = length_and_direction(away);
        let normal = if length > 0.0 { direction.map(|x| sign * x) } else { right_of(edge) };
        (sign * length, normal)
    }

    /// Whether a ray away from the axis leaves through an odd number of edges.
    fn contains(&self, point: [f64; 2]) -> bool {
        // Edges on the axis are crossed by none.
        let beside = |run: &&Run| run.low[1] <= point[1] && point[1] <= run.high[1] && point[0] <= run.high[0];
        let crossed = self.runs.iter().filter(beside).flat_map(|run| &run.edges).filter(|[a, b]| {
            let between = (a[1] > point[1]) != (b[1] > point[1]);
            between && point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossed.count() % 2 == 1
    }

    /// Smallest and largest position along the axis.
    pub(crate) fn range(&self) -> [f64; 2] {
        self.corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| [low.min(c[1]), high.max(c[1])])
    }

    /// Largest distance from the axis.
    pub(crate) fn largest_radius(&self) -> f64 {
        self.corners.iter().map(|corner| corner[0]).fold(0.0, f64::max)
    }

    /// Volume of the solid: the area times the way of its centre of mass (Pappus).
    pub(crate) fn volume(&self) -> f64 {
        let moment = |[a, b]: [[f64; 2]; 2]| (a[0] + b[0]) * (a[0] * b[1] - b[0] * a[1]) / 6.0;
        2.0 * PI * self.edges().map(moment).sum::<f64>()
    }

    /// Surface of the solid: the length times the way of its centre (Pappus).
    pub(crate) fn area(&self) -> f64 {
        self.edges().map(|[a, b]| PI * (a[0] + b[0]) * (b[0] - a[0]).hypot(b[1] - a[1])).sum()
    }
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..corners.len()).map(|start| [corners[start], corners[(start + 1) % corners.len()]])
}

fn twice_area(corners: &[[f64; 2]]) -> f64 {
    edges(corners).map(|[a, b]| a[0] * b[1] - b[0] * a[1]).sum()
}

/// Squared distance from an edge, and the vector from its nearest point.
fn from_edge(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> (f64, [f64; 2]) {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from_start = [point[0] - a[0], point[1] - a[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    let part = ((from_start[0] * along[0] + from_start[1] * along[1]) / length2).clamp(0.0, 1.0);
    let away = [from_start[0] - part * along[0], from_start[1] - part * along[1]];
    (away[0] * away[0] + away[1] * away[1], away)
}

/// Unit vector to the right of an edge: out of the solid.
fn right_of([a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    length_and_direction([b[1] - a[1], a[0] - b[0]]).1
}

/// The first two edges, by their first corners, that meet elsewhere than at the corner they share.
fn crossing_edges(corners: &[[f64; 2]]) -> Option<[usize; 2]> {
    let count = corners.len();
    let edge = |start: usize| [corners[start], corners[(start + 1) % count]];
    let pairs = (0..count).flat_map(|one| (one + 1..count).map(move |other| [one, other]));
    pairs.into_iter().find(|&[one, other]| {
        let neighbours = other == one + 1 || (one == 0 && other == count - 1);
        if neighbours { fold_back(edge(one), edge(other)) } else { meet(edge(one), edge(other)) }
    })
}

/// Twice the area of a triangle, positive where its corners turn left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

fn meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let apart = (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]));
    !apart && turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0
}

/// Whether two edges with a corner in common lie on one another.
fn fold_back(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> bool {
    let (shared, end, far) = if one[1] == other[0] { (one[1], one[0], other[1]) } else { (one[0], one[1], other[0]) };
    let along = (end[0] - shared[0]) * (far[0] - shared[0]) + (end[1] - shared[1]) * (far[1] - shared[1]);
    turn(shared, end, far) == 0.0 && along > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The distance found from all edges, one by one.
    fn of_all_edges(profile: &Profile, point: [f64; 2]) -> f64 {
        let outer = profile.edges().filter(|[a, b]| a[0] > 0.0 || b[0] > 0.0);
        let nearest = outer.map(|edge| from_edge(point, edge).0).fold(f64::INFINITY, f64::min).sqrt();
        let crossed = profile.edges().filter(|[a, b]| {
            let between = (a[1] > point[1]) != (b[1] > point[1]);
            between && point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        if crossed.count() % 2 == 1 { -nearest } else { nearest }
    }

    proptest! {
        /// A star with many corners, some of them on the axis: boxes leave out no edge that counts.
        #[test]
        fn the_nearest_of_all_edges_is_found(
            lengths in prop::collection::vec(0.2..1.0_f64, 3..90),
            points in prop::collection::vec([0.0..2.0_f64, -2.0..2.0], 40),
        ) {
            let count = lengths.len() as f64;
            let corner = |(k, length): (usize, &f64)| {
                let angle = -0.5 * PI + PI * (k as f64 + 0.5) / count;
                [length * angle.cos(), length * angle.sin()]
            };
            let ends = [[0.0, 1.0], [0.0, -1.0]];
            let corners: Vec<[f64; 2]> = lengths.iter().enumerate().map(corner).chain(ends).collect();
            let profile = Profile::new(corners).unwrap();
            for point in points {
                prop_assert_eq!(profile.nearest(point).0, of_all_edges(&profile, point));
            }
        }
    }
}
