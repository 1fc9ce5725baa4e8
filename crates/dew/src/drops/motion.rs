//! Drops that stay, slide and leave.

use super::{Drop, Drops, Retention, contact_line, dot, without};
use std::f64::consts::PI;

/// Largest displacement of a drop between two tests for contacts, over the radius that it covers.
const MAX_DISPLACEMENT: f64 = 0.25;

/// A drop cannot follow a surface that bends away by more than this at an edge: cosine of 45 degrees.
pub(super) const SHARPEST_BEND: f64 = 0.707;

impl Drops {
    /// Moves the drops that their weight moves, in steps short enough to sweep up all that they meet.
    pub(super) fn slide(&mut self, time: f64) {
        let mut left = time;
        loop {
            self.keep(|drops, drop| (!drops.falls(&drop)).then_some(drop));
            let longest = self.state.drops.iter().map(|drop| self.longest_step(drop)).fold(f64::INFINITY, f64::min);
            let step = longest.min(left);
            self.keep(|drops, drop| drops.moved(drop, step));
            self.sweep();
            self.merge();
            left -= step;
            if left <= 0.0 {
                return;
            }
        }
    }

    /// Merges unresolved drops into the sliding drops above them.
    fn sweep(&mut self) {
        let mut drops = std::mem::take(&mut self.state.drops);
        let mut unseen = std::mem::take(&mut self.state.unseen);
        for drop in drops.iter_mut().filter(|drop| drop.velocity != [0.0; 3]) {
            let mut swept = 0.0;
            self.sites_under(drop, |site| swept += std::mem::take(&mut unseen[site]));
            drop.mass += swept;
            drop.radius = self.line.radius(drop.radius, drop.mass / self.laws.density);
        }
        (self.state.drops, self.state.unseen) = (drops, unseen);
    }

    /// Puts what `stays` makes of it in the place of each drop; where that is nothing it has left, and is counted as dripped.
    fn keep(&mut self, stays: impl Fn(&Self, Drop) -> Option<Drop>) {
        let drops = std::mem::take(&mut self.state.drops);
        let mut kept = Vec::with_capacity(drops.len());
        for drop in drops {
            match stays(self, drop) {
                Some(drop) => kept.push(drop),
                None => {
                    self.state.dripped.add(drop.mass);
                    self.state.dripped_count += 1;
                }
            }
        }
        self.state.drops = kept;
    }

    /// Whether a drop falls from an overhang: its weight is more than surface tension holds at its rim,
    /// 2 pi a gamma sin(angle) (Tate 1864, with the contact angle at the solid).
    fn falls(&self, drop: &Drop) -> bool {
        let rim = 2.0 * PI * drop.radius;
        drop.mass * dot(self.laws.gravity, drop.normal)
            > rim * self.laws.surface_tension * self.laws.contact_angle.sin()
    }

    /// The largest deceleration by what holds a drop, m/s2: see [`Retention`].
    fn retention(&self, drop: &Drop) -> f64 {
        let force = match self.laws.retention {
            Retention::Hysteresis { receding, advancing } => {
                2.0 * drop.radius * self.laws.surface_tension * (receding.cos() - advancing.cos())
            }
            Retention::Friction(friction) => friction * self.laws.pressure * PI * drop.radius.powi(2),
        };
        force / drop.mass
    }

    /// Rate at which viscosity brakes a drop, 1/s.
    fn braking(&self, drop: &Drop) -> f64 {
        contact_line::drag(drop.radius, self.angle(drop), self.laws.viscosity) / drop.mass
    }

    /// The time in which a drop moves by [`MAX_DISPLACEMENT`], s; without end where it stays.
    fn longest_step(&self, drop: &Drop) -> f64 {
        let along = without(self.laws.gravity, drop.normal);
        let speed = dot(drop.velocity, drop.velocity).sqrt();
        let faster = (dot(along, along).sqrt() - self.retention(drop)).max(0.0);
        if speed == 0.0 && faster == 0.0 {
            return f64::INFINITY;
        }
        let displacement = MAX_DISPLACEMENT * drop.radius;
        let unbraked = 2.0 * displacement / (speed + (speed * speed + 2.0 * faster * displacement).sqrt());
        // It does not exceed its final speed.
        let fastest = speed.max(faster / self.braking(drop));
        if fastest.is_finite() { unbraked.max(displacement / fastest) } else { unbraked }
    }

    /// Velocity of a drop after a time, and its mean until then, m/s: what holds the drop works against its motion, and at rest against what would move it,
    /// up to its bound; viscosity brakes it. Exact where it goes on straight.
    fn velocity_after(&self, drop: &Drop, time: f64) -> [[f64; 3]; 2] {
        let along = without(self.laws.gravity, drop.normal);
        let braked = time * self.braking(drop);
        // Means of exp(-b t) over the time, and of its integral over the time: without cancellation where hardly anything is braked.
        let [first, second] = if braked > 1e-4 {
            let first = -(-braked).exp_m1() / braked;
            [first, (1.0 - first) / braked]
        } else {
            [1.0 - 0.5 * braked, 0.5 - braked / 6.0]
        };
        let left = (-braked).exp();
        let free: [f64; 3] = std::array::from_fn(|axis| left * drop.velocity[axis] + first * time * along[axis]);
        let (speed, held) = (dot(free, free).sqrt(), self.retention(drop));
        if speed <= first * time * held {
            return [[0.0; 3]; 2];
        }
        let faster: [f64; 3] = std::array::from_fn(|axis| along[axis] - held * free[axis] / speed);
        let after = std::array::from_fn(|axis| left * drop.velocity[axis] + first * time * faster[axis]);
        let mean = std::array::from_fn(|axis| first * drop.velocity[axis] + second * time * faster[axis]);
        [after, mean]
    }

    /// The drop after a step along the surface; none where it leaves at an edge or out of the room.
    fn moved(&self, drop: Drop, step: f64) -> Option<Drop> {
        let [velocity, mean] = self.velocity_after(&drop, step);
        if velocity == [0.0; 3] {
            return Some(Drop { velocity, ..drop });
        }
        let ahead = std::array::from_fn(|axis| drop.position[axis] + step * mean[axis]);
        // A solid in its path takes the drop.
        let mut others = (0..self.solids.len() as u32).filter(|&other| other != drop.solid);
        let in_the_way = others.find(|&other| self.solids[other as usize].signed_distance(ahead) < 0.0);
        let solid = in_the_way.unwrap_or(drop.solid);
        let (position, normal) = self.foot(solid, ahead);
        let bends_away = dot(drop.normal, normal) < SHARPEST_BEND && dot(velocity, normal) > 0.0;
        if bends_away || !self.is_in_room(position) {
            return None;
        }
        Some(Drop { solid, position, normal, velocity: without(velocity, normal), ..drop })
    }
}
