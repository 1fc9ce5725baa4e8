//! What obstacles do to the water of scheme balanced.
//!
//! Beyond a wall the water is taken to go on as in a mirror. A particle's kernel sees none there; what it would see is the part of the
//! kernel that the obstacle covers, so sums over water are divided by 1 - that part. The mirror's pressure pushes across the area
//! that particle and boundary particle share, as between two particles: with the level of the water before the wall, and with the
//! impact of what moves against it (a Riemann problem with a wall: Toro 2009, section 6.3.3).

use super::{Balanced, Column, Parameters, Slopes, forces::SHARED};
use crate::obstacles::{Coverage, Obstacles};
use crate::particle::Particle;
use corpuscle_sph::kernel::cubic_spline;
use rayon::prelude::*;

/// The particles near obstacles, kept between steps.
#[derive(Debug, Default)]
pub(super) struct NearWalls {
    /// Their places in the arrangement.
    places: Vec<u32>,
    coverages: Vec<Coverage>,
    pushes: Vec<Push>,
    /// Force on each obstacle, over the density of water, m4/s2.
    pub on_obstacles: Vec<[f64; 2]>,
}

/// What walls do to a particle, over the density of water, m4/s2.
#[derive(Debug, Clone, Copy, Default)]
struct Push {
    /// Of walls and of the ground before them.
    all: [f64; 2],
    /// Of walls alone.
    of_walls: [f64; 2],
    /// The obstacle that is nearest.
    obstacle: Option<usize>,
}

impl Balanced {
    /// Makes up in the densities for what obstacles cover: n = sum / (1 - covered).
    pub(super) fn add_walls_to_densities(&mut self, particles: &[Particle], obstacles: &Obstacles) {
        let NearWalls { places, coverages, .. } = &mut self.near_walls;
        places.clear();
        if !obstacles.any() {
            return;
        }
        let real = &self.arrangement.real;
        let near = particles.iter().zip(real).filter(|(particle, _)| obstacles.may_reach([particle.x, particle.y]));
        places.extend(near.map(|(_, &place)| place));
        let particle = |place: u32| &particles[self.arrangement.particle[place as usize] as usize];
        let cover = |&place: &u32| {
            let particle = particle(place);
            obstacles.coverage([particle.x, particle.y], particle.h)
        };
        places.par_iter().map(cover).collect_into_vec(coverages);
        for (&place, covered) in places.iter().zip(&*coverages) {
            let density = &mut self.densities[place as usize];
            *density = density.beside(*covered);
        }
    }

    /// Adds the push of walls to the forces.
    pub(super) fn add_walls_to_forces(&mut self, obstacles: &Obstacles) {
        let NearWalls { places, pushes, on_obstacles, .. } = &mut self.near_walls;
        let (columns, slopes, parameters) = (&self.columns, &self.slopes, &self.parameters);
        let push = |&place: &u32| push(parameters, &columns[place as usize], &slopes[place as usize], obstacles);
        places.par_iter().map(push).collect_into_vec(pushes);
        on_obstacles.clear();
        on_obstacles.resize(obstacles.names.len(), [0.0; 2]);
        for (&place, push) in places.iter().zip(&*pushes) {
            let Some(obstacle) = push.obstacle else { continue };
            let place = place as usize;
            let volume = columns[place].depth * columns[place].area;
            let force = &mut self.forces[place];
            (0..2).for_each(|axis| force.acceleration[axis] -= push.all[axis] / volume);
            (0..2).for_each(|axis| force.external[axis] -= push.all[axis]);
            if slopes[place].outside == 0.0 {
                (0..2).for_each(|axis| on_obstacles[obstacle][axis] += push.of_walls[axis]);
            }
        }
    }
}

/// The push of the walls near one particle.
fn push(parameters: &Parameters, own: &Column, slopes: &Slopes, obstacles: &Obstacles) -> Push {
    let gravity = parameters.gravity;
    let h = 1.0 / own.inverse_h;
    let ground = own.surface - own.depth;
    let own_pressure = 0.5 * gravity * own.depth * own.depth * (1.0 - slopes.rest);
    let [bxx, bxy, byy] = slopes.renormalisation;
    let mut push = Push::default();
    let mut nearest = f64::INFINITY;
    obstacles.each([own.x, own.y], 2.0 * h, |site, r, [ex, ey]| {
        let r = r.max(1e-9 * h);
        // A = V_i V_k 2 B_i grad W(h_i): the mirror of a particle has its B and its h.
        let areas = 2.0 * own.area * site.area * cubic_spline::slope_of_one(r, h) / r;
        let area = [areas * (bxx * ex + bxy * ey), areas * (bxy * ex + byy * ey)];
        // Half way to the boundary particle.
        let half_way = |slope: [f64; 2]| 0.5 * (slope[0] * ex + slope[1] * ey);
        let surface = own.surface + half_way(slopes.surface).clamp(-own.depth, own.depth);
        let middle = (ground + half_way(slopes.ground)).max(own.surface - SHARED * own.depth);
        let depth = (surface - middle).max(1e-6 * own.depth);
        let along = |u: f64, v: f64| u * site.normal[0] + v * site.normal[1];
        let across = along(own.u, own.v);
        let at_wall = along(own.u + half_way(slopes.u), own.v + half_way(slopes.v));
        // Towards the wall the flow across it ebbs; where the slopes say otherwise they are noise.
        let across = if at_wall * across <= 0.0 { 0.0 } else { across.signum() * at_wall.abs().min(across.abs()) };
        let impact = depth * slopes.wave_speed * across * along(ex, ey) / r;
        let pressure = (0.5 * gravity * depth * depth + impact).max(0.0);
        let own_depth = (own.surface - middle).max(0.0);
        let ground_push = own_pressure - 0.5 * gravity * own_depth * own_depth;
        (0..2).for_each(|axis| push.all[axis] += area[axis] * (pressure + ground_push));
        (0..2).for_each(|axis| push.of_walls[axis] += area[axis] * pressure);
        if r < nearest {
            (nearest, push.obstacle) = (r, Some(site.obstacle));
        }
    });
    push
}
