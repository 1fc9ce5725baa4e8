//! A step of the flood.

use super::particle::Particle;
use super::{DENSITY, Sampler, SphSweFlood, State};
use corpuscle_model::ModelError;
use corpuscle_sph::BLOCK;
use rayon::prelude::*;

/// Size of a cell over the mean smoothing length: small cells fit the search closer, large ones are fewer and gone through in longer pieces. Particles
/// look as far as they reach themselves.
pub(super) const CELL_OVER_H: f64 = 1.4;

/// What a look at a block of particles gives.
pub(super) struct Renewal {
    sum_of_h: f64,
    /// Whether they are all inside.
    inside: bool,
}

impl SphSweFlood {
    /// A time step short enough for what is in the air, too: it falls its own size in some ten steps.
    pub(super) fn limited(&self, step: f64) -> f64 {
        if self.state.falling.is_empty() { step } else { step.min(self.fall_step()) }
    }

    /// The longest step while anything is in the air, s.
    pub(super) fn fall_step(&self) -> f64 {
        0.1 * (self.spacing / self.settings.gravity_m_per_s2).sqrt()
    }

    /// Gives the particles the smoothing lengths that they have come to need, and the cells their size; whether all the particles are still inside.
    pub(super) fn renew(&mut self) -> bool {
        let edges = &self.surroundings.edges;
        let State { particles, cell, .. } = &mut self.state;
        let renew_block = |particles: &mut [Particle]| {
            let mut block = Renewal { sum_of_h: 0.0, inside: true };
            for particle in particles {
                particle.h = particle.next_h;
                block.sum_of_h += particle.h;
                block.inside &= particle.outside.is_none() && edges.hold([particle.x, particle.y]);
            }
            block
        };
        particles.par_chunks_mut(BLOCK).map(renew_block).collect_into_vec(&mut self.renewals);
        if !particles.is_empty() {
            let sum_of_h: f64 = self.renewals.iter().map(|block| block.sum_of_h).sum();
            *cell = CELL_OVER_H * sum_of_h / particles.len() as f64;
        }
        self.renewals.iter().all(|block| block.inside)
    }

    /// Sorts the particles into cells.
    pub(super) fn arrange(&mut self) {
        self.solver.arrange(&mut self.state.particles, &self.surroundings, self.state.cell);
    }

    pub(super) fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.move_particles(step)?;
        self.keep_out();
        self.gain(step);
        if !self.renew() {
            self.lose();
        }
        self.state.time += step;
        self.arrange();
        let external = self.solver.evaluate(&mut self.state.particles, &self.surroundings, step);
        self.accelerate(step)?;
        self.state.time_step = self.limited(self.settings.sph_swe.time_step_s);
        self.state.external = external;
        self.state.steps += 1;
        self.state.particle_steps += self.state.particles.len() as u64;
        self.check()?;
        external.into_iter().for_each(|force| self.state.momentum.book(DENSITY * (step * force)));
        self.push_obstacles(step);
        self.look();
        Ok(())
    }

    /// Moves the particles. A value that is no number ends the run here, at a place that is still known: what has one does not move.
    fn move_particles(&mut self, step: f64) -> Result<(), ModelError> {
        let move_block = |particles: &mut [Particle]| {
            let mut all_are_sound = true;
            for particle in particles {
                if particle.is_sound() {
                    particle.x += step * particle.u;
                    particle.y += step * particle.v;
                } else {
                    all_are_sound = false;
                }
            }
            all_are_sound
        };
        let blocks = self.state.particles.par_chunks_mut(BLOCK).map(move_block);
        let all_are_sound = blocks.reduce(|| true, |one, other| one && other);
        if all_are_sound { Ok(()) } else { Err(self.remove_defects()) }
    }

    /// Accelerates the particles and slows them by friction.
    fn accelerate(&mut self, step: f64) -> Result<(), ModelError> {
        let gravity = self.settings.gravity_m_per_s2;
        let roughness = (step > 0.0 && !self.roughness.is_smooth()).then_some(&self.roughness);
        let push_block = |particles: &mut [Particle]| {
            let mut slowed = 0.0;
            for particle in particles {
                particle.u += step * particle.ax;
                particle.v += step * particle.ay;
                if let (Some(roughness), None) = (roughness, particle.outside) {
                    slowed += roughness.slow(particle, gravity, step);
                }
                if !particle.is_sound() {
                    slowed = f64::NAN;
                }
            }
            slowed
        };
        self.state.particles.par_chunks_mut(BLOCK).map(push_block).collect_into_vec(&mut self.of_blocks);
        let slowed: f64 = self.of_blocks.iter().sum();
        if slowed.is_nan() {
            return Err(self.remove_defects());
        }
        self.state.momentum.book(DENSITY * slowed);
        Ok(())
    }

    /// Puts back what has come into obstacles.
    fn keep_out(&mut self) {
        if self.surroundings.obstacles.any() {
            let State { particles, impulses, momentum, put_back, .. } = &mut self.state;
            let sum = |impulses: &[[f64; 2]]| impulses.iter().flatten().sum::<f64>();
            let before = sum(impulses);
            let back = self.surroundings.obstacles.keep_out(particles, self.spacing, impulses);
            *put_back += back as u64;
            momentum.book(-DENSITY * (sum(impulses) - before));
        }
    }

    /// Sums the forces on obstacles over a step.
    fn push_obstacles(&mut self, step: f64) {
        let now = self.solver.on_obstacles();
        let State { on_obstacles, impulses, .. } = &mut self.state;
        for ((impulse, last), now) in impulses.iter_mut().zip(on_obstacles.iter_mut()).zip(now) {
            (0..2).for_each(|k| impulse[k] += step * now[k]);
            *last = *now;
        }
    }

    /// Looks at the maps when it is time to.
    pub(super) fn look(&mut self) {
        if self.state.time < self.state.next_look as f64 * self.map_period {
            return;
        }
        self.state.next_look = (self.state.time / self.map_period).floor() as u64 + 1;
        let State { particles, maps, time, .. } = &mut self.state;
        let water = Sampler {
            particles,
            arrangement: self.solver.arrangement(),
            terrain: &self.surroundings.terrain,
            obstacles: &self.surroundings.obstacles,
            since: 0.0,
        };
        maps.look(&water, *time);
        if self.looks_for_overtopping() {
            let State { particles, overtopped, time, .. } = &mut self.state;
            let note = |number: usize| overtopped[number] = overtopped[number].or(Some(*time));
            self.surroundings.obstacles.each_overtopped(particles, note);
        }
    }

    /// Whether obstacles have a height over which water would flow.
    pub(super) fn looks_for_overtopping(&self) -> bool {
        self.settings.obstacle.iter().any(|obstacle| obstacle.height_m.is_some())
    }

    fn check(&self) -> Result<(), ModelError> {
        if self.state.external.iter().all(|force| force.is_finite()) { Ok(()) } else { Err(self.breakdown()) }
    }

    /// What ends a run that cannot go on.
    pub(super) fn breakdown(&self) -> ModelError {
        ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: "a force on the water is no longer a number. Try a smaller flood.sph_swe.time_step_s, or look in the last frame for the place where the water is \
                   fast"
                .into(),
        }
    }
}
