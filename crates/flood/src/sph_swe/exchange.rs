//! Inflow and outflow of water.

use super::edges::OUTWARD;
use super::inflow::ParticleSpawner;
use super::particle::Particle;
use super::{DENSITY, SphSweFlood, State};

/// Distance beyond an edge at which particles are removed, in smoothing lengths: until then they are neighbours of those inside.
pub(super) const BEYOND: f64 = 4.0;

/// Lowest Froude number of a particle that has left: it keeps its speed, but must not block the outflow.
pub(super) const SLOWEST_LEAVING: f64 = 0.1;

impl SphSweFlood {
    /// Books particles that cross the edges, and removes those well beyond them.
    pub(super) fn remove_outflow(&mut self) {
        let edges = &self.surroundings.edges;
        let gravity = self.settings.gravity_m_per_s2;
        let State { particles, water, momentum, .. } = &mut self.state;
        particles.retain_mut(|particle| {
            let before = [particle.u, particle.v];
            let mut place = [particle.x, particle.y];
            let mut velocity = before;
            let side = edges.keep(&mut place, &mut velocity);
            [particle.x, particle.y] = place;
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
            side.is_none_or(|side| edges.beyond(side, particle.x, particle.y) < BEYOND * particle.h)
        });
    }

    /// Adds particles of inflows, and drops that land, during the next step.
    pub(super) fn add_inflow(&mut self, step: f64) {
        if self.sources.is_empty() && self.state.falling.is_empty() {
            return;
        }
        let mut residual_volume = std::mem::take(&mut self.state.residual_volume);
        let mut falling = std::mem::take(&mut self.state.falling);
        let mut spawner = ParticleSpawner {
            water: self.sampler(0.0),
            bounds: self.surroundings.edges.bounds,
            volume: self.volume,
            h: self.h,
            seed: self.seed,
            next_id: self.state.next_id,
            spawned: Vec::new(),
        };
        for (source, residual_volume) in self.sources.iter().zip(&mut residual_volume) {
            spawner.inject(source, residual_volume, self.state.time, step);
        }
        let ParticleSpawner { next_id, mut spawned, .. } = spawner;
        let landed = {
            let water = self.sampler(0.0);
            falling.iter_mut().for_each(|drop| drop.fall(self.settings.gravity_m_per_s2, step));
            falling.extract_if(.., |drop| drop.has_landed(&water)).map(|drop| drop.particle).collect::<Vec<_>>()
        };
        let state = &mut self.state;
        (state.residual_volume, state.falling, state.next_id) = (residual_volume, falling, next_id);
        for particle in &spawned {
            state.water.inflow.add(particle.volume);
            state.momentum.book(DENSITY * particle.volume * (particle.u + particle.v));
        }
        state.particles.append(&mut spawned);
        state.particles.extend(landed);
    }
}

fn leave(particle: &mut Particle, side: u8, gravity: f64) {
    let outward = OUTWARD[usize::from(side)];
    let speed = particle.u * outward[0] + particle.v * outward[1];
    let missing = (SLOWEST_LEAVING * (gravity * particle.depth).sqrt() - speed).max(0.0);
    particle.u += missing * outward[0];
    particle.v += missing * outward[1];
}
