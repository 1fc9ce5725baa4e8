//! Humid air drawn where it lies: the air as buffers of the card that takes the steps.

use super::{Dew, failed};
use crate::card::Card;
use crate::wetting::Wetting;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError};
use corpuscle_model::{Companion, Frame, Model, ModelError};
use std::sync::atomic::AtomicBool;

/// So long, s of wall-clock time, are steps ordered at once for who watches.
pub(super) const AHEAD: f64 = 0.012;

/// Who looks after each batch of steps.
pub(crate) struct Watch<'a> {
    /// Whether the air is seen, or only what the host has.
    pub sees_air: bool,
    /// Is given the time, s, and the drops, and the air on the device.
    pub show: &'a mut dyn FnMut(Frame, Option<DeviceParticles>),
}

impl Dew {
    /// The card that takes the steps, where one does.
    pub fn card(&self) -> Option<Gpu> {
        self.card.as_ref().map(Card::gpu)
    }

    /// The parcels of air that [`Model::frame`] gives, as buffers of the card that takes the steps, without a copy to the host. They hold
    /// until the air moves on. None where no card takes the steps.
    ///
    /// # Errors
    /// [`ModelError::Device`] where the card has too little memory for them.
    pub fn on_device(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let seen = self.card.as_ref().map(|card| card.seen(self.scale().spacing, self.since()));
        seen.transpose().map_err(|error| failed(&error))
    }

    /// Goes on to `time`, s, as [`Model::advance_with`] does, and shows every few steps (a hundredth of a second of wall-clock time, and all
    /// between which drops have their turn, at most) what time it is and the drops, and where `sees_air` the air on the card. Nothing of
    /// the air comes back until it arrives, or `stop` becomes true. Without a card nobody is shown anything.
    ///
    /// # Errors
    /// Those of `advance_to`, and [`ModelError::Device`] where the card has too little memory.
    pub fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        sees_air: bool,
        show: &mut dyn FnMut(Frame, Option<DeviceParticles>),
    ) -> Result<(), ModelError> {
        match &self.card {
            None => self.advance_with(time, stop, companion),
            Some(_) => self.advance_measured(time, stop, companion, &mut Some(Watch { sees_air, show })),
        }
    }

    /// Shows how it stands after a step.
    pub(super) fn show_to(&self, watch: &mut Watch<'_>) -> Result<(), GpuError> {
        let drops = self.wetting.as_ref().map(Wetting::set);
        let card = self.card.as_ref().filter(|_| watch.sees_air);
        let air = card.map(|card| card.seen(self.scale().spacing, 0.0)).transpose()?;
        (watch.show)(Frame { time: self.state.time, sets: drops.into_iter().collect() }, air);
        Ok(())
    }
}
