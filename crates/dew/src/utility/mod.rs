//! Air that no longer matters to any solid (patent CN106650064B): far from all of them and receding, by velocity and force.
//!
//! It only moves: nothing warms, moistens or pushes it, and to the air that matters it is as air beyond an outlet. After a while it
//! is removed. The ledger books it as outflow when it becomes of low utility, and as inflow if it turns back.

#[cfg(feature = "gpu")]
pub(crate) mod upload;

use crate::air::{Particle, Role};
use crate::constants::{PROBE_STEP, UTILITY_STEPS};
use crate::inventory::Inventory;
use crate::settings::LowUtility;
use crate::solids::Surface;
use rayon::prelude::*;

/// Distance beyond that of low utility from which air is removed, in smoothing lengths: air that matters has no neighbours in the gap.
pub(crate) const CULL_MARGIN: f64 = 2.0;

/// Class of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Utility {
    Matters,
    Low,
    Gone,
}

impl Inventory<'_> {
    /// Finds the air of low utility, where a search is due, and removes what has been so for long.
    pub(crate) fn update_utility(&mut self) {
        let Some(low) = self.settings.low_utility.filter(|_| self.state.steps.is_multiple_of(UTILITY_STEPS)) else {
            return;
        };
        let elapsed = self.state.time - self.state.utility_seen;
        self.state.utility_seen = self.state.time;
        let zone = Zone { surfaces: self.surfaces, h: self.scale.h(), sound_speed: self.air.sound_speed, low };
        let utilities: Vec<Utility> =
            self.state.air.par_iter().with_min_len(256).map(|particle| zone.utility(particle)).collect();
        let mut air = std::mem::take(&mut self.state.air);
        for (particle, utility) in air.iter_mut().zip(&utilities) {
            match (particle.role, utility) {
                (Role::Inside, Utility::Low) => {
                    self.book(particle, -1.0);
                    (particle.role, particle.idle, particle.spreading) = (Role::Idle, 0.0, [0.0; 3]);
                }
                (Role::Idle, Utility::Matters) => {
                    particle.role = Role::Inside;
                    self.book(particle, 1.0);
                }
                (Role::Idle, _) => particle.idle += elapsed,
                _ => {}
            }
        }
        let mut utility = utilities.into_iter();
        air.retain(|_| utility.next() != Some(Utility::Gone));
        self.state.air = air;
    }
}

/// The criteria of utility.
struct Zone<'a> {
    surfaces: &'a [Surface],
    /// Smoothing length, m.
    h: f64,
    /// m/s.
    sound_speed: f64,
    low: LowUtility,
}

impl Zone<'_> {
    fn utility(&self, particle: &Particle) -> Utility {
        if !matches!(particle.role, Role::Inside | Role::Idle) {
            return Utility::Matters;
        }
        let distance = self.distance(particle.position);
        if distance < self.low.distance * self.h || !self.recedes(particle, distance) {
            return Utility::Matters;
        }
        let is_far = distance > (self.low.distance + CULL_MARGIN) * self.h;
        let was_long = particle.role == Role::Idle && particle.idle > self.low.after;
        if is_far && was_long { Utility::Gone } else { Utility::Low }
    }

    fn distance(&self, position: [f64; 3]) -> f64 {
        self.surfaces.iter().map(|surface| surface(position)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a particle moves away from the nearest solid, now and with the velocity that the force gives it while sound crosses a
    /// smoothing length.
    fn recedes(&self, particle: &Particle, distance: f64) -> bool {
        let later = self.h / self.sound_speed;
        let with_force = [0, 1, 2].map(|axis| particle.velocity[axis] + later * particle.acceleration[axis]);
        [particle.velocity, with_force].into_iter().all(|velocity| {
            let speed = velocity.iter().map(|along| along * along).sum::<f64>().sqrt();
            let ahead = |axis: usize| particle.position[axis] + PROBE_STEP * self.h * velocity[axis] / speed;
            speed > 0.0 && self.distance([0, 1, 2].map(ahead)) > distance
        })
    }
}
