//! Request and result of a batch of steps.

/// A particle that a source releases.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpawnRequest {
    /// Release time, s.
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
    /// The first step that ends then or after is the last: the host samples the maps.
    pub host_sample: f64,
    /// Times at which the GPU samples the maps itself, [`MAX_MAP_TIMES`](crate::sph_swe::maps::on_gpu::MAX_MAP_TIMES) at most, and when it last did.
    pub map_times: &'a [f64],
    pub last_sample: f64,
    /// Particles that sources release, the earliest first.
    pub spawn_requests: &'a [SpawnRequest],
    /// When rows of gauges are due: [`MOST_ROWS`](crate::sph_swe::gauges::on_gpu::MOST_ROWS) at most.
    pub due: &'a [f64],
}

/// Result of a batch of steps.
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
    /// Number of spawn requests done, and the identity of the next new particle.
    pub spawned: usize,
    pub next_id: u64,
    /// Number of samples of the maps taken, and the time of the last, s.
    pub map_samples: usize,
    pub last_sample: f64,
    /// Whether a value is not finite.
    pub broken: bool,
}

impl BatchResult {
    /// No steps yet at a time, s; `step` is the next one.
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
            spawned: 0,
            next_id: 0,
            map_samples: 0,
            last_sample: 0.0,
            broken: false,
        }
    }

    /// This result followed by a later one.
    pub fn and(self, later: Self) -> Self {
        Self {
            steps: self.steps + later.steps,
            particle_steps: self.particle_steps + later.particle_steps,
            outflow: self.outflow + later.outflow,
            inflow: self.inflow + later.inflow,
            momentum_lost: self.momentum_lost + later.momentum_lost,
            momentum_gained: self.momentum_gained + later.momentum_gained,
            spawned: self.spawned + later.spawned,
            map_samples: self.map_samples + later.map_samples,
            ..later
        }
    }
}
