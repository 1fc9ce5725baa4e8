//! Water that comes and goes.

use super::edges::OUTWARD;
use super::inflow::Nursery;
use super::particle::Particle;
use super::{DENSITY, SphSweFlood, State};

/// How far beyond an edge particles go on, in smoothing lengths: those before the edge and their neighbours see them.
pub(super) const BEYOND: f64 = 4.0;

/// A particle that has left goes on at its speed, but not so slowly that it would stand in the way: at this Froude number
/// at least.
pub(super) const SLOWEST_LEAVING: f64 = 0.1;

impl SphSweFlood {
    /// Books what crosses the edges, and takes out what is well beyond them.
    pub(super) fn lose(&mut self) {
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

    /// Lets in what comes during the coming step.
    pub(super) fn gain(&mut self, step: f64) {
        if self.sources.is_empty() && self.state.falling.is_empty() {
            return;
        }
        let mut owed = std::mem::take(&mut self.state.owed);
        let mut falling = std::mem::take(&mut self.state.falling);
        let mut nursery = Nursery {
            water: self.sampler(0.0),
            bounds: self.surroundings.edges.bounds,
            volume: self.volume,
            h: self.h,
            seed: self.seed,
            next_id: self.state.next_id,
            born: Vec::new(),
        };
        for (source, owed) in self.sources.iter().zip(&mut owed) {
            nursery.pour(source, owed, self.state.time, step);
        }
        let Nursery { next_id, mut born, .. } = nursery;
        let landed = {
            let water = self.sampler(0.0);
            falling.iter_mut().for_each(|drop| drop.fall(self.settings.gravity_m_per_s2, step));
            falling.extract_if(.., |drop| drop.has_landed(&water)).map(|drop| drop.particle).collect::<Vec<_>>()
        };
        let state = &mut self.state;
        (state.owed, state.falling, state.next_id) = (owed, falling, next_id);
        for particle in &born {
            state.water.inflow.add(particle.volume);
            state.momentum.book(DENSITY * particle.volume * (particle.u + particle.v));
        }
        state.particles.append(&mut born);
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
