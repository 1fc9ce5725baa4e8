//! The walls of a set-up, and how those that move by plan do it.

use super::place::closest;
use super::{Setup, Side, ball_volume};
use crate::SetupError;
use crate::world::{Facing, Wall};
use std::f64::consts::TAU;

/// Arcs of constant acceleration in one swing of a wall.
const ARCS: u32 = 64;

/// From `time` on a wall moves so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub time: f64,
    /// Displacement from where the wall started.
    pub displacement: f64,
    pub speed: f64,
    pub acceleration: f64,
}

/// A plan of motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Schedule {
    Knots(Vec<Knot>),
    Swing { amplitude: f64, period: f64 },
}

impl Schedule {
    fn of(side: &Side) -> Option<Self> {
        match side {
            Side::Moving { velocity, until } => {
                let start = Knot { time: 0.0, displacement: 0.0, speed: *velocity, acceleration: 0.0 };
                let end = until.map(|time| Knot { time, displacement: velocity * time, speed: 0.0, ..start });
                Some(Self::Knots(std::iter::once(start).chain(end).collect()))
            }
            Side::Displaced(rows) => Some(Self::Knots(straight(rows))),
            Side::Swinging { amplitude, period } => Some(Self::Swing { amplitude: *amplitude, period: *period }),
            _ => None,
        }
    }

    /// The plan's `number`th knot.
    pub fn knot(&self, number: usize) -> Option<Knot> {
        match self {
            Self::Knots(knots) => knots.get(number).copied(),
            Self::Swing { amplitude, period } => Some(arc(*amplitude, *period, number)),
        }
    }
}

/// Knots of a plan that are looked at, at most: those of a swing come round again.
const MOST_KNOTS: usize = 100_000;

impl Schedule {
    /// Times at which the motion changes, up to an end.
    fn changes(&self, until: f64) -> impl Iterator<Item = f64> {
        let times = (0..MOST_KNOTS).map_while(|number| self.knot(number)).map(|knot| knot.time);
        times.take_while(move |&time| time < until)
    }

    /// Displacement at a time.
    fn displacement(&self, time: f64) -> f64 {
        match self {
            Self::Swing { amplitude, period } => amplitude * (TAU * time / period).sin(),
            Self::Knots(knots) => {
                let passed = knots.partition_point(|knot| knot.time <= time);
                let last = passed.checked_sub(1).map(|last| knots[last]);
                last.map_or(0.0, |knot| knot.displacement + knot.speed * (time - knot.time))
            }
        }
    }
}

/// Straight from row to row.
fn straight(rows: &[[f64; 2]]) -> Vec<Knot> {
    let speed_after = |row: usize| match rows.get(row + 1) {
        Some(next) => (next[1] - rows[row][1]) / (next[0] - rows[row][0]),
        None => 0.0,
    };
    let knot = |(row, &[time, displacement]): (usize, &[f64; 2])| Knot {
        time,
        displacement,
        speed: speed_after(row),
        acceleration: 0.0,
    };
    rows.iter().enumerate().map(knot).collect()
}

/// A piece of a swing as a parabola. With the speeds scaled by tan(w h / 2) / (w h / 2), w the angular frequency and h an arc's time,
/// the arcs join smoothly and meet the sine exactly where they join: the trapezoidal sum of cosines is exact.
fn arc(amplitude: f64, period: f64, number: usize) -> Knot {
    let step = period / f64::from(ARCS);
    let phase = |knot: u64| TAU * (knot % u64::from(ARCS)) as f64 / f64::from(ARCS);
    let largest = amplitude * 2.0 / step * (0.5 * TAU / f64::from(ARCS)).tan();
    let speed = |knot: u64| largest * phase(knot).cos();
    let knot = number as u64;
    Knot {
        time: number as f64 * step,
        displacement: amplitude * phase(knot).sin(),
        speed: speed(knot),
        acceleration: (speed(knot + 1) - speed(knot)) / step,
    }
}

impl<const D: usize> Setup<D> {
    /// The walls, with what moves those that move by plan.
    pub(crate) fn walls(&self) -> Vec<(Wall, Option<Schedule>)> {
        let mut walls = Vec::new();
        for axis in 0..D {
            for (end, side) in self.sides[axis].iter().enumerate().filter(|(_, side)| **side != Side::Periodic) {
                walls.push((self.wall(axis, end, side), Schedule::of(side)));
            }
        }
        if let Some(partition) = &self.partition {
            let mut wall = Wall::fixed(partition.axis, Facing::Both, partition.at);
            wall.hole.clone_from(&partition.hole);
            walls.push((wall, None));
        }
        walls
    }

    /// Walls that move by plan leave room for the balls up to an end: otherwise there would be no end of collisions.
    pub(crate) fn check_room(&self, until: f64) -> Result<(), SetupError> {
        let planned: Vec<(Wall, Schedule)> =
            self.walls().into_iter().filter_map(|(wall, plan)| Some((wall, plan?))).collect();
        let mut times: Vec<f64> = planned.iter().flat_map(|(_, plan)| plan.changes(until)).collect();
        times.push(until);
        times.sort_by(f64::total_cmp);
        times.dedup();
        let balls: Vec<(usize, f64)> = self.balls.iter().map(|ball| (1, ball.radius)).collect();
        let crowds = self.species.iter().map(|species| (self.count_of(species), species.radius));
        let all: Vec<(usize, f64)> = balls.into_iter().chain(crowds).collect();
        let filled: f64 = all.iter().map(|&(count, radius)| count as f64 * ball_volume::<D>(radius)).sum();
        let widest = 2.0 * all.iter().map(|&(_, radius)| radius).fold(0.0, f64::max);
        let alike = all.windows(2).all(|pair| pair[0].1 == pair[1].1);
        // Balls of several sizes can lie closer than equal ones.
        let limit = if alike { closest::<D>() } else { 1.0 };
        for time in times.into_iter().filter(|_| !planned.is_empty()) {
            let mut lengths = self.size;
            for (wall, plan) in &planned {
                let inward = if wall.facing == Facing::Up { 1.0 } else { -1.0 };
                lengths[wall.axis] -= inward * plan.displacement(time);
            }
            let packing = filled / lengths.iter().product::<f64>();
            if lengths.iter().any(|&length| length < widest) || packing > limit {
                return Err(SetupError::Crushed { time, limit });
            }
        }
        Ok(())
    }

    fn wall(&self, axis: usize, end: usize, side: &Side) -> Wall {
        let (facing, place) = if end == 0 { (Facing::Up, 0.0) } else { (Facing::Down, self.size[axis]) };
        let mut wall = Wall::fixed(axis, facing, place);
        match side {
            Side::Thermal { temperature } => wall.temperature = Some(self.boltzmann * temperature),
            Side::Piston { mass, pressure, velocity } => {
                let area: f64 = (0..D).filter(|&other| other != axis).map(|other| self.size[other]).product();
                let inward = if end == 0 { 1.0 } else { -1.0 };
                (wall.moves, wall.mass, wall.speed) = (true, Some(*mass), *velocity);
                wall.acceleration = inward * pressure * area / mass;
            }
            Side::Moving { .. } | Side::Displaced(_) | Side::Swinging { .. } => wall.moves = true,
            Side::Fixed | Side::Periodic => {}
        }
        wall
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Amount, Species};

    #[test]
    fn walls_that_would_crush_the_balls_are_refused() {
        let gas = || Setup::<2>::new([10.0, 10.0]).species(Species::new("balls", Amount::Packing(0.4)));
        let moving = |until| gas().side(0, 1, Side::Moving { velocity: -1.0, until });
        assert!(moving(None).check_room(5.0).is_ok());
        assert!(matches!(moving(None).check_room(6.0), Err(SetupError::Crushed { time: 6.0, .. })));
        assert!(moving(Some(5.0)).check_room(60.0).is_ok());
        let swing = |amplitude| gas().side(1, 0, Side::Swinging { amplitude, period: 3.0 });
        assert!(swing(5.0).check_room(60.0).is_ok() && swing(5.0).check_room(0.1).is_ok());
        assert!(swing(6.0).check_room(60.0).is_err() && swing(11.0).check_room(60.0).is_err());
        let both = Side::Displaced(vec![[0.0, 0.0], [2.0, -3.0], [4.0, 0.0]]);
        let other = Side::Displaced(vec![[0.0, 0.0], [2.0, 3.0]]);
        assert!(gas().side(0, 1, both.clone()).check_room(9.0).is_ok());
        assert!(gas().side(0, 1, both).side(0, 0, other).check_room(9.0).is_err());
    }

    #[test]
    fn a_swinging_wall_meets_the_sine_at_every_knot() {
        let plan = Schedule::Swing { amplitude: 2.0, period: 3.0 };
        for number in 0..200 {
            let (knot, next) = (plan.knot(number).unwrap(), plan.knot(number + 1).unwrap());
            assert!((knot.displacement - 2.0 * (TAU * knot.time / 3.0).sin()).abs() < 1e-12);
            let step = next.time - knot.time;
            let reached = knot.displacement + knot.speed * step + 0.5 * knot.acceleration * step * step;
            assert!((reached - next.displacement).abs() < 1e-12, "{number}: {reached} {next:?}");
            assert!((knot.speed + knot.acceleration * step - next.speed).abs() < 1e-12);
        }
    }
}
