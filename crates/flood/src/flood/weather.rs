//! Rain and infiltration in a step.

use super::{DENSITY, Flood, State};
use crate::particle::Particle;
use crate::rain::{Drop, Ground, RainFunction};
use crate::refinement::Refinement;
use crate::setup;
use corpuscle_scene::{Flood as Settings, Scheme as SchemeName};
use rand::RngExt;

/// It rains once in so many steps: seldom enough to cost next to nothing, often enough to be smooth.
const STEPS: u64 = 8;

/// A new particle stands at random within this share of its cell, along each side.
const SCATTER: f64 = 0.7;

/// The widest distance at which particles of a film stand, m: as far as they are not split, or see each other.
pub(super) fn widest(settings: &Settings, spacing: f64, refinement: Option<&Refinement>) -> f64 {
    refinement.map_or(settings.balanced.largest_smoothing * spacing, Refinement::widest)
}

impl Flood {
    /// Lets it rain as `rain` says, m/s over x, y, m, and time, s, instead of as the scene does. A graphics card is told of it ahead, at
    /// some times; one with too little memory for that takes no more steps.
    pub fn rain(&mut self, rain: RainFunction) {
        let widest = widest(&self.settings, self.spacing, self.refinement.as_ref());
        let ground = Ground::under(rain, &self.surroundings.terrain, self.volume, widest);
        self.state.wetness = ground.dry();
        self.ground = Some(ground);
        #[cfg(feature = "gpu")]
        if let Some(card) = self.card.take()
            && self.open_card(card.gpu()).is_err()
        {
            self.card = None;
        }
    }

    /// Lets it rain and soak in, where it is time to; whether particles may be left without volume, to be taken out.
    pub(super) fn weather(&mut self) -> bool {
        let Some(ground) = self.ground.as_ref().filter(|_| self.state.steps.is_multiple_of(STEPS)) else {
            return false;
        };
        let State { particles, wetness, momentum, time, .. } = &mut self.state;
        let drops = ground.wet(wetness, particles, *time);
        momentum.book(-DENSITY * std::mem::take(&mut wetness.momentum));
        for drop in drops {
            let particle = self.particle_of(&drop);
            self.state.particles.push(particle);
        }
        true
    }

    fn particle_of(&mut self, drop: &Drop) -> Particle {
        let id = self.state.next_id;
        self.state.next_id += 1;
        let mut random = setup::random(self.seed, id);
        let [x, y] = [0, 1].map(|axis| {
            let part = 0.5 + SCATTER * random.random_range(-0.5..0.5);
            drop.corner[axis] + part * drop.size[axis]
        });
        let h = match self.settings.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => {
                self.settings.balanced.smoothing * (drop.size[0] * drop.size[1]).sqrt()
            }
            SchemeName::SphSwe => self.h,
        };
        Particle::new(id, x, y, drop.volume, h)
    }
}
