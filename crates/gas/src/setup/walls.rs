//! The walls of a set-up, and how those that move by plan do it.

use super::{Setup, Side};
use crate::functions::{cos, sin, tan};
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
    let largest = amplitude * 2.0 / step * tan(0.5 * TAU / f64::from(ARCS));
    let speed = |knot: u64| largest * cos(phase(knot));
    let knot = number as u64;
    Knot {
        time: number as f64 * step,
        displacement: amplitude * sin(phase(knot)),
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

    /// Lengths of the box along an axis at the times when the plan of a wall changes, as far as walls stop in the end or swing.
    pub(super) fn planned_lengths(&self, axis: usize) -> Vec<(f64, f64)> {
        let plans = [0, 1].map(|end| Schedule::of(&self.sides[axis][end]));
        let knots = |plan: &Option<Schedule>| match plan {
            Some(Schedule::Knots(knots)) => knots.clone(),
            Some(swing) => (0..(16 * ARCS) as usize).map_while(|number| swing.knot(number)).collect(),
            None => Vec::new(),
        };
        let (low, high) = (knots(&plans[0]), knots(&plans[1]));
        let displacement =
            |knots: &[Knot], time: f64| match knots.partition_point(|knot| knot.time <= time).checked_sub(1) {
                Some(last) => {
                    let since = time - knots[last].time;
                    knots[last].displacement + since * (knots[last].speed + 0.5 * knots[last].acceleration * since)
                }
                None => 0.0,
            };
        let length = |time: f64| (time, self.size[axis] + displacement(&high, time) - displacement(&low, time));
        low.iter().chain(&high).map(|knot| length(knot.time)).collect()
    }

    fn wall(&self, axis: usize, end: usize, side: &Side) -> Wall {
        let (facing, position) = if end == 0 { (Facing::Up, 0.0) } else { (Facing::Down, self.size[axis]) };
        let mut wall = Wall::fixed(axis, facing, position);
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
