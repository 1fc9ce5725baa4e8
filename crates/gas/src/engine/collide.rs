//! What a collision does.

use super::Engine;
use super::contact::Mode;
use serde::{Deserialize, Serialize};

/// How balls rebound from each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rebound {
    /// Relative normal speed after over before.
    pub restitution: f64,
    /// A ball that collides again within this time does so elastically (the TC model: Luding and McNamara, Granular
    /// Matter 1, 1998, 113), which keeps infinitely many collisions from happening in finite time.
    pub contact_time: f64,
}

/// Sums over what happened.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Collisions of two balls.
    pub collisions: u64,
    /// Sum over collisions of (place of one as seen from the other) . (momentum given to it).
    pub virial: f64,
    /// Length of all paths between collisions of balls.
    pub path: f64,
    /// Cell edges crossed, walls hit, and looks at what comes next because a partner was lost.
    pub crossings: u64,
    pub wall_hits: u64,
    pub disturbed: u64,
    /// Energy lost in collisions.
    pub dissipated: crate::sum::ExactSum,
}

impl<const D: usize> Engine<D> {
    /// Moves a ball along its path to now.
    #[inline(always)]
    pub(super) fn bring<M: Mode>(&mut self, ball: usize) {
        let (position, velocity) = self.field.state::<M>(&self.balls[ball], self.now);
        let ball = &mut self.balls[ball];
        (ball.position, ball.velocity, ball.time) = (position, velocity, self.now);
    }

    /// Two balls that touch rebound.
    #[inline(always)]
    pub(super) fn collide<M: Mode>(&mut self, a: usize, b: usize) {
        let flown = self.now - self.balls[a].time.max(self.balls[b].time);
        for ball in [a, b] {
            let since = self.now - self.records[ball].collided;
            self.tally.path += speed(&self.balls[ball].velocity) * (self.now - self.balls[ball].time);
            self.bring::<M>(ball);
            self.events[ball].bends = self.events[ball].bends.wrapping_add(1);
            let _ = since;
        }
        let (me, other) = (&self.balls[a], &self.balls[b]);
        let (kind_a, kind_b) = (self.kinds[me.kind as usize], self.kinds[other.kind as usize]);
        let mut apart: [f64; D] = std::array::from_fn(|axis| other.position[axis] - me.position[axis]);
        self.field.nearest(&mut apart);
        let (mut approach, mut apart2) = (0.0, 0.0);
        for axis in 0..D {
            approach += apart[axis] * (other.velocity[axis] - me.velocity[axis]);
            apart2 += apart[axis] * apart[axis];
        }
        let reduced = kind_a.mass * kind_b.mass / (kind_a.mass + kind_b.mass);
        let mut elasticity = 2.0;
        if self.rebound.restitution < 1.0 {
            let last = self.records[a].collided.max(self.records[b].collided);
            if self.now - last > self.rebound.contact_time {
                let e = self.rebound.restitution;
                elasticity = 1.0 + e;
                self.tally.dissipated.add(0.5 * reduced * (1.0 - e * e) * approach * approach / apart2);
            }
            self.records[a].collided = self.now;
            self.records[b].collided = self.now;
        }
        if M::GROWS {
            // The surfaces must part, not the centres.
            let reach = kind_a.radius + kind_b.radius;
            approach -= reach * self.field.growth * apart2.sqrt();
        }
        let impulse = elasticity * reduced * approach / apart2;
        for axis in 0..D {
            self.balls[a].velocity[axis] += impulse / kind_a.mass * apart[axis];
            self.balls[b].velocity[axis] -= impulse / kind_b.mass * apart[axis];
        }
        self.tally.collisions += 1;
        self.tally.virial -= elasticity * reduced * approach;
        self.watch(flown * approach.abs(), apart2);
    }

    /// Counts collisions in a row between which nothing moved: path times distance against distance squared.
    #[inline(always)]
    pub(super) fn watch(&mut self, path: f64, apart2: f64) {
        self.standstill = if path > SHORTEST * apart2 { 0 } else { self.standstill + 1 };
    }
}

/// The shortest path between two collisions, over the distance of centres, that counts as one.
const SHORTEST: f64 = 1e-10;

#[inline(always)]
pub(super) fn speed<const D: usize>(velocity: &[f64; D]) -> f64 {
    velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
}
