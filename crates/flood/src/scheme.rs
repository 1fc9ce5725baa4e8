//! What a formulation of the water's motion does in a step.

use crate::arrangement::Arrangement;
use crate::edges::{EdgeRule, EdgeRules};
use crate::obstacles::Obstacles;
use crate::particle::Particle;
use corpuscle_terrain::Terrain;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What the water moves in.
pub(crate) struct Surroundings {
    pub terrain: Arc<Terrain>,
    pub edges: EdgeRules,
    pub obstacles: Obstacles,
    /// Time, s.
    pub time: f64,
}

/// How many places of the ground are looked up together.
pub(crate) const TOGETHER: usize = 64;

impl Surroundings {
    /// Looks up the ground under [`TOGETHER`] particles, or fewer. Beyond an edge it goes on as it falls towards it, and never
    /// rises.
    pub fn find_ground(&self, particles: &mut [Particle]) {
        let last = particles.len() - 1;
        let places: [_; TOGETHER] = std::array::from_fn(|k| &particles[k.min(last)]);
        let [heights, slopes_x, slopes_y] =
            self.terrain.heights_and_slopes(&places.map(|particle| particle.x), &places.map(|particle| particle.y));
        let bounds = self.edges.bounds;
        for (k, particle) in particles.iter_mut().enumerate() {
            (particle.ground, particle.ground_slope) = (heights[k], [slopes_x[k], slopes_y[k]]);
            if !bounds.contains(particle.x, particle.y) {
                let dx = particle.x - particle.x.clamp(bounds.x_min, bounds.x_max);
                let dy = particle.y - particle.y.clamp(bounds.y_min, bounds.y_max);
                particle.ground += (slopes_x[k] * dx).min(0.0) + (slopes_y[k] * dy).min(0.0);
            }
        }
    }

    /// The level at which the side over which a particle has left is held, m, if it is.
    pub fn stage(&self, outside: Option<u8>) -> Option<f64> {
        match &self.edges.rules[usize::from(outside?)] {
            EdgeRule::Stage(level) => Some(level.at(self.time)),
            _ => None,
        }
    }
}

/// What is known of all particles together, for sorting them.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Sizes {
    /// Size of a cell, m.
    pub cell: f64,
    /// Whether all particles have the same weight.
    pub even: bool,
}

/// What an evaluation of the forces tells beside the particles' accelerations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Evaluation {
    /// The largest sound time step from here, s.
    pub time_step: f64,
    /// Force of ground and edges on all the water, over the density of water, m4/s2.
    pub external: [f64; 2],
}

/// A formulation. In a step particles are accelerated as far as `before` says, move, water comes and goes; then `arrange`,
/// `evaluate`, and they are accelerated the rest.
pub(crate) trait Scheme: Send {
    /// The part of a step's acceleration that comes before the particles move.
    fn before(&self) -> f64;

    /// Sorts the particles into cells.
    fn arrange(&mut self, particles: &mut Vec<Particle>, surroundings: &Surroundings, sizes: Sizes);

    /// Finds depth, next smoothing length and acceleration of the particles as arranged, `step` s after the last time.
    fn evaluate(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> Evaluation;

    /// The particles in their cells, as last arranged.
    fn arrangement(&self) -> &Arrangement;

    /// Force of the water on each obstacle at the last evaluation, over the density of water, m4/s2.
    fn on_obstacles(&self) -> &[[f64; 2]];

    /// Switches the control force on or off; false where the scheme has none.
    fn control(&mut self, _on: bool) -> bool {
        false
    }

    /// Bytes held.
    fn bytes(&self) -> usize;
}
