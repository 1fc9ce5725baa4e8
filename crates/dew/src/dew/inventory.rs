//! Steps in which particles of air come and go.

use super::Dew;
use crate::inventory::Inventory;
use crate::solids::Body;

impl Dew {
    /// What passes that add and remove particles work on.
    pub(super) fn inventory(&mut self) -> Inventory<'_> {
        Inventory {
            settings: &self.settings,
            air: &self.air,
            room: &self.room,
            inflows: &self.inflows,
            scale: &self.scale,
            solids: &self.solids,
            surfaces: &self.surfaces,
            rest_density: self.rest_density,
            latent_heat: self.latent_heat,
            processes: &self.processes,
            domain: self.domain.as_ref(),
            state: &mut self.state,
        }
    }

    /// Fills the room, and what lies beyond its faces, with air on a lattice.
    pub(super) fn fill(&mut self, bodies: &[Body], start: impl Fn([f64; 3]) -> [f64; 2]) {
        self.open_sides = self.inventory().fill(bodies, start);
    }

    /// Air crosses faces that let it pass, is let in, and is let go.
    pub(super) fn cross_faces(&mut self, step: f64) {
        let mut sides = std::mem::take(&mut self.open_sides);
        self.inventory().cross_faces(step, &mut sides);
        self.open_sides = sides;
    }

    /// The air outside open sides takes the velocity of the air before them, and where it has moved in there is more of it.
    pub(super) fn move_outside(&mut self) {
        let mut sides = std::mem::take(&mut self.open_sides);
        self.inventory().move_outside(&mut sides);
        self.open_sides = sides;
    }
}
