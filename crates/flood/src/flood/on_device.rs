//! A flood drawn where it lies: its particles as buffers of the card that takes the steps.

use super::Flood;
use super::measured_on_card::Onlookers;
use super::on_card::failed;
use crate::card::{Card, Shown};
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError};
use corpuscle_model::{Companion, Model, ModelError};
use std::sync::atomic::AtomicBool;

/// Who looks at the particles on the card.
pub(super) struct Watch<'a> {
    /// When it wants to see them, s: at the end of the next step if that has passed.
    pub wanted: f64,
    pub shown: Shown,
    /// Is told the time, s, and where they are, and gives when it wants to see them next.
    pub show: &'a mut dyn FnMut(f64, &DeviceParticles) -> f64,
}

impl Flood {
    /// The card that takes the steps, where one does.
    pub fn card(&self) -> Option<Gpu> {
        self.card.as_ref().map(Card::gpu)
    }

    /// The particles that [`Model::frame`] gives, as buffers of the card that takes the steps, without a copy
    /// to the host; heights are those of the water's surface. They hold until the water moves on. None where no card takes the steps.
    ///
    /// # Errors
    /// [`ModelError::Device`] where the card has too little memory for them.
    pub fn on_device(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let seen = self.card.as_ref().map(|card| card.seen(self.particles_shown(self.since())));
        seen.transpose().map_err(|error| failed(&error))
    }

    /// Goes on to `time`, s, as [`Model::advance_with`] does, and shows from the time `first`, s, on where the particles are on the card: `show` is
    /// told what time it is, and gives when it wants to see them next, s; a time that has passed stands for the end of the next step.
    /// Nothing comes back in between but a few numbers and rows of gauges, so what draws the particles need not wait for the host. Without
    /// a card nobody is shown anything.
    ///
    /// # Errors
    /// Those of `advance_to`, and [`ModelError::Device`] where the card has too little memory.
    pub fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        first: f64,
        show: &mut dyn FnMut(f64, &DeviceParticles) -> f64,
    ) -> Result<(), ModelError> {
        if self.card.is_none() {
            return self.advance_with(time, stop, companion);
        }
        let watch = Some(Watch { wanted: first, shown: self.particles_shown(0.0), show });
        self.advance_measured(time, stop, Onlookers { watch, ..Onlookers::of(companion) })
    }

    /// Shows the particles, as the card has them after a step that ended at `now`, to who wants to see them before `before`, s.
    pub(super) fn show_to(&self, onlookers: &mut Onlookers<'_>, now: f64, before: f64) -> Result<(), GpuError> {
        let (Some(card), Some(watch)) = (&self.card, &mut onlookers.watch) else { return Ok(()) };
        let mut is_first = true;
        while watch.wanted < before && (watch.wanted > now || is_first) {
            let at = watch.wanted.max(now);
            let particles = card.seen(Shown { since: at - now, ..watch.shown })?;
            let next = (watch.show)(at, &particles);
            watch.wanted = if next > at { next } else { f64::NEG_INFINITY };
            is_first = false;
        }
        Ok(())
    }

    fn particles_shown(&self, since: f64) -> Shown {
        let spacing = self.spacing_shown();
        let mean_spacing = spacing.unwrap_or_else(|| self.mean_spacing());
        Shown { since, spacing, drop_spacing: self.spacing, mean_spacing }
    }

    /// Distance of the particles, m, as the host last knew them.
    fn mean_spacing(&self) -> f64 {
        let own = self.inside().filter(|particle| particle.depth > 0.0).map(|particle| particle.area().sqrt());
        let (sum, count) = own.fold((0.0, 0_u32), |(sum, count), spacing| (sum + spacing, count + 1));
        if count > 0 { sum / f64::from(count) } else { self.spacing }
    }
}
