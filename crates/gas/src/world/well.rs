//! Square wells: pairs of balls closer than a distance have less potential energy by a depth, the same at every distance.
//!
//! Forces act in no time at the rim of a well, as at contact (Alder & Wainwright, J. Chem. Phys. 31, 1959, 459, section II). Whether a pair
//! is in its well is kept and changed at the rim only: it is never found again from distances, which are rounded.

use super::World;
use super::contact::{Mode, Path, Quadratic};
use crate::hash::Hash;
use serde::{Deserialize, Serialize};

/// The wells of all balls, and the pairs that are in them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Well {
    /// Energy that a pair needs to part; negative for a step that it needs energy to climb when it meets.
    pub depth: f64,
    /// Distance of centres at the rim, over that at contact.
    pub width: f64,
    /// For each ball the balls that are in a well with it.
    bound: Vec<Vec<u32>>,
    pub tally: RimTally,
}

/// What happened at the rims of wells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct RimTally {
    /// Pairs that went in.
    pub captures: u64,
    /// Pairs that went out.
    pub escapes: u64,
    /// Pairs that turned back at the rim.
    pub returns: u64,
}

impl Well {
    pub fn new(depth: f64, width: f64, balls: usize) -> Self {
        Well { depth, width, bound: vec![Vec::new(); balls], tally: RimTally::default() }
    }

    /// Balls that are in a well with a ball.
    #[inline(always)]
    pub fn bound_to(&self, ball: usize) -> &[u32] {
        &self.bound[ball]
    }

    /// Number of pairs that are in their wells.
    pub fn pairs(&self) -> u64 {
        self.bound.iter().map(|balls| balls.len() as u64).sum::<u64>() / 2
    }

    /// Potential energy of all pairs.
    pub fn energy(&self) -> f64 {
        -self.depth * self.pairs() as f64
    }

    #[inline(always)]
    pub fn are_bound(&self, a: usize, b: usize) -> bool {
        self.bound[a].contains(&(b as u32))
    }

    fn bind(&mut self, a: usize, b: usize) {
        self.bound[a].push(b as u32);
        self.bound[b].push(a as u32);
    }

    fn part(&mut self, a: usize, b: usize) {
        self.bound[a].retain(|&ball| ball as usize != b);
        self.bound[b].retain(|&ball| ball as usize != a);
    }

    /// Puts the balls in another order.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut now_at = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&from, to)| now_at[from as usize] = to);
        let moved = |&from: &u32| self.bound[from as usize].iter().map(|&ball| now_at[ball as usize]).collect();
        self.bound = order.iter().map(moved).collect();
    }

    /// A ball comes in at the end of the list; `near` are the balls in a well with it.
    fn add(&mut self, near: &[usize]) {
        let ball = self.bound.len();
        self.bound.push(Vec::new());
        near.iter().for_each(|&other| self.bind(ball, other));
    }

    /// A ball is taken out; the last takes its position in the list. Returns how many pairs it was in.
    pub fn swap_remove(&mut self, ball: usize) -> usize {
        let partners = self.bound[ball].clone();
        partners.iter().for_each(|&other| self.part(ball, other as usize));
        let last = self.bound.len() - 1;
        for other in self.bound[last].clone() {
            let list = &mut self.bound[other as usize];
            list.iter_mut().filter(|number| **number as usize == last).for_each(|number| *number = ball as u32);
        }
        self.bound.swap_remove(ball);
        partners.len()
    }

    /// True where lists of a saved state can be those of so many balls.
    pub fn fits(&self, balls: usize) -> bool {
        let known = |ball: usize, other: u32| {
            (other as usize) < balls && other as usize != ball && self.are_bound(other as usize, ball)
        };
        self.bound.len() == balls
            && self.bound.iter().enumerate().all(|(ball, list)| list.iter().all(|&other| known(ball, other)))
    }
}

impl<const D: usize> World<D> {
    /// Distance of the centres of two balls at contact.
    pub fn contact(&self, a: usize, b: usize) -> f64 {
        self.radius(a) + self.radius(b)
    }

    /// Distance within which a ball acts on one of the same size: that of contact, or of the rim of a well.
    pub fn reach(&self, ball: usize) -> f64 {
        2.0 * self.radius(ball) * self.well.as_ref().map_or(1.0, |well| well.width)
    }

    /// Gives all balls wells. Pairs are in them that are as near now.
    pub fn dig_wells(&mut self, depth: f64, width: f64) {
        let mut well = Well::new(depth, width, 0);
        let mut hash = self.hash_for_wells(width);
        for ball in 0..self.balls.len() {
            let position = self.state(ball, self.now).0;
            well.add(&self.near_for_well(&hash, ball, width));
            hash.add(position, self.radius(ball));
        }
        self.well = Some(well);
    }

    /// The last ball of the list has come in: the pairs it is in are those that are near now. Returns how many.
    pub fn dig_last_well(&mut self) -> usize {
        let Some(width) = self.well.as_ref().map(|well| well.width) else { return 0 };
        let last = self.balls.len() - 1;
        let mut hash = self.hash_for_wells(width);
        (0..last).for_each(|ball| hash.add(self.state(ball, self.now).0, self.radius(ball)));
        let near = self.near_for_well(&hash, last, width);
        if let Some(well) = &mut self.well {
            well.add(&near);
        }
        near.len()
    }

    fn hash_for_wells(&self, width: f64) -> Hash<D> {
        let largest = self.kinds.iter().map(|kind| 2.0 * kind.radius * width).fold(0.0, f64::max);
        let extent: [[f64; 2]; D] = std::array::from_fn(|axis| self.extent(axis, self.now));
        let (low, length) = (extent.map(|[low, _]| low), extent.map(|[low, high]| high - low));
        Hash::new(low, length, self.field.period, largest, self.balls.len())
    }

    /// Balls that are filed and in whose wells a ball is.
    fn near_for_well(&self, hash: &Hash<D>, ball: usize, width: f64) -> Vec<usize> {
        let mut near = Vec::new();
        hash.near(&self.state(ball, self.now).0, |other, distance| {
            if distance < width * self.contact(ball, other) {
                near.push(other);
            }
        });
        near
    }

    /// What happens next to a pair in its well: when, and whether it is at the rim. (Else it is at contact.)
    #[inline(always)]
    pub fn next_in_well<M: Mode>(&self, well: &Well, a: usize, b: usize) -> (f64, bool) {
        let path = |ball: usize| {
            let ball = &self.balls[ball];
            Path { position: ball.position, velocity: ball.velocity, time: ball.time }
        };
        let (path_a, path_b) = (path(a), path(b));
        let offset = self.image_of_bound(a, b);
        let contact = self.contact(a, b);
        let core = Quadratic::new::<D, M>(&path_a, &path_b, &offset, contact, &self.field);
        if core.maybe_before::<M>(f64::INFINITY) {
            return (core.root::<M>(), false);
        }
        (Quadratic::leaving::<D, M>(&path_a, &path_b, &offset, contact * well.width, &self.field), true)
    }

    /// From where ball `b` is to its image that is in a well with `a`: the nearest now, since the box is wider than three wells.
    #[inline(always)]
    fn image_of_bound(&self, a: usize, b: usize) -> [f64; D] {
        let (position_a, position_b) = (self.state(a, self.now).0, self.state(b, self.now).0);
        std::array::from_fn(|axis| {
            let period = self.field.period[axis];
            if period == 0.0 {
                return 0.0;
            }
            -period * ((position_b[axis] - position_a[axis]) / period).round_ties_even()
        })
    }

    /// A pair comes to the rim of its well now: it goes in, goes out, or turns back where its motion along the line of centres has too
    /// little energy.
    pub fn cross_rim<M: Mode>(&mut self, a: usize, b: usize) {
        let Some(well) = &self.well else { return };
        let (inside, depth) = (well.are_bound(a, b), well.depth);
        let flown = self.now - self.balls[a].time.max(self.balls[b].time);
        for ball in [a, b] {
            self.book_flight::<M>(ball);
            self.bring::<M>(ball);
        }
        let (apart, approach) = self.line_of_centres(a, b);
        let apart2: f64 = apart.iter().map(|x| x * x).sum();
        let (mass_a, mass_b) = (self.mass(a), self.mass(b));
        let reduced = mass_a * mass_b / (mass_a + mass_b);
        let (outward, gain) = if inside { (1.0, -depth) } else { (-1.0, depth) };
        // The square of the distance times its rate of change, after the kinetic energy has changed.
        let squared = approach * approach + 2.0 * gain * apart2 / reduced;
        let passes = squared > 0.0;
        let after = if passes { outward * squared.sqrt() } else { -outward * approach.abs() };
        let impulse = reduced * (approach - after) / apart2;
        if !impulse.is_finite() {
            return self.refuse(a);
        }
        self.push_apart(a, b, &apart, impulse);
        if let Some(well) = &mut self.well {
            let tally = &mut well.tally;
            match (inside, passes) {
                (_, false) => tally.returns += 1,
                (true, true) => tally.escapes += 1,
                (false, true) => tally.captures += 1,
            }
            match (inside, passes) {
                (_, false) => {}
                (true, true) => well.part(a, b),
                (false, true) => well.bind(a, b),
            }
        }
        self.watch(flown * approach.abs(), apart2);
        self.note_bend(a);
        self.note_bend(b);
    }

    /// The line from one ball to the nearest image of another, and its product with the relative velocity.
    fn line_of_centres(&self, a: usize, b: usize) -> ([f64; D], f64) {
        let (me, other) = (&self.balls[a], &self.balls[b]);
        let mut apart: [f64; D] = std::array::from_fn(|axis| other.position[axis] - me.position[axis]);
        self.field.nearest(&mut apart);
        let approach = (0..D).map(|axis| apart[axis] * (other.velocity[axis] - me.velocity[axis])).sum();
        (apart, approach)
    }

    /// Two balls exchange the momentum `impulse` times `apart`.
    fn push_apart(&mut self, a: usize, b: usize, apart: &[f64; D], impulse: f64) {
        let (mass_a, mass_b) = (self.mass(a), self.mass(b));
        let apart2: f64 = apart.iter().map(|x| x * x).sum();
        if let Some(moments) = &mut self.moments {
            let velocity = &self.balls[a].velocity;
            let gain = |axis: usize| impulse * apart[axis] * (velocity[axis] + 0.5 * impulse / mass_a * apart[axis]);
            moments.collide(apart, impulse, (0..D).map(gain).sum());
        }
        for axis in 0..D {
            self.balls[a].velocity[axis] += impulse / mass_a * apart[axis];
            self.balls[b].velocity[axis] -= impulse / mass_b * apart[axis];
        }
        self.tally.virial -= impulse * apart2;
        if !self.regions.is_empty() {
            self.count_in_regions(self.balls[a].position, *apart, -impulse * apart2);
        }
    }
}
