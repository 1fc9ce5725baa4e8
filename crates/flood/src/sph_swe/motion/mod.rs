//! Motion of the particles: their positions, and their velocities by acceleration and friction.

use super::particle::Particle;
use super::{DENSITY, SphSweFlood};
use corpuscle_model::ModelError;
use corpuscle_sph::BLOCK;
use rayon::prelude::*;

impl SphSweFlood {
    /// Moves the particles. A value that is not finite ends the run here, while the position is still known: such a particle does not move.
    pub(super) fn move_particles(&mut self, step: f64) -> Result<(), ModelError> {
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
    pub(super) fn accelerate(&mut self, step: f64) -> Result<(), ModelError> {
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
}
