//! Progress bars on standard error; hidden where that is not a terminal.

use crate::output::{duration, number, rate};
use corpuscle::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// Length of the bar in ticks.
const TICKS: u64 = 1000;

/// The progress bar of a run.
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar at its beginning.
    pub fn new() -> anyhow::Result<Self> {
        let bar = ProgressBar::new(TICKS);
        bar.set_style(ProgressStyle::with_template("{bar:30} {percent:>3} % {msg}")?);
        Ok(Self(bar))
    }

    /// Shows the progress of the run.
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

    /// Removes the bar.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// The progress bar of an ensemble.
pub struct MemberBar(ProgressBar);

impl MemberBar {
    /// A bar at its beginning.
    pub fn new() -> anyhow::Result<Self> {
        Ok(Self(Bar::new()?.0))
    }

    /// Shows the progress of the members after so much time.
    pub fn show(&self, progress: &corpuscle_ensemble::Progress, elapsed: Duration) {
        let &corpuscle_ensemble::Progress { members, ended, failed, part } = progress;
        let left = elapsed.as_secs_f64() * (1.0 - part) / part;
        let left = if left.is_finite() { format!(", {} left", duration(left)) } else { String::new() };
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        self.0.set_position((part * TICKS as f64) as u64);
        self.0.set_message(format!("{ended} of {members} members{failed}{left}"));
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// Does work of unknown duration under a spinner that shows the time elapsed.
pub fn while_shown<T>(what: &str, work: impl FnOnce() -> T) -> anyhow::Result<T> {
    let spinner = ProgressBar::new_spinner();
    spinner.set_style(ProgressStyle::with_template("{spinner} {msg}, {elapsed}")?);
    spinner.set_message(what.to_owned());
    spinner.enable_steady_tick(Duration::from_millis(100));
    let done = work();
    spinner.finish_and_clear();
    Ok(done)
}
