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

use crate::arrangement::Arrangement;
use crate::density::Density;
use crate::edges::{EdgeRule, EdgeRules};
use crate::particle::Particle;
use corpuscle_terrain::Terrain;
use forces::Force;
use rayon::prelude::*;

/// What the passes read of a particle or image: one cache line.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Column {
    x: f64,
    y: f64,
    u: f64,
    v: f64,
    /// Height of the water's surface, m.
    surface: f64,
    depth: f64,
    /// Area that the particle stands for, 1/n, m2.
    area: f64,
    h: f64,
}

/// First-order exact slopes, and what goes with them.
#[derive(Debug, Clone, Copy, Default)]
struct Slopes {
    /// Renormalisation matrix B (symmetric): xx, xy, yy.
    renormalisation: [f64; 3],
    surface: [f64; 2],
    u: [f64; 2],
    v: [f64; 2],
    ground: [f64; 2],
    /// How much at rest the water is here: 1 at rest, 0 in motion.
    rest: f64,
    /// Share of the neighbourhood that is there: 1 inside the water, less at its rim.
    fullness: f64,
}

/// Numbers of the scheme.
#[derive(Debug, Clone)]
pub struct Parameters {
    /// Acceleration of gravity, m/s2.
    pub gravity: f64,
    /// Smoothing length over particle distance.
    pub eta: f64,
    /// Largest smoothing length, m.
    pub largest_h: f64,
    /// Time step over (smoothing length / wave speed).
    pub cfl: f64,
}

/// The scheme with its working memory.
pub struct Balanced {
    pub parameters: Parameters,
    pub arrangement: Arrangement,
    columns: Vec<Column>,
    densities: Vec<Density>,
    slopes: Vec<Slopes>,
    forces: Vec<Force>,
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
            spare: Vec::new(),
        }
    }

    /// Sorts the particles into cells and finds their depths, accelerations and divergence. Velocities are taken `ahead`
    /// seconds later by the present acceleration. Returns the largest sound time step, s.
    pub fn evaluate(&mut self, particles: &mut Vec<Particle>, edges: &EdgeRules, terrain: &Terrain, ahead: f64) -> f64 {
        self.arrange(particles, edges);
        self.find_densities(particles, terrain, ahead);
        self.show_images(edges, terrain);
        gradients::find(self.parameters.gravity, &self.arrangement, &self.columns, &mut self.slopes);
        self.turn_images(edges);
        forces::find(self.parameters.gravity, &self.arrangement, &self.columns, &self.slopes, &mut self.forces);
        self.take_over(particles)
    }

    fn arrange(&mut self, particles: &mut Vec<Particle>, edges: &EdgeRules) {
        let mean_h = particles.iter().map(|p| p.h).sum::<f64>() / particles.len().max(1) as f64;
        // Images must cover what reaches across the edge, from this side or from beyond.
        let margin = |_: f64, _: f64, reach: f64| 1.5 * reach;
        let reaching = particles.iter().map(|p| (p.x, p.y, 2.0 * p.h));
        self.arrangement.arrange(reaching, edges, margin, 1.2 * mean_h.max(1e-12));
        self.arrangement.sort(particles, &mut self.spare);
        let places = self.arrangement.len();
        self.columns.resize(places, Column::default());
        self.densities.resize(places, Density::default());
        self.slopes.resize(places, Slopes::default());
        self.forces.resize(places, Force::default());
    }

    fn find_densities(&mut self, particles: &mut [Particle], terrain: &Terrain, ahead: f64) {
        let Arrangement { cells, lists, x, y, reach_squared, .. } = &mut self.arrangement;
        lists.search(cells, x, y, reach_squared, &mut self.densities, |found| {
            Density::sum(&found, reach_squared[found.particle].sqrt() / 2.0)
        });
        let Parameters { eta, largest_h, .. } = self.parameters;
        let real = &self.arrangement.real;
        let densities = &self.densities;
        particles.par_iter_mut().zip(real).for_each(|(particle, &place)| {
            let density = &densities[place as usize];
            particle.depth = particle.volume * density.number;
            (particle.ground, _) = terrain.height_and_slope(particle.x, particle.y);
            particle.h = density.next_h(particle.h, eta).min(largest_h);
        });
        for (particle, &place) in particles.iter().zip(real) {
            let slope = terrain.height_and_slope(particle.x, particle.y).1;
            self.slopes[place as usize].ground = slope;
            self.columns[place as usize] = Column {
                x: particle.x,
                y: particle.y,
                u: particle.u + ahead * particle.ax,
                v: particle.v + ahead * particle.ay,
                surface: particle.ground + particle.depth,
                depth: particle.depth,
                area: 1.0 / densities[place as usize].number,
                h: self.arrangement.reach_squared[place as usize].sqrt() / 2.0,
            };
        }
    }

    /// Fills in the images from the particles that they show.
    fn show_images(&mut self, edges: &EdgeRules, terrain: &Terrain) {
        for &(place, source) in &self.arrangement.images {
            let place = place as usize;
            let image = self.arrangement.entries[place].image;
            let mut column = self.columns[source as usize];
            let mut ground = self.slopes[source as usize].ground;
            let bottom = column.surface - column.depth;
            let (x, y) = (self.arrangement.x[place], self.arrangement.y[place]);
            if image.x != 0 {
                match edges.along_x(image.x) {
                    EdgeRule::Periodic => {}
                    EdgeRule::Wall => (column.u, ground[0]) = (-column.u, -ground[0]),
                    EdgeRule::Open | EdgeRule::Stage(_) => {
                        // The ground goes on as it fell towards the edge, never rising beyond it.
                        let edge = terrain.height(0.5 * (x + column.x), column.y);
                        column.surface += (2.0 * (edge - bottom)).min(0.0);
                    }
                }
            }
            if image.y != 0 {
                match edges.along_y(image.y) {
                    EdgeRule::Periodic => {}
                    EdgeRule::Wall => (column.v, ground[1]) = (-column.v, -ground[1]),
                    EdgeRule::Open | EdgeRule::Stage(_) => {
                        let edge = terrain.height(column.x, 0.5 * (y + column.y));
                        column.surface += (2.0 * (edge - bottom)).min(0.0);
                    }
                }
            }
            (column.x, column.y) = (x, y);
            self.columns[place] = column;
            self.slopes[place].ground = ground;
        }
    }

    /// Turns the slopes of the images as their edges turn them.
    fn turn_images(&mut self, edges: &EdgeRules) {
        for &(place, source) in &self.arrangement.images {
            let image = self.arrangement.entries[place as usize].image;
            let ground = self.slopes[place as usize].ground;
            let mut slopes = self.slopes[source as usize];
            slopes.ground = ground;
            if image.x != 0 && *edges.along_x(image.x) != EdgeRule::Periodic {
                let wall = *edges.along_x(image.x) == EdgeRule::Wall;
                slopes.renormalisation[1] = -slopes.renormalisation[1];
                if wall {
                    slopes.surface[0] = -slopes.surface[0];
                    slopes.u[1] = -slopes.u[1];
                    slopes.v[0] = -slopes.v[0];
                } else {
                    (slopes.surface[0], slopes.u[0], slopes.v[0]) = (0.0, 0.0, 0.0);
                }
            }
            if image.y != 0 && *edges.along_y(image.y) != EdgeRule::Periodic {
                let wall = *edges.along_y(image.y) == EdgeRule::Wall;
                slopes.renormalisation[1] = -slopes.renormalisation[1];
                if wall {
                    slopes.surface[1] = -slopes.surface[1];
                    slopes.v[0] = -slopes.v[0];
                    slopes.u[1] = -slopes.u[1];
                } else {
                    (slopes.surface[1], slopes.u[1], slopes.v[1]) = (0.0, 0.0, 0.0);
                }
            }
            self.slopes[place as usize] = slopes;
        }
    }

    /// Hands the forces to the particles and returns the largest sound time step, s.
    fn take_over(&self, particles: &mut [Particle]) -> f64 {
        particles
            .par_iter_mut()
            .zip(&self.arrangement.real)
            .map(|(particle, &place)| {
                let force = &self.forces[place as usize];
                let slopes = &self.slopes[place as usize];
                [particle.ax, particle.ay] = force.acceleration;
                particle.divergence = slopes.u[0] + slopes.v[1];
                let wave = (self.parameters.gravity * particle.depth).sqrt();
                let squeeze = 2.0 * particle.h * (-particle.divergence).max(0.0);
                let pull = (particle.h * particle.ax.hypot(particle.ay)).sqrt();
                self.parameters.cfl * particle.h / (wave + squeeze).max(pull).max(1e-12)
            })
            .reduce(|| f64::INFINITY, f64::min)
    }
}
impl Balanced {
    pub fn probe(&self, place: usize) -> (f64, f64, f64) {
        let c = &self.columns[place];
        (c.depth, c.h, c.area)
    }
}
