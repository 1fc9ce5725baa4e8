//! Water that comes and goes.

use super::{DENSITY, Flood, State};
use crate::edges::OUTWARD;
use crate::inflow::Nursery;
use crate::particle::Particle;

/// How far beyond an edge particles go on, in smoothing lengths: those before the edge and their neighbours see them.
const BEYOND: f64 = 4.0;

/// A particle that has left goes on at its speed, but not so slowly that it would stand in the way: at this Froude number
/// at least.
const SLOWEST_LEAVING: f64 = 0.1;

impl Flood {
    /// Books what crosses the edges, and takes out what is well beyond them.
    pub(super) fn lose(&mut self) {
        let edges = &self.surroundings.edges;
        let gravity = self.settings.gravity_m_per_s2;
        let before_walls = self.before_walls();
        let State { particles, water, momentum, .. } = &mut self.state;
        particles.retain_mut(|particle| {
            let before = [particle.u, particle.v];
            let mut place = [particle.x, particle.y];
            let mut velocity = before;
            let side = edges.keep(&mut place, &mut velocity, before_walls.of(particle.h));
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

    /// Beyond an edge held at a level, water moves with that before the edge: in where it sinks away, out where it comes.
    pub(super) fn carry_beyond(&mut self) {
        let edges = &self.surroundings.edges;
        if !edges.holds_level() {
            return;
        }
        let gravity = self.settings.gravity_m_per_s2;
        let water = self.sampler(0.0);
        let carried: Vec<(usize, [f64; 2])> = (self.state.particles.iter().enumerate())
            .filter_map(|(number, particle)| {
                self.surroundings.stage(particle.outside)?;
                let [x, y] = edges.before(particle.x, particle.y, particle.h);
                let inside = water.at(x, y);
                let outward = OUTWARD[usize::from(particle.outside?)];
                // The outgoing invariant u + 2c is the same on both sides of the edge (Riemann).
                let faster = 2.0 * ((gravity * inside.depth).sqrt() - (gravity * particle.depth).sqrt());
                Some((number, [0, 1].map(|axis| inside.velocity[axis] + faster * outward[axis])))
            })
            .collect();
        for (number, velocity) in carried {
            [self.state.particles[number].u, self.state.particles[number].v] = velocity;
        }
    }

    /// Lets in what comes during the coming step.
    pub(super) fn gain(&mut self, step: f64) {
        let holds_level = self.surroundings.edges.holds_level();
        if self.sources.is_empty() && self.state.falling.is_empty() && !holds_level {
            return;
        }
        let mut owed = std::mem::take(&mut self.state.owed);
        let mut falling = std::mem::take(&mut self.state.falling);
        let mut nursery = self.nursery();
        for (source, owed) in self.sources.iter().zip(&mut owed) {
            nursery.pour(source, owed, self.state.time, step);
        }
        if holds_level {
            nursery.hold_levels(self.state.time);
        }
        let Nursery { next_id, mut born, .. } = nursery;
        let landed = {
            let water = self.sampler(0.0);
            falling.iter_mut().for_each(|drop| drop.fall(self.settings.gravity_m_per_s2, step));
            falling.extract_if(.., |drop| drop.has_landed(&water)).map(|drop| drop.particle).collect::<Vec<_>>()
        };
        let state = &mut self.state;
        (state.owed, state.falling, state.next_id) = (owed, falling, next_id);
        for particle in born.iter().filter(|particle| particle.outside.is_none()) {
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
