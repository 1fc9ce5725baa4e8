//! Particles that are split where the water is thin, and merged where it is deep again.
//!
//! Particles hold about the same volume, so in thin water they stand far apart. One that stands for more area than asked for is
//! halved; halves that have come close together are joined. Both keep volume and momentum: halves have half of each, and what is
//! joined has the sum of each, at the common centre of mass (after Vacondio, Rogers & Stansby 2012, Int. J. Numer. Methods Fluids
//! 69, 1377, and Vacondio et al. 2013, Comput. Methods Appl. Mech. Eng. 256, 132, who split into seven).

use crate::arrangement::{Arrangement, IMAGE};
use crate::edges::EdgeRules;
use crate::obstacles::Obstacles;
use crate::particle::Particle;
use corpuscle_scene::Refinement as Settings;
use corpuscle_sph::FAR_AWAY;
use corpuscle_sph::kernel::cubic_spline;

/// Water slower than this Froude number is not split: a lake stays as it is.
const SLOWEST: f64 = 0.05;

/// Halves stand so far from their common centre, over the distance of particles that stand for as much area.
const APART: f64 = 0.25;

/// How many particles stand round a place grows by half of this power where one is halved, and its smoothing length falls.
const CLOSER: f64 = 0.85;

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

/// Where particles cannot be.
pub(crate) struct Limits<'a> {
    pub edges: &'a EdgeRules,
    pub obstacles: &'a Obstacles,
}

impl Refinement {
    /// As a scene asks for it, whose particles hold `volume` m3 and stand `spacing` m apart.
    pub fn new(settings: &Settings, volume: f64, spacing: f64) -> Self {
        let spacing = settings.spacing_m.unwrap_or(spacing);
        Self { widest: 2.0 * spacing * spacing, smallest: settings.smallest * volume, largest: volume }
    }

    /// Merges and splits particles that stand as arranged, or have moved a little since. What is merged into another is left with no
    /// volume; whether there is any. New particles come last.
    pub fn refine(
        &self,
        particles: &mut Vec<Particle>,
        arrangement: &Arrangement,
        gravity: f64,
        limits: &Limits,
        next_id: &mut u64,
    ) -> bool {
        let mut changed = false;
        for number in 0..arrangement.real.len() {
            let particle = &particles[number];
            if particle.outside.is_some() || particle.volume <= 0.0 || particle.depth <= 0.0 {
                continue;
            }
            if self.is_small(particle) {
                if let Some(partner) = self.partner(number, particles, arrangement) {
                    let other = particles[partner];
                    (particles[partner].volume, particles[partner].weight) = (0.0, 0.0);
                    join(&mut particles[number], &other);
                    changed = true;
                }
            } else if self.is_wide(particle, gravity) {
                let axis = emptiest(number, arrangement);
                let change = change_along(axis, number, particles, arrangement);
                if let Some([one, mut other]) = halves(particle, axis, change, limits) {
                    other.id = *next_id;
                    *next_id += 1;
                    particles[number] = one;
                    particles.push(other);
                    changed = true;
                }
            }
        }
        changed
    }

    fn is_wide(&self, particle: &Particle, gravity: f64) -> bool {
        particle.area() > self.widest
            && particle.volume >= 2.0 * self.smallest
            && particle.speed() > SLOWEST * (gravity * particle.depth).sqrt()
    }

    /// Whether a particle may be merged with another.
    fn is_small(&self, particle: &Particle) -> bool {
        particle.area() < 0.25 * self.widest && particle.volume < 0.75 * self.largest
    }

    /// The nearest neighbour with which a particle can be merged.
    fn partner(&self, number: usize, particles: &[Particle], arrangement: &Arrangement) -> Option<usize> {
        let own = &particles[number];
        let fits = |other: &Particle| {
            other.outside.is_none()
                && other.volume > 0.0
                && other.depth > 0.0
                && self.is_small(other)
                && own.volume + other.volume <= 1.001 * self.largest
                && own.area() + other.area() <= 0.5 * self.widest
        };
        let mut nearest: Option<(f64, usize)> = None;
        for (place, _) in neighbours(arrangement, arrangement.real[number] as usize) {
            let near = arrangement.particle[place];
            if near == IMAGE || !fits(&particles[near as usize]) {
                continue;
            }
            let other = &particles[near as usize];
            let distance = (other.x - own.x).hypot(other.y - own.y);
            if nearest.is_none_or(|(least, _)| distance < least) {
                nearest = Some((distance, near as usize));
            }
        }
        // Those that do not touch stay apart.
        nearest.filter(|&(distance, _)| distance * distance < 2.0 * self.widest).map(|(_, partner)| partner)
    }
}

/// The places of a place's neighbours, and how far they are.
fn neighbours(arrangement: &Arrangement, place: usize) -> impl Iterator<Item = (usize, f64)> {
    let list = arrangement.lists.of(place);
    let all = list.index.iter().zip(list.distance).map(|(&near, &r)| (near as usize, r));
    all.filter(|&(_, r)| r < FAR_AWAY)
}

/// The direction in which a particle has the fewest neighbours: across the largest of sum W e (x) e over unit vectors e to them.
fn emptiest(number: usize, arrangement: &Arrangement) -> [f64; 2] {
    let place = arrangement.real[number] as usize;
    let (x, y) = (arrangement.x[place], arrangement.y[place]);
    let h = 0.5 * arrangement.reach_squared[place].sqrt();
    let (mut difference, mut shear) = (0.0, 0.0);
    for (near, r) in neighbours(arrangement, place) {
        let (ex, ey) = ((arrangement.x[near] - x) / r, (arrangement.y[near] - y) / r);
        let weight = cubic_spline::value_of_one(r, h);
        difference += weight * (ex * ex - ey * ey);
        shear += weight * 2.0 * ex * ey;
    }
    // The main axis of a symmetric tensor; the least is at right angles to it.
    let angle = 0.5 * shear.atan2(difference) + std::f64::consts::FRAC_PI_2;
    [angle.cos(), angle.sin()]
}

/// How the velocity changes along a direction, 1/s: the line that fits that of the neighbours best.
fn change_along(axis: [f64; 2], number: usize, particles: &[Particle], arrangement: &Arrangement) -> [f64; 2] {
    let own = &particles[number];
    let (mut squares, mut change) = (0.0, [0.0; 2]);
    for (place, r) in neighbours(arrangement, arrangement.real[number] as usize) {
        let near = arrangement.particle[place];
        if near == IMAGE {
            continue;
        }
        let near = &particles[near as usize];
        let along = (near.x - own.x) * axis[0] + (near.y - own.y) * axis[1];
        let weight = cubic_spline::value_of_one(r, own.h) * near.weight;
        squares += weight * along * along;
        change[0] += weight * along * (near.u - own.u);
        change[1] += weight * along * (near.v - own.v);
    }
    if squares > 0.0 { change.map(|sum| crate::balanced::envf("GRAD", 1.0) * sum / squares) } else { change }
}

/// The halves of a particle along a direction; none where one would stand beyond an edge or in an obstacle.
fn halves(particle: &Particle, axis: [f64; 2], change: [f64; 2], limits: &Limits) -> Option<[Particle; 2]> {
    let apart = crate::balanced::envf("APART", APART) * particle.area().sqrt();
    let half = |side: f64| Particle {
        x: particle.x + side * apart * axis[0],
        y: particle.y + side * apart * axis[1],
        u: particle.u + side * apart * change[0],
        v: particle.v + side * apart * change[1],
        volume: 0.5 * particle.volume,
        weight: 0.5 * particle.weight,
        depth: particle.depth
            + side
                * apart
                * (0..2).map(|k| axis[k] * (particle.surface_slope[k] - particle.ground_slope[k])).sum::<f64>(),
        h: crate::balanced::envf("CLOSER", CLOSER) * particle.h,
        next_h: crate::balanced::envf("CLOSER", CLOSER) * particle.next_h,
        ..*particle
    };
    let halves = [half(-1.0), half(1.0)];
    let free =
        |half: &Particle| limits.edges.bounds.contains(half.x, half.y) && !limits.obstacles.hold([half.x, half.y]);
    halves.iter().all(free).then_some(halves)
}

/// Takes another particle's water in: at the centre of mass, with the momentum of both.
fn join(particle: &mut Particle, other: &Particle) {
    let volume = particle.volume + other.volume;
    let share = other.volume / volume;
    let mean = |own: f64, other: f64| own + share * (other - own);
    particle.x = mean(particle.x, other.x);
    particle.y = mean(particle.y, other.y);
    particle.u = mean(particle.u, other.u);
    particle.v = mean(particle.v, other.v);
    particle.ax = mean(particle.ax, other.ax);
    particle.ay = mean(particle.ay, other.ay);
    particle.next_h = particle.next_h.max(other.next_h) / CLOSER;
    particle.h = particle.h.max(other.h);
    particle.depth = mean(particle.depth, other.depth);
    particle.id = particle.id.min(other.id);
    particle.volume = volume;
    particle.weight += other.weight;
}
