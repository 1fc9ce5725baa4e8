//! Drops that stay, slide and leave.

use super::{Drop, Drops, dot, without};
use std::f64::consts::PI;

/// A drop moves by at most this part of the radius that it covers before it is looked for what it met.
const LONGEST_WAY: f64 = 0.25;

/// A drop cannot follow a surface that bends away by more than this at an edge: cosine of 45 degrees.
const SHARPEST_BEND: f64 = 0.707;

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

    /// Drops that slide take up the drops below them that are not seen.
    fn sweep(&mut self) {
        let mut drops = std::mem::take(&mut self.state.drops);
        let mut unseen = std::mem::take(&mut self.state.unseen);
        for drop in drops.iter_mut().filter(|drop| drop.velocity != [0.0; 3]) {
            let mut swept = 0.0;
            self.sites_under(drop, |site| swept += std::mem::take(&mut unseen[site]));
            drop.mass += swept;
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
        let rim = 2.0 * PI * self.covered_radius(drop);
        drop.mass * dot(self.laws.gravity, drop.normal)
            > rim * self.laws.surface_tension * self.laws.contact_angle.sin()
    }

    /// Deceleration by friction at its bound, friction x pressure x covered area / mass (patent CN106650064B).
    fn friction(&self, drop: &Drop) -> f64 {
        self.laws.friction * self.laws.pressure * PI * self.covered_radius(drop).powi(2) / drop.mass
    }

    /// The time in which a drop moves by [`LONGEST_WAY`], s; without end where it stays.
    fn longest_step(&self, drop: &Drop) -> f64 {
        let along = without(self.laws.gravity, drop.normal);
        let speed = dot(drop.velocity, drop.velocity).sqrt();
        let faster = (dot(along, along).sqrt() - self.friction(drop)).max(0.0);
        if speed == 0.0 && faster == 0.0 {
            return f64::INFINITY;
        }
        let way = LONGEST_WAY * self.covered_radius(drop);
        2.0 * way / (speed + (speed * speed + 2.0 * faster * way).sqrt())
    }

    /// Velocity of a drop after a time: friction works against it, and at rest against what would move the drop, up to its bound.
    fn velocity_after(&self, drop: &Drop, time: f64) -> [f64; 3] {
        let along = without(self.laws.gravity, drop.normal);
        let free: [f64; 3] = std::array::from_fn(|axis| drop.velocity[axis] + time * along[axis]);
        let (speed, held) = (dot(free, free).sqrt(), time * self.friction(drop));
        if speed <= held { [0.0; 3] } else { free.map(|x| x * (1.0 - held / speed)) }
    }

    /// The drop after a step along the surface; none where it leaves at an edge or out of the room.
    fn moved(&self, drop: Drop, step: f64) -> Option<Drop> {
        let velocity = self.velocity_after(&drop, step);
        if velocity == [0.0; 3] {
            return Some(Drop { velocity, ..drop });
        }
        let mean: [f64; 3] = std::array::from_fn(|axis| 0.5 * (drop.velocity[axis] + velocity[axis]));
        let ahead = std::array::from_fn(|axis| drop.position[axis] + step * mean[axis]);
        // A solid that stands in the way takes the drop over.
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
