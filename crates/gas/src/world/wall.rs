//! Walls: what bounds the gas, moves it, heats it or divides it.

use super::ball::Ball;
use super::contact::{Field, Mode};
use serde::{Deserialize, Serialize};

/// On which side of a wall its gas is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Facing {
    /// Towards larger coordinates: the lower wall of a box.
    Up,
    /// Towards smaller coordinates: the upper wall of a box.
    Down,
    /// On both: a partition.
    Both,
}

/// A ball's path without a hit crosses a plane no more than twice; to go in and out are two passages.
const MOST_PASSAGES: usize = 6;

/// A plane across one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Wall {
    pub axis: usize,
    pub facing: Facing,
    /// Position, speed and acceleration at `since`, in the window.
    pub position: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub since: f64,
    /// How often its motion changed: predictions made before are out of date.
    pub bends: u32,
    /// Mass of a wall that is free to move; `None` for one that no hit moves.
    pub mass: Option<f64>,
    /// Temperature that it gives to what hits it.
    pub temperature: Option<f64>,
    /// Opening in the wall, from and to along each of the other axes.
    pub hole: Option<Vec<[f64; 2]>>,
    /// False for a wall that stays where it is.
    pub moves: bool,
    /// False once it is lifted.
    pub present: bool,
}

impl Wall {
    /// A wall at rest that reflects.
    pub fn fixed(axis: usize, facing: Facing, position: f64) -> Self {
        Wall {
            axis,
            facing,
            position,
            speed: 0.0,
            acceleration: 0.0,
            since: 0.0,
            bends: 0,
            mass: None,
            temperature: None,
            hole: None,
            moves: false,
            present: true,
        }
    }

    pub fn position_at(&self, time: f64) -> f64 {
        let since = time - self.since;
        self.position + self.speed * since + 0.5 * self.acceleration * since * since
    }

    pub fn speed_at(&self, time: f64) -> f64 {
        self.speed + self.acceleration * (time - self.since)
    }

    /// Goes on from `time` at another speed, from the position it has there.
    pub fn bend(&mut self, time: f64, speed: f64) {
        (self.position, self.speed, self.since) = (self.position_at(time), speed, time);
        self.bends = self.bends.wrapping_add(1);
    }

    /// When a ball hits the wall; infinite for never.
    #[inline(always)]
    pub fn meeting<const D: usize, M: Mode>(&self, ball: &Ball<D>, radius: f64, field: &Field<D>) -> f64 {
        if !self.present {
            return f64::INFINITY;
        }
        if let Some(hole) = &self.hole {
            return self.meeting_past_hole::<D, M>(hole, ball, radius, field);
        }
        let start = ball.time.max(self.since);
        let (position, velocity) = field.state::<M>(ball, start);
        let above = position[self.axis] - self.position_at(start);
        let rising = velocity[self.axis] - self.speed_at(start);
        let bending = if M::FALLS { field.gravity[self.axis] } else { 0.0 } - self.acceleration;
        let up = match self.facing {
            Facing::Up => true,
            Facing::Down => false,
            Facing::Both => above > 0.0,
        };
        let side = if up { 1.0 } else { -1.0 };
        let (reach, growth) =
            if M::GROWS { (radius * field.scale_at::<M>(start), radius * field.growth) } else { (radius, 0.0) };
        start + first_contact(side * above - reach, side * rising - growth, side * bending)
    }

    /// As [`Wall::meeting`], for a partition with a hole: a ball that comes to the plane before the hole goes through and may come
    /// back.
    #[cold]
    fn meeting_past_hole<const D: usize, M: Mode>(
        &self,
        hole: &[[f64; 2]],
        ball: &Ball<D>,
        radius: f64,
        field: &Field<D>,
    ) -> f64 {
        let bending = if M::FALLS { field.gravity[self.axis] } else { 0.0 };
        let mut time = ball.time.max(self.since);
        let motion = |time: f64| {
            let (position, velocity) = field.state::<M>(ball, time);
            (position[self.axis] - self.position, velocity[self.axis])
        };
        let mut inside = motion(time).0.abs() < radius * (1.0 - 1e-9);
        for _ in 0..MOST_PASSAGES {
            let (above, rising) = motion(time);
            if inside {
                let up = first_contact(radius - above, -rising, -bending);
                let down = first_contact(radius + above, rising, bending);
                time += up.min(down);
            } else {
                let side = if above > 0.0 { 1.0 } else { -1.0 };
                time += first_contact(side * above - radius, side * rising, side * bending);
            }
            if time == f64::INFINITY || (!inside && !self.passes(hole, &field.state::<M>(ball, time).0)) {
                return time;
            }
            inside = !inside;
        }
        f64::INFINITY
    }

    /// True where a ball's centre at `position` lies before the hole.
    fn passes<const D: usize>(&self, hole: &[[f64; 2]], position: &[f64; D]) -> bool {
        let across = (0..D).filter(|&axis| axis != self.axis);
        across.zip(hole).all(|(axis, &[from, to])| (from..=to).contains(&position[axis]))
    }
}

/// Time until a gap closes that is `gap` now, changes at `rate`, itself at `bend`: the first root of
/// gap + rate t + bend t^2 / 2 at which the gap is closing. A gap that is closed (by rounding) and closing closes at once; one
/// that opens is given the time it comes back.
#[inline(always)]
pub(crate) fn first_contact(gap: f64, rate: f64, bend: f64) -> f64 {
    if bend == 0.0 {
        return if rate < 0.0 { gap.max(0.0) / -rate } else { f64::INFINITY };
    }
    if gap <= 0.0 && (rate < 0.0 || (rate == 0.0 && bend < 0.0)) {
        return 0.0;
    }
    let inside = rate * rate - 2.0 * bend * gap;
    if bend < 0.0 {
        // The gap closes in the end. With a gap closed by rounding, not before it stops opening.
        let root = inside.max(0.0).sqrt();
        return if rate <= 0.0 { 2.0 * gap / (root - rate) } else { (rate + root) / -bend };
    }
    if rate >= 0.0 || inside < 0.0 {
        return f64::INFINITY;
    }
    2.0 * gap / (inside.sqrt() - rate)
}

#[cfg(test)]
mod tests {
    use super::first_contact;

    #[test]
    fn a_gap_closes_at_the_first_root() {
        assert_eq!(first_contact(2.0, -1.0, 0.0), 2.0);
        assert_eq!(first_contact(2.0, 1.0, 0.0), f64::INFINITY);
        assert_eq!(first_contact(-1e-17, -1.0, 0.0), 0.0);
        // Thrown up at 1 with gravity 2: back after 1.
        assert!((first_contact(0.0, 1.0, -2.0) - 1.0).abs() < 1e-15);
        assert!((first_contact(-1e-17, 1.0, -2.0) - 1.0).abs() < 1e-15);
        // Dropped from 1 with gravity 2: after 1.
        assert!((first_contact(1.0, 0.0, -2.0) - 1.0).abs() < 1e-15);
        // A wall that is fled at growing speed is met or not.
        assert_eq!(first_contact(1.0, -1.0, 2.0), f64::INFINITY);
        assert!((first_contact(0.25, -1.0, 1.0) - (1.0 - 0.5_f64.sqrt())).abs() < 1e-15);
    }
}
