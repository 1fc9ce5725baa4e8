//! A batch of steps: what is asked for, and what it did.

/// A particle that is to come from a source.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Birth {
    /// s.
    pub time: f64,
    pub source: usize,
    pub velocity: [f64; 2],
}

/// A request for a batch of steps; times in s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BatchRequest<'a> {
    pub until: f64,
    /// Steps at most.
    pub most: u64,
    /// The first step that ends then or after is the last: the host is to look at the maps.
    pub look: f64,
    /// When the GPU is to look at the maps itself, [`MOST_LOOKS`](super::maps::MOST_LOOKS) at most, and when it last did.
    pub looks: &'a [f64],
    pub looked: f64,
    /// The particles that come from sources, the earliest first.
    pub births: &'a [Birth],
    /// When rows of gauges are due: [`MOST_ROWS`](super::gauges::MOST_ROWS) at most.
    pub due: &'a [f64],
}

/// What a batch of steps did.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BatchResult {
    pub steps: u64,
    pub particle_steps: u64,
    /// Time at the end of the last step, s.
    pub time: f64,
    /// The next step, s.
    pub step: f64,
    /// Volumes, m3, and momentum over density, m4/s.
    pub outflow: f64,
    pub inflow: f64,
    pub momentum_lost: f64,
    pub momentum_gained: f64,
    pub external: [f64; 2],
    pub mean_h: f64,
    /// How many of the births have been, and the identity of the next new particle.
    pub born: usize,
    pub next_id: u64,
    /// How many of the times to look at the maps have passed, and when it was last looked, s.
    pub looks: usize,
    pub looked: f64,
    /// Whether something is no number.
    pub broken: bool,
}

impl BatchResult {
    /// Nothing yet at a time, s; `step` is the next one.
    pub fn none(time: f64, step: f64) -> Self {
        Self {
            steps: 0,
            particle_steps: 0,
            time,
            step,
            outflow: 0.0,
            inflow: 0.0,
            momentum_lost: 0.0,
            momentum_gained: 0.0,
            external: [0.0; 2],
            mean_h: 0.0,
            born: 0,
            next_id: 0,
            looks: 0,
            looked: 0.0,
            broken: false,
        }
    }

    /// With what was done after it.
    pub fn and(self, later: Self) -> Self {
        Self {
            steps: self.steps + later.steps,
            particle_steps: self.particle_steps + later.particle_steps,
            outflow: self.outflow + later.outflow,
            inflow: self.inflow + later.inflow,
            momentum_lost: self.momentum_lost + later.momentum_lost,
            momentum_gained: self.momentum_gained + later.momentum_gained,
            born: self.born + later.born,
            looks: self.looks + later.looks,
            ..later
        }
    }
}
