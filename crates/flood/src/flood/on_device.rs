//! A flood drawn where it lies: its particles as buffers of the card that takes the steps.

use super::Flood;
use super::measured_on_card::Onlookers;
use super::on_card::failed;
use crate::card::{Card, Shown, Watch};
use corpuscle_gpu::{DeviceParticles, Gpu};
use corpuscle_model::{Companion, Model, ModelError};
use std::sync::atomic::AtomicBool;

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

    /// Goes on to `time`, s, as [`Model::advance_with`] does, and tells `show` after each step what time it is, s, and where the particles
    /// are on the card; it gives after how long, s, it wants to see them again, if no step ends before. Until it arrives, or
    /// `stop` becomes true, nothing comes back but a few numbers every 64 steps and rows of gauges, so what draws the particles need not
    /// wait; before a time that is waited for the same may be shown again. Without a card nobody is shown anything.
    ///
    /// # Errors
    /// Those of `advance_to`, and [`ModelError::Device`] where the card has too little memory.
    pub fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        show: &mut dyn FnMut(f64, &DeviceParticles) -> Option<f64>,
    ) -> Result<(), ModelError> {
        if self.card.is_none() {
            return self.advance_with(time, stop, companion);
        }
        let shown = self.particles_shown(0.0);
        let mut latest = self.state.time;
        // A guess may have been too late: time does not go back.
        let mut show = |time: f64, particles: &DeviceParticles| {
            latest = latest.max(time);
            show(latest, particles)
        };
        let watch = Some(Watch { shown, show: &mut show, stop });
        self.advance_measured(time, stop, Onlookers { watch, ..Onlookers::of(companion) })
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
