//! The published model, formula by formula: depths, smoothing lengths and accelerations of the particles.
//!
//! The weights of the smoothing kernel for density, pressure and viscosity, in two dimensions at
//! the particle's own smoothing length; a fixed time step; the terrain-difference velocity control force.
//!
//! Not printed in the paper and taken from where its table points (Mueller, Charypar & Gross 2003): the pressure
//! p = k (rho - rho0) with their symmetric pair force, and their viscosity.

use super::neighbours::Arrangement;
use super::particle::Particle;
use super::surroundings::Surroundings;
use bytemuck::{Pod, Zeroable};
use corpuscle_scene::{SmoothingForm, SphSwe};

/// What the force pass reads of a particle or ghost particle: one cache line, a row of numbers to gather.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Column {
    pub x: f64,
    pub y: f64,
    pub u: f64,
    pub v: f64,
    /// Area that it stands for, mass over density, m2.
    pub area: f64,
    pub density: f64,
    pub(super) pressure: f64,
    pub h: f64,
}

/// The scheme with its working memory.
pub(crate) struct SphSweSolver {
    pub(super) parameters: SphSwe,
    /// Initial smoothing length, m.
    pub(super) h0: f64,
    pub(super) gravity: f64,
    pub(super) arrangement: Arrangement,
    pub(super) columns: Vec<Column>,
    /// Volumes at the indices of the arrangement, m3; none where all particles have the same.
    pub(super) volumes: Vec<f64>,
    /// Depths at the indices of the arrangement, m; 1/m2, still to be taken times the volume, where all particles have the same.
    pub(super) densities: Vec<f64>,
    pub(super) accelerations: Vec<[f64; 2]>,
    pub(super) of_groups: Vec<[f64; 2]>,
    spare: Vec<Particle>,
    /// Indices of the particles near obstacles in the arrangement.
    pub(super) near_walls: Vec<u32>,
    pub(super) of_walls: Vec<([f64; 2], Option<usize>)>,
    pub(super) on_obstacles: Vec<[f64; 2]>,
}

impl SphSweSolver {
    pub fn new(parameters: SphSwe, h0: f64, gravity: f64) -> Self {
        Self {
            parameters,
            h0,
            gravity,
            arrangement: Arrangement::default(),
            columns: Vec::new(),
            volumes: Vec::new(),
            densities: Vec::new(),
            accelerations: Vec::new(),
            of_groups: Vec::new(),
            spare: Vec::new(),
            near_walls: Vec::new(),
            of_walls: Vec::new(),
            on_obstacles: Vec::new(),
        }
    }

    /// Sorts the particles into cells of that size, m.
    pub fn arrange(&mut self, particles: &mut Vec<Particle>, surroundings: &Surroundings, cell: f64) {
        self.arrangement.arrange(particles, |p| (p.x, p.y, p.h), &surroundings.edges, cell);
        self.arrangement.sort(particles, &mut self.spare);
    }

    /// Finds depth, next smoothing length and acceleration of the particles as arranged, `step` s after the last time. Gives the force of ground, edges and
    /// obstacles on all the water, over its density, m4/s2.
    pub fn evaluate(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> [f64; 2] {
        self.find_densities(particles, surroundings, step);
        self.fill_columns(particles, surroundings);
        if self.parameters.smoothing == SmoothingForm::Rate {
            self.find_smoothing(particles, &surroundings.obstacles, step);
        }
        self.add_pair_forces();
        self.add_walls(particles, &surroundings.obstacles);
        self.add_external_forces(particles, surroundings, step)
    }

    /// The particles in their cells, as last arranged.
    pub fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    /// Force of the water on each obstacle at the last evaluation, over the density of water, m4/s2.
    pub fn on_obstacles(&self) -> &[[f64; 2]] {
        &self.on_obstacles
    }

    /// Switches the control force on or off.
    pub fn control(&mut self, on: bool) {
        self.parameters.control_force = on;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let each = size_of::<Column>() + size_of::<f64>() + size_of::<[f64; 2]>();
        self.arrangement.bytes()
            + self.volumes.capacity() * size_of::<f64>()
            + self.arrangement.len() * each
            + self.spare.capacity() * size_of::<Particle>()
    }
}
