//! The progress bar.

use crate::output::{duration, number, rate};
use corpuscle::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// Length of the bar in ticks.
const TICKS: u64 = 1000;

/// A bar on standard error; hidden where that is not a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar at its beginning.
    pub fn new() -> anyhow::Result<Self> {
        let bar = ProgressBar::new(TICKS);
        bar.set_style(ProgressStyle::with_template("{bar:30} {percent:>3} % {msg}")?);
        Ok(Self(bar))
    }

    /// Shows how far the run has come.
    pub fn show(&self, progress: &Progress) {
        let left = progress.left_s.map(|left| format!(", {} left", duration(left))).unwrap_or_default();
        self.0.set_position((progress.fraction() * TICKS as f64) as u64);
        self.0.set_message(format!(
            "t = {} of {}, {} particles, {}{left}",
            number(progress.time),
            number(progress.until),
            progress.particles,
            rate(progress.particle_steps_per_s, progress.counted),
        ));
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}
