//! The ground under the particles.

#[cfg(feature = "gpu")]
pub(super) mod upload;

use super::particle::Particle;
use super::surroundings::Surroundings;

/// Number of positions of the ground that are evaluated together.
pub(super) const GROUND_BLOCK: usize = 64;

impl Surroundings {
    /// Evaluates the ground under [`GROUND_BLOCK`] particles, or fewer. Beyond an edge it goes on as it falls towards it, and never
    /// rises.
    pub fn find_ground(&self, particles: &mut [Particle]) {
        let last = particles.len() - 1;
        let padded: [_; GROUND_BLOCK] = std::array::from_fn(|k| &particles[k.min(last)]);
        let [heights, slopes_x, slopes_y] =
            self.terrain.heights_and_slopes(&padded.map(|particle| particle.x), &padded.map(|particle| particle.y));
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
}
