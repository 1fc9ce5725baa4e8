//! What a formulation of the water's motion does in a step.

use crate::arrangement::Arrangement;
use crate::edges::EdgeRules;
use crate::particle::Particle;
use corpuscle_terrain::Terrain;
use std::sync::Arc;

/// What the water moves in.
pub(crate) struct Surroundings {
    pub terrain: Arc<Terrain>,
    pub edges: EdgeRules,
    /// Time, s.
    pub time: f64,
}

/// What an evaluation of the forces tells beside the particles' accelerations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Evaluation {
    /// The largest sound time step from here, s.
    pub time_step: f64,
    /// Force of ground and edges on all the water, over the density of water, m4/s2.
    pub external: [f64; 2],
}

/// A formulation. A step is: `drift`, then water comes and goes, then `arrange`, `evaluate` and `kick`.
pub(crate) trait Scheme: Send {
    /// Moves the particles on by `step` s.
    fn drift(&self, particles: &mut [Particle], step: f64);

    /// Sorts the particles into cells of about `cell_size` m.
    fn arrange(&mut self, particles: &mut Vec<Particle>, surroundings: &Surroundings, cell_size: f64);

    /// Finds depth, next smoothing length and acceleration of the particles as arranged, `step` s after the last time.
    fn evaluate(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> Evaluation;

    /// Brings the velocities to the end of a step of `step` s.
    fn kick(&self, particles: &mut [Particle], step: f64);

    /// The particles in their cells, as last arranged.
    fn arrangement(&self) -> &Arrangement;

    /// Bytes held.
    fn bytes(&self) -> usize;
}
