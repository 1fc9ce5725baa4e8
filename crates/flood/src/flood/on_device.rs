//! A flood drawn where it lies: its particles as buffers of the card that takes the steps.

use super::Flood;
use super::measured_on_card::Onlookers;
use crate::card::Shown;
use corpuscle_gpu::GpuError;
use corpuscle_model::{Frame, Glance};

/// Who looks at the particles on the card.
pub(super) struct Watch<'a> {
    /// When it wants to see them, s: at the end of the next step if that has passed.
    pub wanted: f64,
    pub shown: Shown,
    /// Is called with the time, s, and the particles; returns when it wants to see them next, s.
    pub show: &'a mut dyn FnMut(Glance) -> f64,
}

impl Flood {
    /// Shows the particles, as the card has them after a step that ended at `now`, to who wants to see them before `before`, s.
    pub(super) fn show_to(&self, onlookers: &mut Onlookers<'_>, now: f64, before: f64) -> Result<(), GpuError> {
        let (Some(card), Some(watch)) = (&self.card, &mut onlookers.watch) else { return Ok(()) };
        let mut is_first = true;
        while watch.wanted < before && (watch.wanted > now || is_first) {
            let at = watch.wanted.max(now);
            let particles = card.seen(Shown { since: at - now, ..watch.shown })?;
            let next = (watch.show)(Glance { frame: Frame { time: at, sets: Vec::new() }, on_device: Some(particles) });
            watch.wanted = if next > at { next } else { f64::NEG_INFINITY };
            is_first = false;
        }
        Ok(())
    }

    /// How the particles are shown `since` s after the last step.
    pub(super) fn particles_shown(&self, since: f64) -> Shown {
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
