//! A step of the flood.

use super::{DENSITY, Flood, State};
use crate::particle::Particle;
use crate::sampling::Sampler;
use corpuscle_model::ModelError;
use corpuscle_scene::Scheme as SchemeName;
use corpuscle_sph::BLOCK;
use rayon::prelude::*;

/// Size of a cell over the mean smoothing length: small cells fit the search closer, large ones are fewer and gone through in
/// longer pieces. Scheme balanced, whose particles must find all that reach them, gains from a close fit.
const CELL_OVER_H_BALANCED: f64 = 1.2;

/// The same for scheme sph-swe, whose particles look as far as they reach themselves.
const CELL_OVER_H_SPH_SWE: f64 = 1.4;

/// Particles are split and merged once in so many steps.
const REFINED: u64 = 8;

/// Before the forces of a step are found, or after.
enum Part {
    Before,
    After,
}

/// What a look at a block of particles gives.
pub(super) struct Renewal {
    sum_of_h: f64,
    /// Whether they are all inside.
    inside: bool,
    /// Whether they all have the weight of the first particle of all.
    even: bool,
}

impl Flood {
    /// A time step short enough for what is in the air, too: it falls its own size in some ten steps.
    pub(super) fn limited(&self, step: f64) -> f64 {
        if self.state.falling.is_empty() { step } else { step.min(self.fall_step()) }
    }

    /// The longest step while anything is in the air, s.
    pub(super) fn fall_step(&self) -> f64 {
        0.1 * (self.spacing / self.settings.gravity_m_per_s2).sqrt()
    }

    /// Size of a cell over the mean smoothing length.
    pub(super) fn cell_over_h(&self) -> f64 {
        match self.settings.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => CELL_OVER_H_BALANCED,
            SchemeName::SphSwe => CELL_OVER_H_SPH_SWE,
        }
    }

    /// Gives the particles the smoothing lengths that they have come to need, and the cells their size; whether all the
    /// particles are still inside, and not too near a wall.
    pub(super) fn renew(&mut self) -> bool {
        let cell_over_h = self.cell_over_h();
        let (edges, before_walls) = (&self.surroundings.edges, self.before_walls());
        let State { particles, sizes, .. } = &mut self.state;
        let weight = particles.first().map(|particle| particle.weight);
        let renew_block = |particles: &mut [Particle]| {
            let mut block = Renewal { sum_of_h: 0.0, inside: true, even: true };
            for particle in particles {
                particle.h = particle.next_h;
                block.sum_of_h += particle.h;
                block.inside &=
                    particle.outside.is_none() && edges.hold([particle.x, particle.y], before_walls.of(particle.h));
                block.even &= Some(particle.weight) == weight;
            }
            block
        };
        particles.par_chunks_mut(BLOCK).map(renew_block).collect_into_vec(&mut self.renewals);
        if !particles.is_empty() {
            let sum_of_h: f64 = self.renewals.iter().map(|block| block.sum_of_h).sum();
            sizes.cell = cell_over_h * sum_of_h / particles.len() as f64;
        }
        sizes.even = self.renewals.iter().all(|block| block.even);
        self.renewals.iter().all(|block| block.inside)
    }

    /// Sorts the particles into cells.
    pub(super) fn arrange(&mut self) {
        self.scheme.arrange(&mut self.state.particles, &self.surroundings, self.state.sizes);
    }

    pub(super) fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.carry_beyond();
        self.push(step, Part::Before)?;
        self.keep_out();
        let merged = self.refine();
        let taken = self.regulate(step);
        self.gain(step);
        if self.weather() | taken | merged {
            self.state.particles.retain(|particle| particle.volume > 0.0);
        }
        if !self.renew() {
            self.lose();
        }
        self.state.time += step;
        self.surroundings.time = self.state.time;
        self.arrange();
        let evaluation = self.scheme.evaluate(&mut self.state.particles, &self.surroundings, step);
        self.push(step, Part::After)?;
        let impulse = match self.settings.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => {
                [0, 1].map(|k| 0.5 * step * (self.state.external[k] + evaluation.external[k]))
            }
            SchemeName::SphSwe => evaluation.external.map(|force| step * force),
        };
        self.state.time_step = self.limited(evaluation.time_step);
        self.state.external = evaluation.external;
        self.state.steps += 1;
        self.state.particle_steps += self.state.particles.len() as u64;
        self.check(step)?;
        impulse.into_iter().for_each(|along| self.state.momentum.book(DENSITY * along));
        self.push_obstacles(step);
        self.look();
        Ok(())
    }

    /// Accelerates the particles for their part of a step and slows them by friction for as long; before the middle of
    /// the step they then move. So water that runs down a slope evenly goes as fast as it should, whatever the step. A
    /// value that is no number ends the run here, at a place that is still known: what has one does not move.
    fn push(&mut self, step: f64, part: Part) -> Result<(), ModelError> {
        let before = self.scheme.before();
        let (share, moved) = match part {
            Part::Before => (before, step),
            Part::After => (1.0 - before, 0.0),
        };
        let (pushed, gravity) = (share * step, self.settings.gravity_m_per_s2);
        let roughness = (pushed > 0.0 && !self.roughness.is_smooth()).then_some(&self.roughness);
        let push_block = |particles: &mut [Particle]| {
            let mut slowed = 0.0;
            for particle in particles {
                particle.u += pushed * particle.ax;
                particle.v += pushed * particle.ay;
                if let (Some(roughness), None) = (roughness, particle.outside) {
                    slowed += roughness.slow(particle, gravity, pushed);
                }
                if particle.is_sound() {
                    particle.x += moved * particle.u;
                    particle.y += moved * particle.v;
                } else {
                    slowed = f64::NAN;
                }
            }
            slowed
        };
        self.state.particles.par_chunks_mut(BLOCK).map(push_block).collect_into_vec(&mut self.of_blocks);
        let slowed: f64 = self.of_blocks.iter().sum();
        if slowed.is_nan() {
            return Err(self.remove_defects(step));
        }
        self.state.momentum.book(DENSITY * slowed);
        Ok(())
    }

    /// Merges and splits particles, where it is time to; whether particles are left without volume, to be taken out.
    fn refine(&mut self) -> bool {
        let Some(refinement) = self.refinement.filter(|_| self.state.steps.is_multiple_of(REFINED)) else {
            return false;
        };
        let State { particles, next_id, .. } = &mut self.state;
        let obstacles = &self.surroundings.obstacles;
        refinement.refine(particles, self.scheme.arrangement(), obstacles, self.settings.gravity_m_per_s2, next_id)
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
        let now = self.scheme.on_obstacles();
        let State { on_obstacles, impulses, .. } = &mut self.state;
        for ((impulse, before), now) in impulses.iter_mut().zip(on_obstacles.iter_mut()).zip(now) {
            let weights = match self.settings.scheme {
                SchemeName::Balanced | SchemeName::Voronoi => [0.5, 0.5],
                SchemeName::SphSwe => [0.0, 1.0],
            };
            (0..2).for_each(|k| impulse[k] += step * (weights[0] * before[k] + weights[1] * now[k]));
            *before = *now;
        }
    }

    /// Looks at the maps when it is time to.
    pub(super) fn look(&mut self) {
        if self.state.time < self.state.next_look as f64 * self.map_period {
            return;
        }
        self.state.next_look = (self.state.time / self.map_period).floor() as u64 + 1;
        let smoothing = self.smoothing();
        let State { particles, maps, time, .. } = &mut self.state;
        let water = Sampler {
            particles,
            arrangement: self.scheme.arrangement(),
            terrain: &self.surroundings.terrain,
            obstacles: &self.surroundings.obstacles,
            since: 0.0,
            smoothing,
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

    /// A time step below this means that the computation has broken down, s.
    pub(super) fn shortest_step(&self) -> f64 {
        1e-9 * self.spacing
    }

    fn check(&self, step: f64) -> Result<(), ModelError> {
        let next = self.state.time_step;
        if self.has_forces() && next.is_finite() && next > self.shortest_step() {
            return Ok(());
        }
        Err(self.breakdown(step))
    }

    /// Scheme sph-swe has steps of one length, whatever comes of its particles.
    fn has_forces(&self) -> bool {
        self.state.external.iter().all(|force| force.is_finite())
    }

    /// What ends a run that cannot go on after a step of so many seconds.
    pub(super) fn breakdown(&self, step: f64) -> ModelError {
        let next = self.state.time_step;
        let what = if self.has_forces() {
            format!("the time step fell from {step:.3e} s to {next:.3e} s")
        } else {
            "a force on the water is no longer a number".into()
        };
        ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: format!(
                "{what}. Try a smaller flood.balanced.cfl (scheme balanced) or flood.sph_swe.time_step_s (scheme sph-swe), or look in the \
                 last frame for the place where the water is fast"
            ),
        }
    }
}
