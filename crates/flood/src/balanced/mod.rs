//! Scheme `balanced`: conservative pair forces from Riemann problems on renormalised areas, with reconstruction.
//!
//! A step is kick-drift-kick. Between drift and second kick come three passes over the particles, each gathering from
//! the neighbours: density (how many particles stand here, so how deep the water is), `gradients` (first-order exact
//! slopes of surface and velocity) and `forces`.
//!
//! Names of the ideas: variable-h SPH for shallow water (Rodriguez-Paz & Bonet 2005), Godunov SPH (Vila 1999),
//! renormalised pair areas (Hopkins 2015), hydrostatic reconstruction (Audusse et al. 2004).

mod forces;
mod gradients;
mod images;
mod walls;

use crate::arrangement::{Arrangement, IMAGE};
use crate::density::{Densities, Density, WeightedDensities};
use crate::particle::Particle;
use crate::scheme::{Evaluation, Scheme, Sizes, Surroundings, TOGETHER};
use bytemuck::{Pod, Zeroable};
use corpuscle_sph::{BLOCK, Near};
use forces::Force;
use rayon::prelude::*;
use walls::NearWalls;

/// What the passes read of a particle or image: one cache line, a row of numbers to gather.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C, align(64))]
struct Column {
    x: f64,
    y: f64,
    u: f64,
    v: f64,
    /// Height of the water's surface, m.
    surface: f64,
    depth: f64,
    /// Area that the particle stands for, m2.
    area: f64,
    /// 1 / h, 1/m.
    inverse_h: f64,
}

/// First-order exact slopes, and what goes with them: two rows of numbers to gather.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C, align(64))]
struct Slopes {
    /// Renormalisation matrix B (symmetric): xx, xy, yy.
    renormalisation: [f64; 3],
    surface: [f64; 2],
    ground: [f64; 2],
    /// 1 for an image beyond an edge, 0 for a particle.
    outside: f64,
    u: [f64; 2],
    v: [f64; 2],
    /// Speed of shallow waves, m/s.
    wave_speed: f64,
    /// How much at rest the water is here: 1 at rest, 0 in motion.
    rest: f64,
    /// How much a particle is alone: 1 without neighbours, 0 with enough of them.
    alone: f64,
    unused: f64,
}

/// Numbers of the scheme.
#[derive(Debug, Clone)]
pub(crate) struct Parameters {
    /// Acceleration of gravity, m/s2.
    pub gravity: f64,
    /// Smoothing length over particle distance.
    pub eta: f64,
    /// Largest smoothing length, m.
    pub largest_h: f64,
    /// Artificial viscosity, in shares of the dissipation of an unreconstructed Riemann problem.
    pub viscosity: f64,
    /// Time step over (smoothing length / wave speed).
    pub cfl: f64,
    /// Time step where nothing moves, s.
    pub longest_step: f64,
}

/// Least depth beyond an edge whose level falls below the ground, over the depth as it was.
const SHALLOWEST_STAGE: f64 = 1e-3;

/// The scheme with its working memory.
pub(crate) struct Balanced {
    parameters: Parameters,
    arrangement: Arrangement,
    columns: Vec<Column>,
    densities: Vec<Density>,
    slopes: Vec<Slopes>,
    forces: Vec<Force>,
    evaluations: Vec<Evaluation>,
    /// The weights, in sorted order; empty where all are the same.
    weights: Vec<f64>,
    near_walls: NearWalls,
    spare: Vec<Particle>,
}

impl Balanced {
    pub fn new(parameters: Parameters) -> Self {
        Self {
            parameters,
            arrangement: Arrangement::default(),
            columns: Vec::new(),
            densities: Vec::new(),
            slopes: Vec::new(),
            forces: Vec::new(),
            evaluations: Vec::new(),
            weights: Vec::new(),
            near_walls: NearWalls::default(),
            spare: Vec::new(),
        }
    }

    fn find_densities(&mut self) {
        let Arrangement { cells, lists, x, y, reach_squared, .. } = &mut self.arrangement;
        self.densities.resize(x.len(), Density::default());
        let (out, weights) = (&mut self.densities, &self.weights);
        if weights.is_empty() {
            lists.search(Near::Either, cells, x, y, reach_squared, out, &Densities { reach_squared });
        } else {
            let sum = WeightedDensities { reach_squared, weights };
            lists.search(Near::Either, cells, x, y, reach_squared, out, &sum);
        }
    }

    /// Gives every place the weight of its particle, where they are not all the same.
    fn fill_weights(&mut self, particles: &[Particle], even: bool) {
        self.weights.clear();
        if even {
            return;
        }
        let Arrangement { particle, images, .. } = &self.arrangement;
        let weight = |&k: &u32| if k == IMAGE { 0.0 } else { particles[k as usize].weight };
        particle.par_iter().map(weight).collect_into_vec(&mut self.weights);
        for &(place, shown) in images {
            self.weights[place as usize] = self.weights[shown as usize];
        }
    }

    /// Hands depth, ground and next smoothing length to the particles.
    fn find_depths(&self, particles: &mut [Particle], surroundings: &Surroundings) {
        let Parameters { eta, largest_h, .. } = self.parameters;
        let find = |particle: &mut Particle, place: u32| {
            let density = &self.densities[place as usize];
            particle.depth = particle.volume * density.alike;
            particle.next_h = density.next_h(particle.h, eta).min(largest_h);
            if let Some(level) = surroundings.stage(particle.outside) {
                particle.depth = (level - particle.ground).max(SHALLOWEST_STAGE * particle.depth);
            }
        };
        let groups = particles.par_chunks_mut(TOGETHER).zip(self.arrangement.real.par_chunks(TOGETHER));
        groups.for_each(|(particles, places)| {
            surroundings.find_ground(particles);
            particles.iter_mut().zip(places).for_each(|(particle, &place)| find(particle, place));
        });
    }

    fn fill_columns(&mut self, particles: &[Particle], ahead: f64) {
        let places = self.arrangement.len();
        self.columns.resize(places, Column::default());
        self.slopes.resize(places, Slopes::default());
        let columns = self.columns.par_iter_mut().zip(&mut self.slopes).zip(&self.densities);
        columns.zip(&self.arrangement.particle).for_each(|(((column, slopes), density), &particle)| {
            if particle == IMAGE {
                return;
            }
            let particle = &particles[particle as usize];
            *column = Column {
                x: particle.x,
                y: particle.y,
                u: particle.u + ahead * particle.ax,
                v: particle.v + ahead * particle.ay,
                surface: particle.surface(),
                depth: particle.depth,
                area: 1.0 / density.alike,
                inverse_h: 1.0 / particle.h,
            };
            slopes.ground = particle.ground_slope;
            slopes.outside = f64::from(u8::from(particle.outside.is_some()));
        });
    }

    /// Hands the accelerations to the particles; the largest sound time step and what acted from outside.
    fn take_over(&mut self, particles: &mut [Particle]) -> Evaluation {
        let Self { parameters, slopes, forces, .. } = self;
        let blocks = particles.par_chunks_mut(BLOCK).zip(self.arrangement.real.par_chunks(BLOCK));
        let of_block = |(particles, places): (&mut [Particle], &[u32])| {
            let mut evaluation = Evaluation { time_step: parameters.longest_step, external: [0.0; 2] };
            for (particle, &place) in particles.iter_mut().zip(places) {
                parameters.take_over_one(particle, &slopes[place as usize], &forces[place as usize], &mut evaluation);
            }
            evaluation
        };
        blocks.map(of_block).collect_into_vec(&mut self.evaluations);
        let none = Evaluation { time_step: parameters.longest_step, external: [0.0; 2] };
        self.evaluations.iter().fold(none, |all, block| Evaluation {
            time_step: all.time_step.min(block.time_step),
            external: [0, 1].map(|k| all.external[k] + block.external[k]),
        })
    }
}

impl Parameters {
    fn take_over_one(&self, particle: &mut Particle, slopes: &Slopes, force: &Force, evaluation: &mut Evaluation) {
        particle.surface_slope = slopes.surface;
        if particle.outside.is_some() {
            [particle.ax, particle.ay] = [0.0; 2];
            return;
        }
        [particle.ax, particle.ay] = force.acceleration;
        let wave = (self.gravity * particle.depth).sqrt();
        let squeeze = 2.0 * particle.h * (-(slopes.u[0] + slopes.v[1])).max(0.0);
        let pull = (particle.h * (particle.ax * particle.ax + particle.ay * particle.ay).sqrt()).sqrt();
        let longest = self.cfl * particle.h / (wave + squeeze).max(pull);
        // What is not a number must not be lost in a minimum: it ends the run.
        evaluation.time_step = if longest.is_nan() { 0.0 } else { evaluation.time_step.min(longest) };
        evaluation.external = [0, 1].map(|k| evaluation.external[k] + force.external[k]);
    }
}

impl Scheme for Balanced {
    fn before(&self) -> f64 {
        0.5
    }

    fn arrange(&mut self, particles: &mut Vec<Particle>, surroundings: &Surroundings, sizes: Sizes) {
        self.arrangement.arrange(particles, |p| (p.x, p.y, 2.0 * p.h), &surroundings.edges, sizes.cell);
        self.arrangement.sort(particles, &mut self.spare);
        self.fill_weights(particles, sizes.even);
    }

    fn evaluate(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> Evaluation {
        self.find_densities();
        self.add_walls_to_densities(particles, &surroundings.obstacles);
        self.find_depths(particles, surroundings);
        self.fill_columns(particles, 0.5 * step);
        self.show_images(surroundings);
        let obstacles = &surroundings.obstacles;
        gradients::find(self.parameters.gravity, &self.arrangement, &self.columns, obstacles, &mut self.slopes);
        self.turn_images(&surroundings.edges);
        self.forces.resize(self.arrangement.len(), Force::default());
        forces::find(&self.parameters, &self.arrangement, &self.columns, &self.slopes, &mut self.forces);
        self.add_walls_to_forces(obstacles);
        self.take_over(particles)
    }

    fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    fn on_obstacles(&self) -> &[[f64; 2]] {
        &self.near_walls.on_obstacles
    }

    fn bytes(&self) -> usize {
        let places = self.arrangement.len();
        let each = size_of::<Column>() + size_of::<Density>() + size_of::<Slopes>() + size_of::<Force>();
        self.arrangement.bytes()
            + places * each
            + 8 * self.weights.capacity()
            + self.spare.capacity() * size_of::<Particle>()
    }
}
