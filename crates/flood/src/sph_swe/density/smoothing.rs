//! The general forms of the paper for the smoothing length, (8) and (9), in two dimensions (`smoothing = "rate"`).

use super::h_of_density;
use crate::sph_swe::obstacles::Obstacles;
use crate::sph_swe::particle::Particle;
use crate::sph_swe::solver::{Column, SphSweSolver};
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use rayon::prelude::*;
use std::f64::consts::FRAC_2_SQRT_PI;

/// c_2 = (1 / (4 pi))^(1/2) of form (8).
const C_2: f64 = 0.25 * FRAC_2_SQRT_PI;

/// The support of a kernel over the h of form (8): with c_2 the circle of radius 2 h has the area of the neighbours. The kernels
/// here have the support h, so that their h is that of form (8) times this.
const SUPPORT_OVER_H: f64 = 2.0;

/// The h of form (8), in spacings, for which its neighbours are counted.
const H_IN_SPACINGS: f64 = 1.2;

/// Least smoothing length over h0 (rho0 / rho)^(1/2). In water that splashes form (9) takes them ever lower, and without
/// neighbours it leaves them there. The density of a particle alone, 4 m / (pi h^2), makes the bound larger than its h, until it finds some.
const MIN_H_FACTOR: f64 = 0.5;

impl SphSweSolver {
    /// Smoothing lengths for the next step by forms (8) and (9): the first for particles that have none yet (`next_h` is 0), the
    /// second for those that have moved for `step` s.
    pub(in crate::sph_swe) fn find_smoothing(&self, particles: &mut [Particle], obstacles: &Obstacles, step: f64) {
        let Self { parameters, h0, .. } = self;
        let longest = parameters.largest_smoothing * h0;
        particles.par_iter_mut().zip(&self.arrangement.real).for_each(|(particle, &index)| {
            let h = if particle.next_h > 0.0 {
                // With the rate of the step's end for all of it, h = h exp(rate step): never negative, whatever the step.
                particle.h * (step * self.rate(particle, obstacles, index)).exp()
            } else {
                self.first(particle, obstacles, index)
            };
            let by_density = h_of_density(parameters, *h0, parameters.density_kg_per_m3 * particle.depth);
            particle.next_h = h.max(MIN_H_FACTOR * by_density).min(longest);
        });
    }

    /// Form (8), h_i = c_2 (sum_j m_j / rho_i)^(1/2), as the support of a kernel, m; the particle is a neighbour of itself. Only those
    /// within its present smoothing length are counted.
    fn first(&self, particle: &Particle, obstacles: &Obstacles, index: u32) -> f64 {
        let reach = SUPPORT_OVER_H * H_IN_SPACINGS * particle.area().sqrt();
        let near = self.arrangement.lists.of(index as usize);
        let mut volume = particle.volume;
        for (&other, &r) in near.index.iter().zip(near.distance) {
            if r < reach.min(particle.h) {
                let Column { area, density, .. } = self.columns[other as usize];
                volume += area * density / self.parameters.density_kg_per_m3;
            }
        }
        obstacles.each([particle.x, particle.y], reach.min(particle.h), |site, _, _| volume += site.volume);
        SUPPORT_OVER_H * C_2 * (volume / particle.depth).sqrt()
    }

    /// Form (9) over h, (1/h_i) Dh_i/Dt = -1/(2 rho_i) sum_j m_j (v_i - v_j) . grad W(r_ij, h_i), 1/s: the kernel of the
    /// density, so that h follows how it changes. Boundary particles count as they do in the density.
    fn rate(&self, particle: &Particle, obstacles: &Obstacles, index: u32) -> f64 {
        let own = &self.columns[index as usize];
        let near = self.arrangement.lists.of(index as usize);
        let kernel = Kernel::<2>::new(self.parameters.kernel, own.h);
        let mut sum = 0.0;
        for (&other, &r) in near.index.iter().zip(near.distance) {
            // Lists are padded with indices of no particle, far away.
            if r < own.h {
                let other = &self.columns[other as usize];
                let apart = (own.u - other.u) * (own.x - other.x) + (own.v - other.v) * (own.y - other.y);
                sum -= other.area * other.density * apart * kernel.fall_over_r(r * r);
            }
        }
        let rho0 = self.parameters.density_kg_per_m3;
        obstacles.each([particle.x, particle.y], own.h, |site, r, way| {
            let apart = -(own.u * way[0] + own.v * way[1]);
            sum -= rho0 * site.volume * apart * kernel.fall_over_r(r * r);
        });
        -sum / (2.0 * own.density)
    }
}
