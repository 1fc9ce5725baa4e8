//! Progress of a run.

/// Progress of a run, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// End of the run, s.
    pub until: f64,
    /// Particles now.
    pub particles: usize,
    /// Particles moved (of a gas: collisions) per second of wall-clock time, since the start or the resumption.
    pub particle_steps_per_s: f64,
    /// Unit of that rate: `particle-steps` or `collisions`.
    pub counted: &'static str,
    /// Estimated wall-clock time left, s; none before the first step.
    pub left_s: Option<f64>,
}

impl Progress {
    /// Fraction of the run that is done, 0 to 1.
    pub fn fraction(&self) -> f64 {
        (self.time / self.until).clamp(0.0, 1.0)
    }
}
