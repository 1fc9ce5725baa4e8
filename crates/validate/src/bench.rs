//! What a bench is and what it gives.

use corpuscle_gpu::Gpu;
use corpuscle_model::ModelError;
use serde::Serialize;
use std::sync::LazyLock;
use std::time::Instant;

/// A rate measured on this machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rate {
    /// What was run: `flood/balanced-60k`.
    pub name: String,
    /// Number of particles.
    pub particles: usize,
    /// Dimensions of the computation.
    pub dimensions: usize,
    /// Part of space that particles fill (gas).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<f64>,
    /// Threads used; 0 on a graphics card.
    pub threads: usize,
    /// The graphics card, where it computes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// The rate, all threads together.
    pub rate: f64,
    /// What is counted: `particle_steps_per_s`.
    pub rate_unit: String,
    /// Memory of the model over its particles.
    pub bytes_per_particle: f64,
}

/// A scene whose cost matters.
#[derive(Debug, Clone, Copy)]
pub struct Bench {
    /// Name: the model and words, `flood/balanced-60k`.
    pub name: &'static str,
    /// What it measures, in a sentence.
    pub about: &'static str,
    /// Runs it.
    pub run: fn(&BenchOptions) -> Vec<Rate>,
}

/// What benches are run with.
#[derive(Debug, Clone, Default)]
pub struct BenchOptions {
    /// Less time for each, for a quick look: the figures scatter more.
    pub quick: bool,
    /// The graphics card to compute on; else the CPU.
    pub gpu: Option<Gpu>,
}

/// All benches.
pub fn benches() -> &'static [Bench] {
    static ALL: LazyLock<Vec<Bench>> = LazyLock::new(|| {
        [crate::flood::bench::BENCHES, crate::gas::bench::BENCHES, crate::dew::bench::BENCHES].concat()
    });
    &ALL
}

/// Time spent on steps: the wall clock's, or what a card says.
pub(crate) struct Clock {
    /// The card, where one takes the steps.
    pub device: Option<String>,
    began: Instant,
    before: f64,
}

impl Clock {
    /// Has the card take the steps by `use_card`, where one is to; none where it cannot, which it tells.
    pub fn start(options: &BenchOptions, use_card: impl FnOnce(Gpu) -> Result<(), ModelError>) -> Option<Self> {
        if let Some(Err(error)) = options.gpu.clone().map(use_card) {
            eprintln!("left out: {error}");
            return None;
        }
        let device = options.gpu.as_ref().map(|gpu| gpu.name.clone());
        Some(Self { device, began: Instant::now(), before: 0.0 })
    }

    /// Starts from 0; `on_card` is the time that the card says it has spent, s.
    pub fn restart(&mut self, on_card: Option<f64>) {
        self.began = Instant::now();
        self.before = on_card.unwrap_or(0.0);
    }

    /// Seconds since; `on_card` is the time that the card says it has spent, s.
    pub fn seconds(&self, on_card: Option<f64>) -> f64 {
        let on_card = on_card.map(|busy| busy - self.before);
        on_card.unwrap_or_else(|| self.began.elapsed().as_secs_f64())
    }

    /// Threads of the CPU that took the steps.
    pub fn threads(&self) -> usize {
        if self.device.is_some() { 0 } else { rayon::current_num_threads() }
    }
}
