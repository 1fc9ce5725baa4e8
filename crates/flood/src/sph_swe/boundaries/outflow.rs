//! Outflow of water over the sides.

use super::OUTWARD;
use crate::sph_swe::particle::Particle;
use crate::sph_swe::{DENSITY, SphSweFlood, State};

/// Distance beyond an edge at which particles are removed, in smoothing lengths: until then they are neighbours of those inside.
pub(in crate::sph_swe) const BEYOND: f64 = 4.0;

/// Lowest Froude number of a particle that has left: it keeps its speed, but must not block the outflow.
pub(in crate::sph_swe) const SLOWEST_LEAVING: f64 = 0.1;

impl SphSweFlood {
    /// Books particles that cross the edges, and removes those well beyond them.
    pub(in crate::sph_swe) fn remove_outflow(&mut self) {
        let edges = &self.surroundings.edges;
        let gravity = self.settings.gravity_m_per_s2;
        let State { particles, water, momentum, .. } = &mut self.state;
        particles.retain_mut(|particle| {
            let before = [particle.u, particle.v];
            let mut position = [particle.x, particle.y];
            let mut velocity = before;
            let side = edges.keep(&mut position, &mut velocity);
            [particle.x, particle.y] = position;
            [particle.u, particle.v] = velocity;
            let carried = |velocity: [f64; 2]| DENSITY * particle.volume * (velocity[0] + velocity[1]);
            match (particle.outside, side) {
                (None, None) => momentum.book(carried(velocity) - carried(before)),
                (None, Some(side)) => {
                    water.outflow.add(particle.volume);
                    momentum.book(-carried(before));
                    leave(particle, side, gravity);
                }
                (Some(_), None) => {
                    water.inflow.add(particle.volume);
                    momentum.book(carried(velocity));
                }
                (Some(_), Some(_)) => {}
            }
            particle.outside = side;
            side.is_none() || edges.beyond(particle.x, particle.y) < BEYOND * particle.h
        });
    }
}

fn leave(particle: &mut Particle, side: u8, gravity: f64) {
    let outward = OUTWARD[usize::from(side)];
    let speed = particle.u * outward[0] + particle.v * outward[1];
    let missing = (SLOWEST_LEAVING * (gravity * particle.depth).sqrt() - speed).max(0.0);
    particle.u += missing * outward[0];
    particle.v += missing * outward[1];
}
