//! Benches: measurements of rates.

use corpuscle_dew::Dew;
use corpuscle_flood::{SphSweFlood, VoronoiFlood};
use corpuscle_gpu::{Gpu, PassTiming};
use corpuscle_model::{GpuModel, Model, ModelError};
use corpuscle_processes::Processes;
use serde::Serialize;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A rate measured on this machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rate {
    /// Name of the bench: `flood/voronoi-60k`.
    pub name: String,
    /// Number of particles.
    pub particles: usize,
    /// Dimensions of the computation.
    pub dimensions: usize,
    /// Packing fraction (gas).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<f64>,
    /// Threads used, of each process; 0 on a GPU.
    pub threads: usize,
    /// Processes that share the model, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub processes: Option<usize>,
    /// The GPU, where it computes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// The rate, all threads together.
    pub rate: f64,
    /// Unit of the rate: `particle_steps_per_s`.
    pub rate_unit: String,
    /// Memory of the model over its particles; of several processes that of the first, times their number.
    pub bytes_per_particle: f64,
    /// Times of the passes of a step on the GPU, where requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub passes: Vec<PassTime>,
}

/// Time of a pass on a GPU.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PassTime {
    /// The name of its kernel.
    pub name: &'static str,
    /// How often it is done in a step.
    pub times_a_step: f64,
    /// Time in a step by the GPU's own clock, s.
    pub seconds_a_step: f64,
}

/// A bench: a scene whose rate is measured.
#[derive(Debug, Clone, Copy)]
pub struct Bench {
    /// Name: the model and words, `flood/voronoi-60k`.
    pub name: &'static str,
    /// What it measures, in a sentence.
    pub about: &'static str,
    /// True for a GPU only.
    pub needs_gpu: bool,
    /// Whether several processes share its model.
    pub is_shared: bool,
    /// Runs it.
    pub run: fn(&BenchOptions) -> Vec<Rate>,
}

/// Options of benches.
#[derive(Debug, Clone, Default)]
pub struct BenchOptions {
    /// Less time for each: the rates scatter more.
    pub quick: bool,
    /// The GPU to compute on; else the CPU.
    pub gpu: Option<Gpu>,
    /// Whether each pass of a step is timed on the GPU.
    pub passes: bool,
    /// The processes that share floods by scheme voronoi, and dew.
    pub processes: Processes,
}

/// A model that takes steps.
pub(crate) trait Stepped: Model {
    /// Time of the next step, s.
    fn time_step(&self) -> f64;
    /// Bytes held on the CPU.
    fn bytes(&self) -> usize;
}

macro_rules! stepped {
    ($($model:ty),*) => {
        $(impl Stepped for $model {
            fn time_step(&self) -> f64 {
                self.time_step()
            }
            fn bytes(&self) -> usize {
                self.bytes()
            }
        })*
    };
}

stepped!(SphSweFlood, VoronoiFlood, Dew);

/// Moves the steps of a model to a GPU.
fn use_gpu(model: &mut dyn Model, gpu: Gpu) -> Result<(), ModelError> {
    let why = model.cpu_only().map_or("", |cpu_only| cpu_only.what);
    model.on_gpu_mut().ok_or_else(|| ModelError::Setup(why.into()))?.use_gpu(gpu)
}

/// How a rate is measured.
pub(crate) struct Measuring {
    pub name: &'static str,
    pub dimensions: usize,
    /// Steps before the clock is started.
    pub settling: u64,
    /// Steps between two readings of the clock: on the CPU, and on a GPU, where each reading brings the state back.
    pub steps: [f64; 2],
    /// Wall-clock time, s.
    pub seconds: f64,
}

impl Measuring {
    /// The rate of a model, or none with a line that says so where the GPU cannot compute it.
    pub fn rate<M: Stepped>(&self, mut model: M, options: &BenchOptions) -> Result<Option<Rate>, ModelError> {
        if let Some(Err(error)) = options.gpu.clone().map(|gpu| use_gpu(&mut model, gpu)) {
            eprintln!("left out: {error}");
            return Ok(None);
        }
        let device = options.gpu.as_ref().map(|gpu| gpu.name.clone());
        let steps = self.steps[usize::from(device.is_some())];
        let ahead = |model: &mut M| model.advance_to(model.time() + steps * model.time_step(), &AtomicBool::new(false));
        while model.steps() < self.settling {
            ahead(&mut model)?;
        }
        let gpu_seconds = |model: &M| model.on_gpu().and_then(GpuModel::gpu_seconds);
        let (began, busy, before) = (Instant::now(), gpu_seconds(&model), model.particle_steps());
        let spent = |model: &M| match (gpu_seconds(model), busy) {
            (Some(now), Some(before)) => now - before,
            _ => began.elapsed().as_secs_f64(),
        };
        while spent(&model) < if options.quick { 0.2 * self.seconds } else { self.seconds } {
            ahead(&mut model)?;
        }
        let particles = model.particles();
        let mut rate = Rate {
            name: self.name.into(),
            particles,
            dimensions: self.dimensions,
            packing: None,
            threads: if device.is_some() { 0 } else { rayon::current_num_threads() },
            processes: options.processes.link().map(|link| link.count()),
            rate: (model.particle_steps() - before) as f64 / spent(&model),
            rate_unit: "particle_steps_per_s".into(),
            bytes_per_particle: model
                .on_gpu()
                .and_then(GpuModel::gpu_bytes)
                .unwrap_or((model.bytes() * options.processes.count()) as u64) as f64
                / particles as f64,
            device,
            passes: Vec::new(),
        };
        if options.passes {
            let steps = model.steps();
            if let Some(model) = model.on_gpu_mut() {
                model.time_passes();
            }
            ahead(&mut model)?;
            let steps = (model.steps() - steps) as f64;
            let a_step = |(name, taken): (&'static str, PassTiming)| PassTime {
                name,
                times_a_step: f64::from(taken.times) / steps,
                seconds_a_step: taken.total.as_secs_f64() / steps,
            };
            rate.passes =
                model.on_gpu().map(GpuModel::pass_times).unwrap_or_default().into_iter().map(a_step).collect();
            rate.passes.sort_by(|a, b| b.seconds_a_step.total_cmp(&a.seconds_a_step));
        }
        Ok(Some(rate))
    }
}
