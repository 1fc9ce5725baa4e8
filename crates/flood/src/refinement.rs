//! Particles that are split where the water is thin, and merged where it is deep again.
//!
//! Particles hold about the same volume, so in thin water they stand far apart. One that stands for more area than asked for is
//! halved; halves that have come close together are joined. Both keep volume and momentum: halves have half of each, and what is
//! joined has the sum of each, at the common centre of mass (after Vacondio, Rogers & Stansby 2012, Int. J. Numer. Methods Fluids
//! 69, 1377, and Vacondio et al. 2013, Comput. Methods Appl. Mech. Eng. 256, 132, who split into seven).

use crate::arrangement::{Arrangement, IMAGE};
use crate::obstacles::Obstacles;
use crate::particle::Particle;
use corpuscle_scene::Refinement as Settings;
use corpuscle_sph::FEWEST;
use corpuscle_sph::kernel::cubic_spline;
use rayon::prelude::*;

/// Water slower than this Froude number is not split: a lake stays as it is.
const SLOWEST: f64 = 0.05;

/// Halves stand so far from their common centre, over the distance of particles that stand for as much area. A quarter would fill a
/// regular lattice; water that thins out has drawn its particles apart along its way. At a dry front 0.35 does best (depth and place of
/// the front; 0.25 to 0.45 tried).
const APART: f64 = 0.35;

/// By what the smoothing length is multiplied when a particle is halved, and divided when two are merged: on its way to 1 / sqrt(2).
const CLOSER: f64 = 0.85;

/// Two particles are merged where they stand for less than this share of the area for which one is split.
const MERGED: f64 = 0.6;

/// When a particle is split, and when two are merged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Refinement {
    /// The area for which a particle may stand, m2.
    widest: f64,
    /// No particle is split that has less than twice this volume, m3.
    smallest: f64,
    /// No two are merged that have more than this together, m3.
    largest: f64,
}

impl Refinement {
    /// As a scene asks for it, whose particles hold `volume` m3 and stand `spacing` m apart.
    pub fn new(settings: &Settings, volume: f64, spacing: f64) -> Self {
        let spacing = settings.spacing_m.unwrap_or(spacing);
        Self { widest: 2.0 * spacing * spacing, smallest: settings.smallest * volume, largest: 1.1 * volume }
    }

    /// The area for which a particle may stand, m2, the smallest volume of a half, m3, and the largest of what is merged, m3.
    #[cfg(feature = "gpu")]
    pub fn numbers(&self) -> [f64; 3] {
        [self.widest, self.smallest, self.largest]
    }

    /// The side of the square for which a particle may stand at most, m.
    pub fn widest(&self) -> f64 {
        self.widest.sqrt()
    }

    /// Merges and splits particles that stand as arranged, or have moved a little since. Two are merged where each is the nearest that
    /// the other can be merged with, so that it does not matter who is asked first. What is merged into another is left with no volume;
    /// whether there is any. New particles come last.
    pub fn refine(
        &self,
        particles: &mut Vec<Particle>,
        arrangement: &Arrangement,
        obstacles: &Obstacles,
        gravity: f64,
        next_id: &mut u64,
    ) -> bool {
        let mut merged = false;
        let of_number = |number: usize| self.partner(number, particles, arrangement);
        let partners: Vec<Option<usize>> =
            (0..arrangement.real.len()).into_par_iter().with_min_len(FEWEST).map(of_number).collect();
        for (number, partner) in partners.iter().enumerate() {
            let particle = particles[number];
            if let Some(partner) = *partner {
                let is_mutual = partners[partner] == Some(number) && number < partner;
                let both = is_mutual.then(|| joined(&particle, &particles[partner]));
                if let Some(both) = both.filter(|both| !obstacles.hold([both.x, both.y])) {
                    particles[number] = both;
                    (particles[partner].volume, particles[partner].weight) = (0.0, 0.0);
                    merged = true;
                }
            } else if self.is_wide(&particle, gravity) {
                let [one, other] = halves(&particle, emptiest(number, arrangement), *next_id);
                if [one, other].iter().all(|half| !obstacles.hold([half.x, half.y])) {
                    particles[number] = one;
                    particles.push(other);
                    *next_id += 1;
                }
            }
        }
        merged
    }

    /// Whether a particle is to be split.
    fn is_wide(&self, particle: &Particle, gravity: f64) -> bool {
        is_water(particle)
            && particle.area() > self.widest
            && particle.volume >= 2.0 * self.smallest
            && particle.speed() > SLOWEST * (gravity * particle.depth).sqrt()
    }

    /// Whether a particle may be merged with another.
    fn is_small(&self, particle: &Particle) -> bool {
        is_water(particle) && particle.area() < MERGED * self.widest && particle.volume < 0.75 * self.largest
    }

    /// The nearest particle with which one can be merged, where it is small.
    fn partner(&self, number: usize, particles: &[Particle], arrangement: &Arrangement) -> Option<usize> {
        let own = &particles[number];
        if !self.is_small(own) {
            return None;
        }
        let mut nearest: Option<(f64, usize)> = None;
        for (place, _) in neighbours(number, arrangement) {
            let near = arrangement.particle[place] as usize;
            if arrangement.particle[place] == IMAGE || !self.is_small(&particles[near]) {
                continue;
            }
            let other = &particles[near];
            let apart = (other.x - own.x).hypot(other.y - own.y);
            let area = own.area() + other.area();
            let fits = own.volume + other.volume <= self.largest && area < MERGED * self.widest;
            if fits && apart * apart < 2.0 * area && nearest.is_none_or(|(least, _)| apart < least) {
                nearest = Some((apart, near));
            }
        }
        nearest.map(|(_, partner)| partner)
    }
}

/// Whether a particle is water on the ground, its depth known.
fn is_water(particle: &Particle) -> bool {
    particle.outside.is_none() && particle.volume > 0.0 && particle.depth > 0.0
}

/// The places of the particles and images that a particle reaches, as they were arranged, and how far they are.
fn neighbours(number: usize, arrangement: &Arrangement) -> impl Iterator<Item = (usize, f64)> {
    let Arrangement { cells, x, y, .. } = arrangement;
    let own = arrangement.real[number] as usize;
    let squared = arrangement.reach_squared[own];
    let places = cells.ranges(x[own], y[own], squared.sqrt()).flatten();
    let distance = move |place: usize| (place, (x[place] - x[own]).hypot(y[place] - y[own]));
    places.filter(move |&place| place != own).map(distance).filter(move |&(_, r)| r * r < squared && r > 0.0)
}

/// The direction in which a particle has the fewest neighbours: across the largest of sum W e (x) e over unit vectors e to them.
fn emptiest(number: usize, arrangement: &Arrangement) -> [f64; 2] {
    let place = arrangement.real[number] as usize;
    let (x, y) = (arrangement.x[place], arrangement.y[place]);
    let h = 0.5 * arrangement.reach_squared[place].sqrt();
    let (mut difference, mut shear) = (0.0, 0.0);
    for (near, r) in neighbours(number, arrangement) {
        let (ex, ey) = ((arrangement.x[near] - x) / r, (arrangement.y[near] - y) / r);
        let weight = cubic_spline::value_of_one(r, h);
        difference += weight * (ex * ex - ey * ey);
        shear += weight * 2.0 * ex * ey;
    }
    // The main axis of a symmetric tensor; the least is at right angles to it.
    let angle = 0.5 * shear.atan2(difference) + std::f64::consts::FRAC_PI_2;
    [angle.cos(), angle.sin()]
}

/// The halves of a particle, apart along a direction; the second has an identity of its own.
fn halves(particle: &Particle, axis: [f64; 2], id: u64) -> [Particle; 2] {
    let apart = APART * particle.area().sqrt();
    let half = |side: f64, id: u64| Particle {
        x: particle.x + side * apart * axis[0],
        y: particle.y + side * apart * axis[1],
        volume: 0.5 * particle.volume,
        weight: 0.5 * particle.weight,
        next_h: CLOSER * particle.next_h,
        id,
        ..*particle
    };
    [half(-1.0, particle.id), half(1.0, id)]
}

/// Two particles as one: at their centre of mass, with the momentum of both, standing for the area of both.
fn joined(one: &Particle, other: &Particle) -> Particle {
    let volume = one.volume + other.volume;
    let mean = |of: fn(&Particle) -> f64| (one.volume * of(one) + other.volume * of(other)) / volume;
    Particle {
        x: mean(|particle| particle.x),
        y: mean(|particle| particle.y),
        u: mean(|particle| particle.u),
        v: mean(|particle| particle.v),
        ax: mean(|particle| particle.ax),
        ay: mean(|particle| particle.ay),
        next_h: one.next_h.max(other.next_h) / CLOSER,
        depth: volume / (one.area() + other.area()),
        id: one.id.min(other.id),
        volume,
        weight: one.weight + other.weight,
        ..*one
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn particle() -> impl Strategy<Value = Particle> {
        let number = || -50.0..50.0_f64;
        (number(), number(), number(), number(), 1e-6..10.0_f64, 1e-3..5.0_f64)
            .prop_map(|(x, y, u, v, volume, depth)| Particle { u, v, depth, ..Particle::new(7, x, y, volume, 1.0) })
    }

    /// Volume, momentum and first moments over them.
    fn sums(particles: &[Particle]) -> [f64; 5] {
        let sum = |of: fn(&Particle) -> f64| particles.iter().map(|particle| particle.volume * of(particle)).sum();
        [sum(|_| 1.0), sum(|p| p.u), sum(|p| p.v), sum(|p| p.x), sum(|p| p.y)]
    }

    fn close(one: [f64; 5], other: [f64; 5], volume: f64) -> bool {
        one.iter().zip(other).all(|(one, other)| (one - other).abs() <= 1e-13 * 100.0 * volume)
    }

    proptest! {
        #[test]
        fn halves_hold_what_the_whole_held(whole in particle(), angle in 0.0..6.3_f64) {
            let halves = halves(&whole, [angle.cos(), angle.sin()], 8);
            prop_assert_eq!(halves[0].volume + halves[1].volume, whole.volume);
            prop_assert_eq!(halves[0].weight + halves[1].weight, whole.weight);
            prop_assert!(close(sums(&halves), sums(&[whole]), whole.volume));
        }

        #[test]
        fn what_is_joined_holds_what_both_held(one in particle(), other in particle()) {
            let both = joined(&one, &other);
            prop_assert_eq!(both.volume, one.volume + other.volume);
            prop_assert!((both.area() / (one.area() + other.area()) - 1.0).abs() < 1e-13);
            prop_assert!(close(sums(&[both]), sums(&[one, other]), both.volume));
        }
    }
}
