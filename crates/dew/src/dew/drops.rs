//! Drops on the solids in a step.

use super::Dew;
use crate::drops::{DropLaws, Drops, SurfaceWater, Surfaces};
use crate::wetting::{Wetting, patch_of};
use corpuscle_solids::Solid;
use std::sync::Arc;

impl Dew {
    /// From here on water on the solids forms drops. `solids` are the bodies, in order.
    pub(crate) fn lay_drops(&mut self, laws: DropLaws, solids: Arc<[Solid]>, water: Vec<SurfaceWater>, seed: u64) {
        let (mut particles, mut patches) = (Vec::new(), Vec::new());
        for (number, particle) in self.solids.particles.iter().enumerate() {
            let Some(normal) = particle.normal.filter(|_| particle.area > 0.0) else { continue };
            particles.push(number as u32);
            patches.push(patch_of(particle, normal, &solids[particle.body as usize], self.scale.spacing));
        }
        let surfaces = Surfaces { solids, water, patches, room: [self.room.low, self.room.high] };
        self.wetting = Some(Wetting::new(Drops::new(laws, surfaces, seed), particles));
        self.set_evaporation();
    }

    /// Transfers what condensed or was laid on the solids to the drops, which move up to now.
    pub fn transfer_water_to_drops(&mut self) {
        let Some(wetting) = self.wetting.as_mut() else { return };
        let left = wetting.transfer_to_drops(&mut self.state.water_on, self.state.time);
        if self.processes.is_first() {
            self.state.water.book(-left);
        }
        self.set_evaporation();
    }

    /// Transfers condensed water to the drops, where that is due for `air` particles of air.
    pub(crate) fn update_drops(&mut self, air: usize) {
        let step = self.state.steps;
        let Some(wetting) = self.wetting.as_mut().filter(|wetting| wetting.is_due(step, air)) else { return };
        wetting.set_step(step);
        self.transfer_water_to_drops();
    }

    /// Sets the evaporation that the drops allow at the solids' particles.
    pub(crate) fn set_evaporation(&mut self) {
        if let Some(wetting) = &self.wetting {
            wetting.set_evaporation(self.scale.spacing, &mut self.evaporation);
        }
    }
}
