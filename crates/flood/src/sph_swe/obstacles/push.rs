//! The push of boundary particles on the water, and that of the water on obstacles.

use super::Obstacles;
use crate::sph_swe::particle::Particle;
use crate::sph_swe::solver::SphSweSolver;
use corpuscle_scene::SphSwe;
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use rayon::prelude::*;

impl SphSweSolver {
    /// Adds the push of obstacles to that of the water.
    pub(in crate::sph_swe) fn add_walls(&mut self, particles: &[Particle], obstacles: &Obstacles) {
        self.on_obstacles.clear();
        self.on_obstacles.resize(obstacles.names.len(), [0.0; 2]);
        if !obstacles.any() {
            return;
        }
        let Self { parameters, arrangement, near_walls, of_walls, accelerations, on_obstacles, .. } = self;
        let near = particles
            .iter()
            .zip(&arrangement.real)
            .filter(|(particle, _)| obstacles.may_reach([particle.x, particle.y]));
        near_walls.clear();
        near_walls.extend(near.map(|(_, &index)| index));
        let particle = |index: u32| &particles[arrangement.particle[index as usize] as usize];
        let push = |&index: &u32| push_of_walls(parameters, obstacles, particle(index));
        near_walls.par_iter().map(push).collect_into_vec(of_walls);
        for (&index, &(push, obstacle)) in near_walls.iter().zip(&*of_walls) {
            let Some(obstacle) = obstacle else { continue };
            let particle = particle(index);
            for axis in 0..2 {
                accelerations[index as usize][axis] += push[axis];
                if particle.outside.is_none() {
                    on_obstacles[obstacle][axis] -= particle.volume * push[axis];
                }
            }
        }
    }
}

/// The push of boundary particles, m/s2, and the number of the nearest one's obstacle:
/// a = -sum_k rho0 V_k (p_i / rho_i^2) grad W_ik (Akinci et al. 2012, equation 9).
fn push_of_walls(parameters: &SphSwe, obstacles: &Obstacles, particle: &Particle) -> ([f64; 2], Option<usize>) {
    let SphSwe { density_kg_per_m3: rho0, gas_constant, clip_negative_pressure, .. } = *parameters;
    let density = rho0 * particle.depth;
    let pressure = gas_constant * (density - rho0);
    let pressure = if clip_negative_pressure { pressure.max(0.0) } else { pressure };
    let strength = rho0 * pressure / (density * density);
    let kernel = Kernel::<2>::new(parameters.kernel, particle.h);
    let (mut push, mut nearest, mut obstacle) = ([0.0; 2], f64::INFINITY, None);
    obstacles.each([particle.x, particle.y], particle.h, |site, r, way| {
        let slope = site.volume * kernel.slope(r) / r.max(1e-9 * particle.h);
        (0..2).for_each(|axis| push[axis] -= strength * slope * way[axis]);
        if r < nearest {
            (nearest, obstacle) = (r, Some(site.obstacle));
        }
    });
    (push, obstacle)
}
