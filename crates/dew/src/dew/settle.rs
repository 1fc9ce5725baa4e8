//! The air before anything happens: spread evenly between the solids.

use super::Dew;
use crate::air::{Rates, Role};
use crate::constants::FARTHEST_SPREAD;
use crate::settings::WallTreatment;
use crate::solids::contact::Pair;
use crate::walls;
use rayon::prelude::*;

/// Most steps by which the air is evened out at the start, how far each goes over the square of the spacing and the
/// gradient of crowding, and the gradient, over the spacing, that is even enough.
const SETTLING: u32 = 200;
const SETTLING_STEP: f64 = 0.2;
const EVEN: f64 = 1e-3;

impl Dew {
    /// Spreads the air evenly between the solids before anything happens.
    pub(super) fn settle(&mut self) {
        let completes =
            |walls: &WallTreatment| matches!(walls, WallTreatment::DensityCorrection | WallTreatment::Ghosts);
        let completed = self.contact.walls.is_empty() || self.contact.walls.iter().any(completes);
        let walls = self.contact.walls.clone();
        if completed {
            // Solids that leave the air's density incomplete would draw the air in that spreads between the others.
            let completing = |walls: &&mut WallTreatment| !completes(walls);
            self.contact
                .walls
                .iter_mut()
                .filter(completing)
                .for_each(|walls| *walls = WallTreatment::DensityCorrection);
        }
        self.spread_evenly(if completed { SETTLING } else { 0 });
        self.evaluate(0.0);
        if completed {
            self.take_as_rest();
        }
        self.contact.walls = walls;
        self.evaluate(0.0);
        self.take_out_repelled();
    }

    /// The pressure at rest becomes that of the air as it stands: neither too much nor too little of it is in the room.
    pub(super) fn take_as_rest(&mut self) {
        let sum = self.processes.total_of(self.inside().map(|particle| particle.density).collect());
        self.rest_density = sum / (self.inside_count() as f64).max(1.0);
    }

    /// Evens out the air in the room, in `most` sweeps at most.
    pub(super) fn spread_evenly(&mut self, most: u32) {
        let (room, spacing) = (self.room, self.scale.spacing);
        for _ in 0..most {
            self.evaluate(0.0);
            let uneven = |rates: &Rates| rates.spread.iter().fold(0.0_f64, |most, along| most.max(along.abs()));
            let most_uneven = self.rates.par_iter().map(uneven).reduce(|| 0.0, f64::max);
            if -self.processes.least(-most_uneven) * spacing < EVEN {
                break;
            }
            let particles = self.state.air.par_iter_mut().zip(&self.rates).with_min_len(1024);
            particles.filter(|(particle, _)| particle.role == Role::Inside).for_each(|(particle, rates)| {
                let farthest = FARTHEST_SPREAD * spacing;
                for axis in 0..3 {
                    let step = SETTLING_STEP * spacing * spacing * rates.spread[axis];
                    particle.position[axis] += step.clamp(-farthest, farthest);
                }
                room.keep(&mut particle.position, &mut particle.velocity);
            });
        }
    }

    /// Takes out air that a virtual force would throw off at the start: where it acts there is a vacuum.
    fn take_out_repelled(&mut self) {
        let Self { contact, state, scale, processes, .. } = self;
        let is_repelled = |pair: &Pair| {
            contact.walls[pair.other as usize] == WallTreatment::VirtualForce && pair.r < walls::CALM * scale.spacing
        };
        let mut stays = vec![true; state.air.len()];
        for near in contact.near.iter().filter(|near| contact.of_air(near).iter().any(is_repelled)) {
            stays[near.particle as usize] = false;
        }
        if !processes.any(stays.contains(&false)) {
            return;
        }
        let mut stays = stays.into_iter();
        state.air.retain(|_| stays.next() == Some(true));
        self.evaluate(0.0);
    }
}
