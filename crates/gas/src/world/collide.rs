//! What a collision of two balls does.

use super::World;
use super::contact::Mode;
use serde::{Deserialize, Serialize};

/// How balls rebound from each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rebound {
    /// Relative normal speed after over before.
    pub restitution: f64,
    /// A ball that collides again within this time does so without loss (TC model: Luding and McNamara, Granular Matter 1,
    /// 1998, 113), which keeps infinitely many collisions from happening in finite time.
    pub contact_time: f64,
}

/// The shortest path between two collisions, over the distance of centres, that counts as one.
const SHORTEST: f64 = 1e-10;

impl<const D: usize> World<D> {
    /// Two balls that touch now rebound.
    #[inline(always)]
    pub fn collide<M: Mode>(&mut self, a: usize, b: usize) {
        let flown = self.now - self.balls[a].time.max(self.balls[b].time);
        for ball in [a, b] {
            self.book_flight::<M>(ball);
            self.bring::<M>(ball);
        }
        let (me, other) = (&self.balls[a], &self.balls[b]);
        let (kind_a, kind_b) = (self.kinds[me.kind as usize], self.kinds[other.kind as usize]);
        let mut apart: [f64; D] = std::array::from_fn(|axis| other.position[axis] - me.position[axis]);
        let mut images = 0.0;
        if M::SHEARS {
            images = self.field.nearest_in_shear(&mut apart, self.now);
        } else {
            self.field.nearest(&mut apart);
        }
        let (mut approach, mut apart2) = (0.0, 0.0);
        for axis in 0..D {
            approach += apart[axis] * (other.velocity[axis] - me.velocity[axis]);
            apart2 += apart[axis] * apart[axis];
        }
        if M::SHEARS {
            approach += apart[0] * images * self.field.slide.speed;
        }
        let reduced = kind_a.mass * kind_b.mass / (kind_a.mass + kind_b.mass);
        let mut elasticity = 2.0;
        if self.rebound.restitution < 1.0 {
            elasticity = self.lossy(a, b, 0.5 * reduced * approach * approach / apart2);
        }
        if M::GROWS {
            // The surfaces must part, not the centres.
            approach -= (kind_a.radius + kind_b.radius) * self.field.growth * apart2.sqrt();
        }
        let impulse = elasticity * reduced * approach / apart2;
        if !impulse.is_finite() {
            return self.refuse(a);
        }
        if let Some(moments) = &mut self.moments {
            let velocity = &self.balls[a].velocity;
            let mut gain = 0.0;
            for axis in 0..D {
                gain += impulse * apart[axis] * (velocity[axis] + 0.5 * impulse / kind_a.mass * apart[axis]);
            }
            moments.collide(&apart, impulse, gain);
        }
        for axis in 0..D {
            self.balls[a].velocity[axis] += impulse / kind_a.mass * apart[axis];
            self.balls[b].velocity[axis] -= impulse / kind_b.mass * apart[axis];
        }
        if M::SHEARS {
            // What the image gains beside the ball itself, which is slower by the image's speed.
            self.tally.shear.book(images * self.field.slide.speed * impulse * apart[0]);
        }
        self.tally.collisions += 1;
        self.tally.virial -= elasticity * reduced * approach;
        if !self.regions.is_empty() {
            self.count_in_regions(self.balls[a].position, apart, -elasticity * reduced * approach);
        }
        self.watch(flown * approach.abs(), apart2);
        if self.followed.is_some() {
            self.note_collision(a, b);
        }
    }

    /// 1 + the restitution of this collision; books the energy that it costs of what is in the normal motion.
    #[cold]
    fn lossy(&mut self, a: usize, b: usize, energy: f64) -> f64 {
        let last = self.records[a].collided.max(self.records[b].collided);
        (self.records[a].collided, self.records[b].collided) = (self.now, self.now);
        if self.now - last < self.rebound.contact_time {
            return 2.0;
        }
        let e = self.rebound.restitution;
        self.tally.dissipated.add((1.0 - e * e) * energy);
        1.0 + e
    }

    /// An event of a ball does not happen, and ends the run.
    #[cold]
    pub fn refuse(&mut self, ball: usize) {
        self.refused = Some(ball);
    }

    /// Counts collisions in a row between which nothing moved: path times distance against distance squared.
    #[inline(always)]
    pub fn watch(&mut self, path: f64, apart2: f64) {
        self.standstill = if path > SHORTEST * apart2 { 0 } else { self.standstill + 1 };
    }
}

/// Collisions in a row between which nothing moves, at which a gas is given up: with loss and without a guard they are a collapse
/// that rounding errors may end; else balls are jammed.
const STANDSTILL: [u32; 2] = [20, 10_000];

impl<const D: usize> World<D> {
    /// True where collisions follow each other without anything moving, or an event was refused.
    #[inline(always)]
    pub fn stands_still(&self) -> bool {
        let unguarded = self.rebound.restitution < 1.0 && self.rebound.contact_time == 0.0;
        self.standstill > STANDSTILL[usize::from(!unguarded)] || self.refused.is_some()
    }
}

/// Magnitude of a velocity.
#[inline(always)]
pub(crate) fn speed<const D: usize>(velocity: &[f64; D]) -> f64 {
    velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
}
