//! The contract a model fulfils, and what it gives: frames, gauges, maps, charts, paths and a ledger.
//!
//! A model depends on no screen, file or window. The caller advances it to a time and reads its state.

mod chart;
mod container;
mod frame;
mod gauge;
#[cfg(feature = "gpu")]
mod gpu_model;
mod ledger;
mod map;
mod name;
mod observer;
mod path;
mod reproducible_sum;
mod sums;
mod surface;

pub use chart::{Chart, ChartAxis, ChartSeries, ChartStyle};
pub use container::Container;
pub use frame::{Column, Frame, ParticleSet, Values};
pub use gauge::GaugeColumn;
#[cfg(feature = "gpu")]
pub use gpu_model::{Advance, Glance, GpuModel};
pub use ledger::{Account, Balance, Ledger};
pub use map::Map;
pub use name::Name;
pub use observer::{AdvanceObserver, ModelProgress, advance_with};
pub use path::Path;
pub use reproducible_sum::{ROUNDERS, ReproducibleSum};
pub use sums::{CompensatedSum, ExactSum};
pub use surface::{Distance, SolidShape, Surface};

use std::any::Any;
use std::sync::atomic::AtomicBool;

/// What can go wrong while a model runs. The text says what happened, when, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The computation broke down (a value that is not a number, a step too small to go on).
    #[error("the computation broke down at t = {time} s, step {step}: {what}")]
    Breakdown {
        /// Simulated time, s.
        time: f64,
        /// Number of the step.
        step: u64,
        /// The cause, and what to try.
        what: String,
    },
    /// The scene requires something that cannot be set up.
    #[error("{0}")]
    Setup(String),
    /// The device that computes gave up: lost, or out of memory.
    #[error("{0}")]
    Device(String),
    /// A saved state that does not fit this scene or this version.
    #[error("the checkpoint cannot be used: {0}")]
    Checkpoint(String),
}

/// Why a model runs on the CPU only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CpuOnly {
    /// What runs on the CPU only, as a sentence.
    pub what: &'static str,
    /// What to do where a GPU was requested.
    pub remedy: &'static str,
}

/// A model: physics that advances in time and whose state can be read.
///
/// The model steps at its own pace. The state that it shows at the requested time is read between two steps
/// (dense output), so reading it never changes the physics: the same scene gives the same bits
/// whatever the frame or gauge period.
pub trait Model: Any + Send {
    /// The model's name as written in a scene: `flood`, `gas` or `dew`.
    fn name(&self) -> &'static str;

    /// Where it computes: `cpu` or `gpu`.
    fn backend(&self) -> &'static str {
        "cpu"
    }

    /// Why the model runs on the CPU only, which a model does unless it says otherwise; none where a GPU can take its steps.
    fn cpu_only(&self) -> Option<CpuOnly> {
        Some(CpuOnly { what: "this model runs on the CPU only", remedy: "leave `--backend gpu` out" })
    }

    /// The model as one that can step on a GPU; none where it runs on the CPU only.
    #[cfg(feature = "gpu")]
    fn on_gpu(&self) -> Option<&dyn GpuModel> {
        None
    }

    /// As [`Model::on_gpu`], to change it.
    #[cfg(feature = "gpu")]
    fn on_gpu_mut(&mut self) -> Option<&mut dyn GpuModel> {
        None
    }

    /// The time the model shows now, s. Exactly the time of the last call of [`Model::advance_to`].
    fn time(&self) -> f64;

    /// Steps taken so far (gas: collisions).
    fn steps(&self) -> u64;

    /// Particles moved so far, summed over the steps: the measure of work done (gas: collisions).
    fn particle_steps(&self) -> u64;

    /// Particles in the model now.
    fn particles(&self) -> usize;

    /// Advances so that the model shows `time` (s, not before the present one). Returns early, at a time
    /// before `time` and in a sound state, when `stop` becomes true.
    ///
    /// # Errors
    /// [`ModelError::Breakdown`] where the computation cannot go on; the state before it stays readable.
    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError>;

    /// Advances as [`Model::advance_to`] does, and has `observer` take the rows of gauges that fall due on the way, the one at `time` among
    /// them. Returns early too when the observer calls the model back.
    ///
    /// # Errors
    /// Those of [`Model::advance_to`].
    fn advance_with(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
    ) -> Result<(), ModelError> {
        advance_with(self, time, stop, observer)
    }

    /// The particles at the time shown.
    fn frame(&self) -> Frame;

    /// Names and units of the gauge quantities, in the order of [`Model::gauge_row`].
    fn gauge_columns(&self) -> Vec<GaugeColumn>;

    /// The gauge values at the time shown; not-a-number where a gauge has nothing to measure.
    fn gauge_row(&self) -> Vec<f64>;

    /// Fields over the model's own map grid, as they stand now. Empty for a model without maps.
    fn maps(&self) -> Vec<Map>;

    /// Gives those of the [`Model::maps`] whose names `is_wanted` to `take`, one after another, so that not all of them need be in memory.
    fn each_map(&self, is_wanted: &dyn Fn(&str) -> bool, take: &mut dyn FnMut(Map)) {
        self.maps().into_iter().filter(|map| is_wanted(map.name)).for_each(take);
    }

    /// What was measured up to the time shown, as charts. Empty for a model without charts.
    fn charts(&self) -> Vec<Chart> {
        Vec::new()
    }

    /// The trajectories of the particles that are followed, up to the time shown. Empty where none is.
    fn paths(&self) -> Vec<Path> {
        Vec::new()
    }

    /// The surfaces of solids, as they stand now. Empty for a model without solids.
    fn surfaces(&self) -> Vec<Surface> {
        Vec::new()
    }

    /// The box round the particles; none for a model without one.
    fn container(&self) -> Option<Container> {
        None
    }

    /// What should be conserved, what came in and what went out.
    fn ledger(&self) -> Ledger;

    /// Warnings about this run, in sentences.
    fn warnings(&self) -> Vec<String>;

    /// The whole state, to the bit.
    fn save(&self) -> Vec<u8>;

    /// Takes back a state that [`Model::save`] wrote for the same scene.
    ///
    /// # Errors
    /// [`ModelError::Checkpoint`] where the bytes are damaged or belong to another scene.
    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError>;
}
