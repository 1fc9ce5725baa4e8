//! A step of the flood.

use super::particle::Particle;
use super::sampling::Sampler;
use super::{DENSITY, SphSweFlood, State};
use corpuscle_model::ModelError;
use corpuscle_sph::BLOCK;
use rayon::prelude::*;

/// Size of a cell over the mean smoothing length: small cells fit the search closer, large ones are fewer and gone through in longer pieces. Particles
/// search as far as their own support.
pub(super) const CELL_OVER_H: f64 = 1.4;

/// Sums over a block of particles when their smoothing lengths are updated.
pub(super) struct BlockUpdate {
    sum_of_h: f64,
    /// Whether they are all inside.
    inside: bool,
}

impl SphSweFlood {
    /// The time step, limited while drops fall: one falls its own size in some ten steps.
    pub(super) fn limit_time_step(&self, step: f64) -> f64 {
        if self.state.falling.is_empty() { step } else { step.min(self.fall_step()) }
    }

    /// The longest step while anything is in the air, s.
    pub(super) fn fall_step(&self) -> f64 {
        0.1 * (self.spacing / self.settings.gravity_m_per_s2).sqrt()
    }

    /// Sets the particles' new smoothing lengths and the size of the cells; returns whether all the particles are still inside.
    pub(super) fn update_smoothing_lengths(&mut self) -> bool {
        let edges = &self.surroundings.edges;
        let State { particles, cell, .. } = &mut self.state;
        let update_block = |particles: &mut [Particle]| {
            let mut block = BlockUpdate { sum_of_h: 0.0, inside: true };
            for particle in particles {
                particle.h = particle.next_h;
                block.sum_of_h += particle.h;
                block.inside &= particle.outside.is_none() && edges.hold([particle.x, particle.y]);
            }
            block
        };
        particles.par_chunks_mut(BLOCK).map(update_block).collect_into_vec(&mut self.block_updates);
        if !particles.is_empty() {
            let sum_of_h: f64 = self.block_updates.iter().map(|block| block.sum_of_h).sum();
            *cell = CELL_OVER_H * sum_of_h / particles.len() as f64;
        }
        self.block_updates.iter().all(|block| block.inside)
    }

    /// Sorts the particles into cells.
    pub(super) fn arrange(&mut self) {
        self.solver.arrange(&mut self.state.particles, &self.surroundings, self.state.cell);
    }

    pub(super) fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.move_particles(step)?;
        self.resolve_obstacle_penetration();
        self.add_inflow(step);
        if !self.update_smoothing_lengths() {
            self.remove_outflow();
        }
        self.state.time += step;
        self.arrange();
        let external = self.solver.evaluate(&mut self.state.particles, &self.surroundings, step);
        self.accelerate(step)?;
        self.state.time_step = self.limit_time_step(self.settings.sph_swe.time_step_s);
        self.state.external = external;
        self.state.steps += 1;
        self.state.particle_steps += self.state.particles.len() as u64;
        self.check()?;
        external.into_iter().for_each(|force| self.state.momentum.book(DENSITY * (step * force)));
        self.add_obstacle_impulses(step);
        self.sample_maps();
        Ok(())
    }

    /// Samples the maps when it is time to.
    pub(super) fn sample_maps(&mut self) {
        if self.state.time < self.state.next_sample as f64 * self.map_period {
            return;
        }
        self.state.next_sample = (self.state.time / self.map_period).floor() as u64 + 1;
        let State { particles, maps, time, .. } = &mut self.state;
        let water = Sampler {
            particles,
            arrangement: self.solver.arrangement(),
            terrain: &self.surroundings.terrain,
            obstacles: &self.surroundings.obstacles,
            since: 0.0,
        };
        maps.sample(&water, *time);
        if self.detects_overtopping() {
            let State { particles, overtopped, time, .. } = &mut self.state;
            let note = |number: usize| overtopped[number] = overtopped[number].or(Some(*time));
            self.surroundings.obstacles.each_overtopped(particles, note);
        }
    }

    /// Whether obstacles have a height over which water would flow.
    pub(super) fn detects_overtopping(&self) -> bool {
        self.settings.obstacle.iter().any(|obstacle| obstacle.height_m.is_some())
    }

    fn check(&self) -> Result<(), ModelError> {
        if self.state.external.iter().all(|force| force.is_finite()) { Ok(()) } else { Err(self.breakdown()) }
    }

    /// The error that ends a run whose forces are not finite.
    pub(super) fn breakdown(&self) -> ModelError {
        ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: "a force on the water is no longer a number. Try a smaller flood.sph_swe.time_step_s, or look in the last frame for the position where the water is \
                   fast"
                .into(),
        }
    }
}
