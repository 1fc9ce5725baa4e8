//! Humid air drawn where it lies: the air as buffers of the card that takes the steps.

use super::{Dew, failed};
use crate::card::Card;
use crate::wetting::Wetting;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError};
use corpuscle_model::{Companion, Frame, Model, ModelError};
use std::sync::atomic::AtomicBool;

/// Who looks at the drops, and at the air on the card.
pub(crate) struct Watch<'a> {
    /// When it wants to see them, s.
    pub wanted: f64,
    /// Whether the air is seen, or only what the host has.
    pub sees_air: bool,
    /// Is given the time, s, and the drops, and the air on the device; gives when it wants to see them next.
    pub show: &'a mut dyn FnMut(Frame, Option<DeviceParticles>) -> f64,
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

    /// Goes on to `time`, s, as [`Model::advance_with`] does, and shows from the time `first`, s, on what time it is, the drops, and where
    /// `sees_air` the air on the card; `show` gives when it wants to see them next, s, no sooner than at the end of the next step. Nothing of
    /// the air comes back until it arrives, or `stop` becomes true. Without a card nobody is shown anything.
    ///
    /// # Errors
    /// Those of `advance_to`, and [`ModelError::Device`] where the card has too little memory.
    pub fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        (first, sees_air): (f64, bool),
        show: &mut dyn FnMut(Frame, Option<DeviceParticles>) -> f64,
    ) -> Result<(), ModelError> {
        match &self.card {
            None => self.advance_with(time, stop, companion),
            Some(_) => {
                let watch = Some(Watch { wanted: first, sees_air, show });
                self.advance_measured(time, stop, companion, watch)
            }
        }
    }

    /// Shows how it stands now to who wants to see it by now.
    pub(super) fn show_to(&self, watch: &mut Option<Watch<'_>>) -> Result<(), GpuError> {
        let Some(watch) = watch.as_mut().filter(|watch| watch.wanted <= self.shown) else { return Ok(()) };
        let drops = self.wetting.as_ref().map(Wetting::set);
        let card = self.card.as_ref().filter(|_| watch.sees_air);
        let air = card.map(|card| card.seen(self.scale().spacing, self.since())).transpose()?;
        let next = (watch.show)(Frame { time: self.shown, sets: drops.into_iter().collect() }, air);
        watch.wanted = next.max(self.shown + self.state.time_step);
        Ok(())
    }
}
