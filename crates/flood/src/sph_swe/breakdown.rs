//! Ends a run in which a value is no longer a number, before anything of it is written.

use super::SphSweFlood;
use super::particle::{Defect, Particle};
use corpuscle_model::ModelError;

/// Coordinates in messages are rounded to one part in so many of a metre or degree.
const COORDINATE: f64 = 1e6;

impl SphSweFlood {
    /// The error for the particles of which some have a value that no water has; none where none does. It names the
    /// particle whose defect is nearest to the cause.
    pub(super) fn defect_among(&self, particles: &[Particle], time: f64, step: u64) -> Option<ModelError> {
        let broken = particles.iter().filter_map(|particle| Some((particle, particle.defect()?)));
        let (particle, Defect { quantity, value, .. }) = broken.min_by_key(|(_, defect)| defect.rank)?;
        let position = self.position_of(particle);
        let what = format!(
            "{position} the {quantity} of particle {} is {value:.4e}. Look at the ground and the water there, in the last frame; \
             a shorter time step (flood.sph_swe.time_step_s) or a smaller flood.spacing_m may help",
            particle.id
        );
        Some(ModelError::Breakdown { time, step, what })
    }

    /// The position of a particle, in words; the last finite one, if it is not finite now.
    fn position_of(&self, particle: &Particle) -> String {
        let is_known = |particle: &&Particle| particle.x.is_finite() && particle.y.is_finite();
        let before = || self.state.particles.iter().filter(|before| before.id == particle.id).find(is_known);
        let Some(known) = Some(particle).filter(is_known).or_else(before) else {
            return "at an unknown position".into();
        };
        let own = self.surroundings.terrain.to_own([known.x, known.y]);
        let [x, y] = own.map(|along| (along * COORDINATE).round() / COORDINATE);
        format!("at x = {x}, y = {y} in the terrain's coordinates")
    }

    /// The error for particles of the state of which some have a value that no water has. These are taken out, so that
    /// what is written of the state at the end of the run holds numbers only.
    pub(super) fn remove_defects(&mut self) -> ModelError {
        let (time, steps) = (self.state.time, self.state.steps);
        let error = self.defect_among(&self.state.particles, time, steps).unwrap_or_else(|| self.breakdown());
        self.state.particles.retain(Particle::is_sound);
        self.arrange();
        error
    }
}
