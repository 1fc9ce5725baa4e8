//! What a bench is and what it gives.

use serde::Serialize;
use std::sync::LazyLock;

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
    pub gpu: Option<corpuscle_gpu::Gpu>,
}

/// All benches.
pub fn benches() -> &'static [Bench] {
    static ALL: LazyLock<Vec<Bench>> = LazyLock::new(|| {
        [crate::flood::bench::BENCHES, crate::gas::bench::BENCHES, crate::dew::bench::BENCHES].concat()
    });
    &ALL
}
